"""Photos without depth, and the results of structure from motion and stereo."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np

from world2minecraft.core.types import checks
from world2minecraft.core.types.capture import Camera


@dataclass(frozen=True, eq=False)
class RigMember:
    """A photo's part in a rig: photos from one place, with known directions to each other.

    Photos with the same ``place`` belong together, such as the views of one panorama.
    ``camera_to_rig`` float64 [4, 4] is the same for all photos with the same number ``sensor``, and
    the identity for sensor 0.
    """

    place: str
    sensor: int
    camera_to_rig: np.ndarray


@dataclass(frozen=True, eq=False)
class Photo:
    """A photo whose camera and pose may be unknown.

    ``colour`` is upright, uint8 [H, W, 3] in sRGB. ``camera`` has the size of the photo, or is None
    if the lens is unknown. ``camera_guessed`` means that the camera is an initial estimate (from
    EXIF). ``camera_to_scan`` 4x4 is None if the pose is unknown. ``rig`` is set if the photo
    shares its place with others; its camera is then exact.
    """

    name: str
    colour: np.ndarray
    camera: Camera | None = None
    camera_guessed: bool = False
    camera_to_scan: np.ndarray | None = None
    rig: RigMember | None = None

    def __post_init__(self):
        put = object.__setattr__
        checks.identifier("name", self.name)
        put(self, "colour", checks.array("colour", self.colour, np.uint8, (None, None, 3)))
        size = (self.colour.shape[1], self.colour.shape[0])
        if self.camera is not None and (self.camera.width_px, self.camera.height_px) != size:
            raise ValueError(f"the camera must have the size of the photo, {size}")
        if self.camera_to_scan is not None:
            pose = checks.transform("camera_to_scan", self.camera_to_scan)
            put(self, "camera_to_scan", pose)


class PhotoStream(Protocol):
    """Photos that can be iterated repeatedly, one at a time."""

    def __iter__(self) -> Iterator[Photo]:
        """Iterate over the photos from the first."""
        ...

    def __len__(self) -> int:
        """Return the number of photos."""
        ...


@dataclass(frozen=True, eq=False)
class SparseScene:
    """The camera poses of photos, and the points that are visible in several of them.

    ``cameras`` (one per frame, at the size of its photo) and ``camera_to_scan`` float64 [F, 4, 4]
    correspond to ``names``. ``points_m`` float32 [N, 3] are in the same frame, with ``colour``
    uint8 [N, 3]. Observation t is point ``track_point[t]`` seen by frame ``track_frame[t]`` (both
    int32 [T]) at ``track_px[t]`` (float32 [T, 2], pixel centres at +0.5). ``error_px`` is the mean
    reprojection error. ``left_out`` lists the frames that could not be registered with reasons.
    ``facts`` are results for the report, and ``notes`` are sentences.
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
    """A depth map computed for a photo, with the pose of the photo.

    ``camera`` has no distortion. ``depth_m`` float32 [h, w] is the z-depth in metres, or 0 if
    unknown. ``trust`` uint8 [h, w] is the reliability of each pixel, up to 255.
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
