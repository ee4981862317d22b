"""Semi-global matching: depths that fit their pixels and change little from one to the next.

Along each of eight directions a path carries, for each plane, the least cost of everything behind
it; the plane with the least sum of all eight wins. Hirschmueller's method, with whole costs.
"""

import numpy as np

from world2minecraft.core.jit import njit


@njit
def sum_paths(costs, small_step, large_step):
    """Return float32 [h, w, D]: the sum of eight paths' costs; see the module.

    Args:
        costs: uint8 [h, w, D].
        small_step: what a change by one plane between two pixels costs.
        large_step: what a larger change costs.
    """
    high, wide, planes = costs.shape
    total = np.zeros((high, wide, planes), np.float32)
    # [direction, row before or here, pixel with a margin, plane with a margin]
    paths = np.empty((3, 2, wide + 2, planes + 2), np.float32)
    least = np.empty((3, 2, wide + 2), np.float32)
    along = np.empty((2, planes + 2), np.float32)
    for way in range(2):
        paths[:] = 0
        least[:] = 0
        for row in range(high):
            y = row if way == 0 else high - 1 - row
            now, before = row % 2, 1 - row % 2
            _start(paths, least, now)
            along[:] = 0
            along[:, 0] = along[:, planes + 1] = np.inf
            along_least = np.float32(0)
            for column in range(wide):
                x = column if way == 0 else wide - 1 - column
                here = column % 2
                along_least = _step(
                    costs[y, x], along[1 - here], along_least, along[here], total[y, x],
                    small_step, large_step,
                )  # fmt: skip
                for k in range(3):
                    least[k, now, x + 1] = _step(
                        costs[y, x], paths[k, before, x + k], least[k, before, x + k],
                        paths[k, now, x + 1], total[y, x], small_step, large_step,
                    )  # fmt: skip
    return total


@njit
def _start(paths, least, now):
    """Paths that come in from the sides begin with nothing."""
    wide, planes = paths.shape[2] - 2, paths.shape[3] - 2
    for k in range(3):
        for side in (0, wide + 1):
            least[k, now, side] = 0
            paths[k, now, side, :] = 0
        for x in range(wide + 2):
            for row in range(2):
                paths[k, row, x, 0] = paths[k, row, x, planes + 1] = np.inf


@njit
def _step(costs, before, before_least, here, total, small_step, large_step):
    """Carry a path on by one pixel and add it to the sum; return its least cost."""
    small, jump = np.float32(small_step), before_least + np.float32(large_step)
    smallest = np.float32(np.inf)
    for d in range(len(costs)):
        way = min(before[d + 1], min(before[d], before[d + 2]) + small)
        value = np.float32(costs[d]) + (min(way, jump) - before_least)
        here[d + 1] = value
        total[d] += value
        smallest = min(smallest, value)
    return smallest


@njit
def best_planes(total):
    """Return float32 [h, w]: the plane of the least sum, between planes by a parabola."""
    high, wide, planes = total.shape
    found = np.empty((high, wide), np.float32)
    for y in range(high):
        for x in range(wide):
            best = 0
            for d in range(1, planes):
                if total[y, x, d] < total[y, x, best]:
                    best = d
            found[y, x] = best
            if 0 < best < planes - 1:
                low, mid, up = total[y, x, best - 1], total[y, x, best], total[y, x, best + 1]
                bend = low + up - 2 * mid
                if bend > 0:
                    found[y, x] = best + (low - up) / (2 * bend)
    return found
