"""Splinters of a cut go back to the piece that they touch most."""

import numpy as np
from scipy import ndimage

from world2minecraft.reconstruction.instances.heap import Heap

THIN_M = 0.2  # A piece this thin in plan
SHORT_M = 0.75  # and this short is the flank or the edge of its neighbour,
LEAST_CELLS = 40  # and one of so few cells a splinter of it.


def absorbed(pieces: np.ndarray, heap: Heap) -> np.ndarray:
    """Return pieces, int32 [X, Y, Z], numbered anew from 1, without splinters.

    The smallest goes first; one that touches no other piece stays.
    """
    result = pieces.copy()
    kept: set[int] = set()
    while True:
        splinter = _smallest_splinter(result, heap, kept)
        if splinter is None:
            break
        into = _most_touched(result, splinter)
        if into:
            result[result == splinter] = into
        else:
            kept.add(splinter)
    numbers = np.unique(result[result > 0])
    return np.searchsorted(numbers, result).astype(np.int32) + (result > 0)


def _smallest_splinter(pieces: np.ndarray, heap: Heap, kept: set[int]) -> int | None:
    found = []
    for number, box in enumerate(ndimage.find_objects(pieces), start=1):
        if box is None or number in kept:
            continue
        sides = sorted((side.stop - side.start) * heap.voxel_m for side in box[:2])
        cells = int(np.count_nonzero(pieces[box] == number))
        if cells < LEAST_CELLS or (sides[0] <= THIN_M and sides[1] <= SHORT_M):
            found.append((cells, number))
    return min(found)[1] if found else None


def _most_touched(pieces: np.ndarray, number: int) -> int:
    """Return the piece that has most cells beside those of ``number``; of equals the lowest."""
    own = pieces == number
    beside = pieces[ndimage.binary_dilation(own, np.ones((3, 3, 3), np.bool_)) & ~own]
    counts = np.bincount(beside[beside > 0])
    return int(counts.argmax()) if len(counts) else 0
