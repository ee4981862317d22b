"""Small islands of depth: bits that hang on nothing around them are chance, not things."""

import numpy as np

from world2minecraft.core.jit import njit


@njit
def without_islands(depth, least_px, step):
    """Return the depth map without islands of under ``least_px`` pixels, 0 in their place.

    Args:
        depth: float32 [h, w] z-depth, 0 where there is none.
        least_px: pixels of the smallest island that stays.
        step: neighbours hang together where their depths differ by less than this share.
    """
    high, wide = depth.shape
    result = depth.copy()
    visited = np.zeros(high * wide, np.bool_)
    island = np.empty(high * wide, np.int64)
    for start in range(high * wide):
        if visited[start] or depth[start // wide, start % wide] <= 0:
            continue
        visited[start] = True
        island[0] = start
        done, count = 0, 1
        while done < count:
            y, x = island[done] // wide, island[done] % wide
            done += 1
            for way in range(4):
                v, u = y + (way == 0) - (way == 1), x + (way == 2) - (way == 3)
                if v < 0 or u < 0 or v >= high or u >= wide or visited[v * wide + u]:
                    continue
                if depth[v, u] > 0 and abs(depth[v, u] - depth[y, x]) < step * depth[y, x]:
                    visited[v * wide + u] = True
                    island[count] = v * wide + u
                    count += 1
        if count < least_px:
            for k in range(count):
                result[island[k] // wide, island[k] % wide] = 0
    return result
