"""Types of an unread capture: its frames' files, stated cameras and poses, and ``Source``.

Nothing is decoded here. Paths, matrices and units are as the capture states them; ``validation``
checks them afterwards, in the same way for every source.
"""

from dataclasses import dataclass, field
from typing import Literal, Protocol, runtime_checkable

import numpy as np

from world2minecraft.capture.images import ImagePlace
from world2minecraft.capture.options import ScanOptions
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.types import Camera


def as_floats(values: object) -> np.ndarray:
    """Return stated numbers as float64 in the shape of their lists; empty where they are none.

    NaN and infinity stay; a whole number too long for a float makes the whole empty.

    Example:
        >>> as_floats([[1, 2], [3, 4]]).shape, as_floats([[1, 2], [3]]).shape, as_floats("x").shape
        ((2, 2), (0,), (0,))
    """
    try:
        return np.array(values, np.float64)
    except (TypeError, ValueError, OverflowError):
        return np.zeros(0)


@dataclass(frozen=True, eq=False)
class FrameFiles:
    """One frame as stated: unread images, unchecked pose.

    ``camera_to_world`` is float64 [4, 4] of an OpenCV camera, that of the colour image or of the
    depth image where there is no colour; it may hold NaN where tracking was lost, and is None
    where the capture states none. ``problem`` says why the frame cannot be used at all.
    ``trust_path`` is an image of how far each depth pixel is to be trusted, at the depth image's
    size; ``Capture.full_trust`` tells its unit. ``time_s`` orders the frames of videos.
    """

    name: str
    camera_to_world: np.ndarray | None
    colour_path: ImagePlace | None = None
    colour_camera: Camera | None = None
    depth_path: ImagePlace | None = None
    depth_camera: Camera | None = None
    depth_to_colour: np.ndarray = field(default_factory=lambda: np.eye(4))
    labels_path: ImagePlace | None = None
    problem: str = ""
    trust_path: ImagePlace | None = None
    time_s: float | None = None


@dataclass(frozen=True, eq=False)
class Capture:
    """A capture that was detected and listed but not yet validated.

    ``folder`` is the folder or file that the user named. ``one_matrix`` says that depth and colour
    share one stated matrix, so that the colour camera may truly be another. ``depth_unit`` is None
    where the capture does not state it. ``depth_kind`` says what made the depth: a ``sensor``,
    ``stereo``, a ``network``, or nothing that errs (``exact``, a rendered mesh). ``lens``
    says whether the colour cameras are ``stated`` or a first ``guess`` (EXIF, or none).
    ``full_trust`` is the value of ``trust_path`` that means full trust; 0 always means none.
    ``world_up`` is a unit vector of the world frame where the capture is known to stand upright.
    ``scale`` and ``scale_sigma`` are as in ``Scan``: ``unknown`` where poses have no unit.
    ``skipped`` are frames that were left out before, with reasons. ``room`` is ``scan_to_room``
    and the room's size in metres where depth cannot tell them: of one photo that has none.
    """

    folder: AnyPath
    source: str
    frames: tuple[FrameFiles, ...]
    depth_unit: str | None = None
    one_matrix: bool = False
    notes: tuple[str, ...] = ()
    depth_kind: Literal["sensor", "stereo", "network", "exact"] = "sensor"
    lens: Literal["stated", "guess"] = "stated"
    full_trust: float = 255.0
    world_up: np.ndarray | None = None
    scale: Literal["metric", "estimated", "unknown"] = "metric"
    scale_sigma: float = 0.0
    skipped: tuple[tuple[str, str], ...] = ()
    room: tuple[np.ndarray, np.ndarray] | None = None


class Source(Protocol):
    """One kind of capture on disk.

    A place is a folder, a file, or the inside of a zip (``archive.ArchivePath``, which has the
    part of ``Path`` that readers need), so that most sources read zips without knowing it.
    """

    layout: str  # One line that shows a reader what it looks like.

    def recognise(self, folder: AnyPath) -> bool:
        """Return whether this kind of capture lies there, from names alone where that tells."""
        ...

    def read(self, folder: AnyPath) -> Capture:
        """List the frames.

        Raises:
            CaptureError: something that every frame needs is missing or contradicts itself.
        """
        ...


@runtime_checkable
class ConfigurableSource(Source, Protocol):
    """A source that options of the user can help, such as the unit of a mesh."""

    def read_with(self, folder: AnyPath, options: ScanOptions) -> Capture:
        """List the frames, as ``read`` does."""
        ...
