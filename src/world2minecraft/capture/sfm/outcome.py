"""What was solved, as the value that later stages take: in one order, rounded, with its figures."""

from typing import Any

import numpy as np

from world2minecraft.capture.sfm.bundle import Solved
from world2minecraft.capture.sfm.features import Features
from world2minecraft.capture.sfm.similarity_transform import Similarity
from world2minecraft.core.types import Camera, SparseScene

DIGITS = 9  # What is left of rounding in sums; a nanometre.


def scene(
    photos: list[Features],
    found: Solved,
    change: Similarity | None = None,
    kept: dict[int, tuple[Camera, np.ndarray]] | None = None,
    **told: Any,
) -> SparseScene:
    """Return the solved photos as a SparseScene.

    Args:
        photos: all photos, in their order.
        found: poses and points.
        change: carries these to the wanted frame.
        kept: cameras and poses by number that are given out as they are, not rounded.
        told: ``left_out``, ``notes`` and ``facts``.
    """
    kept = kept or {}
    order = sorted({*found.poses, *kept})
    number = np.full(len(photos), -1)
    number[order] = range(len(order))
    poses = np.array([found.poses.get(i, np.eye(4)) for i in order])
    points = found.points
    if change is not None:
        poses, points = change.poses(poses), change.points(points)
    poses = np.round(poses, DIGITS) + 0.0  # No minus zero.
    for row, i in enumerate(order):
        if i in kept:
            poses[row] = kept[i][1]
    pixels = _pixels(photos, found)
    facts = {
        "photos_given": len(photos),
        "photos_placed": len(order),
        "error_px": round(found.median_px, 4) if len(found.error_px) else None,
        "points": len(points),
        "triangulation_deg": round(middle_angle_deg(found), 3),
        **told.pop("facts", {}),
    }
    return SparseScene(
        tuple(photos[i].name for i in order),
        tuple(kept[i][0] if i in kept else found.cameras[i] for i in order),
        poses,
        np.round(points, DIGITS).astype(np.float32),
        _colours(photos, found),
        number[found.track_photo].astype(np.int32),
        found.track_point.astype(np.int32),
        pixels.astype(np.float32),
        round(float(found.error_px.mean()), 6) if len(found.error_px) else 0.0,
        facts=facts,
        **told,
    )


def middle_depth(found: Solved) -> float:
    """Return the median distance along the view from a photo to a point that it sees."""
    depths = []
    for i, pose in sorted(found.poses.items()):
        seen = found.points[found.track_point[found.track_photo == i]]
        depths.append((seen - pose[:3, 3]) @ pose[:3, 2])
    return float(np.median(np.concatenate(depths)))


def middle_angle_deg(found: Solved) -> float:
    """Return the median over points of the widest angle between the first ray and another."""
    if len(found.points) == 0:
        return 0.0
    centres = np.zeros((max(found.poses) + 1, 3))
    for i, pose in found.poses.items():
        centres[i] = pose[:3, 3]
    rays = centres[found.track_photo] - found.points[found.track_point]
    rays /= np.maximum(np.linalg.norm(rays, axis=1, keepdims=True), 1e-12)
    starts = np.searchsorted(found.track_point, np.arange(len(found.points)))
    cosines = (rays * rays[starts[found.track_point]]).sum(axis=1)
    widest = np.minimum.reduceat(cosines, starts)
    return float(np.degrees(np.median(np.arccos(np.clip(widest, -1, 1)))))


def _pixels(photos: list[Features], found: Solved) -> np.ndarray:
    pixels = np.zeros((len(found.track_photo), 2))
    for i in found.poses:
        mine = found.track_photo == i
        pixels[mine] = photos[i].pixels[found.track_feature[mine]]
    return pixels


def _colours(photos: list[Features], found: Solved) -> np.ndarray:
    """Return each point's mean colour, uint8 [P, 3]."""
    count = len(found.points)
    total = np.zeros((count, 3), np.int64)
    for i in found.poses:
        mine = found.track_photo == i
        colours = photos[i].colours[found.track_feature[mine]]
        np.add.at(total, found.track_point[mine], colours.astype(np.int64))
    seen = np.maximum(np.bincount(found.track_point, minlength=count), 1)
    return ((2 * total + seen[:, None]) // (2 * seen[:, None])).astype(np.uint8)
