"""Merging of neighbouring pieces that were recognised as parts of the same object.

A toilet and its cistern, a bed and its headboard and the halves of a sofa often come as objects of
their own, even of different classes. Pieces whose boxes meet become one object if most votes for
both are for the same NYU40 class, and if they are together no larger than such a thing.
"""

from itertools import combinations

import numpy as np
from scipy import ndimage

from world2minecraft.core.types import OccupancyGrid
from world2minecraft.core.vocabulary import nyu40_names

# Longest side and height of one object in metres. Several chairs, tables or cabinets may touch.
LARGEST_M = {
    "bed": (2.4, 1.8),
    "sofa": (3.2, 1.3),
    "refrigerator": (1.2, 2.2),
    "television": (2.0, 1.3),
    "toilet": (0.95, 1.3),
    "bathtub": (2.1, 1.0),
}
MIN_SHARE = 0.5  # Of the votes for a piece.


def merge_same_names(
    owners: np.ndarray, grid: OccupancyGrid, class_votes: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Merge neighbouring pieces of one object.

    Args:
        owners: Number of the object of each cell, int32 [X, Y, Z], 0 for none.
        grid: Grid with labels.
        class_votes: Votes for the NYU40 classes from 1 of each object, float [count + 1, 40].

    Returns:
        The owners, and the labels, uint8 [X, Y, Z], in which merged cells have the class of the
        larger piece.
    """
    known = nyu40_names()
    limits = {known[name]: limit for name, limit in LARGEST_M.items()}
    total = np.maximum(class_votes.sum(axis=1), 1e-6)
    best = class_votes.argmax(axis=1) + 1
    best[class_votes.max(axis=1) < MIN_SHARE * total] = 0
    best[~np.isin(best, list(limits))] = 0
    if not best.any():
        return owners, grid.labels
    result, labels = owners.copy(), grid.labels.copy()
    boxes = ndimage.find_objects(owners)
    for first, second in combinations(np.flatnonzero(best).tolist(), 2):
        if best[first] != best[second] or not _meet(boxes[first - 1], boxes[second - 1]):
            continue
        one, other = (int(result[owners == number][0]) for number in (first, second))
        if one == other or not _fits(result, (one, other), limits[int(best[first])], grid.voxel_m):
            continue
        sizes = [np.count_nonzero(result == number) for number in (one, other)]
        large, small = (one, other) if sizes[0] >= sizes[1] else (other, one)
        moved = result == small
        labels[moved] = np.bincount(labels[result == large]).argmax()
        result[moved] = large
    return result, labels


def _meet(one: tuple[slice, ...] | None, other: tuple[slice, ...] | None) -> bool:
    """Return whether two boxes of cells overlap or touch."""
    if one is None or other is None:
        return False
    return all(a.start <= b.stop and b.start <= a.stop for a, b in zip(one, other, strict=True))


def _fits(
    owners: np.ndarray, pair: tuple[int, int], limit_m: tuple[float, float], voxel_m: float
) -> bool:
    """Return whether two pieces are together within a longest side and a height."""
    (box,) = ndimage.find_objects(np.isin(owners, pair).astype(np.int8))
    x, y, z = ((side.stop - side.start) * voxel_m for side in box)
    return max(x, y) <= limit_m[0] + voxel_m and z <= limit_m[1] + voxel_m
