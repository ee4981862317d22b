"""Chairs that stand askew: the smallest rectangle around their cells in plan, turned freely."""

from typing import NamedTuple

import numpy as np

from world2minecraft.core.classes import SemanticClass

ANGLES_DEG = np.array([sign * a for a in range(8, 38) for sign in (1, -1)], np.float64)
CLEARLY = 0.95  # Of the upright rectangle's area. Straight chairs of 0.08 m cells stay above it.
LIKE_MIRRORED = 0.02  # A rectangle turned the other way that is as small: the turn is open.
RIM = 0.6  # Cells from the outermost centres to the sides; cells are met by their corners.
SIDES_M = (0.34, 0.66)  # Of a whole chair, and of no easy chair, heap, or back alone.


class Rectangle(NamedTuple):
    """A rectangle in plan: degrees counter-clockwise, middle and sides in cells, float64 [2]."""

    angle_deg: float
    middle: np.ndarray
    sides: np.ndarray


def askew_rectangle(cells: np.ndarray, class_id: int, voxel_m: float) -> Rectangle | None:
    """Return the rectangle of a chair of cells, int [N, 3], turned by 8 to 37 degrees.

    None for other classes, where the upright rectangle is about as small, and where the sides
    are not those of one chair. ``middle`` counts from the grid's corner.
    """
    if class_id != SemanticClass.CHAIR:
        return None
    plan = np.unique(cells[:, :2], axis=0) + 0.5
    upright = np.prod(np.ptp(plan, axis=0) + RIM)
    every = [_around(plan, angle) for angle in ANGLES_DEG]
    areas = np.round([float(np.prod(one.sides)) for one in every], 9)
    best = every[int(areas.argmin())]
    mirrored = areas[np.sign(ANGLES_DEG) != np.sign(best.angle_deg)].min()
    sides_m = best.sides * voxel_m
    if (
        areas.min() > CLEARLY * upright
        or mirrored < (1 + LIKE_MIRRORED) * areas.min()
        or not (SIDES_M[0] <= sides_m.min() and sides_m.max() <= SIDES_M[1])
    ):
        return None
    return best


def _around(plan: np.ndarray, angle_deg: float) -> Rectangle:
    """Return the rectangle of one angle around some points, float64 [N, 2]."""
    cos, sin = np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))
    along = plan[:, 0] * cos + plan[:, 1] * sin
    aside = plan[:, 1] * cos - plan[:, 0] * sin
    u, v = ((line.min() + line.max()) / 2 for line in (along, aside))
    middle = np.array([u * cos - v * sin, u * sin + v * cos])
    return Rectangle(float(angle_deg), middle, np.array([np.ptp(along), np.ptp(aside)]) + RIM)
