"""Errors of camera poses, depth scales and the room frame, before and after correction.

The error of the room frame is reported separately from the errors of the occupancy.
"""

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.coordinates import apply, invert_rigid
from world2minecraft.core.types import Layout
from world2minecraft.evaluation.scoring.truth_files import Truth
from world2minecraft.evaluation.scoring.used_frames import UsedFrame, common_move
from world2minecraft.formats.scan_record import read_poses

STRAIGHT_DEG = 10.0  # A wall of the truth that runs along an axis of the estimated frame.


def frame_error(truth_to_room: np.ndarray, layouts: Sequence[Layout] = ()) -> dict[str, float]:
    """Return the error of an estimated frame, regardless of its quarter turn and corner.

    Args:
        truth_to_room: The rigid 4x4 transform from the frame of the ground truth to the estimated
            one.
        layouts: The true rooms in the frame of the ground truth.

    Returns:
        ``tilt_deg`` is the angle between the up directions, ``yaw_deg`` the angle to the nearest
        quarter turn, and ``floor_m`` the estimated height of the true floor's origin. With
        ``layouts``, ``walls_x_m`` and ``walls_y_m`` are the positions of the true walls nearest to
        the corner of the estimated frame.
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
    """Return the positions of the true walls along the estimated x and y axes in metres."""
    lines: tuple[list[float], list[float]] = ([], [])
    for layout in layouts:
        corners = floor_corners(layout, truth_to_room)
        for start, end in zip(corners, np.roll(corners, -1, axis=0), strict=True):
            angle = abs(math.degrees(math.atan2(end[1] - start[1], end[0] - start[0])))
            for axis, straight in ((0, 90.0), (1, 0.0)):
                if min(abs(angle - straight), abs(angle - straight - 180)) < STRAIGHT_DEG:
                    lines[axis].append(float((start[axis] + end[axis]) / 2))
    return lines


def floor_corners(layout: Layout, truth_to_room: np.ndarray) -> np.ndarray:
    """Return the corners of a true room's floor in the estimated frame, float64 [N, 3] in m."""
    heights = np.full((len(layout.floor_polygon_m), 1), layout.floor_z_m)
    return apply(truth_to_room, np.hstack([layout.floor_polygon_m, heights]))


def pose_facts(out: Path, truth: Truth, frames: Sequence[UsedFrame]) -> dict[str, Any]:
    """Return the errors of poses and depth scales of a run.

    The result is empty if the true poses are unknown.

    Args:
        out: The folder of the run.
        truth: The ground truth.
        frames: The frames used.
    """
    if not truth.camera_to_truth or not frames:
        return {}
    true = [truth.truth_to_scan @ frame.camera_to_truth for frame in frames]
    stated = [frame.camera_to_scan for frame in frames]
    scales = [(truth.depth_scale or {}).get(frame.name, 1.0) for frame in frames]
    facts = {"stated": pose_error(stated, true) | scale_error(scales)}
    if (out / "poses.npz").is_file():
        found = read_poses(out / "poses.npz")
        change_of = dict(zip(found.names, found.pose_change, strict=True))
        scale_of = dict(zip(found.names, found.depth_scale.tolist(), strict=True))
        changes = [change_of.get(frame.name, np.eye(4)) for frame in frames]
        given = [scale_of.get(frame.name, 1.0) for frame in frames]
        moved = [change @ pose for change, pose in zip(changes, stated, strict=True)]
        left = [scale * own for scale, own in zip(scales, given, strict=True)]
        facts["corrected"] = pose_error(moved, true) | scale_error(left)
    return facts


def pose_error(given: Sequence[np.ndarray], true: Sequence[np.ndarray]) -> dict[str, float]:
    """Return the mean distance and angle between given and true poses [4, 4].

    ``mean_mm`` and ``mean_deg`` are measured in the frame of the scan. ``apart_mm`` and
    ``apart_deg`` remain after the best common rigid transform, which removes the error of the frame
    itself.
    """
    common = common_move(true, given)
    together = [common @ t for t in true]
    return {
        "mean_mm": _mean_mm(given, true),
        "mean_deg": _mean_deg(given, true),
        "apart_mm": _mean_mm(given, together),
        "apart_deg": _mean_deg(given, together),
    }


def scale_error(left: Sequence[float]) -> dict[str, float]:
    """Return the root mean square and the mean of the remaining depth errors in percent.

    Args:
        left: The remaining scale factor of each frame's depth after all corrections.
    """
    off = 100 * (np.asarray(left, np.float64) - 1)
    return {
        "scale_rms_percent": float(np.sqrt((off**2).mean())),
        "scale_mean_percent": float(off.mean()),
    }


def _mean_mm(given: Sequence[np.ndarray], true: Sequence[np.ndarray]) -> float:
    distances = [np.linalg.norm(g[:3, 3] - t[:3, 3]) for g, t in zip(given, true, strict=True)]
    return float(1000 * np.mean(distances))


def _mean_deg(given: Sequence[np.ndarray], true: Sequence[np.ndarray]) -> float:
    angles = []
    for g, t in zip(given, true, strict=True):
        between = (invert_rigid(t) @ g)[:3, :3]
        # The sine half keeps small angles exact, where the cosine alone loses them.
        sine = np.linalg.norm(between - between.T) / (2 * math.sqrt(2))
        angles.append(math.degrees(math.atan2(sine, (np.trace(between) - 1) / 2)))
    return float(np.mean(angles))
