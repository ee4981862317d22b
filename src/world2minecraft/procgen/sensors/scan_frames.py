"""The frames of a virtual scan with their ground truth, generated one at a time.

``ScanSettings`` contains the settings of a scan. ``room_shots`` plans the tour and renders the
images. Images are not stored, so the memory use does not depend on their number.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from world2minecraft.core.classes import CLASS_COUNT, CLASS_NAMES, SemanticClass
from world2minecraft.core.types import Camera, View
from world2minecraft.core.vocabulary import OTHER_NYU40, label_id_classes, label_id_of
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
    label_names: bool = False

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
        if self.label_names and not self.with_labels:
            raise ValueError("label_names requires label images")
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
    # The scale has its own generator, so that the noise does not depend on it.
    scale = scale_factor(how.depth_scale_sigma, np.random.default_rng([how.seed, 4, number]))
    rng = np.random.default_rng([how.seed, 3, number])
    model, camera = find_sensor(how.sensor), how.camera
    photo = take_photo(scene, camera, camera_to_room)
    luminance = photo.colour.astype(np.float32) @ LUMINANCE
    depth_m = sense_depth(model, photo.depth_m, photo.cosine, luminance, camera.fx_px, rng)
    stated = jitter_pose(model, camera_to_room, rng)
    colour = _noisy(photo.colour, model, rng)
    labels, label_ids = None, None
    if how.label_names:
        label_ids = _label_ids(room, photo, how.label_error, rng)
        labels = label_id_classes()[label_ids]
    elif how.with_labels:
        labels = _labels(room, photo, how.label_error, rng)
    view = View(
        name=f"frame-{number:06d}",
        camera_to_scan=to_scan @ stated,
        colour=colour,
        colour_camera=camera,
        depth_m=depth_m * np.float32(scale),
        depth_camera=camera,
        labels=labels,
        label_ids=label_ids,
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
        wrong, shift = _wrong_patches(labels.shape, error, CLASS_COUNT - 1, rng)
        other = (labels - 1 + shift) % (CLASS_COUNT - 1) + 1
        labels = np.where(wrong & (labels != 255), other, labels)
    return labels.astype(np.uint8)


def _label_ids(room: Room, photo: Photo, error: float, rng: np.random.Generator) -> np.ndarray:
    """Return the names of what a photo shows as label ids, uint16 [H, W].

    A share of the patches has another name that occurs in the room.
    """
    names = [label_id_of(item.name.replace("_", " ")) or OTHER_NYU40 for item in room.objects]
    structure = [0, *(label_id_of(name) or 0 for name in CLASS_NAMES[1 : SemanticClass.CHAIR])]
    voxels = np.maximum(photo.voxel_index, 0)
    labels, instance = room.labels.reshape(-1)[voxels], room.instance.reshape(-1)[voxels]
    of_instance = np.array([0, *names], np.uint16)
    generic = np.array([*structure, *[OTHER_NYU40] * (CLASS_COUNT - len(structure))], np.uint16)
    ids = np.where(instance > 0, of_instance[instance], generic[np.minimum(labels, 11)])
    ids[photo.voxel_index < 0] = 0
    if error:
        used = np.unique(np.concatenate([of_instance[1:], generic[1 : SemanticClass.CHAIR]]))
        wrong, shift = _wrong_patches(ids.shape, error, len(used), rng)
        other = used[(np.searchsorted(used, ids) + shift) % len(used)]
        ids = np.where(wrong & (ids > 0), other, ids)
    return ids.astype(np.uint16)


def _wrong_patches(
    shape: tuple[int, ...], error: float, count: int, rng: np.random.Generator
) -> tuple[np.ndarray, np.ndarray]:
    """Return which pixels are in wrong patches, and how far their label of ``count`` is moved."""
    height, width = shape
    patches = (height // PATCH_PX + 1, width // PATCH_PX + 1)
    wrong, shift = rng.random(patches) < error, rng.integers(1, max(count, 2), patches)
    return tuple(
        values.repeat(PATCH_PX, axis=0).repeat(PATCH_PX, axis=1)[:height, :width]
        for values in (wrong, shift)
    )  # type: ignore[return-value]
