"""Consistency checks between depth maps, and the speckle filter."""

import numpy as np

from world2minecraft.core.jit import njit


@njit
def check_consistency(depth, rays, others, to_others, cameras, tolerance):
    """Count for each pixel the other depth maps that agree with its depth.

    Args:
        depth: z-depth, float32 [h, w]; 0 if missing.
        rays: x/z and y/z of the pixels, float32 [h, w, 2].
        others: Depth maps of the other cameras, float32 [N, h, w].
        to_others: Transforms from this camera's frame to those of the others, float64 [N, 4, 4].
        cameras: fx, fy, cx, cy of the other cameras, float64 [N, 4].
        tolerance: Maximum relative difference of depths that agree.

    Returns:
        The number of agreeing depth maps as uint8 [h, w], and the mean of the pixel's own depth and
        the agreeing depths along its ray as float32 [h, w].
    """
    height, width = depth.shape
    votes, mean = np.zeros((height, width), np.uint8), np.zeros((height, width), np.float32)
    for y in range(height):
        for x in range(width):
            z = np.float64(depth[y, x])
            if z <= 0:
                continue
            px, py = rays[y, x, 0] * z, rays[y, x, 1] * z
            total, count = z, 1
            for n in range(len(others)):
                pose = to_others[n]
                qz = pose[2, 0] * px + pose[2, 1] * py + pose[2, 2] * z + pose[2, 3]
                if qz <= 0.05 * z:
                    continue
                qx = pose[0, 0] * px + pose[0, 1] * py + pose[0, 2] * z + pose[0, 3]
                qy = pose[1, 0] * px + pose[1, 1] * py + pose[1, 2] * z + pose[1, 3]
                u = np.floor(qx / qz * cameras[n, 0] + cameras[n, 2])
                v = np.floor(qy / qz * cameras[n, 1] + cameras[n, 3])
                if not (0 <= u < others[n].shape[1] and 0 <= v < others[n].shape[0]):
                    continue
                theirs = np.float64(others[n, int(v), int(u)])
                if theirs > 0 and abs(theirs - qz) <= tolerance * qz:
                    votes[y, x] += 1
                    total += z * theirs / qz
                    count += 1
            mean[y, x] = total / count
    return votes, mean


@njit
def filter_speckles(depth, min_size_px, step):
    """Return the depth map with connected regions of under ``min_size_px`` pixels set to 0.

    Args:
        depth: z-depth, float32 [h, w]; 0 if missing.
        min_size_px: Size of the smallest region that is kept.
        step: Maximum relative difference of neighbouring depths in a region.
    """
    height, width = depth.shape
    result = depth.copy()
    visited = np.zeros(height * width, np.bool_)
    island = np.empty(height * width, np.int64)
    for start in range(height * width):
        if visited[start] or depth[start // width, start % width] <= 0:
            continue
        visited[start] = True
        island[0] = start
        done, count = 0, 1
        while done < count:
            y, x = island[done] // width, island[done] % width
            done += 1
            for way in range(4):
                v, u = y + (way == 0) - (way == 1), x + (way == 2) - (way == 3)
                if v < 0 or u < 0 or v >= height or u >= width or visited[v * width + u]:
                    continue
                if depth[v, u] > 0 and abs(depth[v, u] - depth[y, x]) < step * depth[y, x]:
                    visited[v * width + u] = True
                    island[count] = v * width + u
                    count += 1
        if count < min_size_px:
            for k in range(count):
                result[island[k] // width, island[k] % width] = 0
    return result
