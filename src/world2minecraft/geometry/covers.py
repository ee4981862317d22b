"""Few boxes for round shapes: boxes may overlap where a partition would need many more.

A disc of cells falls into a box for each step of its rim; boxes that overlap take two steps each.
"""

from itertools import product

import numpy as np

from world2minecraft.core.jit import njit
from world2minecraft.geometry.boxes import partition

WORTH = 0.75  # A cover is taken where it has at most this share of a partition's boxes.
LEAST_BOXES = 8  # With fewer boxes a partition is always taken: it needs no care where boxes meet.
SEARCH_CELLS = 1_000_000
# The orders in which a box grows from a cell, along both ways of each axis in turn.
_ORDERS = np.array([[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]])


def few_boxes(labels: np.ndarray) -> np.ndarray:
    """Return few boxes of one label whose union is a shape exactly.

    They share no cell, except where boxes that overlap within one label are far fewer.

    Args:
        labels: int [X, Y, Z], 0 where there is nothing.

    Returns:
        int32 [N, 7], as ``partition`` gives them; the largest first where they overlap.

    Raises:
        ValueError: the labels have not three axes.
    """
    apart = partition(labels)
    if len(apart) < LEAST_BOXES or labels.size > SEARCH_CELLS:
        return apart
    over = cover(labels)
    return over if len(over) <= WORTH * len(apart) else apart


def cover(labels: np.ndarray) -> np.ndarray:
    """Return few boxes, int32 [N, 7], that cover a shape exactly and may overlap in one label.

    Greedy from each of eight corners: the first cell that is not covered yet grows into the box
    that covers most; at last boxes that the others cover are dropped.
    """
    held = np.argwhere(labels)
    if not len(held):
        return np.empty((0, 7), np.int32)
    low, high = held.min(axis=0), held.max(axis=0) + 1
    window = tuple(slice(a, b) for a, b in zip(low, high, strict=True))
    inner = labels[window].astype(np.int32)
    best: np.ndarray | None = None
    for flips in product((False, True), repeat=3):
        found = _covered(inner, flips)
        if best is None or len(found) < len(best):
            best = found
    boxes = best + np.array([0, *low, *low])  # type: ignore[operator]  # Eight were tried.
    volume = np.prod(boxes[:, 4:] - boxes[:, 1:4], axis=1)
    return boxes[np.lexsort((*boxes.T[::-1], -volume))].astype(np.int32)


def _covered(labels: np.ndarray, flips: tuple[bool, ...]) -> np.ndarray:
    ways = tuple(slice(None, None, -1 if flip else 1) for flip in flips)
    boxes = np.empty((int(np.count_nonzero(labels)), 7), np.int64)
    boxes = boxes[: _cover(np.ascontiguousarray(labels[ways]), _ORDERS, boxes)]
    for axis, flip in enumerate(flips):
        if flip:
            first, last = boxes[:, 1 + axis].copy(), boxes[:, 4 + axis].copy()
            boxes[:, 1 + axis] = labels.shape[axis] - last
            boxes[:, 4 + axis] = labels.shape[axis] - first
    return boxes


@njit
def _cover(labels, orders, boxes):  # pragma: no cover
    """Write the boxes of a cover; return how many."""
    times = np.zeros(labels.shape, np.int32)
    count = 0
    for x in range(labels.shape[0]):
        for y in range(labels.shape[1]):
            for z in range(labels.shape[2]):
                if labels[x, y, z] == 0 or times[x, y, z] > 0:
                    continue
                most = -1
                for n in range(len(orders)):
                    box = _grown(labels, orders[n], x, y, z)
                    new = _fresh(times, box)
                    if new > most:
                        most = new
                        boxes[count, 0] = labels[x, y, z]
                        boxes[count, 1:] = box
                _count(times, boxes[count, 1:], 1)
                count += 1
    return _pruned(times, boxes, count)


@njit
def _pruned(times, boxes, count):  # pragma: no cover
    """Drop, from the last to the first, the boxes whose every cell another covers too."""
    kept = 0
    needed = np.ones(count, np.bool_)
    for n in range(count - 1, -1, -1):
        a, b, c, d, e, f = boxes[n, 1:]
        if times[a:d, b:e, c:f].min() > 1:
            needed[n] = False
            _count(times, boxes[n, 1:], -1)
    for n in range(count):
        if needed[n]:
            boxes[kept] = boxes[n]
            kept += 1
    return kept


@njit
def _grown(labels, order, x, y, z):  # pragma: no cover
    """Return the box, int64 [6], that grows from a cell along each axis of an order in turn."""
    box = np.array([x, y, z, x + 1, y + 1, z + 1])
    label = labels[x, y, z]
    for axis in order:
        while box[axis] > 0:
            box[axis] -= 1
            if not _is_one(labels, label, box, axis, box[axis]):
                box[axis] += 1
                break
        while box[3 + axis] < labels.shape[axis]:
            if not _is_one(labels, label, box, axis, box[3 + axis]):
                break
            box[3 + axis] += 1
    return box


@njit
def _is_one(labels, label, box, axis, place):  # pragma: no cover
    """Tell whether a box's layer at a place along an axis is of one label."""
    low, high = box[:3].copy(), box[3:].copy()
    low[axis], high[axis] = place, place + 1
    for x in range(low[0], high[0]):
        for y in range(low[1], high[1]):
            for z in range(low[2], high[2]):
                if labels[x, y, z] != label:
                    return False
    return True


@njit
def _fresh(times, box):  # pragma: no cover
    new = 0
    for x in range(box[0], box[3]):
        for y in range(box[1], box[4]):
            for z in range(box[2], box[5]):
                if times[x, y, z] == 0:
                    new += 1
    return new


@njit
def _count(times, box, step):  # pragma: no cover
    times[box[0] : box[3], box[1] : box[4], box[2] : box[5]] += step
