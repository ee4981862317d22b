"""Photos without depth, and what structure from motion and stereo give: poses, points, depth."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np

from world2minecraft.core.types import checks
from world2minecraft.core.types.capture import Camera


@dataclass(frozen=True, eq=False)
class Photo:
    """One picture, whose camera and place may be unknown.

    ``colour`` is upright, uint8 [H, W, 3] sRGB. ``camera`` is of its size; None where nothing is
    stated of the lens. ``camera_guessed`` says that it is a start (EXIF), not a statement.
    ``camera_to_scan`` 4x4 is None where no pose is stated.
    """

    name: str
    colour: np.ndarray
    camera: Camera | None = None
    camera_guessed: bool = False
    camera_to_scan: np.ndarray | None = None

    def __post_init__(self):
        put = object.__setattr__
        checks.identifier("name", self.name)
        put(self, "colour", checks.array("colour", self.colour, np.uint8, (None, None, 3)))
        size = (self.colour.shape[1], self.colour.shape[0])
        if self.camera is not None and (self.camera.width_px, self.camera.height_px) != size:
            raise ValueError(f"the camera is of another size than the picture, {size}")
        if self.camera_to_scan is not None:
            pose = checks.transform("camera_to_scan", self.camera_to_scan)
            put(self, "camera_to_scan", pose)


class PhotoStream(Protocol):
    """Photos that can be read again, one at a time."""

    def __iter__(self) -> Iterator[Photo]:
        """Read the photos from the first."""
        ...

    def __len__(self) -> int:
        """The number of photos."""
        ...


@dataclass(frozen=True, eq=False)
class SparseScene:
    """Where photos were taken, and the points that several of them see.

    ``cameras`` (one a frame, at its photo's size) and ``camera_to_scan`` float64 [F, 4, 4] belong
    to ``names``; ``points_m`` float32 [N, 3] lie in the same frame, ``colour`` uint8 [N, 3].
    Observation t is point ``track_point[t]`` seen by frame ``track_frame[t]`` (both int32 [T]) at
    ``track_px[t]`` (float32 [T, 2], pixel centres at +0.5). ``error_px`` is the mean reprojection
    error. Frames that could not be placed are ``left_out`` with reasons. ``facts`` are figures for
    the report, ``notes`` sentences.
    """

    names: tuple[str, ...]
    cameras: tuple[Camera, ...]
    camera_to_scan: np.ndarray
    points_m: np.ndarray
    colour: np.ndarray
    track_frame: np.ndarray
    track_point: np.ndarray
    track_px: np.ndarray
    error_px: float
    left_out: tuple[tuple[str, str], ...] = ()
    notes: tuple[str, ...] = ()
    facts: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self):
        put = object.__setattr__
        frames = len(self.names)
        if len(set(self.names)) != frames or len(self.cameras) != frames:
            raise ValueError("names must be distinct, with one camera each")
        poses = checks.floats("camera_to_scan", self.camera_to_scan, (frames, 4, 4))
        put(self, "camera_to_scan", poses)
        put(self, "points_m", checks.array("points_m", self.points_m, np.float32, (None, 3)))
        points = len(self.points_m)
        put(self, "colour", checks.array("colour", self.colour, np.uint8, (points, 3)))
        put(self, "track_px", checks.array("track_px", self.track_px, np.float32, (None, 2)))
        tracks = len(self.track_px)
        for name, most in (("track_frame", frames), ("track_point", points)):
            index = checks.array(name, getattr(self, name), np.int32, (tracks,))
            if tracks and not (index.min() >= 0 and index.max() < most):
                raise ValueError(f"{name} must be 0 to {most - 1}")
            put(self, name, index)


@dataclass(frozen=True, eq=False)
class DepthMap:
    """Depth that was computed for a photo.

    ``camera`` has no distortion; ``depth_m`` float32 [h, w] is z-depth, 0 where there is none;
    ``trust`` uint8 [h, w] is 255 where it is sure. The pose is that of the photo.
    """

    name: str
    camera: Camera
    depth_m: np.ndarray
    trust: np.ndarray

    def __post_init__(self):
        put = object.__setattr__
        shape = (self.camera.height_px, self.camera.width_px)
        if any(self.camera.distortion):
            raise ValueError("the camera of a depth map must have no distortion")
        put(self, "depth_m", checks.array("depth_m", self.depth_m, np.float32, shape))
        put(self, "trust", checks.array("trust", self.trust, np.uint8, shape))
