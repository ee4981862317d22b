"""What each object stands on or hangs from: the floor, another object, a wall or the ceiling.

The columns of an object decide. A column counts for what is at most two cells below its lowest
cell, and one that begins in the two layers on the floor counts for the floor, which is seldom seen
under furniture. Without such columns, the object hangs from the wall beside it or from the ceiling
above it, or stands on the nearest thing below.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import ObjectInstance, OccupancyGrid
from world2minecraft.reconstruction.instances.object_voxels import floor_layer_below

NEAR_CELLS = 2  # Gap to a support, from noise and hidden cells.
MIN_SHARE = 0.25  # Of an object's columns near its bottom that have a common support.
BOTTOM_CELLS = 3  # Layers at the bottom of an object whose columns count.
_STRUCTURE = {
    "floor": (SemanticClass.FLOOR,),
    "wall": (SemanticClass.WALL, SemanticClass.WINDOW),
    "ceiling": (SemanticClass.CEILING,),
}


def with_supports(
    instances: Sequence[ObjectInstance], grid: OccupancyGrid
) -> tuple[ObjectInstance, ...]:
    """Return the objects with what supports them.

    Args:
        instances: Objects; their ids are those of ``grid.instance``.
        grid: Occupancy of the room.
    """
    lowest = {one.id: int(one.cells[:, 2].min()) for one in instances if len(one.cells)}
    return tuple(
        replace(one, supported_by=support_of(one, grid, lowest) if len(one.cells) else "")
        for one in instances
    )


def support_of(one: ObjectInstance, grid: OccupancyGrid, lowest: dict[int, int]) -> int | str:
    """Return the support of an object: an object id, ``floor``, ``wall`` or ``ceiling``.

    Args:
        one: Object with cells.
        grid: Occupancy of the room.
        lowest: Lowest layer of each object by id. Only objects that begin lower are supports, so
            that two objects never support each other.
    """
    columns = _lowest_cells(one.cells)
    bottom = int(columns[:, 2].min())
    feet = columns[columns[:, 2] < bottom + BOTTOM_CELLS]
    floor = floor_layer_below(one.cells, grid)
    if bottom < floor + NEAR_CELLS:
        return "floor"
    fitting = [0, *(number for number, low in lowest.items() if low < bottom and number != one.id)]
    found = _most_common(_first_below(feet, grid, fitting, NEAR_CELLS), MIN_SHARE)
    if found is not None:
        return found or "floor"
    for name, axes in (("wall", (0, 1)), ("ceiling", (2,))):
        if _is_beside(one.cells, grid, _STRUCTURE[name], axes):
            return name
    return _most_common(_first_below(feet, grid, fitting, bottom), 0.0) or "floor"


def _lowest_cells(cells: np.ndarray) -> np.ndarray:
    """Return the lowest cell of each column, int [M, 3], of cells int [N, 3]."""
    ordered = cells[np.lexsort((cells[:, 2], cells[:, 1], cells[:, 0]))]
    first = np.ones(len(ordered), bool)
    first[1:] = (ordered[1:, :2] != ordered[:-1, :2]).any(axis=1)
    return ordered[first]


def _first_below(
    feet: np.ndarray, grid: OccupancyGrid, fitting: Sequence[int], reach: int
) -> np.ndarray:
    """Return what is first below each foot int [N, 3]: 0 for floor, an id, or -1 for nothing."""
    result = np.full(len(feet), -1)
    for step in range(1, reach + 1):
        z = feet[:, 2] - step
        at = (feet[:, 0], feet[:, 1], np.maximum(z, 0))
        owner = grid.instance[at].astype(np.int64)
        is_floor = grid.labels[at] == SemanticClass.FLOOR
        is_known = is_floor | ((owner > 0) & np.isin(owner, fitting))
        chosen = (result < 0) & (z >= 0) & is_known
        result[chosen] = np.where(is_floor, 0, owner)[chosen]
    return result


def _most_common(found: np.ndarray, min_share: float) -> int | None:
    """Return the most common support of int [N], or None below a share of all columns."""
    known = found[found >= 0]
    if not len(known):
        return None
    numbers, counts = np.unique(known, return_counts=True)
    best = int(counts.argmax())
    return int(numbers[best]) if counts[best] >= min_share * len(found) else None


def _is_beside(
    cells: np.ndarray, grid: OccupancyGrid, classes: Sequence[int], axes: Sequence[int]
) -> bool:
    """Return whether a class is within ``NEAR_CELLS`` of cells int [N, 3], along some axes."""
    signs = (1,) if axes == (2,) else (-1, 1)
    for axis in axes:
        for step in range(1, NEAR_CELLS + 1):
            for sign in signs:
                there = cells.copy()
                there[:, axis] = np.clip(
                    there[:, axis] + sign * step, 0, grid.labels.shape[axis] - 1
                )
                if np.isin(grid.labels[tuple(there.T)], classes).any():
                    return True
    return False
