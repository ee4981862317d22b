"""The light at the corners of quads: what rays read of the light lattice, at given places."""

import numpy as np

from world2minecraft.rendering.light.lattice import BLOCK_SHIFT, COUNT_SHIFT

_NEAR_EDGE = 1e-3  # Blocks: a face so near its cell's boundary is lit from beyond it.
OPEN = np.array([60, 0, 0], np.uint8)  # Daylight and free corners: faces that a cut lays bare.


def light_at(
    lattice: np.ndarray, cells: np.ndarray, facing: np.ndarray, points: np.ndarray
) -> np.ndarray:
    """Return sky light, block light (quarters of a level, 0 to 60) and occluders (0 to 240 for 3).

    Args:
        lattice: uint16 [3, X + 2, Y + 2, Z + 2], see ``rendering.light.lattice``.
        cells: int [N, 3], the cell of each point.
        facing: int [N], the side that the face looks to.
        points: float64 [N, 3], in coordinates of the cell, 0 to 1.

    Returns:
        uint8 [N, 3].
    """
    axis, sign = facing // 2, np.where(facing % 2, 1, -1)
    rows = np.arange(len(points))
    along = points[rows, axis]
    on_rim = np.where(sign > 0, along > 1 - _NEAR_EDGE, along < _NEAR_EDGE)
    first, second = np.array([1, 0, 0])[axis], np.array([2, 2, 1])[axis]
    p = np.clip(points[rows, first], 0, 1)[:, None]
    q = np.clip(points[rows, second], 0, 1)[:, None]
    base = cells.copy()
    base[rows, axis] += 1 + on_rim * sign
    corners = []
    for a, b in ((0, 0), (0, 1), (1, 0), (1, 1)):
        at = base.copy()
        at[rows, first] += a
        at[rows, second] += b
        at = np.clip(at, 0, np.array(lattice.shape[1:]) - 1)  # What stands free may be outside.
        corners.append(_parts(lattice[axis, at[:, 0], at[:, 1], at[:, 2]]))
    one, two, three, four = corners
    mixed = (1 - p) * ((1 - q) * one + q * two) + p * ((1 - q) * three + q * four)
    return (mixed * [1, 1, 80] + 0.5).astype(np.uint8)


def _parts(words: np.ndarray) -> np.ndarray:
    """Return float64 [N, 3] of the lattice's words."""
    return np.stack([words & 63, (words >> BLOCK_SHIFT) & 63, words >> COUNT_SHIFT], axis=1).astype(
        np.float64
    )
