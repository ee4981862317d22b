"""What a source reads from a folder: where the frames lie and what is stated of their cameras.

Nothing is decoded here. Paths, matrices and units are as the capture states them; ``checking``
judges them afterwards, the same way for every source.
"""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

import numpy as np

from world2minecraft.types import Camera


@dataclass(frozen=True, eq=False)
class FrameFiles:
    """One frame as stated: unread images, unchecked pose.

    ``camera_to_world`` is float64 [4, 4] of an OpenCV camera, that of the colour image or of the
    depth image where there is no colour; it may hold NaN where tracking was lost, and is None
    with the reason in ``problem`` where the frame cannot be used at all.
    """

    name: str
    camera_to_world: np.ndarray | None
    colour_path: Path | None = None
    colour_camera: Camera | None = None
    depth_path: Path | None = None
    depth_camera: Camera | None = None
    depth_to_colour: np.ndarray = field(default_factory=lambda: np.eye(4))
    labels_path: Path | None = None
    problem: str = ""


@dataclass(frozen=True, eq=False)
class Capture:
    """A folder of frames, found out and listed but not judged.

    ``one_matrix`` says that depth and colour share one stated matrix, so that the colour camera
    may truly be another. ``depth_unit`` is None where the capture does not state it.
    """

    folder: Path
    source: str
    frames: tuple[FrameFiles, ...]
    depth_unit: str | None = None
    one_matrix: bool = False
    notes: tuple[str, ...] = ()


class Source(Protocol):
    """One layout of captures on disk."""

    layout: str  # One line that shows a reader what the folder looks like.

    def recognise(self, folder: Path) -> bool:
        """Return whether the folder has this layout, from its names alone."""
        ...

    def read(self, folder: Path) -> Capture:
        """List the frames.

        Raises:
            CaptureError: something that every frame needs is missing or contradicts itself.
        """
        ...
