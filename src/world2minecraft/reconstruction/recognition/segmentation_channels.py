"""Geometry channels of the segmentation network, computed from a depth image without PyTorch.

They have half the resolution of the colours, as the noise of depth cameras spans several pixels.
Channels: inverse depth, height above the floor, the normal along up, forward and right, whether
depth is known, and whether the height of the floor is known. Where the direction of up is unknown
it is estimated from the normals, as in Gupta et al., "Learning rich features from RGB-D images"
(2014). Where the height of the floor is unknown, the lowest visible points take its place.
"""

import numpy as np

from world2minecraft.capture.depth_steps import depth_step_m, smooth_depth_steps
from world2minecraft.core.jit import njit
from world2minecraft.core.types import Camera
from world2minecraft.geometry.unprojection import pixel_rays

LONG_SIDE_PX = 320  # Of the images that the network takes.
INVERSE_DEPTH, HEIGHT, NORMAL_UP, NORMAL_FORWARD, NORMAL_RIGHT, IS_KNOWN, HAS_FLOOR = range(7)
GEOMETRY_CHANNELS = 7
# Of red, green and blue, 0 to 255: those of the ImageNet pictures, as backbones expect them.
COLOUR_MEAN, COLOUR_SPREAD = (123.675, 116.28, 103.53), (58.395, 57.12, 57.375)
NEAREST_M = 0.3  # Depth cameras see nothing closer.
HEIGHT_RANGE_M = (-1.0, 4.0)
FLOOR_PERCENTILE = 1.0
REACH_PX = 3  # Half the side of the window of a normal, at half resolution.
EDGE_SHARE, EDGE_M = 0.04, 0.02  # A larger difference in depth is another surface.
MIN_FIT_PX = 6
UP_ROUNDS_DEG = (45.0, 15.0)
UP_REPEATS = 5
UP_EVERY_PX = 2
MIN_UP_NORMALS = 30
IMAGE_UP = (0.0, -1.0, 0.0)


def network_size(
    width_px: int, height_px: int, long_side_px: int = LONG_SIDE_PX
) -> tuple[int, int]:
    """Return width and height at which the network sees an image.

    Example:
        >>> network_size(640, 480), network_size(1080, 1920)
        ((320, 240), (180, 320))
    """
    scale = long_side_px / max(width_px, height_px)
    return max(round(width_px * scale), 1), max(round(height_px * scale), 1)


def sample_nearest(image: np.ndarray, width_px: int, height_px: int) -> np.ndarray:
    """Return an image [H, W] resampled without mixing values, which would bridge edges of depth."""
    rows = (np.arange(height_px) * 2 + 1) * image.shape[0] // (2 * height_px)
    columns = (np.arange(width_px) * 2 + 1) * image.shape[1] // (2 * width_px)
    return image[rows[:, None], columns]


def geometry_size(width_px: int, height_px: int) -> tuple[int, int]:
    """Return width and height of the geometry channels beside an image of the given size.

    Example:
        >>> geometry_size(320, 240), geometry_size(321, 239)
        ((160, 120), (161, 120))
    """
    return (width_px + 1) // 2, (height_px + 1) // 2


def geometry_channels(
    depth_m: np.ndarray | None,
    camera: Camera,
    up: np.ndarray | None = None,
    camera_height_m: float | None = None,
) -> np.ndarray:
    """Compute the geometry channels of an image.

    Args:
        depth_m: Depth along the optical axis in metres, [H, W], 0 where unknown; or None.
        camera: Camera of the depth image, scaled to the size of the result.
        up: Direction of up in the camera frame (x right, y down, z forward), or None if unknown.
        camera_height_m: Height of the camera above the floor in metres, or None if unknown.

    Returns:
        The channels, float32 [7, camera.height_px, camera.width_px]. All are 0 without depth.
    """
    shape = (camera.height_px, camera.width_px)
    if depth_m is None or not (depth_m > 0).any():
        return np.zeros((GEOMETRY_CHANNELS, *shape), np.float32)
    fine_m = fine_depth(depth_m, camera.width_px, camera.height_px)
    return channels_of_fine_depth(fine_m, pixel_rays(camera), up, camera_height_m)


def fine_depth(depth_m: np.ndarray, width_px: int, height_px: int) -> np.ndarray:
    """Return depth resampled to a size and smoothed if it was stored in steps, float32 [H, W]."""
    depth_m = np.asarray(depth_m, np.float32)
    step_m = depth_step_m(depth_m)
    small_m = sample_nearest(depth_m, width_px, height_px)
    return smooth_depth_steps(small_m, step_m) if step_m else small_m


def channels_of_fine_depth(
    depth_m: np.ndarray,
    rays: np.ndarray,
    up: np.ndarray | None = None,
    camera_height_m: float | None = None,
    floor_rows: int | None = None,
) -> np.ndarray:
    """Compute the geometry channels of depth that needs no smoothing.

    Args:
        depth_m: Depth in metres, float32 [H, W], 0 where unknown.
        rays: x/z and y/z of the ray of each pixel, float32 [H, W, 2].
        up: Direction of up in the camera frame, or None if unknown.
        camera_height_m: Height of the camera above the floor in metres, or None if unknown.
        floor_rows: Number of rows from the top that are searched for the lowest point where the
            height is unknown. Defaults to all; training uses fewer, as if less was in view.

    Returns:
        The channels, float32 [7, H, W].
    """
    known = depth_m > 0
    normals = surface_normals(depth_m, rays)
    up = estimate_up(normals) if up is None else np.asarray(up, np.float32)
    axes = level_axes(up)
    result = np.zeros((GEOMETRY_CHANNELS, *depth_m.shape), np.float32)
    result[INVERSE_DEPTH][known] = 1 / np.maximum(depth_m[known], NEAREST_M)
    above = depth_m * (rays[..., 0] * up[0] + rays[..., 1] * up[1] + up[2])
    if camera_height_m is None:
        searched = above[:floor_rows][known[:floor_rows]]
        searched = searched if len(searched) else above[known]
        lowest = float(np.percentile(searched[::4], FLOOR_PERCENTILE)) if len(searched) else 0.0
        camera_height_m = -lowest
    else:
        result[HAS_FLOOR] = 1
    result[HEIGHT] = np.where(known, np.clip(above + camera_height_m, *HEIGHT_RANGE_M), 0)
    result[NORMAL_UP : NORMAL_RIGHT + 1] = np.moveaxis(normals @ axes.T, 2, 0)
    result[IS_KNOWN] = known
    return result


def level_axes(up: np.ndarray) -> np.ndarray:
    """Return the unit vectors up, forward and right of a camera that is held level, [3, 3]."""
    up = up / np.linalg.norm(up)
    ahead = np.array([0, 0, 1]) - up[2] * up
    if np.linalg.norm(ahead) < 1e-3:  # The camera looks straight up or down.
        ahead = np.array([0, -1, 0]) + up[1] * up
    ahead = ahead / np.linalg.norm(ahead)
    return np.stack([up, ahead, np.cross(ahead, up)]).astype(np.float32)


def estimate_up(normals: np.ndarray) -> np.ndarray:
    """Estimate the direction of up, float32 [3], from surface normals [H, W, 3] (0 if unknown).

    Up in the image is turned towards normals parallel to it and away from normals perpendicular to
    it, first with a tolerance of 45 degrees and then with one of 15.
    """
    picked = normals[::UP_EVERY_PX, ::UP_EVERY_PX].reshape(-1, 3).astype(np.float64)
    picked = picked[(picked != 0).any(axis=1)]
    up = np.array(IMAGE_UP, np.float64)
    if len(picked) < MIN_UP_NORMALS:
        return up.astype(np.float32)
    for degrees in UP_ROUNDS_DEG:
        near, across = np.cos(np.deg2rad(degrees)), np.sin(np.deg2rad(degrees))
        for _ in range(UP_REPEATS):
            along = np.abs(picked @ up)
            level, upright = picked[along > near], picked[along < across]
            _, vectors = np.linalg.eigh(upright.T @ upright - level.T @ level)
            best = vectors[:, 0]
            up = best if best @ up >= 0 else -best
    return up.astype(np.float32)


def surface_normals(depth_m: np.ndarray, rays: np.ndarray) -> np.ndarray:
    """Compute the unit normals that face the camera, float32 [H, W, 3], 0 where unknown.

    A plane is linear in inverse depth, so a plane is fitted to the inverse depths around each
    pixel that belong to the same surface.
    """
    return _normals(np.ascontiguousarray(depth_m, np.float32), rays)


@njit
def _normals(depth, rays):
    height, width = depth.shape
    result = np.zeros((height, width, 3), np.float32)
    for i in range(height):
        for j in range(width):
            z = depth[i, j]
            if z <= 0:
                continue
            gate = EDGE_SHARE * z + EDGE_M
            x0, y0 = rays[i, j, 0], rays[i, j, 1]
            n = sx = sy = sw = sxx = sxy = syy = sxw = syw = 0.0
            for a in range(max(i - REACH_PX, 0), min(i + REACH_PX + 1, height)):
                for b in range(max(j - REACH_PX, 0), min(j + REACH_PX + 1, width)):
                    other = depth[a, b]
                    if other <= 0 or abs(other - z) > gate:
                        continue
                    x, y, w = rays[a, b, 0] - x0, rays[a, b, 1] - y0, 1 / other
                    n += 1
                    sx += x
                    sy += y
                    sw += w
                    sxx += x * x
                    sxy += x * y
                    syy += y * y
                    sxw += x * w
                    syw += y * w
            if n < MIN_FIT_PX:
                continue
            sxx -= sx * sx / n
            sxy -= sx * sy / n
            syy -= sy * sy / n
            sxw -= sx * sw / n
            syw -= sy * sw / n
            size = sxx * syy - sxy * sxy
            if size <= 1e-3 * sxx * syy or size <= 0:
                continue
            a_x = (syy * sxw - sxy * syw) / size
            a_y = (sxx * syw - sxy * sxw) / size
            rest = (sw - a_x * sx - a_y * sy) / n - a_x * x0 - a_y * y0
            norm = np.sqrt(a_x * a_x + a_y * a_y + rest * rest)
            if norm > 0:  # 1 / z = a . (x, y, 1), so a points along the ray, away from the camera.
                result[i, j, 0] = -a_x / norm
                result[i, j, 1] = -a_y / norm
                result[i, j, 2] = -rest / norm
    return result
