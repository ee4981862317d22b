"""Decompose labelled grids into few axis-aligned boxes: exactly, approximately or overlapping.

The input is an integer grid of labels in which 0 is empty. Each output box is a row
``[label, x0, y0, z0, x1, y1, z1]`` whose upper corner is exclusive.

- ``partition_boxes`` returns disjoint boxes whose union is exactly the labelled shape. Finding the
  minimum number of boxes is hard, so the grid is swept in 48 ways (six axis orders, eight corners)
  and the best sweep is used.
- ``simplify_boxes`` returns fewer disjoint boxes at a bounded loss of IoU. Each step either merges
  two neighbouring boxes into their bounding box or drops a small box, whichever changes fewer cells
  per box saved.
- ``decompose_boxes`` lets boxes of the same label overlap if a partition needs many more. A disc,
  for example, needs one disjoint box per step of its rim, but two overlapping boxes are enough.
"""

from itertools import permutations, product

import numpy as np

from world2minecraft.core.jit import njit

MAX_PARTITION_SEARCH_CELLS = 4_000_000  # Above it one sweep is made: 48 would take seconds.
REACH = 2  # Cells between boxes that may be joined; a box over a wider gap changes the shape.
MAX_BOXES = 600  # More boxes are kept: each step compares all pairs of neighbours.
RECOLOUR = 0.5  # Cost of a cell that changes its label.
MAX_COVER_SHARE = 0.75  # A cover is taken where it has at most this share of a partition's boxes.
MIN_COVER_BOXES = 8  # With fewer boxes a partition is always taken.
MAX_COVER_SEARCH_CELLS = 1_000_000
# The orders in which a box grows from a cell, along both ways of each axis in turn.
_ORDERS = np.array([[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]])


def partition_boxes(labels: np.ndarray) -> np.ndarray:
    """Partition a labelled grid exactly into few disjoint boxes.

    Args:
        labels: Integer array [X, Y, Z]; 0 is empty, labels are 1 or greater.

    Returns:
        The boxes as sorted int32 [N, 7]: label, first cell and exclusive upper corner.

    Raises:
        ValueError: If ``labels`` does not have three axes.

    Example:
        >>> partition_boxes(np.array([[[1, 1, 0], [1, 1, 0]]])).tolist()
        [[1, 0, 0, 0, 1, 2, 2]]
    """
    if labels.ndim != 3:
        raise ValueError(f"labels must have shape [X, Y, Z], got {labels.shape}")
    low, inner = _crop(labels)
    if not inner.size:
        return np.empty((0, 7), np.int32)
    orders = list(product(permutations(range(3)), product((False, True), repeat=3)))
    best: np.ndarray | None = None
    for axes, flips in orders[: 1 if inner.size > MAX_PARTITION_SEARCH_CELLS else None]:
        found = _sweep(inner, axes, flips)
        if best is None or len(found) < len(best):
            best = found
    joined = join_adjacent_boxes(best)  # type: ignore[arg-type]  # There is one order at least.
    return _sorted(joined + np.array([0, *low, *low], np.int32))


def _crop(labels: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the first occupied cell, and the labels in the bounding box of all occupied cells."""
    held = np.argwhere(labels)
    if not len(held):
        return np.zeros(3, np.int32), np.empty((0, 0, 0), np.int32)
    low, high = held.min(axis=0), held.max(axis=0) + 1
    window = tuple(slice(a, b) for a, b in zip(low, high, strict=True))
    return low.astype(np.int32), labels[window].astype(np.int32)


def _sweep(labels: np.ndarray, axes: tuple[int, ...], flips: tuple[bool, ...]) -> np.ndarray:
    """Return the boxes of one sweep with a given order and direction of the axes."""
    turned = labels.transpose(axes)
    turned = turned[tuple(slice(None, None, -1 if flip else 1) for flip in flips)]
    boxes = np.empty((int(np.count_nonzero(labels)), 7), np.int32)
    boxes = boxes[: _grow(np.ascontiguousarray(turned), boxes)]
    result = np.empty_like(boxes)
    result[:, 0] = boxes[:, 0]
    for place, (axis, flip) in enumerate(zip(axes, flips, strict=True)):
        first, last = boxes[:, 1 + place], boxes[:, 4 + place]
        if flip:
            first, last = turned.shape[place] - last, turned.shape[place] - first
        result[:, 1 + axis], result[:, 4 + axis] = first, last
    return result


@njit
def _grow(labels, boxes):  # pragma: no cover
    """Write the boxes that grow from each free cell, and return their number."""
    size_x, size_y, size_z = labels.shape
    done = np.zeros(labels.shape, np.bool_)
    count = 0
    for x in range(size_x):
        for y in range(size_y):
            for z in range(size_z):
                label = labels[x, y, z]
                if label == 0 or done[x, y, z]:
                    continue
                z1 = z + 1
                while z1 < size_z and labels[x, y, z1] == label and not done[x, y, z1]:
                    z1 += 1
                y1 = y + 1
                while y1 < size_y and _is_free(labels, done, label, x, x + 1, y1, y1 + 1, z, z1):
                    y1 += 1
                x1 = x + 1
                while x1 < size_x and _is_free(labels, done, label, x1, x1 + 1, y, y1, z, z1):
                    x1 += 1
                done[x:x1, y:y1, z:z1] = True
                boxes[count, 0] = label
                boxes[count, 1], boxes[count, 2], boxes[count, 3] = x, y, z
                boxes[count, 4], boxes[count, 5], boxes[count, 6] = x1, y1, z1
                count += 1
    return count


@njit
def _is_free(labels, done, label, x0, x1, y0, y1, z0, z1):  # pragma: no cover
    for x in range(x0, x1):
        for y in range(y0, y1):
            for z in range(z0, z1):
                if labels[x, y, z] != label or done[x, y, z]:
                    return False
    return True


def join_adjacent_boxes(boxes: np.ndarray) -> np.ndarray:
    """Merge pairs of boxes, int32 [N, 7], that have the same label and together form a box."""
    held = [tuple(row) for row in _sorted(boxes).tolist()]
    for axis in (3, 2, 1):
        others = [0, *(a for n in (1, 2, 3) if n != axis for a in (n, n + 3))]
        held.sort(key=lambda row: ([row[n] for n in others], row[axis]))
        joined: list[list[int]] = []
        for row in held:
            last = joined[-1] if joined else None
            if (
                last is not None
                and all(last[n] == row[n] for n in others)
                and last[axis + 3] == row[axis]
            ):
                last[axis + 3] = row[axis + 3]
            else:
                joined.append(list(row))
        held = [tuple(row) for row in joined]
    return _sorted(np.array(held, np.int32).reshape(-1, 7))


def _sorted(boxes: np.ndarray) -> np.ndarray:
    return boxes[np.lexsort(boxes.T[::-1])]


def simplify_boxes(
    labels: np.ndarray,
    least_iou: float,
    open_cells: np.ndarray | None = None,
    *,
    enough: int = 1,
) -> np.ndarray:
    """Approximate a labelled grid by few disjoint boxes with at least a given IoU.

    Args:
        labels: Integer array [X, Y, Z]; 0 is empty.
        least_iou: Minimum IoU of the boxes with the grid, in (0, 1]; 1 keeps the shape exactly.
            Cells that change from one label to another count half.
        open_cells: Bool [X, Y, Z] mask of empty cells that may be filled at no cost, such as the
            unseen interior of an object.
        enough: Number of boxes at which merging stops.

    Returns:
        The boxes as int32 [N, 7], in the format of ``partition_boxes``.

    Raises:
        ValueError: If ``least_iou`` is out of range or ``labels`` does not have three axes.
    """
    if not 0 < least_iou <= 1:
        raise ValueError(f"least_iou must be above 0 and at most 1, got {least_iou}")
    boxes = partition_boxes(labels).astype(np.int64)
    if not enough < len(boxes) <= MAX_BOXES:
        return boxes.astype(np.int32)
    costly = labels == 0
    if open_cells is not None:
        costly &= ~open_cells
    empty = np.zeros(np.add(labels.shape, 1), np.int64)
    empty[1:, 1:, 1:] = costly.cumsum(0).cumsum(1).cumsum(2)
    alive = _coarsen(boxes, empty, float(np.count_nonzero(labels)), float(least_iou), enough)
    return join_adjacent_boxes(boxes[alive].astype(np.int32))


@njit
def _coarsen(boxes, empty, size, least, enough):  # pragma: no cover
    """Simplify ``boxes`` in place, step by step, and return the mask of remaining boxes, bool [N].

    ``met`` is the size of the intersection of the shape and the boxes, in which relabelled cells
    count half; ``union`` is the size of their union.
    """
    alive = np.ones(len(boxes), np.bool_)
    met, union = size, size
    while alive.sum() > enough:
        best, first, second = np.inf, -1, -1
        for i in range(len(boxes)):
            if not alive[i]:
                continue
            own = _volume(boxes[i])
            if alive.sum() > 1 and (met - own) / union >= least and own < best:
                best, first, second = own, i, i
            for j in range(i + 1, len(boxes)):
                if not alive[j] or not _is_near(boxes[i], boxes[j]):
                    continue
                added, recoloured, saved = _join_cost(boxes, alive, empty, i, j)
                if saved == 0 or (met - recoloured) / (union + added) < least:
                    continue
                if (added + recoloured) / saved < best:
                    best, first, second = (added + recoloured) / saved, i, j
        if first < 0:
            return alive
        if first == second:
            met -= _volume(boxes[first])
            alive[first] = False
            continue
        added, recoloured, _ = _join_cost(boxes, alive, empty, first, second)
        met, union = met - recoloured, union + added
        _join(boxes, alive, first, second)
    return alive


@njit
def _volume(box):  # pragma: no cover
    return float((box[4] - box[1]) * (box[5] - box[2]) * (box[6] - box[3]))


@njit
def _is_near(one, other):  # pragma: no cover
    for axis in range(1, 4):
        if one[axis] > other[axis + 3] + REACH or other[axis] > one[axis + 3] + REACH:
            return False
    return True


@njit
def _bounding_box(one, other):  # pragma: no cover
    """Return the bounding box of two boxes with the label of the larger one."""
    box = one.copy() if _volume(one) >= _volume(other) else other.copy()
    for axis in range(1, 4):
        box[axis] = min(one[axis], other[axis])
        box[axis + 3] = max(one[axis + 3], other[axis + 3])
    return box


@njit
def _join_cost(boxes, alive, empty, i, j):  # pragma: no cover
    """Return the number of cells a merge adds, its relabelling cost and the number of boxes saved.

    No box is saved if another box is partly inside the bounding box of both.
    """
    box = _bounding_box(boxes[i], boxes[j])
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
                recoloured += RECOLOUR * _volume(boxes[n])
        elif meets:
            return 0.0, 0.0, 0
    return float(_sum_in_box(empty, box)), recoloured, inside - 1


@njit
def _sum_in_box(sums, box):  # pragma: no cover
    """Return the sum over a box from cumulative sums [X + 1, Y + 1, Z + 1]."""
    total = 0
    for x in range(2):
        for y in range(2):
            for z in range(2):
                sign = 1 if (x + y + z) % 2 == 1 else -1
                total += sign * sums[box[1 + 3 * x], box[2 + 3 * y], box[3 + 3 * z]]
    return total


@njit
def _join(boxes, alive, first, second):  # pragma: no cover
    """Replace two boxes by their bounding box and remove the boxes inside it."""
    box = _bounding_box(boxes[first], boxes[second])
    for n in range(len(boxes)):
        within = True
        for axis in range(1, 4):
            within &= boxes[n, axis] >= box[axis] and boxes[n, axis + 3] <= box[axis + 3]
        if within:
            alive[n] = False
    boxes[first] = box
    alive[first] = True


def decompose_boxes(labels: np.ndarray) -> np.ndarray:
    """Decompose a labelled grid exactly into few boxes.

    The boxes are disjoint unless overlapping boxes of the same label are far fewer.

    Args:
        labels: Integer array [X, Y, Z]; 0 is empty.

    Returns:
        The boxes as int32 [N, 7], in the format of ``partition_boxes``. Overlapping boxes are
        sorted from large to small.

    Raises:
        ValueError: If ``labels`` does not have three axes.
    """
    disjoint = partition_boxes(labels)
    if len(disjoint) < MIN_COVER_BOXES or labels.size > MAX_COVER_SEARCH_CELLS:
        return disjoint
    covering = cover_boxes(labels)
    return covering if len(covering) <= MAX_COVER_SHARE * len(disjoint) else disjoint


def cover_boxes(labels: np.ndarray) -> np.ndarray:
    """Cover a labelled grid exactly with few boxes, int32 [N, 7], that may overlap within a label.

    The search is greedy and starts from each of the eight corners: the first uncovered cell grows
    into the box that covers the most uncovered cells. Redundant boxes are removed at the end.
    """
    held = np.argwhere(labels)
    if not len(held):
        return np.empty((0, 7), np.int32)
    low, high = held.min(axis=0), held.max(axis=0) + 1
    window = tuple(slice(a, b) for a, b in zip(low, high, strict=True))
    inner = labels[window].astype(np.int32)
    best: np.ndarray | None = None
    for flips in product((False, True), repeat=3):
        found = _cover_from_corner(inner, flips)
        if best is None or len(found) < len(best):
            best = found
    boxes = best + np.array([0, *low, *low])  # type: ignore[operator]  # Eight were tried.
    volume = np.prod(boxes[:, 4:] - boxes[:, 1:4], axis=1)
    return boxes[np.lexsort((*boxes.T[::-1], -volume))].astype(np.int32)


def _cover_from_corner(labels: np.ndarray, flips: tuple[bool, ...]) -> np.ndarray:
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
    """Write the boxes of a cover and return their number."""
    times = np.zeros(labels.shape, np.int32)
    count = 0
    for x in range(labels.shape[0]):
        for y in range(labels.shape[1]):
            for z in range(labels.shape[2]):
                if labels[x, y, z] == 0 or times[x, y, z] > 0:
                    continue
                most = -1
                for n in range(len(orders)):
                    box = _grow_from_cell(labels, orders[n], x, y, z)
                    new = _count_uncovered(times, box)
                    if new > most:
                        most = new
                        boxes[count, 0] = labels[x, y, z]
                        boxes[count, 1:] = box
                _add_in_box(times, boxes[count, 1:], 1)
                count += 1
    return _prune(times, boxes, count)


@njit
def _prune(times, boxes, count):  # pragma: no cover
    """Remove, from the last to the first, the boxes whose cells are all covered by others."""
    count_left = 0
    needed = np.ones(count, np.bool_)
    for n in range(count - 1, -1, -1):
        a, b, c, d, e, f = boxes[n, 1:]
        if times[a:d, b:e, c:f].min() > 1:
            needed[n] = False
            _add_in_box(times, boxes[n, 1:], -1)
    for n in range(count):
        if needed[n]:
            boxes[count_left] = boxes[n]
            count_left += 1
    return count_left


@njit
def _grow_from_cell(labels, order, x, y, z):  # pragma: no cover
    """Return the box, int64 [6], that grows from a cell along the axes of an order in turn."""
    box = np.array([x, y, z, x + 1, y + 1, z + 1])
    label = labels[x, y, z]
    for axis in order:
        while box[axis] > 0:
            box[axis] -= 1
            if not _layer_has_label(labels, label, box, axis, box[axis]):
                box[axis] += 1
                break
        while box[3 + axis] < labels.shape[axis]:
            if not _layer_has_label(labels, label, box, axis, box[3 + axis]):
                break
            box[3 + axis] += 1
    return box


@njit
def _layer_has_label(labels, label, box, axis, place):  # pragma: no cover
    """Return whether all cells of a box's layer along an axis have one label."""
    low, high = box[:3].copy(), box[3:].copy()
    low[axis], high[axis] = place, place + 1
    for x in range(low[0], high[0]):
        for y in range(low[1], high[1]):
            for z in range(low[2], high[2]):
                if labels[x, y, z] != label:
                    return False
    return True


@njit
def _count_uncovered(times, box):  # pragma: no cover
    new = 0
    for x in range(box[0], box[3]):
        for y in range(box[1], box[4]):
            for z in range(box[2], box[5]):
                if times[x, y, z] == 0:
                    new += 1
    return new


@njit
def _add_in_box(times, box, step):  # pragma: no cover
    times[box[0] : box[3], box[1] : box[4], box[2] : box[5]] += step
