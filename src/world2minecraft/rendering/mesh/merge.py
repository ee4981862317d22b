"""Faces of full cubes that lie side by side and look alike become one quad."""

from typing import NamedTuple

import numpy as np

# For each side, the two axes along it.
ALONG = np.array([[1, 2], [1, 2], [0, 2], [0, 2], [0, 1], [0, 1]])


class Rectangles(NamedTuple):
    """R rectangles of unit faces: the lowest cell of each, and how far it goes on."""

    first: np.ndarray  # int64 [R], the row of the face in its lowest cell
    length: np.ndarray  # int64 [R, 3], cells along x, y and z


def merged(cells: np.ndarray, side: np.ndarray, look: np.ndarray) -> Rectangles:
    """Join unit faces along one of their axes, and what that gives along the other.

    Args:
        cells: int [N, 3].
        side: int [N], 0 to 5.
        look: int [N]; only faces of one look are joined, and none whose look is below 0.
    """
    one, two = (
        cells[np.arange(len(side)), ALONG[side, 0]],
        cells[np.arange(len(side)), ALONG[side, 1]],
    )
    plane = cells[np.arange(len(side)), side // 2]
    first, run = _runs([side, plane, look, one, two], look >= 0)
    keys = [side[first], plane[first], look[first], two[first], run, one[first]]
    again, lines = _runs(keys, look[first] >= 0)
    rows = first[again]
    length = np.ones((len(rows), 3), np.int64)
    at = np.arange(len(rows))
    length[at, ALONG[side[rows], 0]] = lines
    length[at, ALONG[side[rows], 1]] = run[again]
    return Rectangles(rows, length)


def _runs(keys: list[np.ndarray], may: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Join rows equal in all keys but the last, which counts up by one; return first and number."""
    if not len(keys[0]):
        return np.zeros(0, np.int64), np.zeros(0, np.int64)
    order = np.lexsort(keys[::-1])
    ordered = [key[order] for key in keys]
    goes_on = may[order][1:].copy()
    for key in ordered[:-1]:
        goes_on &= key[1:] == key[:-1]
    goes_on &= ordered[-1][1:] == ordered[-1][:-1] + 1
    starts = np.flatnonzero(np.concatenate([[True], ~goes_on]))
    return order[starts], np.diff(starts, append=len(order))
