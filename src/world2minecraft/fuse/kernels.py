"""The inner loops of fusion: points into cells, and rays through free space.

Everything is in cell units of the room: a point at 3.7 lies in cell 3, which stands at index
``3 - low`` of the map's arrays. Only whole numbers are shifted, so that a map that has grown holds
the same bits as one that was large from the start. The plain reading of the kernels is in the
tests, which hold them against it.
"""

import numpy as np

from world2minecraft.jit import njit

UNTOUCHED, FREED = -1, -2


@njit
def to_cells(points_m, scan_to_cells):
    """Carry points float32 [N, 3] by a 3x4 transform; return them with their bounds."""
    count = len(points_m)
    cells = np.empty((count, 3), np.float32)
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for n in range(count):
        for axis in range(3):
            value = scan_to_cells[axis, 3]
            for other in range(3):
                value += scan_to_cells[axis, other] * points_m[n, other]
            cells[n, axis] = value
            low[axis] = min(low[axis], value)
            high[axis] = max(high[axis], value)
    return cells, low, high


@njit
def add_points(
    points, weight, colour, votes, camera, low, parameters, log_odds, all_votes, colour_sum,
    offset_sum, hits, slots,
):  # fmt: skip
    """Add one view's points to the map's arrays, in place.

    Args:
        points: float32 [N, 3] in cells of the room.
        weight: float32 [N], square metres that each point covers.
        colour: uint8 [N, 3], or [0, 3] for none.
        votes: float32 [N, 12], or [0, 12] for none.
        camera: float64 [3] in cells of the room.
        low: int64 [3], the room cell at index (0, 0, 0) of the arrays.
        parameters: hit, free, limit log-odds; nudge in cells; least area in square metres; least
            points; clearance in cells; the cell's size in metres.
        log_odds: float32 [X, Y, Z], the map, as are the next four.
        all_votes: float32 [X, Y, Z, 12].
        colour_sum: float32 [X, Y, Z, 3].
        offset_sum: float32 [X, Y, Z, 3], metres.
        hits: uint32 [X, Y, Z].
        slots: int32 [X, Y, Z], -1 everywhere; left so.
    """
    hit, free, limit, nudge, min_area, min_points, clear, voxel_m = parameters
    cells, count, area, targets = _collect(points, weight, camera, low, nudge, slots)
    taken = np.zeros(len(cells), np.bool_)
    for s in range(len(cells)):
        taken[s] = count[s] >= min_points and area[s] >= min_area
        if taken[s]:
            i, j, k = cells[s]
            log_odds[i, j, k] = min(limit, log_odds[i, j, k] + hit)
            hits[i, j, k] += count[s]
            for axis in range(3):
                mean = targets[s, axis] / count[s] - (cells[s, axis] + low[axis] + 0.5)
                offset_sum[i, j, k, axis] += mean * count[s] * voxel_m
    _add_attributes(points, camera, low, nudge, colour, votes, taken, slots, colour_sum, all_votes)
    freed = np.empty((slots.size, 3), np.int32)
    freed_count = 0
    for s in range(len(cells)):
        if count[s] >= min_points:
            freed_count = _free_ray(
                camera, targets[s] / count[s], low, clear, free, limit, log_odds, slots, freed,
                freed_count,
            )  # fmt: skip
    for s in range(len(cells)):
        slots[cells[s, 0], cells[s, 1], cells[s, 2]] = UNTOUCHED
    for f in range(freed_count):
        slots[freed[f, 0], freed[f, 1], freed[f, 2]] = UNTOUCHED


@njit
def _cell_behind(point, camera, low, nudge):
    """Return the index of the cell of the matter behind a surface point: a nudge along its ray."""
    x, y, z = point[0] - camera[0], point[1] - camera[1], point[2] - camera[2]
    share = nudge / max(np.sqrt(x * x + y * y + z * z), 1e-6)
    return (
        int(np.floor(point[0] + x * share)) - low[0],
        int(np.floor(point[1] + y * share)) - low[1],
        int(np.floor(point[2] + z * share)) - low[2],
    )


@njit
def _collect(points, weight, camera, low, nudge, slots):
    """Sum up the points of each touched cell, and number those cells in ``slots``."""
    cells = np.empty((len(points), 3), np.int32)
    count = np.zeros(len(points), np.int64)
    area = np.zeros(len(points), np.float64)
    targets = np.zeros((len(points), 3), np.float64)
    used = 0
    for n in range(len(points)):
        i, j, k = _cell_behind(points[n], camera, low, nudge)
        slot = slots[i, j, k]
        if slot < 0:
            slot = used
            slots[i, j, k] = slot
            cells[slot] = i, j, k
            used += 1
        count[slot] += 1
        area[slot] += weight[n]
        for axis in range(3):
            targets[slot, axis] += points[n, axis]
    return cells[:used], count[:used], area[:used], targets[:used]


@njit
def _add_attributes(points, camera, low, nudge, colour, votes, taken, slots, colour_sum, all_votes):
    """Add the colours and votes of the points whose cells were taken."""
    if len(colour) == 0 and len(votes) == 0:
        return
    for n in range(len(points)):
        i, j, k = _cell_behind(points[n], camera, low, nudge)
        if not taken[slots[i, j, k]]:
            continue
        if len(colour):
            for channel in range(3):
                colour_sum[i, j, k, channel] += colour[n, channel]
        if len(votes):
            for label in range(votes.shape[1]):
                all_votes[i, j, k, label] += votes[n, label]


@njit
def _free_ray(camera, target, low, clear, free, limit, log_odds, slots, freed, freed_count):
    """Walk from the camera to a surface point; each cell crossed is freed once a view.

    A cell counts as crossed where the middle of the ray's way through it lies nearer than
    ``clear`` before the point. Cells that the view saw a surface in are left alone.
    """
    way = target - camera
    length = np.sqrt((way * way).sum())
    end = length - clear
    if end <= 0:
        return freed_count
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
        i, j, k = cell[0] - low[0], cell[1] - low[1], cell[2] - low[2]
        if (entry + leave) / 2 < end and slots[i, j, k] == UNTOUCHED:
            log_odds[i, j, k] = max(-limit, log_odds[i, j, k] + free)
            slots[i, j, k] = FREED
            freed[freed_count] = i, j, k
            freed_count += 1
        cell[axis] += step[axis]
        at[axis] += gap[axis]
        entry = leave
    return freed_count
