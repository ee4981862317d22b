"""Removal of lens distortion from images, at any target size."""

from dataclasses import replace

import numpy as np

from world2minecraft.core.jit import njit
from world2minecraft.core.types import Camera
from world2minecraft.geometry.unprojection import pixel_rays, project


def pinhole_camera(camera: Camera, width_px: int) -> Camera:
    """Return a camera without distortion, with the same field of view at another image width."""
    height_px = max(1, round(camera.height_px * width_px / camera.width_px))
    return replace(camera.scaled_to(width_px, height_px), distortion=(0.0,) * 5)


def undistort_image(colour: np.ndarray, camera: Camera, target: Camera) -> np.ndarray:
    """Resample an image to another camera at the same position and orientation.

    Args:
        colour: Image taken by ``camera``, uint8 [H, W, 3] or [H, W].
        camera: Intrinsics and distortion of the image.
        target: Camera to resample to. Pixels outside the image repeat the nearest border pixel.

    Returns:
        The image at the target's size, uint8. Pixels are averaged over their footprint if the image
        has a higher resolution, otherwise interpolated.
    """
    rays = pixel_rays(target).astype(np.float64)
    ahead = np.concatenate([rays, np.ones((*rays.shape[:2], 1))], axis=2)
    at_px = project(ahead, camera) - 0.5
    side = max(1, round(camera.fx_px / target.fx_px))
    planes = np.ascontiguousarray(colour.reshape(*colour.shape[:2], -1))
    read = _sample_bilinear(planes, at_px, side, camera.fx_px / target.fx_px)
    return read.reshape(*read.shape[:2], *colour.shape[2:])


@njit
def _sample_bilinear(colour, at_px, side, step):
    """Sample each position as the mean of side x side bilinear samples, ``step`` pixels wide."""
    high, wide, channels = colour.shape
    result = np.empty((at_px.shape[0], at_px.shape[1], channels), np.uint8)
    for v in range(at_px.shape[0]):
        for u in range(at_px.shape[1]):
            for c in range(channels):
                total = 0.0
                for i in range(side):
                    y = at_px[v, u, 1] + ((i + 0.5) / side - 0.5) * step
                    y = min(max(y, 0.0), high - 1.0)
                    y0 = min(int(y), max(high - 2, 0))
                    y1, b = min(y0 + 1, high - 1), y - y0
                    for j in range(side):
                        x = at_px[v, u, 0] + ((j + 0.5) / side - 0.5) * step
                        x = min(max(x, 0.0), wide - 1.0)
                        x0 = min(int(x), max(wide - 2, 0))
                        x1, a = min(x0 + 1, wide - 1), x - x0
                        top = colour[y0, x0, c] * (1 - a) + colour[y0, x1, c] * a
                        low = colour[y1, x0, c] * (1 - a) + colour[y1, x1, c] * a
                        total += top * (1 - b) + low * b
                result[v, u, c] = np.uint8(total / (side * side) + 0.5)
    return result
