"""How far the cameras' poses and the depths' scales are off, as stated and as corrected."""

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.coordinates import invert_rigid
from world2minecraft.evaluation.scoring.truth import Truth
from world2minecraft.evaluation.scoring.used_frames import UsedFrame, common_move
from world2minecraft.formats.poses import read_poses


def pose_facts(out: Path, truth: Truth, frames: Sequence[UsedFrame]) -> dict[str, Any]:
    """Return the errors of poses and depth scales; empty where the truth tells no poses."""
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
    """Return the mean distance and angle between poses [4, 4] of the same frames.

    ``mean_mm`` and ``mean_deg`` are in the scan's frame; the ``apart`` ones are what is left once
    all poses were moved by one common turn and shift, which is the frame's own error.
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
    """Return by how many per cent depths are still wrong: their root mean square, and the mean.

    Args:
        left: of each frame, what true depth is multiplied by once all corrections are made.
    """
    off = 100 * (np.asarray(left, np.float64) - 1)
    return {
        "scale_rms_percent": float(np.sqrt((off**2).mean())),
        "scale_mean_percent": float(off.mean()),
    }


def _mean_mm(given: Sequence[np.ndarray], true: Sequence[np.ndarray]) -> float:
    apart = [np.linalg.norm(g[:3, 3] - t[:3, 3]) for g, t in zip(given, true, strict=True)]
    return float(1000 * np.mean(apart))


def _mean_deg(given: Sequence[np.ndarray], true: Sequence[np.ndarray]) -> float:
    angles = []
    for g, t in zip(given, true, strict=True):
        between = (invert_rigid(t) @ g)[:3, :3]
        # The sine half keeps small angles exact, where the cosine alone loses them.
        sine = np.linalg.norm(between - between.T) / (2 * math.sqrt(2))
        angles.append(math.degrees(math.atan2(sine, (np.trace(between) - 1) / 2)))
    return float(np.mean(angles))
