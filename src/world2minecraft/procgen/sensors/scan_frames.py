"""The frames of a virtual scan with their ground truth, generated one at a time.

``ScanSettings`` contains the settings of a scan. ``room_shots`` plans the tour and renders the
images. Images are not stored, so the memory use does not depend on their number.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from world2minecraft.core.classes import CLASS_COUNT
from world2minecraft.core.types import Camera, View
from world2minecraft.geometry.rotations import rotation_from_vector
from world2minecraft.procgen.rooms.room import Room
from world2minecraft.procgen.sensors.depth_camera import (
    PHONES,
    Sensor,
    find_sensor,
    jitter_pose,
    scale_factor,
    sense_depth,
)
from world2minecraft.procgen.sensors.photo_rendering import (
    Photo,
    PhotoScene,
    prepare_photos,
    take_photo,
)
from world2minecraft.procgen.sensors.trajectory import plan_trajectory

FOCAL_SHARE = 0.82  # Focal length / width: 525 px at 640, a field of view of 63 degrees.
MAX_TILT_DEG = 27.0  # What the shared kitchen's world frame is tilted by.
LUMINANCE = np.array([0.299, 0.587, 0.114], np.float32)
DEFAULT_FRAMES = {"photo": 100, "photos": 100, "video": 240}
USUAL_FRAMES = 40  # Default for sensors with depth.
PATCH_PX = 8  # Label errors come in patches: a segmenter errs by regions.


@dataclass(frozen=True)
class ScanSettings:
    """The settings of a virtual scan. See ``scan_room`` for the fields.

    Raises:
        UnknownNameError: If the sensor is unknown.
        ValueError: If a value is out of range.
    """

    sensor: str = "rgbd"
    frames: int | None = None
    seed: int = 0
    with_labels: bool = False
    label_error: float = 0.0
    depth_scale_sigma: float = 0.0
    coverage: float = 1.0
    width: int = 640
    height: int = 480

    def __post_init__(self):
        find_sensor(self.sensor)
        if self.frames is not None and self.frames < 1:
            raise ValueError(f"frames must be 1 or more, got {self.frames}")
        if not 0 <= self.label_error <= 1:
            raise ValueError(f"label_error must be from 0 to 1, got {self.label_error}")
        if not 0 <= self.depth_scale_sigma <= 0.2:
            raise ValueError(
                f"depth_scale_sigma must be from 0 to 0.2, got {self.depth_scale_sigma}"
            )
        if not 0 < self.coverage <= 1:
            raise ValueError(f"coverage must be above 0 and at most 1, got {self.coverage}")
        if self.phone and (self.with_labels or self.label_error):
            raise ValueError(f"labels require the sensor rgbd or clean, got {self.sensor}")
        if self.sensor == "video" and (self.width % 2 or self.height % 2):
            raise ValueError(f"video width and height must be even, got {self.width}x{self.height}")
        if self.phone and self.depth_scale_sigma:
            raise ValueError(f"depth_scale_sigma must be 0 for {self.sensor}, which has no depth")

    @property
    def phone(self) -> bool:
        """Whether the sensor is a phone, which does not measure depth."""
        return self.sensor in PHONES

    @property
    def planned(self) -> int:
        """The number of frames of the whole tour."""
        if self.frames is not None:
            return self.frames
        return DEFAULT_FRAMES.get(self.sensor, USUAL_FRAMES)

    @property
    def taken(self) -> int:
        """The number of recorded frames, at least 1, given by ``coverage``."""
        return max(1, round(self.coverage * self.planned))

    @property
    def camera(self) -> Camera:
        """The pinhole camera of the colour and depth images."""
        focal_px = FOCAL_SHARE * self.width
        return Camera(self.width, self.height, focal_px, focal_px, self.width / 2, self.height / 2)


class FrameTruth(NamedTuple):
    """The ground truth of a frame."""

    name: str
    camera_to_truth: np.ndarray  # float64 [4, 4], the true camera pose in the room.
    depth_scale: float  # The factor by which the sensor multiplied the true depth.


class Shot(NamedTuple):
    """A view of a scan and its ground truth."""

    view: View
    truth: FrameTruth


def room_shots(room: Room, how: ScanSettings) -> Iterator[Shot]:
    """Yield the shots of a depth camera's scan one at a time, in the order of the tour."""
    scene = prepare_photos(room)
    rng = np.random.default_rng([how.seed, 1])
    poses = plan_trajectory(room, scene.scene, how.camera, how.planned, rng)[: how.taken]
    to_scan = room_to_scan(how.seed)
    return (_shot(room, scene, how, pose, to_scan, n) for n, pose in enumerate(poses))


def room_to_scan(seed: int) -> np.ndarray:
    """Return the 4x4 transform from the room to the world frame of the capture.

    The transform has a random yaw, a tilt of at most 27 degrees and a random translation.
    """
    rng = np.random.default_rng([seed, 2])
    yaw, direction = rng.uniform(-np.pi, np.pi, 2)
    tilt = np.radians(rng.uniform(0.2, 1.0) * MAX_TILT_DEG)
    axis = np.array([np.cos(direction), np.sin(direction), 0.0])
    transform = np.eye(4)
    transform[:3, :3] = rotation_from_vector(axis * tilt) @ rotation_from_vector(
        np.array([0, 0, yaw])
    )
    transform[:3, 3] = rng.uniform(-2, 2, 3)
    return transform


def _shot(
    room: Room,
    scene: PhotoScene,
    how: ScanSettings,
    camera_to_room: np.ndarray,
    to_scan: np.ndarray,
    number: int,
) -> Shot:
    # The scale has a source of its own: with and without it the noise is the same.
    scale = scale_factor(how.depth_scale_sigma, np.random.default_rng([how.seed, 4, number]))
    rng = np.random.default_rng([how.seed, 3, number])
    model, camera = find_sensor(how.sensor), how.camera
    photo = take_photo(scene, camera, camera_to_room)
    luminance = photo.colour.astype(np.float32) @ LUMINANCE
    depth_m = sense_depth(model, photo.depth_m, photo.cosine, luminance, camera.fx_px, rng)
    stated = jitter_pose(model, camera_to_room, rng)
    view = View(
        name=f"frame-{number:06d}",
        camera_to_scan=to_scan @ stated,
        colour=_noisy(photo.colour, model, rng),
        colour_camera=camera,
        depth_m=depth_m * np.float32(scale),
        depth_camera=camera,
        labels=_labels(room, photo, how.label_error, rng) if how.with_labels else None,
    )
    return Shot(view, FrameTruth(view.name, camera_to_room, scale))


def _noisy(colour: np.ndarray, model: Sensor, rng: np.random.Generator) -> np.ndarray:
    if not model.colour_sigma:
        return colour
    noise = rng.standard_normal(colour.shape[:2], np.float32)[..., None]
    noisy = colour + noise * np.float32(model.colour_sigma) + 0.5
    return np.clip(noisy, 0, 255).astype(np.uint8)


def _labels(room: Room, photo: Photo, error: float, rng: np.random.Generator) -> np.ndarray:
    """Return the label image, in which a share of the patches has a wrong class."""
    labels = room.labels.reshape(-1)[np.maximum(photo.voxel_index, 0)]
    labels[photo.voxel_index < 0] = 255
    if error:
        height, width = labels.shape
        shape = (height // PATCH_PX + 1, width // PATCH_PX + 1)
        wrong = rng.random(shape) < error
        shift = rng.integers(1, CLASS_COUNT - 1, shape)
        wrong, shift = (
            values.repeat(PATCH_PX, axis=0).repeat(PATCH_PX, axis=1)[:height, :width]
            for values in (wrong, shift)
        )
        other = (labels - 1 + shift) % (CLASS_COUNT - 1) + 1
        labels = np.where(wrong & (labels != 255), other, labels)
    return labels.astype(np.uint8)
