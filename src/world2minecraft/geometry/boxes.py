"""Few boxes for many cells: exact partitions first, then coarser ones within a bound.

A shape comes as labels on a grid, 0 where there is nothing; it goes out as boxes of one label,
``[label, x0, y0, z0, x1, y1, z1]`` with the last corner excluded. The boxes of a partition never
share a cell, and together they are the shape. The fewest boxes are hard to find, so the shape is
swept in 48 ways (six orders of growth, from eight corners) and the best sweep wins.
"""

from itertools import permutations, product

import numpy as np

from world2minecraft.core.jit import njit

SEARCH_CELLS = 4_000_000  # Above it one sweep is made: 48 would take seconds.


def partition(labels: np.ndarray) -> np.ndarray:
    """Return few boxes of one label that are a shape exactly and share no cell.

    Args:
        labels: int [X, Y, Z], 0 where there is nothing, else 1 and more.

    Returns:
        int32 [N, 7], sorted: label, first cell, and the one past the last along each axis.

    Raises:
        ValueError: the labels have not three axes.

    Example:
        >>> partition(np.array([[[1, 1, 0], [1, 1, 0]]])).tolist()
        [[1, 0, 0, 0, 1, 2, 2]]
    """
    if labels.ndim != 3:
        raise ValueError(f"labels must have shape [X, Y, Z], not {labels.shape}")
    low, inner = _cropped(labels)
    if not inner.size:
        return np.empty((0, 7), np.int32)
    orders = list(product(permutations(range(3)), product((False, True), repeat=3)))
    best: np.ndarray | None = None
    for axes, flips in orders[: 1 if inner.size > SEARCH_CELLS else None]:
        found = _swept(inner, axes, flips)
        if best is None or len(found) < len(best):
            best = found
    joined = join_pairs(best)  # type: ignore[arg-type]  # There is one order at least.
    return _sorted(joined + np.array([0, *low, *low], np.int32))


def _cropped(labels: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the first cell that holds something, and the labels of the box around all."""
    held = np.argwhere(labels)
    if not len(held):
        return np.zeros(3, np.int32), np.empty((0, 0, 0), np.int32)
    low, high = held.min(axis=0), held.max(axis=0) + 1
    window = tuple(slice(a, b) for a, b in zip(low, high, strict=True))
    return low.astype(np.int32), labels[window].astype(np.int32)


def _swept(labels: np.ndarray, axes: tuple[int, ...], flips: tuple[bool, ...]) -> np.ndarray:
    """Return the boxes of one sweep: the axes in an order, some of them backwards."""
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
    """Write the boxes that grow from each free cell along the last axis first; return how many."""
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


def join_pairs(boxes: np.ndarray) -> np.ndarray:
    """Return boxes, int32 [N, 7], with every two of one label that make one box joined."""
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


def painted_boxes(boxes: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    """Return the labels, int32 of a shape, that boxes int [N, 7] are; later ones cover earlier."""
    labels = np.zeros(shape, np.int32)
    for label, x0, y0, z0, x1, y1, z1 in boxes.tolist():
        labels[x0:x1, y0:y1, z0:z1] = label
    return labels


def _sorted(boxes: np.ndarray) -> np.ndarray:
    return boxes[np.lexsort(boxes.T[::-1])]
