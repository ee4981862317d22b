"""Export options, the interface of an exporter, and functions that several exporters share."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any, Protocol

import numpy as np

from world2minecraft.core.errors import InputError, UnknownNameError, UsageError
from world2minecraft.minecraftocc.types import OccSample
from world2minecraft.rendering.output.images import colour_bytes

FORMATS = ("nyu", "occscannet", "embodied", "npz")
UNKNOWN_CHOICES = ("keep", "empty")
# Axes of OccScanNet labels: y, x, z in the published files, which EmbodiedOcc and GPOcc swap when
# they load them, and x, y, z for ISO, which does not.
AXES_CHOICES = {"published": (1, 0, 2), "iso": (0, 1, 2)}
# Where ISO, EmbodiedOcc and GPOcc look for OccScanNet, from the folder that they run in.
DATA_ROOT = "./data/occscannet"
FRAMES_PER_SCENE = 30  # As in EmbodiedOcc-ScanNet, whose loader reads whole scenes into memory.
JPEG_QUALITY = 95  # As in NYU's colour images; the loaders read only JPEG.


@dataclass(frozen=True)
class ExportRule:
    """The options of an export.

    Attributes:
        unknown: How to write unknown cells: ``keep`` (255) or ``empty`` (0). All loaders but one
            ignore 255 in losses and scores, and that one (ISO's loader for OccScanNet) treats 255
            as empty, so the default is ``keep``.
        in_view: Whether to mark cells outside the image as unknown, as the paper does.
        short_bin: ``nyu`` only: write only the header of each ``.bin`` file, since loaders use just
            its name.
        data_root: ``occscannet`` and ``embodied`` only: prefix of the paths inside the files.
        axes: ``occscannet`` only: ``published`` for the axis order of the published files, or
            ``iso`` for the order that ISO's loader expects.
        frames_per_scene: ``embodied`` only: maximum number of frames per scene, evenly spaced; 0
            uses all.
    """

    unknown: str = "keep"
    in_view: bool = False
    short_bin: bool = False
    data_root: str = DATA_ROOT
    frames_per_scene: int = FRAMES_PER_SCENE

    axes: str = "published"

    def __post_init__(self):
        if self.axes not in AXES_CHOICES:
            raise UnknownNameError("order of axes", self.axes, AXES_CHOICES)
        if self.unknown not in UNKNOWN_CHOICES:
            raise UnknownNameError("treatment of unknown cells", self.unknown, UNKNOWN_CHOICES)
        if self.frames_per_scene < 0:
            raise UsageError(f"frames_per_scene must be 0 or more, got {self.frames_per_scene}")

    def as_data(self) -> dict[str, Any]:
        """Return the options as a dict for JSON, without the axes of the published files."""
        data = asdict(self)
        return data if self.axes != "published" else {k: v for k, v in data.items() if k != "axes"}


class Exporter(Protocol):
    """Interface of an exporter, which writes samples in one format to one folder."""

    def is_done(self, key: str) -> bool:
        """Return whether all files of a sample exist."""
        ...

    def write(self, sample: OccSample) -> None:
        """Write a sample.

        Raises:
            InputError: If the format cannot represent the sample.
            OutputError: If the folder cannot be written.
        """
        ...

    def pause(self) -> None:
        """Save what is needed to resume the export later. Called when the export is interrupted."""
        ...

    def finish(self, keys: Sequence[str]) -> None:
        """Write the lists and tables that cover all samples."""
        ...

    def notes(self) -> list[str]:
        """Return descriptions of data that the format cannot represent unchanged."""
        ...


def encode_jpeg(pixels: np.ndarray) -> bytes:
    """Encode a colour image, uint8 [H, W, 3], as a JPEG without chroma subsampling."""
    return colour_bytes(pixels, ".jpg", JPEG_QUALITY)


def require_colour(sample: OccSample) -> np.ndarray:
    """Return the colour image of a sample.

    Raises:
        InputError: If the sample has no colour image.
    """
    if sample.colour is None:
        raise InputError(
            sample.key,
            "the sample has no colour image, which this format requires; export to npz instead",
        )
    return sample.colour


def export_split(sample: OccSample) -> str:
    """Return ``train`` or ``test`` for a sample, with ``train`` if it has no split."""
    return "test" if sample.split in ("test", "val") else "train"
