"""Tops of objects that gave no depth: glossy counters and glass tables, closed where space shows.

A ray that crosses the space above a counter and meets nothing measurable in it leaves free cells
above unseen ones. Such a step, level with the rim of an object and joined to it, is its top.
"""

import numpy as np

from world2minecraft.core.types import UNSEEN, OccupancyGrid
from world2minecraft.geometry.morphology import dilate, dilate_within, nearest_set_cells

RIM_LAYERS = 1  # A top lies within a cell of the rim that it joins.
REACH_M = 0.7  # How far from the rim: the depth of a worktop.
LEAST_RIM_M = 0.3  # Lower things are no furniture with a top.


def top_cells(grid: OccupancyGrid, cells: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return unseen cells that close the top of an object, and cells that look like them.

    Args:
        grid: the room; its free cells show where the top must be.
        cells: int [M, 3], the object's own.

    Returns:
        int [N, 3], the unseen cells; int [N, 3], for each the nearest cell of the object that
        was seen from above.
    """
    low, box = _box(grid, cells)
    steps, free = _steps(grid, box)
    body, joined = _joined_to(grid, cells, low, steps)
    upper = body & np.concatenate([free[:, :, 1:], np.zeros_like(free[:, :, :1])], axis=2)
    flat = upper & ~np.concatenate([np.zeros_like(body[:, :, :1]), body[:, :, :-1]], axis=2)
    upper = flat if flat.any() else upper  # The edge over a front mixes both their colours.
    if not joined.any() or not upper.any():
        return np.zeros((0, 3), int), np.zeros((0, 3), int)
    nearest, _ = nearest_set_cells(upper)
    return np.argwhere(joined) + low, np.stack([axis[joined] for axis in nearest], 1) + low


def step_cells(grid: OccupancyGrid, cells: np.ndarray) -> np.ndarray:
    """Return the unseen cells, int [N, 3], that close the top of an object with cells [M, 3]."""
    low, box = _box(grid, cells)
    steps, _ = _steps(grid, box)
    return np.argwhere(_joined_to(grid, cells, low, steps)[1]) + low


def _box(grid: OccupancyGrid, cells: np.ndarray) -> tuple[np.ndarray, tuple[slice, ...]]:
    """Return the box around an object in which its top may lie, and its low corner, int [3]."""
    reach = max(1, round(REACH_M / grid.voxel_m))
    low = np.maximum(cells.min(0) - [reach, reach, 1], 0)
    high = np.minimum(cells.max(0) + np.array([reach + 1, reach + 1, 3]), grid.shape)
    return low, tuple(slice(int(a), int(b)) for a, b in zip(low, high, strict=True))


def _joined_to(
    grid: OccupancyGrid, cells: np.ndarray, low: np.ndarray, steps: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return an object's own tall cells and the steps that join it, bool in the box of steps."""
    reach = max(1, round(REACH_M / grid.voxel_m))
    body = np.zeros(steps.shape, bool)
    tall = grid.origin_m[2] + (cells[:, 2] + 1) * grid.voxel_m >= LEAST_RIM_M
    body[tuple((cells[tall] - low).T)] = True
    return body, _joined(steps, dilate(body, (0, 0, RIM_LAYERS)), reach)


def _steps(grid: OccupancyGrid, box: tuple[slice, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Return the unseen cells, bool, that lie right under seen free space, and that space."""
    unseen = grid.source[box] == UNSEEN
    free = (grid.labels[box] == 0) & ~unseen
    steps = np.zeros_like(unseen)
    steps[:, :, :-1] = unseen[:, :, :-1] & free[:, :, 1:]
    return steps, free


def _joined(steps: np.ndarray, rim: np.ndarray, reach: int) -> np.ndarray:
    """Return the steps that join the rim layer by layer, within ``reach`` cells of it."""
    flat = np.zeros((3, 3, 3), bool)
    flat[:, :, 1] = [[0, 1, 0], [1, 1, 1], [0, 1, 0]]
    return dilate_within(rim, steps | rim, flat, reach) & steps & ~rim
