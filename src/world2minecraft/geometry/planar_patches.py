"""Planar patches of a depth image, the input of registration and alignment.

Each square of pixels that is flat yields a point, a normal and a standard deviation. The inverse
depth of a plane is linear in the pixel's ray, ``1 / z = a + b x + c y``, so a patch is a linear fit
at any slope; and the noise of the inverse depth of structured light hardly depends on the distance.
Four squares whose joint fit is as good as their own are merged, since a wider patch has a more
precise normal.
"""

from dataclasses import dataclass

import numpy as np

from world2minecraft.core.jit import njit
from world2minecraft.core.types import Camera
from world2minecraft.geometry.unprojection import pixel_rays

SQUARES_ACROSS = 64  # 10 px at 640: 6 cm at 3 m.
MIN_DEPTH_SHARE = 0.5  # Of a square's pixels that must have depth.
ROUGH_M, ROUGH_GROWTH = 0.003, 0.0035  # rms of a flat square, 1.5 times the rgbd sensor's noise.
MIN_RMS_M = 0.0003  # Millimetre steps of stored depth.
MAX_SLOPE_SIGMA = 0.12  # 7 degrees; less certain normals are not used.
MERGE_F = 3.0  # F statistic above which nine more parameters fit better than by chance.
MAX_DEPTH_M = 6.0


@dataclass(frozen=True, eq=False)
class Patches:
    """Planar patches in the frame of their camera.

    Attributes:
        points_m: Centre points in metres, float64 [N, 3].
        normals: Unit normals towards the camera, float64 [N, 3].
        sigma_m: Standard deviation of each point along its normal in metres, due to pixel noise
            alone, float64 [N].
    """

    points_m: np.ndarray
    normals: np.ndarray
    sigma_m: np.ndarray

    def subsample(self, most: int) -> "Patches":
        """Return at most ``most`` patches, evenly spread over the image."""
        count = len(self.sigma_m)
        if count <= most:
            return self
        index = np.arange(most) * count // most
        return Patches(self.points_m[index], self.normals[index], self.sigma_m[index])


def extract_patches(depth_m: np.ndarray, camera: Camera) -> Patches:
    """Extract the planar patches of a depth image.

    Args:
        depth_m: Depth along the optical axis in metres, float32 [H, W]; 0 is missing.
        camera: Intrinsics of the depth camera.
    """
    side = max(4, round(camera.width_px / SQUARES_ACROSS))
    rows = _patches(depth_m, pixel_rays(camera), side)
    return Patches(rows[:, :3], rows[:, 3:6], rows[:, 6])


@njit
def _moments(depth, rays, top, left, side):
    """Return sums of 1, x, y, xx, xy, yy, d, xd, yd, dd over a square; d is the inverse depth."""
    sums = np.zeros(10)
    for v in range(top, top + side):
        for u in range(left, left + side):
            z = depth[v, u]
            if z > 0 and z < MAX_DEPTH_M:
                x, y, d = float(rays[v, u, 0]), float(rays[v, u, 1]), 1.0 / z
                sums[0] += 1
                sums[1] += x
                sums[2] += y
                sums[3] += x * x
                sums[4] += x * y
                sums[5] += y * y
                sums[6] += d
                sums[7] += x * d
                sums[8] += y * d
                sums[9] += d * d
    return sums


@njit
def _fit(sums, least, row):
    """Fit a square, write point, normal and sigma to ``row``, and return the residual, or -1."""
    n = sums[0]
    if n < least or n < 8:
        return -1.0
    x, y, d = sums[1] / n, sums[2] / n, sums[6] / n
    xx, xy, yy = sums[3] - n * x * x, sums[4] - n * x * y, sums[5] - n * y * y
    xd, yd, dd = sums[7] - n * x * d, sums[8] - n * y * d, sums[9] - n * d * d
    size = xx * yy - xy * xy
    if size <= 1e-3 * xx * yy:
        return -1.0
    b, c = (xd * yy - yd * xy) / size, (yd * xx - xd * xy) / size
    left = max(dd - b * xd - c * yd, 0.0)
    z = 1.0 / d
    left = max(left, (n - 3) * (MIN_RMS_M / (z * z)) ** 2)
    sigma_d = np.sqrt(left / (n - 3))
    rms = sigma_d * z * z
    slope_sigma = rms / (z * np.sqrt(min(xx, yy)))
    if rms > ROUGH_M + ROUGH_GROWTH * z * z or slope_sigma > MAX_SLOPE_SIGMA:
        return -1.0
    a = d - b * x - c * y
    length = np.sqrt(a * a + b * b + c * c)
    row[0], row[1], row[2] = x * z, y * z, z
    row[3], row[4], row[5] = -b / length, -c / length, -a / length
    # A step of depth moves the point along its ray; along the normal it counts by their cosine.
    row[6] = rms / np.sqrt(n) * d / length
    return left


@njit
def _patches(depth, rays, side):
    down, across = depth.shape[0] // (2 * side), depth.shape[1] // (2 * side)
    found = np.empty((4 * down * across, 7))
    rows, lefts = np.empty((5, 7)), np.empty(4)
    count = 0
    least = MIN_DEPTH_SHARE * side * side
    for i in range(down):
        for j in range(across):
            whole = np.zeros(10)
            for part in range(4):
                top, left = (2 * i + part // 2) * side, (2 * j + part % 2) * side
                sums = _moments(depth, rays, top, left, side)
                lefts[part] = _fit(sums, least, rows[part])
                whole += sums
            if lefts.min() >= 0:
                left = _fit(whole, least, rows[4])
                inner = lefts.sum()
                if left >= 0 and (left - inner) * (whole[0] - 12) <= MERGE_F * 9 * inner:
                    found[count] = rows[4]
                    count += 1
                    continue
            for part in range(4):
                if lefts[part] >= 0:
                    found[count] = rows[part]
                    count += 1
    return found[:count].copy()
