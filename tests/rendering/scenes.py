"""Small volumes for the tests of the ray caster, and a slow readable reference of it."""

import numpy as np

from world2minecraft.core.coordinates import block_to_room, look_at
from world2minecraft.core.types import BlockVolume, Camera
from world2minecraft.rendering.plain_models import visible_boxes

PALETTE = (
    "minecraft:air",
    "minecraft:white_concrete",
    "minecraft:oak_planks",
    "minecraft:oak_stairs[facing=east,half=bottom,shape=straight,waterlogged=false]",
    "minecraft:oak_slab[type=bottom,waterlogged=false]",
    "minecraft:torch",
    "minecraft:red_concrete",
)
CAMERA = Camera(64, 48, 40.0, 40.0, 32.0, 24.0)


def volume_of(states: np.ndarray, semantic: np.ndarray | None = None, scale: float = 4.0):
    filled = states > 0
    return BlockVolume(
        states=states.astype(np.uint16),
        palette=PALETTE,
        semantic=np.where(filled, 10, 0).astype(np.uint8) if semantic is None else semantic,
        instance=states.astype(np.uint16) * 3,
        corner=(-1, 63, -2),
        block_to_room=block_to_room(np.array([0.0, 2.0]), scale),
    )


def random_volume(rng: np.random.Generator, shape=(9, 7, 8), share=0.12) -> BlockVolume:
    states = np.where(rng.random(shape) < share, rng.integers(1, len(PALETTE), shape), 0)
    return volume_of(states)


def random_pose(rng: np.random.Generator, volume: BlockVolume) -> np.ndarray:
    """A camera anywhere within the volume, looking at any other place of it."""
    low, high = np.array(volume.corner), np.array(volume.corner) + volume.states.shape
    eye, target = (
        volume.block_to_room[:3, :3] @ rng.uniform(low, high) + volume.block_to_room[:3, 3]
        for _ in range(2)
    )
    return look_at(eye, target)


def slow_picture(volume: BlockVolume, camera: Camera, camera_to_room: np.ndarray):
    """Return (z-depth, cell index) by testing each ray with each box of the scene, in float64."""
    to_block = np.linalg.inv(volume.block_to_room)
    boxes, cells = [], []
    for cell in np.argwhere(volume.states):
        for box in visible_boxes(volume.palette[volume.states[tuple(cell)]]):
            boxes.append(box.astype(np.float64) + np.tile(cell + volume.corner, 2))
            cells.append(np.ravel_multi_index(cell, volume.states.shape))
    depth = np.zeros((camera.height_px, camera.width_px))
    index = np.full(depth.shape, -1)
    if not boxes:
        return depth, index
    low, high = np.array(boxes)[:, :3], np.array(boxes)[:, 3:]
    origin = to_block[:3, :3] @ camera_to_room[:3, 3] + to_block[:3, 3]
    for v in range(camera.height_px):
        for u in range(camera.width_px):
            ray = np.array(
                [
                    (u + 0.5 - camera.cx_px) / camera.fx_px,
                    (v + 0.5 - camera.cy_px) / camera.fy_px,
                    1,
                ]
            )
            direction = to_block[:3, :3] @ camera_to_room[:3, :3] @ ray
            near, far = (low - origin) / direction, (high - origin) / direction
            enter = np.minimum(near, far).max(axis=1)
            leave = np.maximum(near, far).min(axis=1)
            enter[(enter > leave) | (enter <= 0)] = np.inf
            if np.isfinite(enter.min()):
                depth[v, u], index[v, u] = enter.min(), cells[int(enter.argmin())]
    return depth, index
