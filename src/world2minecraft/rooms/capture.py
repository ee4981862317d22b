"""A generated room becomes a capture on disk, as a sensor would hand it over, with its truth.

The capture is in our plain layout; its world frame is turned, tilted and shifted, so that the
alignment has work. ``truth.npz`` and ``truth.json`` hold what no sensor knows.
"""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from world2minecraft.classes import CLASS_COUNT, CLASS_NAMES
from world2minecraft.files import write_json, write_npz
from world2minecraft.progress import Progress, silent
from world2minecraft.rooms.photo import Photo, PhotoScene, prepare_photos, take_photo
from world2minecraft.rooms.room import Room
from world2minecraft.rooms.sensor import (
    Sensor,
    jittered_pose,
    rotation_of_vector,
    sense_depth,
    sensor,
)
from world2minecraft.rooms.tour import plan_tour
from world2minecraft.scan.plain import write_plain
from world2minecraft.types import Camera, View

FOCAL_SHARE = 0.82  # Of the width: 525 px at 640, a field of view of 63 degrees.
MAX_TILT_DEG = 27.0  # What the shared kitchen's world frame is tilted by.
LUMINANCE = np.array([0.299, 0.587, 0.114], np.float32)
PATCH_PX = 8  # Label errors come in patches: a segmenter errs by regions.


def scan_room(
    room: Room,
    folder: str | Path,
    *,
    sensor: str = "rgbd",
    frames: int = 40,
    seed: int = 0,
    with_labels: bool = False,
    label_error: float = 0.0,
    width: int = 640,
    height: int = 480,
    progress: Progress = silent,
) -> None:
    """Scan a room virtually and write the capture with its truth.

    Args:
        room: the room.
        folder: where the capture goes; made if missing.
        sensor: ``rgbd`` or ``clean``.
        frames: how many pictures.
        seed: of the tour, the world frame and the noise; the same seed gives the same bytes.
        with_labels: whether to write label images.
        label_error: the share of the label images, in patches, that says another class.
        width: of the pictures, in pixels.
        height: of the pictures, in pixels.
        progress: called after each frame, stage ``capture``.

    Raises:
        UnknownNameError: no sensor has this name. OutputError: the folder cannot be written.
    """
    views = room_views(
        room, sensor=sensor, frames=frames, seed=seed, with_labels=with_labels,
        label_error=label_error, width=width, height=height,
    )  # fmt: skip
    write_plain(folder, _reported(views, frames, progress))
    write_truth(room, folder, room_to_scan(seed))


def _reported(views: Iterator[View], frames: int, progress: Progress) -> Iterator[View]:
    for done, view in enumerate(views, start=1):
        yield view
        progress("capture", done, frames, view.name)


def room_views(
    room: Room,
    *,
    sensor: str = "rgbd",
    frames: int = 40,
    seed: int = 0,
    with_labels: bool = False,
    label_error: float = 0.0,
    width: int = 640,
    height: int = 480,
) -> Iterator[View]:
    """Yield the views of a virtual scan one at a time; arguments as ``scan_room``."""
    model = _sensor(sensor)
    if frames < 1 or not 0 <= label_error <= 1:
        raise ValueError(f"frames must be 1 or more and label_error a share, not {frames}")
    focal_px = FOCAL_SHARE * width
    camera = Camera(width, height, focal_px, focal_px, width / 2, height / 2)
    scene = prepare_photos(room)
    to_scan = room_to_scan(seed)
    poses = plan_tour(room, scene.scene, camera, frames, np.random.default_rng([seed, 1]))
    return (
        _view(room, scene, model, camera, pose, to_scan, n, seed, with_labels, label_error)
        for n, pose in enumerate(poses)
    )


_sensor = sensor  # The argument of the public functions has the same plain name.


def room_to_scan(seed: int) -> np.ndarray:
    """Return the 4x4 from the room to the capture's world frame: any yaw, tilted up to 27 deg."""
    rng = np.random.default_rng([seed, 2])
    yaw, direction = rng.uniform(-np.pi, np.pi, 2)
    tilt = np.radians(rng.uniform(0.2, 1.0) * MAX_TILT_DEG)
    axis = np.array([np.cos(direction), np.sin(direction), 0.0])
    transform = np.eye(4)
    transform[:3, :3] = rotation_of_vector(axis * tilt) @ rotation_of_vector(np.array([0, 0, yaw]))
    transform[:3, 3] = rng.uniform(-2, 2, 3)
    return transform


def _view(
    room: Room,
    scene: PhotoScene,
    model: Sensor,
    camera: Camera,
    camera_to_room: np.ndarray,
    to_scan: np.ndarray,
    number: int,
    seed: int,
    with_labels: bool,
    label_error: float,
) -> View:
    rng = np.random.default_rng([seed, 3, number])
    photo = take_photo(scene, camera, camera_to_room)
    luminance = photo.colour.astype(np.float32) @ LUMINANCE
    depth_m = sense_depth(model, photo.depth_m, photo.cosine, luminance, camera.fx_px, rng)
    stated = jittered_pose(model, camera_to_room, rng)
    return View(
        name=f"frame-{number:06d}",
        camera_to_scan=to_scan @ stated,
        colour=_noisy(photo.colour, model.colour_sigma, rng),
        colour_camera=camera,
        depth_m=depth_m,
        depth_camera=camera,
        labels=_labels(room, photo, label_error, rng) if with_labels else None,
    )


def _noisy(colour: np.ndarray, sigma: float, rng: np.random.Generator) -> np.ndarray:
    if not sigma:
        return colour
    noise = rng.standard_normal(colour.shape[:2], np.float32)[..., None] * np.float32(sigma)
    return np.clip(colour + noise + 0.5, 0, 255).astype(np.uint8)


def _labels(room: Room, photo: Photo, error: float, rng: np.random.Generator) -> np.ndarray:
    """Return the label image; a share of its patches says another class."""
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


def write_truth(room: Room, folder: str | Path, truth_room_to_scan: np.ndarray) -> None:
    """Write ``truth.npz`` and ``truth.json`` beside a capture.

    Raises:
        OutputError: the folder cannot be written.
    """
    write_npz(
        Path(folder) / "truth.npz",
        {
            "labels": room.labels,
            "instance": room.instance,
            "voxel_m": np.array(room.voxel_m),
            "origin_m": room.origin_m,
            "truth_room_to_scan": truth_room_to_scan,
        },
    )
    objects = [
        {
            "id": number,
            "class": CLASS_NAMES[item.class_id],
            "name": item.name,
            "center_m": _rounded(item.center_m),
            "size_m": _rounded(item.size_m),
            "yaw_deg": item.yaw_deg,
        }
        for number, item in enumerate(room.layout.objects, start=1)
    ]
    truth = {"kind": room.kind, "seed": room.seed, "size_m": _rounded(room.size_m)}
    write_json(Path(folder) / "truth.json", {**truth, "objects": objects})


def _rounded(values: np.ndarray) -> list[float]:
    return [round(float(value), 4) for value in values]
