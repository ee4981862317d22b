"""Coverage of a grid's air by large empty boxes, each of which a ray crosses in one step.

Every air cell belongs to an air box that contains it and is as large as possible. Boxes may
overlap. A ray crosses a furnished room in two or three steps, however small the blocks are, and a
packet of rays that leaves a box by one face has hit nothing inside. After an edit only the affected
boxes are replaced.
"""

import numpy as np

from world2minecraft.core.jit import njit
from world2minecraft.rendering.grid_traversal import fill_distances

MAX_SIDE_CELLS = 96  # A side; a box of the open sky need not be larger.
_AIR = 0  # What ``solid`` holds for air; other values are taken over as they are.
_ORPHAN = -9  # Air that has no box for a moment.
_MAX_GROWTH = 4  # A table that grew by this factor is rebuilt.


def find_empty_boxes(kinds: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Cover the air of a grid with boxes.

    Args:
        kinds: Kind of each cell, int8 [X, Y, Z]: ``FULL``, ``BOXES``, or 0 for air.

    Returns:
        ``space`` int32 [X, Y, Z] and ``bounds`` int16 [V, 6], as described in ``SceneTables``.
        There is always at least one box, even if no cell uses it.
    """
    kinds = np.ascontiguousarray(kinds)
    reach = (kinds == _AIR).astype(np.uint8)
    fill_distances(reach)
    order = np.argsort(255 - reach.ravel(), kind="stable").astype(np.int32)
    order = order[: int(np.count_nonzero(reach))]  # Cells of air, the roomiest first.
    return _cover_air(kinds, reach, order, _count_solid(kinds))


@njit
def _count_solid(kinds):
    """Return how much is no air below each corner: int32 [X + 1, Y + 1, Z + 1]."""
    nx, ny, nz = kinds.shape
    total = np.zeros((nx + 1, ny + 1, nz + 1), np.int32)
    for i in range(nx):
        for j in range(ny):
            row = 0
            for k in range(nz):
                row += 1 if kinds[i, j, k] != _AIR else 0
                below = total[i, j + 1, k + 1] + total[i + 1, j, k + 1] - total[i, j, k + 1]
                total[i + 1, j + 1, k + 1] = below + row
    return total


@njit
def _solid_in_box(total, x0, y0, z0, x1, y1, z1):
    return (
        total[x1, y1, z1] - total[x0, y1, z1] - total[x1, y0, z1] - total[x1, y1, z0]
        + total[x0, y0, z1] + total[x0, y1, z0] + total[x1, y0, z0] - total[x0, y0, z0]
    )  # fmt: skip


@njit
def _cover_air(kinds, reach, order, total):
    nx, ny, nz = kinds.shape
    space = np.empty((nx, ny, nz), np.int32)
    for i in range(nx):
        for j in range(ny):
            for k in range(nz):
                space[i, j, k] = kinds[i, j, k] if kinds[i, j, k] != _AIR else -9
    bounds = np.zeros((256, 6), np.int16)
    volumes = np.zeros(256, np.int64)
    count = 0
    box = np.zeros(6, np.int64)
    for flat in order:
        i, j, k = flat // (ny * nz), flat // nz % ny, flat % nz
        if space[i, j, k] >= 0:
            continue
        _box_around(box, i, j, k, int(reach[i, j, k]) - 1, kinds.shape)
        _grow(box, total, kinds.shape)
        if count == len(bounds):
            bounds = np.concatenate((bounds, np.zeros_like(bounds)))
            volumes = np.concatenate((volumes, np.zeros_like(volumes)))
        bounds[count] = box
        volumes[count] = (box[3] - box[0]) * (box[4] - box[1]) * (box[5] - box[2])
        _claim_cells(space, volumes, box, count)
        count += 1
    return space, bounds[: max(count, 1)].copy()


@njit
def _box_around(box, i, j, k, reach, shape):
    """Set a box to the cells within ``reach`` of a cell, which are air."""
    reach = min(reach, MAX_SIDE_CELLS // 2)
    for axis in range(3):
        at = i if axis == 0 else (j if axis == 1 else k)
        box[axis] = max(at - reach, 0)
        box[axis + 3] = min(at + reach + 1, shape[axis])


@njit
def _grow(box, total, shape):
    """Move a box's faces outward, in turn, as long as it stays air."""
    grew = True
    while grew:
        grew = False
        for face in range(6):
            axis = face % 3
            step = 1 if face > 2 else -1
            new = box[face] + step
            if new < 0 or new > shape[axis] or box[axis + 3] - box[axis] >= MAX_SIDE_CELLS:
                continue
            old = box[face]
            box[face] = new
            if _solid_in_box(total, box[0], box[1], box[2], box[3], box[4], box[5]):
                box[face] = old
            else:
                grew = True


@njit
def _claim_cells(space, volumes, box, row):
    """Give a box the cells within it that have none, or a smaller one."""
    for i in range(box[0], box[3]):
        for j in range(box[1], box[4]):
            for k in range(box[2], box[5]):
                if space[i, j, k] < 0 or volumes[space[i, j, k]] < volumes[row]:
                    space[i, j, k] = row


def update_empty_boxes(
    space: np.ndarray, bounds: np.ndarray, cells: np.ndarray, kinds: np.ndarray
) -> np.ndarray:
    """Update the boxes after cells have changed. ``space`` is modified in place.

    Args:
        space: Box of each cell, int32 [X, Y, Z]; see ``SceneTables``.
        bounds: Bounds of the boxes, int16 [V, 6].
        cells: The changed cells, int64 [N, 3].
        kinds: New kind of each changed cell, int8 [N]: ``FULL``, ``BOXES``, or 0 for air.

    Returns:
        ``bounds`` with new rows appended.
    """
    before = len(bounds)
    for cell, kind in zip(cells, kinds, strict=True):
        bounds = _set_cell(space, bounds, cell[0], cell[1], cell[2], int(kind))
    if len(bounds) <= _MAX_GROWTH * max(before, 64):
        return bounds
    space[:], bounds = find_empty_boxes(np.where(space >= 0, 0, space).astype(np.int8))
    return bounds


@njit
def _set_cell(space, bounds, i, j, k, kind):
    was_air = space[i, j, k] >= 0
    if kind == 0:
        if not was_air:
            space[i, j, k] = _ORPHAN
            bounds = _add_box(space, bounds, i, j, k)
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
        _shrink_box(bounds, row, i, j, k)
        bounds = _cover_orphans(space, bounds, row, box)
    return bounds


@njit
def _shrink_box(bounds, row, i, j, k):
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
def _cover_orphans(space, bounds, row, old):
    """Find boxes for the cells that a box had before it was cut."""
    for i in range(old[0], old[3]):
        for j in range(old[1], old[4]):
            for k in range(old[2], old[5]):
                if space[i, j, k] == row and not _contains(bounds, row, i, j, k):
                    space[i, j, k] = _ORPHAN
    for i in range(old[0], old[3]):
        for j in range(old[1], old[4]):
            for k in range(old[2], old[5]):
                if space[i, j, k] == _ORPHAN:
                    bounds = _add_box(space, bounds, i, j, k)
    return bounds


@njit
def _contains(bounds, row, i, j, k):
    box = bounds[row]
    return box[0] <= i < box[3] and box[1] <= j < box[4] and box[2] <= k < box[5]


@njit
def _add_box(space, bounds, i, j, k):
    """Grow a box of air around a cell and give it the cells that have none, or a smaller one."""
    box = np.array([i, j, k, i + 1, j + 1, k + 1])
    grew = True
    while grew:
        grew = False
        for face in range(6):
            axis = face % 3
            if box[axis + 3] - box[axis] < MAX_SIDE_CELLS and _is_layer_free(space, box, face):
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
def _is_layer_free(space, box, face):
    """Return whether the layer of cells before a face of a box is air within the grid."""
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
