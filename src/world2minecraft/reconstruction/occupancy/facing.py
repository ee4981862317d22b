"""Which way the surface at each pixel of a depth image faces.

Depth is averaged in squares of pixels; a square's normal is that of the plane through the means of
its neighbours, as far as the surface goes on without a jump. Squares at jumps have none.
"""

import numpy as np

from world2minecraft.core.jit import njit
from world2minecraft.core.types import Camera
from world2minecraft.geometry.unprojection import pixel_rays

SQUARES_WIDE = 160  # 4 px at 640: the mean of 16 pixels, and 16 px from side to side.
REACH = 2  # Squares to either side.
JUMP_SHARE = 0.04  # Of the depth: neighbouring squares of one surface differ by less.


def facing_of_depth(
    depth_m: np.ndarray, camera: Camera, camera_to_frame: np.ndarray, pixels: np.ndarray
) -> np.ndarray:
    """Return float32 [N, 3]: unit normals towards the camera, (0, 0, 0) where there is none.

    Args:
        depth_m: float32 [H, W] z-depth in metres, 0 = hole.
        camera: the depth camera.
        camera_to_frame: 4x4 pose of the depth camera; the normals are those of its frame.
        pixels: int32 [N], flat indices of the pixels that are asked for.
    """
    side = max(1, round(camera.width_px / SQUARES_WIDE))
    means = _square_means(depth_m, pixel_rays(camera), side)
    turn = np.ascontiguousarray(camera_to_frame[:3, :3], np.float64)
    return _spread(_normals(means), turn, pixels, camera.width_px, side)


@njit
def _square_means(depth_m, rays, side):
    """Return float32 [h, w, 3], the mean point of each square; z is 0 where a surface jumps."""
    high, wide = -(-depth_m.shape[0] // side), -(-depth_m.shape[1] // side)
    means = np.zeros((high, wide, 3), np.float32)
    for i in range(high):
        for j in range(wide):
            count, x, y, total, near, far = 0, 0.0, 0.0, 0.0, np.inf, 0.0
            for v in range(i * side, min((i + 1) * side, depth_m.shape[0])):
                for u in range(j * side, min((j + 1) * side, depth_m.shape[1])):
                    z = depth_m[v, u]
                    if z > 0:
                        count += 1
                        x += rays[v, u, 0] * z
                        y += rays[v, u, 1] * z
                        total += z
                        near, far = min(near, z), max(far, z)
            if 2 * count >= side * side and far - near < 2.5 * JUMP_SHARE * near:
                means[i, j] = x / count, y / count, total / count
    return means


@njit
def _reach(means, i, j, down, across):
    """Return how many squares the surface goes on from (i, j) in a direction, at most REACH."""
    steps = 0
    while steps < REACH:
        a, b = i + (steps + 1) * down, j + (steps + 1) * across
        if a < 0 or b < 0 or a >= means.shape[0] or b >= means.shape[1]:
            break
        here, there = means[a - down, b - across, 2], means[a, b, 2]
        if there == 0 or abs(there - here) > JUMP_SHARE * here:
            break
        steps += 1
    return steps


@njit
def _normals(means):
    """Return float32 [h, w, 3], unit normals towards the camera."""
    result = np.zeros(means.shape, np.float32)
    for i in range(means.shape[0]):
        for j in range(means.shape[1]):
            if means[i, j, 2] == 0:
                continue
            up, down = _reach(means, i, j, -1, 0), _reach(means, i, j, 1, 0)
            left, right = _reach(means, i, j, 0, -1), _reach(means, i, j, 0, 1)
            if up + down == 0 or left + right == 0:
                continue
            a = means[i + down, j] - means[i - up, j]
            b = means[i, j + right] - means[i, j - left]
            x = a[1] * b[2] - a[2] * b[1]
            y = a[2] * b[0] - a[0] * b[2]
            z = a[0] * b[1] - a[1] * b[0]
            length = np.sqrt(x * x + y * y + z * z)
            if length < 1e-12:
                continue
            if x * means[i, j, 0] + y * means[i, j, 1] + z * means[i, j, 2] > 0:
                length = -length
            result[i, j] = x / length, y / length, z / length
    return result


@njit
def _spread(normals, turn, pixels, width_px, side):
    """Return the turned normal of the square of each pixel."""
    turned = np.zeros(normals.shape, np.float32)
    for i in range(normals.shape[0]):
        for j in range(normals.shape[1]):
            for axis in range(3):
                value = 0.0
                for other in range(3):
                    value += turn[axis, other] * normals[i, j, other]
                turned[i, j, axis] = value
    result = np.empty((len(pixels), 3), np.float32)
    for n in range(len(pixels)):
        v = pixels[n] // width_px
        result[n] = turned[v // side, (pixels[n] - v * width_px) // side]
    return result
