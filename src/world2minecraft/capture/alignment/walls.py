"""Estimation of a room's yaw and inner bounding box in a level frame (z up, floor at 0)."""

from dataclasses import dataclass

import numpy as np

from world2minecraft.capture.alignment.axis_profiles import (
    CELL_M,
    axis_profile,
    face_position_m,
    other_axes,
    tukey_weights,
)
from world2minecraft.core.coordinates import rotation_about_z
from world2minecraft.geometry.oriented_points import OrientedPoints, cell_codes

MAX_WALL_LEAN = 0.17  # Sine of 10 degrees: how far a wall's normal may lean.
MIN_FACING_COSINE = 0.94  # Cosine of 20 degrees.
MIN_WALL_M2 = 0.5  # Smaller surfaces are furniture; a wardrobe's door has more.
MIN_WALL_SHARE = 0.2  # Minimum area, as a share of the largest surface facing the same way.
MAX_BEYOND_SHARE = 0.03  # Maximum share of patches outside: seen through doors or mirrors.
MIN_CEILING_M = 1.8
EDGE_QUANTILE = 0.005


@dataclass(frozen=True)
class RoomBox:
    """The inner bounding box of a room in the level frame.

    Attributes:
        low_m: Minimum corner in metres, float64 [3].
        high_m: Maximum corner in metres, float64 [3].
        seen: Sides with a detected surface, of x-, x+, y-, y+ and z+; other sides end at the
            outermost points.
    """

    low_m: np.ndarray
    high_m: np.ndarray
    seen: tuple[str, ...]


def find_yaw(surface: OrientedPoints) -> float:
    """Return the rotation of the walls against the axes in degrees, from -45 to 45.

    The normals of vertical surfaces vote modulo 90 degrees; lines fitted to the large walls refine
    the result.
    """
    upright = surface.normals[np.abs(surface.normals[:, 2]) < MAX_WALL_LEAN]
    if len(upright) < 50:
        return 0.0
    angles = np.degrees(np.arctan2(upright[:, 1], upright[:, 0])) % 90
    votes = np.bincount(np.minimum(angles.astype(np.int64), 89), minlength=90).astype(float)
    votes = sum(np.roll(votes, shift) * (3 - abs(shift)) for shift in (-2, -1, 0, 1, 2))
    yaw = float(np.argmax(votes)) + 0.5
    for within_deg in (8.0, 4.0, 3.0):
        yaw += _mean_offset_deg(angles, yaw, within_deg)
    for _ in range(2):
        yaw += _wall_slope(surface.transformed(rotation_about_z(-yaw)))
    return (yaw + 45) % 90 - 45


def _mean_offset_deg(angles: np.ndarray, yaw: float, within_deg: float) -> float:
    """Return by how much the angles near a yaw, modulo 90 degrees, differ from it on average."""
    off = (angles - yaw + 45) % 90 - 45
    near = np.abs(off) < within_deg
    return float(np.mean(off[near])) if near.sum() > 20 else 0.0


def _wall_slope(surface: OrientedPoints) -> float:
    """Return the mean remaining rotation of the large walls in degrees, by fitting lines."""
    total, weights = 0.0, 0.0
    for axis in (0, 1):
        for sign in (-1, 1):
            points = surface.points_m[sign * surface.normals[:, axis] > MIN_FACING_COSINE]
            found = axis_profile(points, axis)
            for place in found.peaks(max(MIN_WALL_M2, 0.4 * float(found.area_m2.max()))):
                slope, weight = _line_slope(points, axis, float(place))
                total += weight * (-slope if axis == 0 else slope)
                weights += weight
    return float(np.degrees(np.arctan(total / weights))) if weights > 0 else 0.0


def _line_slope(points: np.ndarray, axis: int, place_m: float) -> tuple[float, float]:
    """Fit ``p[axis] = place + slope * p[other]`` near a position (Tukey), and return its weight."""
    along, across = points[:, 1 - axis], points[:, axis]
    line, spread = (0.0, place_m, 0.0), 0.0
    for limit_m in (0.10, 0.06, 0.04, 0.04):
        line, spread = _refit_line(along, across, line, limit_m)
        if spread == 0:
            return 0.0, 0.0
    return line[0], spread


def _refit_line(
    along: np.ndarray, across: np.ndarray, line: tuple[float, float, float], limit_m: float
) -> tuple[tuple[float, float, float], float]:
    """Fit a line (slope, level, middle) to the points near one, and return the points' spread.

    The spread is 0 where there are too few points.
    """
    slope, level, middle = line
    off = across - level - slope * (along - middle)
    weight = tukey_weights(off, limit_m)
    if weight.sum() < 20:
        return line, 0.0
    middle = float(np.average(along, weights=weight))
    level = float(np.average(across, weights=weight))
    spread = float(np.sum(weight * (along - middle) ** 2))
    if spread < 1e-6:
        return line, 0.0
    slope = float(np.sum(weight * (along - middle) * (across - level)) / spread)
    return (slope, level, middle), spread


def find_room_box(surface: OrientedPoints) -> RoomBox:
    """Return the inner box of a room whose walls are along x and y and whose floor is at z = 0."""
    low, high, seen = np.zeros(3), np.zeros(3), []
    for axis, name in ((0, "x"), (1, "y")):
        for sign, ends, side in ((1, low, "-"), (-1, high, "+")):
            place, found = _find_side(surface, axis, sign)
            ends[axis] = place
            if found:
                seen.append(name + side)
    high[2], found = _find_ceiling(surface)
    if found:
        seen.append("z+")
    return RoomBox(low, high, tuple(seen))


def _find_side(surface: OrientedPoints, axis: int, sign: int) -> tuple[float, bool]:
    """Return the position of the room's boundary on one side, and whether there is a wall.

    ``sign`` is the sign of the inward normal: +1 on the low side. The outermost large surface is
    the wall, unless too much of the scan is beyond it.
    """
    outward = -sign * surface.points_m[:, axis]
    patches = _one_value_per_cell(surface.points_m, outward)
    end = float(np.quantile(patches, 1 - EDGE_QUANTILE))
    facing = sign * surface.normals[:, axis] > MIN_FACING_COSINE
    found = axis_profile(np.column_stack([outward, other_axes(surface.points_m, axis)])[facing], 0)
    places = found.peaks(max(MIN_WALL_M2, MIN_WALL_SHARE * float(found.area_m2.max())))
    for place in places[::-1]:
        if np.mean(patches > place + 0.10) <= MAX_BEYOND_SHARE:
            return face_position_m(surface.subset(facing), axis, -sign * float(place)), True
    return -sign * end, False


def _one_value_per_cell(points: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return one of the values for each occupied 10 cm cell."""
    return values[np.unique(cell_codes(points, CELL_M), return_index=True)[1]]


def _find_ceiling(surface: OrientedPoints) -> tuple[float, bool]:
    """Return the height of the highest large surface that faces down, or of the highest points."""
    points = surface.points_m
    facing = surface.subset(surface.normals[:, 2] < -MIN_FACING_COSINE)
    found = axis_profile(facing.points_m, 2)
    high = _one_value_per_cell(points, points[:, 2])
    for place in found.peaks(MIN_WALL_M2)[::-1]:
        if place > MIN_CEILING_M and np.mean(high > place + 0.10) <= MAX_BEYOND_SHARE:
            return face_position_m(facing, 2, float(place)), True
    return float(np.quantile(high, 1 - EDGE_QUANTILE)), False
