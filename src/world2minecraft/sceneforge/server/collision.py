"""What stops a person who walks in the page: the boxes of a build's blocks, or of voxels.

The page walks by the same physics as ``walk/``; it is sent the shape of each cell, the boxes of
each shape, and where to begin.
"""

from typing import Any

import numpy as np

from world2minecraft.core.classes import OBJECT_CLASSES, SemanticClass
from world2minecraft.core.types import OccupancyGrid
from world2minecraft.minecraft.physics import BlockWorld, standing_place
from world2minecraft.sceneforge.arrays import packed_arrays
from world2minecraft.sceneforge.block_preview import Build, HeldScene

MAGIC = b"W2MC"


def build_collision(build: Build) -> bytes:
    """Return the collision boxes of a build, in cells of its volume."""
    return _bytes(BlockWorld.of_volume(build.volume), build.facts())


def voxel_collision(scene: HeldScene) -> bytes:
    """Return the occupied cells of a scene as full cubes, a block a voxel, in block axes."""
    grid = scene.grid
    solid = np.moveaxis(grid.occupied[:, ::-1], 1, 2)  # Room -y is block z.
    world = BlockWorld.of_cells(solid)
    feet, yaw_deg = _start(grid, world)
    told = {
        "rev": scene.rev,
        "blocks_per_metre": 1 / grid.voxel_m,
        "grid_to_room": _block_axes_to_room(grid).ravel().tolist(),
        "feet": list(feet),
        "yaw_deg": yaw_deg,
    }
    return _bytes(world, told)


def _bytes(world: BlockWorld, told: dict[str, Any]) -> bytes:
    starts = np.cumsum([0, *(len(shape) for shape in world.shapes)])
    arrays = {
        "kinds": world.kinds,
        "boxes": np.concatenate(world.shapes).astype(np.float32),
        "starts": starts.astype(np.int32),
    }
    return packed_arrays(MAGIC, told, arrays)


def _block_axes_to_room(grid: OccupancyGrid) -> np.ndarray:
    """Carry cells in block axes (x, z, -y) to room metres, float64 [4, 4]."""
    x, y, z = grid.origin_m
    v = grid.voxel_m
    return np.array(
        [[v, 0, 0, x], [0, 0, -v, y + grid.shape[1] * v], [0, v, 0, z], [0, 0, 0, 1]], np.float64
    )


def _start(grid: OccupancyGrid, world: BlockWorld) -> tuple[tuple[float, float, float], float]:
    """Return where to stand in the middle of the floor, looking at the middle of the furniture."""
    axes = np.linalg.inv(_block_axes_to_room(grid))
    floor = _middle(grid, grid.labels == SemanticClass.FLOOR)
    things = _middle(grid, np.isin(grid.labels, OBJECT_CLASSES))
    top = np.flatnonzero((grid.labels == SemanticClass.FLOOR).any(axis=(0, 1)))
    feet = axes @ [*floor[:2], grid.origin_m[2] + (top[-1:].sum() + 1) * grid.voxel_m, 1]
    x, y, z = (float(round(value, 6)) for value in feet[:3])
    place = standing_place(world, (x, y, z), 1 / grid.voxel_m)
    way = (axes @ [*things, 1])[:3] - np.array(place)
    yaw_deg = float(np.degrees(np.arctan2(-way[0], way[2]))) if np.hypot(way[0], way[2]) else 0.0
    return place, round(yaw_deg, 3)


def _middle(grid: OccupancyGrid, where: np.ndarray) -> np.ndarray:
    """Return the middle of some cells in room metres, of the whole grid where there are none."""
    cells = np.argwhere(where)
    middle = np.median(cells, axis=0) + 0.5 if len(cells) else np.array(grid.shape) / 2
    return grid.origin_m + middle * grid.voxel_m
