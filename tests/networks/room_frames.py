"""Two views of a generated room with the truth of the cells before them, as a batch."""

from functools import lru_cache

import numpy as np
import torch

from world2minecraft.core.coordinates import look_at
from world2minecraft.core.types import Camera
from world2minecraft.networks.batch import OccInput, OccTarget
from world2minecraft.procgen import generate_room
from world2minecraft.procgen.sensors.photo_rendering import prepare_photos, take_photo

SHAPE, VOXEL_M = (30, 30, 18), 0.16
CAMERA = Camera(96, 72, 78.0, 78.0, 48.0, 36.0)
EYE_M = 1.5
BLOCK = 8  # Cells of 2 cm in one of 16 cm.


@lru_cache(maxsize=1)
def room_batch() -> tuple[OccInput, OccTarget]:
    """Two views of one room, one along +y and one along -y, with depth."""
    room = generate_room(5, kind="living")
    scene = prepare_photos(room)
    middle_m, depth_m = room.size_m[0] / 2, room.size_m[1]
    shots = [_shot(room, scene, middle_m, 0.6, 1), _shot(room, scene, middle_m, depth_m - 0.6, -1)]
    image, to_grid, depth, labels = (np.stack(column) for column in zip(*shots, strict=True))
    lens = np.array([[CAMERA.fx_px, 0, CAMERA.cx_px], [0, CAMERA.fy_px, CAMERA.cy_px], [0, 0, 1]])
    inputs = OccInput(
        torch.from_numpy(image),
        torch.from_numpy(np.stack([lens, lens])).float(),
        torch.from_numpy(to_grid).float(),
        SHAPE,
        VOXEL_M,
        torch.from_numpy(depth),
    )
    labels = torch.from_numpy(labels).long()
    return inputs, OccTarget(labels, torch.ones_like(labels, dtype=torch.bool))


def _shot(room, scene, x_m, y_m, ahead):
    """The view from a place along +y (ahead 1) or -y (-1): picture, pose, depth, labels."""
    eye = np.array([x_m, y_m, EYE_M])
    pose = look_at(eye, eye + np.array([0, ahead, -0.25]))
    photo = take_photo(scene, CAMERA, pose)
    shape = np.array(SHAPE)
    # The grid reaches as far to both sides, from the camera forward, and from under the floor.
    low = np.round(eye / VOXEL_M - np.array([shape[0] / 2, 0 if ahead > 0 else shape[1], 0]))
    low[2] = -1
    labels = _cells(room, low.astype(int))
    grid_to_room = np.eye(4)
    grid_to_room[:3, 3] = low * VOXEL_M
    if ahead < 0:
        labels = labels[::-1, ::-1]
        grid_to_room[:2, 3] += shape[:2] * VOXEL_M
        grid_to_room[[0, 1], [0, 1]] = -1
    image = photo.colour.transpose(2, 0, 1).astype(np.float32) / 255
    to_grid = np.linalg.inv(grid_to_room) @ pose
    return image, to_grid, photo.depth_m.astype(np.float32), labels.copy()


def _cells(room, low):
    """Labels of 16 cm: the class of most 2 cm cells where an eighth of them is occupied or more."""
    first = np.round(low * VOXEL_M / room.voxel_m - room.origin_m / room.voxel_m).astype(int)
    fine = np.full(np.array(SHAPE) * BLOCK, 255, np.uint8)
    start, stop = np.maximum(first, 0), np.minimum(first + fine.shape, room.labels.shape)
    inner = tuple(slice(a, b) for a, b in zip(start - first, stop - first, strict=True))
    outer = tuple(slice(a, b) for a, b in zip(start, stop, strict=True))
    fine[inner] = room.labels[outer]
    x, y, z = SHAPE
    blocks = fine.reshape(x, BLOCK, y, BLOCK, z, BLOCK).transpose(0, 2, 4, 1, 3, 5)
    blocks = blocks.reshape(*SHAPE, -1)
    counts = np.stack([(blocks == name).sum(-1) for name in range(12)], -1)
    unknown = (blocks == 255).sum(-1)
    full = counts[..., 1:].sum(-1) >= blocks.shape[-1] / 8
    hollow = np.where(counts[..., 0] >= unknown, 0, 255)
    return np.where(full, counts[..., 1:].argmax(-1) + 1, hollow).astype(np.uint8)
