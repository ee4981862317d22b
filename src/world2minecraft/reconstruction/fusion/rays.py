"""The free space of a view: every cell that its rays cross before they meet a surface."""

import numpy as np

from world2minecraft.core.jit import njit
from world2minecraft.reconstruction.fusion.kernels import place_of


@njit
def free_rays(camera, target, count, sure, rules, low, table, used, log_odds, mark, base):
    """Lower the log-odds of each cell crossed, once a view.

    One ray goes to the mean point of each cell with enough points that are trusted by half.

    Args:
        camera: float64 [3] in cells of the room.
        target: float64 [M, 3], sums of points.
        count: int64 [M], how many points.
        sure: float64 [M], their mean trust.
        rules: float64; see ``EvidenceMap``.
        low: int64 [3], the first block of the table.
        table: int32 [X, Y, Z], the numbers of the blocks.
        used: int64 [2], blocks and records in use.
        log_odds: float32 [C].
        mark: int64 [C]; see kernels.py.
        base: the view's number in ``mark``.
    """
    for s in range(len(target)):
        if count[s] >= rules[4] and sure[s] >= 0.5:
            _free_ray(
                camera, target[s] / count[s], rules, low, table, used, log_odds, mark, base
            )  # fmt: skip


@njit
def _free_ray(camera, target, rules, low, table, used, log_odds, mark, base):
    """Walk from the camera to a surface point.

    A cell counts as crossed where the middle of the ray's way through it lies nearer than the
    clearance before the point. Cells that the view saw a surface in are left alone.
    """
    free, limit = rules[1], rules[2]
    way = target - camera
    length = np.sqrt((way * way).sum())
    end = length - rules[10] - rules[11] * length
    if end <= 0:
        return
    way /= length
    cell, step = np.empty(3, np.int64), np.empty(3, np.int64)
    at, gap = np.empty(3), np.empty(3)
    for axis in range(3):
        cell[axis] = int(np.floor(camera[axis]))
        step[axis] = 1 if way[axis] > 0 else -1
        gap[axis] = np.inf if way[axis] == 0 else abs(1.0 / way[axis])
        edge = cell[axis] + (1 if way[axis] > 0 else 0)
        at[axis] = np.inf if way[axis] == 0 else (edge - camera[axis]) / way[axis]
    entry = 0.0
    while entry < end:
        axis = 0 if at[0] <= at[1] and at[0] <= at[2] else (1 if at[1] <= at[2] else 2)
        leave = at[axis]
        if (entry + leave) / 2 < end:
            place = place_of(cell[0], cell[1], cell[2], low, table, used)
            if mark[place] < base:
                log_odds[place] = max(-limit, log_odds[place] + free)
                mark[place] = base
        cell[axis] += step[axis]
        at[axis] += gap[axis]
        entry = leave
