"""Where a face lies along an axis, to millimetres.

Beside a wall's own face stand others a few centimetres away: a door's leaf and a window's pane
behind it, a picture or a wardrobe's back before it. The one with the most surface is the wall.
"""

import numpy as np

from world2minecraft.capture.alignment.surface import CELL_M, profile
from world2minecraft.geometry.oriented_points import Surface

REACH_M = 0.08  # A door's leaf lies up to 5 cm behind its wall.
BIN_M = 0.01
LIMITS_M = (0.03, 0.02, 0.012, 0.012)  # The last parts a wall from a rug or a leaf 2 cm away.
LIFT_M = 0.003  # What a face is off for other reasons than noise; no patch counts for more.


def face_place_m(facing: Surface, axis: int, place_m: float) -> float:
    """Return where the largest face near a place lies along an axis.

    Args:
        facing: the surface that looks along the axis, one way.
        axis: 0, 1 or 2.
        place_m: where the face is about; returned where nothing is within 8 cm of it.
    """
    near = facing.chosen(np.abs(facing.points_m[:, axis] - place_m) < REACH_M)
    if not len(near.points_m):
        return place_m
    found = profile(near.points_m, axis, BIN_M)
    place_m = float(found.centers_m()[int(np.argmax(found.area_m2 + found.bin_area_m2))])
    trust = 1 / (near.sigma_m**2 + LIFT_M**2) / looks(near.points_m, axis)
    for limit_m in LIMITS_M:
        off = near.points_m[:, axis] - place_m
        weight = trust * np.where(np.abs(off) < limit_m, (1 - (off / limit_m) ** 2) ** 2, 0.0)
        if weight.sum() > 0:
            place_m += float(np.sum(weight * off) / weight.sum())
    return place_m


def looks(points_m: np.ndarray, axis: int) -> np.ndarray:
    """Return how many points share each one's 10 cm of a face: many looks are one surface."""
    others = [other for other in range(3) if other != axis]
    cells = np.floor(points_m[:, others] / CELL_M).astype(np.int64)
    cells -= cells.min(axis=0, initial=0)
    code = cells[:, 0] * (cells[:, 1].max(initial=0) + 1) + cells[:, 1]
    _, index, counts = np.unique(code, return_inverse=True, return_counts=True)
    return counts[index]
