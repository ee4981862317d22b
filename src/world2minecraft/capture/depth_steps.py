"""Smoothing of depth images that were stored in coarse steps.

Depth stored with 8 bits has steps of some centimetres. Each step looks like a small plane that
faces the camera, so gravity and walls would follow the camera instead of the room. The values only
state an interval, in which the smoothest surface is reconstructed. In inverse depth a plane is
linear in the pixel coordinates, so planes are recovered exactly.
"""

import numpy as np

from world2minecraft.core.jit import njit

STEP_RANGE_M = (0.015, 0.1)  # Less is within the noise of depth cameras; more is no quantisation.
MIN_VALUES = 6  # Fewer distinct values say nothing about steps.
MIN_PIXELS_EACH = 50  # On average, at each value; small images have few pixels of any value.
SAMPLED = 4  # Every so many pixels are looked at first.
EDGE_STEPS = 2.5  # Larger jumps between neighbouring pixels are edges of objects.
MIN_LEVEL_PX = 24  # Shortest side of the coarsest level of the pyramid.
SWEEPS = 16
STIFFNESS = 1e-3  # Weight of the slope beside the curvature; it settles what nothing else does.


def depth_step_m(depth_m: np.ndarray) -> float:
    """Return the step between the stored values of a depth image in metres, or 0 if it is fine.

    Args:
        depth_m: Depth in metres, float32 [H, W], 0 where it is missing.
    """
    if not _spacing_m(depth_m[::SAMPLED, ::SAMPLED], MIN_PIXELS_EACH / SAMPLED**2):
        return 0.0  # Most depth is fine, and a sample of it shows that.
    return _spacing_m(depth_m, MIN_PIXELS_EACH)


def _spacing_m(depth_m: np.ndarray, pixels_each: float) -> float:
    """Return the regular spacing of the values of depth in metres, or 0 if there is none."""
    seen = depth_m[depth_m > 0]
    values = np.unique(seen)
    if len(values) < MIN_VALUES or len(seen) < pixels_each * len(values):
        return 0.0
    steps_m = np.diff(values)
    step_m = float(np.median(steps_m))
    regular = steps_m.min() >= 0.5 * step_m
    return step_m if regular and STEP_RANGE_M[0] <= step_m <= STEP_RANGE_M[1] else 0.0


def smooth_depth_steps(depth_m: np.ndarray, step_m: float) -> np.ndarray:
    """Return the smoothest depth that rounds to a stepped depth image, float32 [H, W].

    Args:
        depth_m: Depth in metres, float32 [H, W], 0 where it is missing.
        step_m: Step between its values in metres.
    """
    seen = depth_m > 0
    near = np.where(seen, 1 / np.maximum(depth_m - step_m / 2, step_m / 2), 0.0)
    far = np.where(seen, 1 / np.maximum(depth_m + step_m / 2, step_m / 2), 0.0)
    levels = 0
    while min(depth_m.shape) >> (levels + 1) >= MIN_LEVEL_PX:
        levels += 1
    inverse = np.zeros((0, 0))  # Of the coarser level.
    for level in range(levels, -1, -1):
        every = (slice(None, None, 1 << level),) * 2
        stored, low, high = (x[every].astype(np.float64) for x in (depth_m, far, near))
        # A jump between two pixels of a coarse level may be a slope of many fine ones.
        edge_m = EDGE_STEPS * step_m * (1 + 0.5 * level)
        if level == levels:
            inverse = (low + high) / 2
        else:
            inverse = _refined(inverse, stored, low, high, edge_m)
        _relax(inverse, _links(stored, edge_m), low, high, SWEEPS << level)
    with np.errstate(divide="ignore"):
        return np.where(seen, 1 / inverse, 0.0).astype(np.float32)


@njit
def _refined(coarse, stored, low, high, edge_m):
    """Return inverse depth interpolated linearly from every second pixel, within bounds."""
    height, width = stored.shape
    result = (low + high) / 2
    for i in range(height):
        for j in range(width):
            total, count = 0.0, 0
            for y in (i - i % 2, i + i % 2):
                for x in (j - j % 2, j + j % 2):
                    inside = y // 2 < coarse.shape[0] and x // 2 < coarse.shape[1]
                    if not (inside and y < height and x < width):
                        continue
                    if stored[y, x] > 0 and abs(stored[y, x] - stored[i, j]) <= edge_m:
                        total += coarse[y // 2, x // 2]
                        count += 1
            if count:
                result[i, j] = min(max(total / count, low[i, j]), high[i, j])
    return result


@njit
def _links(stored, edge_m):
    """Return, for each pixel, a bit for each neighbour that is on the same surface, uint8 [H, W].

    Bits 0 to 3 stand for the rows -2, -1, 1 and 2 from the pixel, bits 4 to 7 for the columns. Two
    pixels away counts if the pixel between is linked and no edge is after it.
    """
    height, width = stored.shape
    links = np.zeros((height, width), np.uint8)
    for i in range(height):
        for j in range(width):
            if stored[i, j] <= 0:
                continue
            for axis in range(2):
                for side in range(2):
                    way = 2 * side - 1
                    y, x = i + way * (1 - axis), j + way * axis
                    if not (0 <= y < height and 0 <= x < width) or stored[y, x] <= 0:
                        continue
                    if abs(stored[y, x] - stored[i, j]) > edge_m:
                        continue
                    links[i, j] |= 1 << (4 * axis + 1 + side)
                    y2, x2 = y + way * (1 - axis), x + way * axis
                    if not (0 <= y2 < height and 0 <= x2 < width) or stored[y2, x2] <= 0:
                        continue
                    if abs(stored[y2, x2] - stored[y, x]) <= edge_m:
                        links[i, j] |= 1 << (4 * axis + 3 * side)
    return links


@njit
def _relax(inverse, links, low, high, sweeps):
    """Reduce the curvature of inverse depth in place, within bounds, along ``_links``."""
    height, width = inverse.shape
    for sweep in range(sweeps):
        for n in range(height):
            i = n if sweep % 2 == 0 else height - 1 - n
            for m in range(width):
                j = m if sweep % 2 == 0 else width - 1 - m
                linked = links[i, j]
                if linked == 0:
                    continue
                total, weight = 0.0, 0.0
                for axis in range(2):
                    down, right = 1 - axis, axis
                    bits = linked >> (4 * axis)
                    before = inverse[i - down, j - right] if bits & 2 else 0.0
                    after = inverse[i + down, j + right] if bits & 4 else 0.0
                    if bits & 6 == 6:
                        total += 2 * (before + after)
                        weight += 4
                    if bits & 1:
                        total += 2 * before - inverse[i - 2 * down, j - 2 * right]
                        weight += 1
                    if bits & 8:
                        total += 2 * after - inverse[i + 2 * down, j + 2 * right]
                        weight += 1
                    if bits & 2:
                        total += STIFFNESS * before
                        weight += STIFFNESS
                    if bits & 4:
                        total += STIFFNESS * after
                        weight += STIFFNESS
                inverse[i, j] = min(max(total / weight, low[i, j]), high[i, j])
