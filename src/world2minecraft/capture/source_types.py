"""Types of a capture that has not been validated: frames, captures and the ``Source`` protocol.

Nothing is decoded here. Paths, matrices and units are as stated by the capture; ``validation``
checks them afterwards in the same way for all sources.
"""

from dataclasses import dataclass, field
from typing import Literal, Protocol, runtime_checkable

import numpy as np

from world2minecraft.capture.images import ImagePlace
from world2minecraft.capture.options import ScanOptions
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.types import Camera
from world2minecraft.core.types.photos import RigMember


def as_floats(values: object) -> np.ndarray:
    """Convert nested lists to a float64 array; the result is empty if that is not possible.

    NaN and infinity are kept. An integer too large for a float makes the whole result empty.

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
    """A frame as stated by a capture, with unread images and an unchecked pose.

    Attributes:
        name: Name of the frame.
        camera_to_world: Pose of the colour camera, or of the depth camera without colour, float64
            [4, 4] with OpenCV axes. It contains NaN if tracking was lost, and is None if no pose is
            stated.
        colour_path: Colour image, or None.
        colour_camera: Intrinsics of the colour image, or None.
        depth_path: Depth image, or None.
        depth_camera: Intrinsics of the depth image, or None.
        depth_to_colour: Transform from the depth camera to the colour camera, float64 [4, 4].
        labels_path: Label image, or None.
        problem: Why the frame cannot be used, or an empty string.
        trust_path: Confidence image of the size of the depth image, in units of
            ``Capture.full_trust``.
        time_s: Time in seconds, which orders the frames of a video, or None.
        rig: Part in a rig, for photos that share a place, or None.
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
    rig: RigMember | None = None


@dataclass(frozen=True, eq=False)
class Capture:
    """A capture that has been detected and listed but not yet validated.

    Attributes:
        folder: Folder or file given by the user.
        source: Name of the format.
        frames: The frames as stated.
        depth_unit: Depth unit, or None if the capture does not state it.
        one_matrix: Whether depth and colour share one stated matrix, so that the colour camera may
            differ from it.
        notes: Remarks for the user.
        depth_kind: Origin of the depth: ``sensor``, ``stereo``, ``network``, or ``exact`` for
            rendered depth without errors.
        lens: Whether the colour intrinsics are ``stated`` or a ``guess`` (from EXIF, or missing).
        full_trust: Value in ``trust_path`` images that means full confidence; 0 always means none.
        world_up: Up direction as a unit vector in the world frame, or None if unknown.
        scale: Kind of scale, as in ``Scan``; ``unknown`` if the poses have no unit.
        scale_sigma: Relative standard deviation of the scale, as in ``Scan``.
        skipped: Names of frames skipped earlier, with reasons.
        room: ``scan_to_room`` and the room size in metres if stated, for captures without depth.
        source_to_scan: Transform from the coordinates of the files to those of ``frames``, float64
            [4, 4]: an axis change and a scale for meshes, a shift for georeferenced poses.
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
    source_to_scan: np.ndarray = field(default_factory=lambda: np.eye(4))


class Source(Protocol):
    """A reader of one format of captures.

    Paths are folders, files or places in a zip archive. ``ArchivePath`` implements the part of
    ``Path`` that readers use, so that most sources can read archives without special code.
    """

    layout: str  # One line that shows a reader what it looks like.

    def recognise(self, folder: AnyPath) -> bool:
        """Return whether a path is a capture of this format, from file names only if possible."""
        ...

    def read(self, folder: AnyPath) -> Capture:
        """Read the list of frames.

        Raises:
            CaptureError: If required data is missing or inconsistent.
        """
        ...


@runtime_checkable
class ConfigurableSource(Source, Protocol):
    """A source that supports user options, such as the unit of a mesh."""

    def read_with(self, folder: AnyPath, options: ScanOptions) -> Capture:
        """Read the list of frames with user options."""
        ...
