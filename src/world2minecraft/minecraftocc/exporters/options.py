"""The options of an export, the interface of an exporter, and what several exporters share."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any, Protocol

import numpy as np

from world2minecraft.core.errors import InputError, UnknownNameError, UsageError
from world2minecraft.minecraftocc.types import OccSample
from world2minecraft.rendering.output.images import colour_bytes

FORMATS = ("nyu", "occscannet", "embodied", "npz")
UNKNOWN_CHOICES = ("keep", "empty")
# Where ISO, EmbodiedOcc and GPOcc look for OccScanNet, from the folder that they run in.
DATA_ROOT = "./data/occscannet"
FRAMES_PER_SCENE = 30  # As EmbodiedOcc-ScanNet; its loader holds all frames of a scene at once.
JPEG_QUALITY = 95  # As good as NYU's own colour images; the loaders take JPEG alone.


@dataclass(frozen=True)
class ExportRule:
    """The choices that the formats leave open.

    ``unknown`` is what cells of 255 are written as. All loaders but one leave 255 out of losses
    and scores, and that one (ISO's, of OccScanNet) makes them empty by itself: so they are kept.
    """

    unknown: str = "keep"  # keep (255) or empty (0)
    in_view: bool = False  # Cells outside the image become unknown, as the paper culls them.
    short_bin: bool = False  # nyu: a .bin of its head alone, which loaders only look for by name.
    data_root: str = DATA_ROOT  # occscannet, embodied: what paths inside the files begin with.
    frames_per_scene: int = FRAMES_PER_SCENE  # embodied: evenly taken; 0 for all.

    def __post_init__(self):
        if self.unknown not in UNKNOWN_CHOICES:
            raise UnknownNameError("choice of unknown cells", self.unknown, UNKNOWN_CHOICES)
        if self.frames_per_scene < 0:
            raise UsageError(f"frames_per_scene must be 0 or more, not {self.frames_per_scene}")

    def as_data(self) -> dict[str, Any]:
        """Return the choices as JSON holds them."""
        return asdict(self)


class Exporter(Protocol):
    """Writes one format into one folder."""

    def is_done(self, key: str) -> bool:
        """Return whether all files of a sample are there."""
        ...

    def write(self, sample: OccSample) -> None:
        """Write a sample.

        Raises:
            InputError: the format cannot hold it. OutputError: the folder cannot be written.
        """
        ...

    def pause(self) -> None:
        """Leave the folder so that the same export can go on: it was stopped."""
        ...

    def finish(self, keys: Sequence[str]) -> None:
        """Write what names all samples: lists and tables."""
        ...

    def notes(self) -> list[str]:
        """Return sentences on what the format could not hold unchanged."""
        ...


def encode_jpeg(pixels: np.ndarray) -> bytes:
    """Return uint8 [H, W, 3] as a JPEG, its colours at full resolution."""
    return colour_bytes(pixels, ".jpg", JPEG_QUALITY)


def require_colour(sample: OccSample) -> np.ndarray:
    """Return a sample's colour image. Raises InputError where it has none."""
    if sample.colour is None:
        raise InputError(
            sample.key, "it has no colour image, which this format needs; npz does without"
        )
    return sample.colour


def export_split(sample: OccSample) -> str:
    """Return train or test; a sample of neither goes to train."""
    return "test" if sample.split in ("test", "val") else "train"
