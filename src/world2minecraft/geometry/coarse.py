"""Fewer boxes than a shape has exactly, as long as the shape stays the same but for a little.

Each step joins two boxes that lie near each other into the box around both, or drops a small
one: whichever changes fewest cells for each box that it saves. Boxes never come to overlap.
"""

import numpy as np

from world2minecraft.core.jit import njit
from world2minecraft.geometry.boxes import join_pairs, partition

REACH = 2  # Cells between boxes that may be joined; a box over a wider gap changes the shape.
MOST_BOXES = 600  # More are left as they are: each step looks at every pair of neighbours.
RECOLOUR = 0.5  # What a cell costs that keeps its place and takes another label.


def coarsened(
    labels: np.ndarray,
    least_iou: float,
    open_cells: np.ndarray | None = None,
    *,
    enough: int = 1,
) -> np.ndarray:
    """Return fewer boxes that share no cell, their union of at least an IoU with a shape.

    Args:
        labels: int [X, Y, Z], 0 where there is nothing.
        least_iou: from above 0 to 1; at 1 the boxes are the shape exactly. Cells that take
            another label count by half.
        open_cells: bool [X, Y, Z], cells without a label that may be filled at no cost, such as
            those inside an object that no camera saw.
        enough: boxes are joined no further once they are so few.

    Returns:
        int32 [N, 7], as ``partition`` gives them.

    Raises:
        ValueError: the bound lies outside its range, or ``labels`` have not three axes.
    """
    if not 0 < least_iou <= 1:
        raise ValueError(f"least_iou must be above 0, up to 1, not {least_iou}")
    boxes = partition(labels).astype(np.int64)
    if not enough < len(boxes) <= MOST_BOXES:
        return boxes.astype(np.int32)
    costly = labels == 0
    if open_cells is not None:
        costly &= ~open_cells
    empty = np.zeros(np.add(labels.shape, 1), np.int64)
    empty[1:, 1:, 1:] = costly.cumsum(0).cumsum(1).cumsum(2)
    alive = _coarsen(boxes, empty, float(np.count_nonzero(labels)), float(least_iou), enough)
    return join_pairs(boxes[alive].astype(np.int32))


@njit
def _coarsen(boxes, empty, size, least, enough):  # pragma: no cover
    """Change ``boxes`` in place, step by step; return which of them are left, bool [N].

    ``met`` is the size of what the shape and the boxes share, less what was relabelled by half;
    ``union`` that of both together.
    """
    alive = np.ones(len(boxes), np.bool_)
    met, union = size, size
    while alive.sum() > enough:
        best, first, second = np.inf, -1, -1
        for i in range(len(boxes)):
            if not alive[i]:
                continue
            own = _size(boxes[i])
            if alive.sum() > 1 and (met - own) / union >= least and own < best:
                best, first, second = own, i, i
            for j in range(i + 1, len(boxes)):
                if not alive[j] or not _is_near(boxes[i], boxes[j]):
                    continue
                added, recoloured, saved = _joined(boxes, alive, empty, i, j)
                if saved == 0 or (met - recoloured) / (union + added) < least:
                    continue
                if (added + recoloured) / saved < best:
                    best, first, second = (added + recoloured) / saved, i, j
        if first < 0:
            return alive
        if first == second:
            met -= _size(boxes[first])
            alive[first] = False
            continue
        added, recoloured, _ = _joined(boxes, alive, empty, first, second)
        met, union = met - recoloured, union + added
        _join(boxes, alive, first, second)
    return alive


@njit
def _size(box):  # pragma: no cover
    return float((box[4] - box[1]) * (box[5] - box[2]) * (box[6] - box[3]))


@njit
def _is_near(one, other):  # pragma: no cover
    for axis in range(1, 4):
        if one[axis] > other[axis + 3] + REACH or other[axis] > one[axis + 3] + REACH:
            return False
    return True


@njit
def _around(one, other):  # pragma: no cover
    """Return the box around two, labelled as the larger of them."""
    box = one.copy() if _size(one) >= _size(other) else other.copy()
    for axis in range(1, 4):
        box[axis] = min(one[axis], other[axis])
        box[axis + 3] = max(one[axis + 3], other[axis + 3])
    return box


@njit
def _joined(boxes, alive, empty, i, j):  # pragma: no cover
    """Return the cells that a join adds, what it relabels by cost, and how many boxes it saves.

    It saves none where another box lies partly in the box around both.
    """
    box = _around(boxes[i], boxes[j])
    recoloured, inside = 0.0, 0
    for n in range(len(boxes)):
        if not alive[n]:
            continue
        meets, within = True, True
        for axis in range(1, 4):
            meets &= boxes[n, axis] < box[axis + 3] and box[axis] < boxes[n, axis + 3]
            within &= boxes[n, axis] >= box[axis] and boxes[n, axis + 3] <= box[axis + 3]
        if within:
            inside += 1
            if boxes[n, 0] != box[0]:
                recoloured += RECOLOUR * _size(boxes[n])
        elif meets:
            return 0.0, 0.0, 0
    return float(_count(empty, box)), recoloured, inside - 1


@njit
def _count(sums, box):  # pragma: no cover
    """Return the sum over a box from the sums [X + 1, Y + 1, Z + 1] of all below each corner."""
    total = 0
    for x in range(2):
        for y in range(2):
            for z in range(2):
                sign = 1 if (x + y + z) % 2 == 1 else -1
                total += sign * sums[box[1 + 3 * x], box[2 + 3 * y], box[3 + 3 * z]]
    return total


@njit
def _join(boxes, alive, first, second):  # pragma: no cover
    """Put the box around two in the place of the first; what lies in it goes."""
    box = _around(boxes[first], boxes[second])
    for n in range(len(boxes)):
        within = True
        for axis in range(1, 4):
            within &= boxes[n, axis] >= box[axis] and boxes[n, axis + 3] <= box[axis + 3]
        if within:
            alive[n] = False
    boxes[first] = box
    alive[first] = True
