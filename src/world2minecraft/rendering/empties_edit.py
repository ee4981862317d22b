"""Empty boxes where cells change: the boxes that an edit touches, and no others, are made anew."""

import numpy as np

from world2minecraft.core.jit import njit
from world2minecraft.rendering.empties import MOST_CELLS, empty_boxes

_ORPHAN = -9  # Air that has no box for a moment.
_MOST_GROWTH = 4  # A table of boxes that grew so many times is made anew.


def edited_boxes(
    space: np.ndarray, bounds: np.ndarray, cells: np.ndarray, kinds: np.ndarray
) -> np.ndarray:
    """Set what some cells are; ``space`` changes in place.

    Args:
        space: int32 [X, Y, Z], see ``SceneTables``.
        bounds: int16 [V, 6].
        cells: int64 [N, 3].
        kinds: int8 [N], ``FULL``, ``BOXES`` or 0 for air.

    Returns:
        ``bounds``, with new rows at its end.
    """
    before = len(bounds)
    for cell, kind in zip(cells, kinds, strict=True):
        bounds = _set_cell(space, bounds, cell[0], cell[1], cell[2], int(kind))
    if len(bounds) <= _MOST_GROWTH * max(before, 64):
        return bounds
    space[:], bounds = empty_boxes(np.where(space >= 0, 0, space).astype(np.int8))
    return bounds


@njit
def _set_cell(space, bounds, i, j, k, kind):
    was_air = space[i, j, k] >= 0
    if kind == 0:
        if not was_air:
            space[i, j, k] = _ORPHAN
            bounds = _adopt(space, bounds, i, j, k)
        return bounds
    space[i, j, k] = kind
    if not was_air:
        return bounds
    box = np.zeros(6, np.int64)
    for row in range(len(bounds)):
        for side in range(6):
            box[side] = bounds[row, side]
        if not (box[0] <= i < box[3] and box[1] <= j < box[4] and box[2] <= k < box[5]):
            continue
        _cut(bounds, row, i, j, k)
        bounds = _adopt_all(space, bounds, row, box)
    return bounds


@njit
def _cut(bounds, row, i, j, k):
    """Shrink a box to the largest part of it that a plane beside a cell leaves."""
    best, face, value = -1, 0, 0
    for axis in range(3):
        at = i if axis == 0 else (j if axis == 1 else k)
        low, high = bounds[row, axis], bounds[row, axis + 3]
        area = 1
        for other in range(3):
            if other != axis:
                area *= bounds[row, other + 3] - bounds[row, other]
        if area * (at - low) > best:
            best, face, value = area * (at - low), axis + 3, at
        if area * (high - at - 1) > best:
            best, face, value = area * (high - at - 1), axis, at + 1
    bounds[row, face] = value


@njit
def _adopt_all(space, bounds, row, old):
    """Find boxes for the cells that a box had before it was cut."""
    for i in range(old[0], old[3]):
        for j in range(old[1], old[4]):
            for k in range(old[2], old[5]):
                if space[i, j, k] == row and not _holds(bounds, row, i, j, k):
                    space[i, j, k] = _ORPHAN
    for i in range(old[0], old[3]):
        for j in range(old[1], old[4]):
            for k in range(old[2], old[5]):
                if space[i, j, k] == _ORPHAN:
                    bounds = _adopt(space, bounds, i, j, k)
    return bounds


@njit
def _holds(bounds, row, i, j, k):
    box = bounds[row]
    return box[0] <= i < box[3] and box[1] <= j < box[4] and box[2] <= k < box[5]


@njit
def _adopt(space, bounds, i, j, k):
    """Grow a box of air around a cell and give it the cells that have none, or a smaller one."""
    box = np.array([i, j, k, i + 1, j + 1, k + 1])
    grew = True
    while grew:
        grew = False
        for face in range(6):
            axis = face % 3
            if box[axis + 3] - box[axis] < MOST_CELLS and _free(space, box, face):
                box[face] += 1 if face > 2 else -1
                grew = True
    row = len(bounds)
    bounds = np.concatenate((bounds, box.astype(np.int16).reshape(1, 6)))
    size = _volume(bounds, row)
    for x in range(box[0], box[3]):
        for y in range(box[1], box[4]):
            for z in range(box[2], box[5]):
                if space[x, y, z] == _ORPHAN or _volume(bounds, space[x, y, z]) < size:
                    space[x, y, z] = row
    return bounds


@njit
def _free(space, box, face):
    """Tell whether the layer of cells before a face of a box is air within the grid."""
    axis = face % 3
    low, high = box[:3].copy(), box[3:].copy()
    if face > 2:
        low[axis], high[axis] = box[face], box[face] + 1
    else:
        low[axis], high[axis] = box[face] - 1, box[face]
    if low[axis] < 0 or high[axis] > space.shape[axis]:
        return False
    for i in range(low[0], high[0]):
        for j in range(low[1], high[1]):
            for k in range(low[2], high[2]):
                if space[i, j, k] < 0 and space[i, j, k] != _ORPHAN:
                    return False
    return True


@njit
def _volume(bounds, row):
    box = bounds[row]
    size = np.int64(box[3] - box[0]) * np.int64(box[4] - box[1]) * np.int64(box[5] - box[2])
    return size
