"""Bits of a lamp: its foot on the floor, a piece of its cord, join the shade over or under them."""

import numpy as np

from world2minecraft.core.classes import UNKNOWN, SemanticClass
from world2minecraft.core.types import OccupancyGrid
from world2minecraft.reconstruction.instances.heap import floor_below
from world2minecraft.reconstruction.instances.owned import cells_by_owner

THIN_CELLS = 2  # A post or a cord is at most so wide,
FLAT_CELLS = 1  # a foot so high.
GAP_M = 1.4  # Between the foot of a lamp and its shade.


def join_posts(owners: np.ndarray, grid: OccupancyGrid) -> np.ndarray:
    """Return owners, int32 [X, Y, Z], in which posts, cords and feet belong to their lamps.

    What lies wholly within the floor and belongs to nothing is no object.
    """
    result = owners.copy()
    pieces = dict(cells_by_owner(owners, grid.labels, SemanticClass.OBJS))
    bits = {number: cells for number, cells in pieces.items() if _is_bit(cells, grid)}
    whole = {number: cells for number, cells in pieces.items() if number not in bits}
    for cells in bits.values():
        gaps = {one: _gap(cells, other, grid) for one, other in whole.items()}
        near = {one: gap for one, gap in gaps.items() if gap is not None}
        if near:
            result[tuple(cells.T)] = min(near, key=lambda one: (near[one], one))
        elif int(cells[:, 2].max()) < floor_below(cells, grid):
            result[tuple(cells.T)] = 0
    return result


def _is_bit(cells: np.ndarray, grid: OccupancyGrid) -> bool:
    wide, deep, tall = np.ptp(cells, axis=0) + 1
    if max(wide, deep) <= THIN_CELLS:
        return True
    low = int(cells[:, 2].min()) - floor_below(cells, grid)
    return bool(tall <= FLAT_CELLS and low <= 0)


def _gap(bit: np.ndarray, whole: np.ndarray, grid: OccupancyGrid) -> int | None:
    """Return the layers between a bit and a thing straight over or under it; None if it is not."""
    middle = bit[:, :2].mean(axis=0)
    inside = (middle >= whole[:, :2].min(axis=0) - 1) & (middle <= whole[:, :2].max(axis=0) + 1)
    if not inside.all():
        return None
    first = min(int(bit[:, 2].max()), int(whole[:, 2].max())) + 1
    last = max(int(bit[:, 2].min()), int(whole[:, 2].min()))
    if last - first > GAP_M / grid.voxel_m:
        return None
    x, y = (int(value) for value in np.round(middle))
    between = grid.labels[x, y, first:last]
    blocked = (between > 0) & (between != UNKNOWN) & (between != SemanticClass.OBJS)
    return None if blocked.any() else max(last - first, 0)
