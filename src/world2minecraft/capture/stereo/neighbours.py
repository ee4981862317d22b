"""Which photos each is compared with: those that see the same things at a good angle."""

import numpy as np

from world2minecraft.capture.stereo.downscaled_photos import SmallPhoto
from world2minecraft.core.coordinates import apply, invert_rigid
from world2minecraft.geometry.unprojection import project

ASKED = 7  # A grid of 7x7 rays, each at three depths, stands for what a photo sees.
DEPTH_PERCENTILES = (20, 50, 80)
MANY_SHARED = 20  # So many points in common prove that nothing stands between.


def chosen_neighbours(
    photos: list[SmallPhoto], depths_m: np.ndarray, count: int, angle_deg: float
) -> list[np.ndarray]:
    """Return for each photo the numbers of up to ``count`` others, the best first.

    Args:
        photos: all of them.
        depths_m: float64 [F, 3], three depths that stand for what each sees.
        count: of neighbours.
        angle_deg: the angle wanted between the two rays to a point.
    """
    result = []
    poses = np.array([photo.camera_to_scan for photo in photos])
    to_cameras = np.array([invert_rigid(pose) for pose in poses])
    for number, photo in enumerate(photos):
        points_m, depth_m = _asked_points(photo, depths_m[number])
        scores = np.array(
            [
                _score(photo, photos[other], to_cameras[other], points_m, depth_m, angle_deg)
                if other != number
                else 0.0
                for other in range(len(photos))
            ]
        )
        order = np.argsort(-scores, kind="stable")
        result.append(order[scores[order] > 0.02][:count])
    return result


def _asked_points(photo: SmallPhoto, depths_m: np.ndarray):
    """Return points [P, 3] of the scan frame that the photo may see, and their depth."""
    camera = photo.camera
    u, v = np.meshgrid(
        (np.arange(ASKED) + 0.5) / ASKED * camera.width_px,
        (np.arange(ASKED) + 0.5) / ASKED * camera.height_px,
    )
    x, y = (u - camera.cx_px) / camera.fx_px, (v - camera.cy_px) / camera.fy_px
    rays = np.stack([x, y, np.ones_like(x)], axis=-1).reshape(-1, 3)
    points_m = (rays[None] * depths_m[:, None, None]).reshape(-1, 3)
    return apply(photo.camera_to_scan, points_m), np.repeat(depths_m, len(rays))


def _score(photo, other, to_other, points_m, depth_m, angle_deg) -> float:
    """Return how much of the points the other sees, each counted by its angle and distance."""
    seen_m = apply(to_other, points_m)
    z = seen_m[:, 2]
    ahead = z > 0.3 * depth_m
    at_px = project(np.where(ahead[:, None], seen_m, 1.0), other.camera)
    size = (other.camera.width_px, other.camera.height_px)
    inside = ahead & ((at_px >= 0) & (at_px < size)).all(axis=1)
    if not inside.any():
        return 0.0
    here = points_m[inside] - photo.camera_to_scan[:3, 3]
    there = points_m[inside] - other.camera_to_scan[:3, 3]
    lengths = np.linalg.norm(here, axis=1) * np.linalg.norm(there, axis=1)
    cosine = (here * there).sum(axis=1) / np.maximum(lengths, 1e-12)
    angle = np.degrees(np.arccos(np.clip(cosine, -1, 1)))
    octaves = np.log2(np.maximum(angle, 1e-3) / angle_deg)
    distance = np.log2(z[inside] / depth_m[inside])
    worth = np.exp(-0.5 * octaves**2 - 0.5 * (distance / 0.5) ** 2)
    shared = len(np.intersect1d(photo.guide_point, other.guide_point, assume_unique=True))
    return float(worth.sum() / len(points_m) * (0.2 + 0.8 * min(1.0, shared / MANY_SHARED)))
