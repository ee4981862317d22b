"""How far an estimated room frame is off, told apart from errors of occupancy."""

import math
from collections.abc import Sequence

import numpy as np

from world2minecraft.core.coordinates import apply
from world2minecraft.core.types import Layout

STRAIGHT_DEG = 10.0  # A wall of the truth that runs along an axis of the estimated frame.


def frame_error(truth_to_room: np.ndarray, layouts: Sequence[Layout] = ()) -> dict[str, float]:
    """Return how far an estimated frame is off, whatever quarter turn and corner it chose.

    ``tilt_deg`` is the angle between the two ups, ``yaw_deg`` that to the nearest quarter turn,
    ``floor_m`` the height that it gives the true floor's origin. ``walls_x_m`` and ``walls_y_m``,
    given where ``layouts`` are, say where the true wall lies that stands nearest to the frame's
    own corner.

    Args:
        truth_to_room: 4x4 rigid, from the truth's frame to the estimated one.
        layouts: the true rooms, in the truth's frame.
    """
    rotation = truth_to_room[:3, :3]
    up = np.clip(rotation[2, 2], -1.0, 1.0)
    yaw = math.degrees(math.atan2(rotation[1, 0], rotation[0, 0]))
    error = {
        "tilt_deg": math.degrees(math.acos(float(up))),
        "yaw_deg": abs((yaw + 45) % 90 - 45),
        "floor_m": float(truth_to_room[2, 3]),
    }
    lines = wall_lines(truth_to_room, layouts)
    for name, places in zip(("walls_x_m", "walls_y_m"), lines, strict=True):
        if places:
            error[name] = min(places, key=abs)
    return error


def wall_lines(
    truth_to_room: np.ndarray, layouts: Sequence[Layout]
) -> tuple[list[float], list[float]]:
    """Return where true walls cross the estimated x and y axes: the means of their two ends."""
    lines: tuple[list[float], list[float]] = ([], [])
    for layout in layouts:
        heights = np.full((len(layout.floor_polygon_m), 1), layout.floor_z_m)
        corners = apply(truth_to_room, np.hstack([layout.floor_polygon_m, heights]))
        for start, end in zip(corners, np.roll(corners, -1, axis=0), strict=True):
            angle = abs(math.degrees(math.atan2(end[1] - start[1], end[0] - start[0])))
            for axis, straight in ((0, 90.0), (1, 0.0)):
                if min(abs(angle - straight), abs(angle - straight - 180)) < STRAIGHT_DEG:
                    lines[axis].append(float((start[axis] + end[axis]) / 2))
    return lines
