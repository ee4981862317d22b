"""Footprints of upright boxes: shared area and volume, and the share outside a room.

Boxes are objects with ``center_m``, ``size_m`` along their own axes, and ``yaw_deg`` or
``quarter_turns``. Areas and volumes are exact, except ``outside_share``, which counts sample points
because a room may have any outline.
"""

from typing import Any

import numpy as np

from world2minecraft.furniture.layout_checks import inside_polygon, plan_corners_m

POINTS = 50  # A side of the raster over a footprint: a share is exact to 0.04 %.


def shared_area_m2(a: Any, b: Any) -> float:
    """Return the area shared by the footprints of two boxes, in square metres."""
    return area_m2(_clip(plan_corners_m(a), plan_corners_m(b)))


def shared_height_m(a: Any, b: Any) -> float:
    """Return the shared height of two boxes in metres, or the negative gap between them."""
    low = max(a.center_m[2] - a.size_m[2] / 2, b.center_m[2] - b.size_m[2] / 2)
    high = min(a.center_m[2] + a.size_m[2] / 2, b.center_m[2] + b.size_m[2] / 2)
    return float(high - low)


def shared_volume_m3(a: Any, b: Any) -> float:
    """Return the volume shared by two boxes in cubic metres."""
    height_m = shared_height_m(a, b)
    return shared_area_m2(a, b) * height_m if height_m > 0 else 0.0


def area_m2(polygon_m: np.ndarray) -> float:
    """Return the area of a simple polygon, float64 [N, 2], or 0 with fewer than 3 corners.

    Example:
        >>> area_m2(np.array([[0, 0], [2, 0], [2, 3], [0, 3]]))
        6.0
    """
    if len(polygon_m) < 3:
        return 0.0
    x, y = polygon_m[:, 0], polygon_m[:, 1]
    return float(abs(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2)


def outside_share(item: Any, floor_polygon_m: np.ndarray, margin_m: float) -> float:
    """Return the share of a box's footprint that is more than ``margin_m`` outside a room.

    Args:
        item: The box.
        floor_polygon_m: Outline of the room, float [N, 2], a simple polygon in either direction.
        margin_m: Distance in metres outside the room that is tolerated.
    """
    corners = plan_corners_m(item)
    steps = (np.arange(POINTS) + 0.5) / POINTS
    along, across = corners[1] - corners[0], corners[3] - corners[0]
    points = corners[0] + steps[:, None, None] * along + steps[None, :, None] * across
    within = inside_polygon(points.reshape(-1, 2), floor_polygon_m, margin_m)
    return float(1 - within.mean())


def _clip(polygon: np.ndarray, window: np.ndarray) -> np.ndarray:
    """Return the part of a polygon within a convex one, both counter-clockwise [N, 2]."""
    for start, end in zip(window, np.roll(window, -1, axis=0), strict=True):
        if not len(polygon):
            break
        side = end - start
        left = side[0] * (polygon[:, 1] - start[1]) - side[1] * (polygon[:, 0] - start[0])
        polygon = _half_plane(polygon, left)
    return polygon


def _half_plane(polygon: np.ndarray, left: np.ndarray) -> np.ndarray:
    """Return the part of a polygon whose corners have ``left`` of 0 or more."""
    corners = []
    following, left_next = np.roll(polygon, -1, axis=0), np.roll(left, -1)
    for corner, after, here, there in zip(polygon, following, left, left_next, strict=True):
        if here >= 0:
            corners.append(corner)
        if (here >= 0) != (there >= 0):
            corners.append(corner + (after - corner) * here / (here - there))
    return np.array(corners).reshape(-1, 2)
