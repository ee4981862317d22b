"""Surface normals from depth images, on a coarse grid of pixels.

Each grid pixel is given the mean point of a small window, and its normal is that of the plane
through the means of its neighbours ``reach_px`` to either side. A place where depth jumps, bends
or is missing has none.
"""

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import uniform_filter

from world2minecraft.geometry.lifting import pixel_rays
from world2minecraft.types import Camera

MAX_BEND = 0.02  # Of the depth: how far the middle may lie off the mean of its two neighbours.


@dataclass(frozen=True)
class OrientedPoints:
    """Points with unit normals that look at the camera.

    ``points_m`` and ``normals`` are float64 [N, 3] in the camera's frame; ``area_m2`` float64 [N]
    is the surface that each stands for.
    """

    points_m: np.ndarray
    normals: np.ndarray
    area_m2: np.ndarray


def normals_of_depth(
    depth_m: np.ndarray, camera: Camera, *, step_px: int = 6, reach_px: int = 6, max_m: float = 5.0
) -> OrientedPoints:
    """Return oriented points on every ``step_px``-th pixel.

    Args:
        depth_m: float32 [H, W] z-depth in metres, 0 = hole.
        camera: the depth camera.
        step_px: distance of the grid's pixels.
        reach_px: distance of the neighbours; wider is calmer and rounds corners more.
        max_m: depth beyond is left out, since its noise grows with the square of the distance.
    """
    half_px = max(1, reach_px // 2)
    z = _smoothed(depth_m, 2 * half_px + 1)
    rays = pixel_rays(camera)
    height, width = z.shape
    margin = reach_px + half_px  # Windows that hang over the image's edge are lopsided.
    rows = np.arange(margin, height - margin, step_px)[:, None]
    columns = np.arange(margin, width - margin, step_px)[None, :]

    def at(down: int, across: int) -> tuple[np.ndarray, np.ndarray]:
        depth = z[rows + down, columns + across].astype(np.float64)
        ray = rays[rows + down, columns + across].astype(np.float64)
        return depth, np.dstack([ray * depth[..., None], depth])

    middle, points = at(0, 0)
    left, right = at(0, -reach_px), at(0, reach_px)
    top, bottom = at(-reach_px, 0), at(reach_px, 0)
    whole = (middle > 0) & (middle < max_m)
    for one, other in ((left, right), (top, bottom)):
        whole &= (one[0] > 0) & (other[0] > 0)
        whole &= np.abs(one[0] + other[0] - 2 * middle) < 2 * MAX_BEND * middle
    normals = np.cross(bottom[1] - top[1], right[1] - left[1])
    length = np.linalg.norm(normals, axis=2)
    whole &= length > 1e-12
    points, normals = points[whole], normals[whole] / length[whole][:, None]
    normals[np.einsum("ij,ij->i", normals, points) > 0] *= -1
    # The cross product spans (2 reach)^2 pixels of surface; the grid has one point in step^2.
    area = length[whole] * (step_px / (2 * reach_px)) ** 2
    return OrientedPoints(points, normals, area)


def _smoothed(depth_m: np.ndarray, window_px: int) -> np.ndarray:
    """Return the mean depth of each window, 0 where the window has a hole or a jump."""
    mean = uniform_filter(depth_m, window_px, mode="nearest")
    square = uniform_filter(depth_m * depth_m, window_px, mode="nearest")
    spread = np.sqrt(np.maximum(square - mean * mean, 0))
    flat = spread < MAX_BEND * 2 * mean
    share = uniform_filter((depth_m > 0).astype(np.float32), window_px, mode="nearest")
    return np.where(flat & (share > 0.99), mean, np.float32(0))
