"""Captures: cameras, posed views, scans, and the corrections of frames."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, Protocol

import numpy as np

from world2minecraft.core.types import checks

MAX_SIDE_PX = 20_000
IDENTITY = np.eye(4)


@dataclass(frozen=True)
class Camera:
    """A pinhole camera with OpenCV distortion k1 k2 p1 p2 k3 and pixel centres at +0.5."""

    width_px: int
    height_px: int
    fx_px: float
    fy_px: float
    cx_px: float
    cy_px: float
    distortion: tuple[float, ...] = (0.0, 0.0, 0.0, 0.0, 0.0)

    def __post_init__(self):
        for name in ("width_px", "height_px"):
            size = getattr(self, name)
            if int(size) != size or not 0 < size <= MAX_SIDE_PX:
                raise ValueError(f"{name} must be 1 to {MAX_SIDE_PX}, got {size}")
            object.__setattr__(self, name, int(size))
        checks.positive("fx_px", self.fx_px)
        checks.positive("fy_px", self.fy_px)
        checks.floats("cx_px, cy_px", (self.cx_px, self.cy_px), (2,))
        distortion = tuple(checks.floats("distortion", self.distortion, (5,)).tolist())
        object.__setattr__(self, "distortion", distortion)

    @property
    def matrix(self) -> np.ndarray:
        """The 3x3 intrinsic matrix K."""
        return np.array(
            [[self.fx_px, 0, self.cx_px], [0, self.fy_px, self.cy_px], [0, 0, 1]], np.float64
        )

    def resized(self, width_px: int, height_px: int) -> "Camera":
        """Return the camera of the same image resampled to another size.

        Raises:
            ValueError: If the aspect ratio changes by more than 1 %.
        """
        across, down = width_px / self.width_px, height_px / self.height_px
        if abs(across / down - 1) > 0.01:
            raise ValueError(
                f"{width_px}x{height_px} has another aspect ratio than "
                f"{self.width_px}x{self.height_px}"
            )
        return self.scaled_to(width_px, height_px)

    def scaled_to(self, width_px: int, height_px: int) -> "Camera":
        """Return the camera of the same image resampled to another size with any aspect ratio."""
        across, down = width_px / self.width_px, height_px / self.height_px
        return Camera(
            width_px,
            height_px,
            self.fx_px * across,
            self.fy_px * down,
            self.cx_px * across,
            self.cy_px * down,
            self.distortion,
        )


@dataclass(frozen=True, eq=False)
class View:
    """A frame with its pose. Colour and depth can have different sizes, lenses and positions.

    ``depth_m`` is the z-depth in metres, or 0 without a measurement. ``camera_to_scan`` is the pose
    of the colour camera, or of the depth camera if there is no colour. ``trust`` uint8 [h, w] is
    the reliability of each depth pixel, up to 255. ``label_ids`` uint16 [h, w] are finer than
    ``labels``: NYU40 classes and names, see ``core.vocabulary.label_id_names``; 0 is unknown.
    """

    name: str
    camera_to_scan: np.ndarray
    colour: np.ndarray | None = None
    colour_camera: Camera | None = None
    depth_m: np.ndarray | None = None
    depth_camera: Camera | None = None
    depth_to_colour: np.ndarray = field(default_factory=lambda: IDENTITY)
    labels: np.ndarray | None = None
    trust: np.ndarray | None = None
    label_ids: np.ndarray | None = None

    def __post_init__(self):
        put = object.__setattr__
        checks.identifier("name", self.name)
        put(self, "camera_to_scan", checks.transform("camera_to_scan", self.camera_to_scan))
        put(self, "depth_to_colour", checks.transform("depth_to_colour", self.depth_to_colour))
        if (self.colour is None) != (self.colour_camera is None):
            raise ValueError("colour and colour_camera must be given together")
        if (self.depth_m is None) != (self.depth_camera is None):
            raise ValueError("depth_m and depth_camera must be given together")
        if self.colour_camera is not None:
            shape = (self.colour_camera.height_px, self.colour_camera.width_px)
            put(self, "colour", checks.array("colour", self.colour, np.uint8, (*shape, 3)))
            if self.labels is not None:
                put(self, "labels", checks.labels("labels", self.labels, shape))
            if self.label_ids is not None:
                ids = checks.array("label_ids", self.label_ids, np.uint16, shape)
                put(self, "label_ids", ids)
        elif self.labels is not None or self.label_ids is not None:
            raise ValueError("labels require a colour image")
        if self.depth_camera is not None:
            shape = (self.depth_camera.height_px, self.depth_camera.width_px)
            depth = checks.array("depth_m", self.depth_m, np.float32, shape)
            if not (np.isfinite(depth).all() and (depth >= 0).all()):
                raise ValueError("depth_m must be finite and not negative (0 for missing depth)")
            put(self, "depth_m", depth)
            if self.trust is not None:
                put(self, "trust", checks.array("trust", self.trust, np.uint8, shape))
        elif self.trust is not None:
            raise ValueError("trust requires a depth image")

    @property
    def depth_camera_to_scan(self) -> np.ndarray:
        """The pose of the depth camera, a 4x4 transform."""
        return self.camera_to_scan @ self.depth_to_colour


class ViewStream(Protocol):
    """Views that can be iterated repeatedly, one at a time, without loading the whole capture."""

    def __iter__(self) -> Iterator[View]:
        """Iterate over the views from the first."""
        ...

    def __len__(self) -> int:
        """Return the number of views."""
        ...


@dataclass(frozen=True)
class FrameSigmas:
    """Uncertainty (one sigma) of the room's frame in the scan.

    Attributes:
        tilt_deg: Uncertainty of the up direction in degrees.
        yaw_deg: Uncertainty of the rotation about it that aligns the walls with x and y.
        floor_m: Uncertainty of the floor's height in metres; None if no floor was seen.
    """

    tilt_deg: float
    yaw_deg: float
    floor_m: float | None

    def __post_init__(self):
        checks.positive("tilt_deg", self.tilt_deg)
        checks.positive("yaw_deg", self.yaw_deg)
        if self.floor_m is not None:
            checks.positive("floor_m", self.floor_m)


@dataclass(frozen=True, eq=False)
class Scan:
    """An aligned capture with the position of the room and the reliability of its scale.

    ``scan_to_room`` transforms the scan frame to the room frame. The inner box of the room spans
    (0, 0, 0) to ``room_size_m``. ``notes`` are sentences for the report, ``name`` is the name of
    the scene, and ``depth_kind`` is the source of the depth, which determines its errors.
    ``world_up`` is a unit vector in the scan frame if the capture records the up direction.
    ``frame_sigmas`` is None if the capture states the room frame. ``source_to_scan`` transforms the
    coordinates of the capture's files to the scan frame: a shift for georeferenced poses, also a
    change of axes and a scale for meshes. ``colour_correction`` is the factor of the stated focal
    length of the colour camera and the shifts of its principal point in pixels, to the right and
    downward.
    """

    views: ViewStream
    scan_to_room: np.ndarray
    room_size_m: np.ndarray
    frames_used: tuple[str, ...]
    frames_skipped: tuple[tuple[str, str], ...] = ()
    scale: Literal["metric", "estimated", "unknown"] = "metric"
    scale_sigma: float = 0.0
    source: str = ""
    notes: tuple[str, ...] = ()
    name: str = ""
    depth_kind: Literal["sensor", "stereo", "network", "exact"] = "sensor"
    world_up: np.ndarray | None = None
    frame_sigmas: FrameSigmas | None = None
    source_to_scan: np.ndarray = field(default_factory=lambda: IDENTITY)
    colour_correction: tuple[float, float, float] = (1.0, 0.0, 0.0)

    def __post_init__(self):
        put = object.__setattr__
        put(self, "source_to_scan", checks.floats("source_to_scan", self.source_to_scan, (4, 4)))
        if self.world_up is not None:
            put(self, "world_up", checks.floats("world_up", self.world_up, (3,)))
            if abs(np.linalg.norm(self.world_up) - 1) > 1e-6:
                raise ValueError(f"world_up must be a unit vector, got {self.world_up.tolist()}")
        put(self, "scan_to_room", checks.transform("scan_to_room", self.scan_to_room))
        put(self, "room_size_m", checks.lengths("room_size_m", self.room_size_m, (3,)))
        if (self.room_size_m <= 0).any():
            raise ValueError(f"room_size_m must be above 0, got {self.room_size_m.tolist()}")
        if self.scale not in ("metric", "estimated", "unknown"):
            raise ValueError(f"scale must be metric, estimated or unknown, got {self.scale!r}")
        put(self, "frames_used", tuple(self.frames_used))
        put(self, "frames_skipped", tuple(self.frames_skipped))
        put(self, "notes", tuple(self.notes))


@dataclass(frozen=True, eq=False)
class Corrections:
    """The results of the registration: a pose correction and a depth scale for each frame.

    ``pose_change`` float64 [F, 4, 4] is a rigid transform, scan to scan, applied on the left of a
    frame's pose. ``depth_scale`` float64 [F] is a factor for the depth. ``facts`` are the results
    for ``scan.json``. A frame that is not in ``names`` is not changed.
    """

    names: tuple[str, ...]
    pose_change: np.ndarray
    depth_scale: np.ndarray
    facts: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self):
        put = object.__setattr__
        names = tuple(str(name) for name in self.names)
        if len(set(names)) != len(names):
            raise ValueError("names must be distinct")
        change = checks.floats("pose_change", self.pose_change, (len(names), 4, 4))
        scale = checks.floats("depth_scale", self.depth_scale, (len(names),))
        if (scale <= 0).any():
            raise ValueError("depth_scale must be above 0")
        for name, one in zip(names, change, strict=True):
            checks.transform(f"pose_change of {name}", one)
        put(self, "names", names)
        put(self, "pose_change", change)
        put(self, "depth_scale", scale)
