"""Conversion between depth images and 3D points with the pinhole model.

The pixel (u, v), counted from 0, has its centre at (u + 0.5, v + 0.5). Its point in the camera
frame (OpenCV axes, metres) is ``z * ((u + 0.5 - cx) / fx, (v + 0.5 - cy) / fy, 1)``.
"""

from functools import lru_cache

import numpy as np

from world2minecraft.core.jit import njit
from world2minecraft.core.types import Camera

UNDISTORT_ROUNDS = 8  # The fixed point of common lenses moves under 1e-4 px after five.


@lru_cache(maxsize=8)
def pixel_rays(camera: Camera) -> np.ndarray:
    """Return x/z and y/z of the undistorted ray through each pixel centre, float32 [H, W, 2]."""
    across = (np.arange(camera.width_px) + 0.5 - camera.cx_px) / camera.fx_px
    down = (np.arange(camera.height_px) + 0.5 - camera.cy_px) / camera.fy_px
    bent_x, bent_y = np.meshgrid(across, down)
    x, y = bent_x, bent_y
    if any(camera.distortion):
        for _ in range(UNDISTORT_ROUNDS):
            scale, shift_x, shift_y = lens_distortion(x, y, camera.distortion)
            x, y = (bent_x - shift_x) / scale, (bent_y - shift_y) / scale
    rays = np.stack([x, y], axis=2).astype(np.float32)
    rays.flags.writeable = False
    return rays


def lens_distortion(
    x: np.ndarray, y: np.ndarray, distortion: tuple[float, ...]
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return OpenCV's radial factor and tangential shifts at undistorted (x, y)."""
    k1, k2, p1, p2, k3 = distortion
    square = x * x + y * y
    scale = 1 + square * (k1 + square * (k2 + square * k3))
    shift_x = 2 * p1 * x * y + p2 * (square + 2 * x * x)
    shift_y = p1 * (square + 2 * y * y) + 2 * p2 * x * y
    return scale, shift_x, shift_y


def project(points_m: np.ndarray, camera: Camera) -> np.ndarray:
    """Project points [..., 3] of the camera frame, z > 0, to pixels float64 [..., 2]."""
    x, y = points_m[..., 0] / points_m[..., 2], points_m[..., 1] / points_m[..., 2]
    scale, shift_x, shift_y = lens_distortion(x, y, camera.distortion)
    return np.stack(
        [
            (x * scale + shift_x) * camera.fx_px + camera.cx_px,
            (y * scale + shift_y) * camera.fy_px + camera.cy_px,
        ],
        axis=-1,
    )


def unproject_depth(
    depth_m: np.ndarray, camera: Camera, camera_to_frame: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Convert the pixels of a depth image to 3D points.

    Args:
        depth_m: Depth along the optical axis in metres, float32 [H, W]; 0 is missing.
        camera: Intrinsics of the depth camera.
        camera_to_frame: 4x4 pose of the depth camera.

    Returns:
        The points in the target frame in metres, float32 [N, 3], and the increasing indices of
        their pixels in the flattened image, int32 [N].
    """
    return _unproject(depth_m, pixel_rays(camera), camera_to_frame.astype(np.float64))


@njit
def _unproject(depth_m, rays, pose):
    height, width = depth_m.shape
    points = np.empty((height * width, 3), np.float32)
    pixels = np.empty(height * width, np.int32)
    count = 0
    for v in range(height):
        for u in range(width):
            z = depth_m[v, u]
            if z > 0:
                x, y = rays[v, u, 0] * z, rays[v, u, 1] * z
                for axis in range(3):
                    points[count, axis] = (
                        pose[axis, 0] * x + pose[axis, 1] * y + pose[axis, 2] * z + pose[axis, 3]
                    )
                pixels[count] = v * width + u
                count += 1
    return points[:count], pixels[:count]
