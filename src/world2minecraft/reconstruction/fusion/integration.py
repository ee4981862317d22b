"""Kernels that integrate one view: surface points into cells, and rays into free space.

Coordinates are in cells of the room: a point at 3.7 is in cell 3, wherever the map begins, so a map
that has grown has the same bits as one that was large from the start. The ``mark`` of a cell is
``base`` if a ray of the view crossed it, ``base + 1 + n`` if it is the n-th cell with surface in
the view, and less otherwise. The tests contain a plain reference implementation of the kernels.
"""

from typing import NamedTuple

import numpy as np

from world2minecraft.core.jit import njit
from world2minecraft.reconstruction.fusion.voxel_blocks import (
    BLOCK_CELLS,
    FACE_SUMS,
    FACES,
    MASK,
    SHIFT,
    BlockTable,
    CellArrays,
    RecordArrays,
)


class ViewRules(NamedTuple):
    """The rules of integrating a view; see ``FusionParameters``."""

    hit_log_odds: float
    free_log_odds: float
    limit_log_odds: float
    min_area_m2: float  # Minimum area of a cell that a view must see,
    min_points: int  # and minimum number of points in it.
    face_m2: float
    sigma_m: float
    sigma_growth: float
    pose_m: float
    pose_growth: float
    clear_cells: float  # Rays stop at this distance before their point, in cells,
    clear_growth: float  # plus this distance per cell of length.


class CellSums(NamedTuple):
    """The sums over the points of one view in each of the M cells in which it saw surface."""

    hits: np.ndarray  # int64 [M], points
    area: np.ndarray  # float64 [M], square metres
    target: np.ndarray  # float64 [M, 3], of points
    # For each side that points face: their count, sums of their offsets from the cell's centre in
    # metres, of normals and of distances in metres.
    faces: np.ndarray  # float64 [M, 6, 8]
    trust: np.ndarray  # float64 [M], the mean trust of the points, 1 where none is given


@njit
def to_cells(points_m, scan_to_cells):
    """Transform points float32 [N, 3] by a 3x4 matrix and return them with their bounds."""
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
def place_of(i, j, k, blocks: BlockTable):
    """Return the index of cell (i, j, k) in the flat arrays, allocating its block if required."""
    low = blocks.low
    a, b, c = (i >> SHIFT) - low[0], (j >> SHIFT) - low[1], (k >> SHIFT) - low[2]
    block = blocks.numbers[a, b, c]
    if block == 0:
        blocks.used[0] += 1
        block = blocks.used[0]
        blocks.numbers[a, b, c] = block
    inner = ((i & MASK) << SHIFT | (j & MASK)) << SHIFT | (k & MASK)
    return block * BLOCK_CELLS + inner


@njit
def places_of(cells, blocks: BlockTable):
    """Return the indices, int64 [N], of cells int64 [N, 3] in the flat arrays."""
    places = np.empty(len(cells), np.int64)
    for n in range(len(cells)):
        places[n] = place_of(cells[n, 0], cells[n, 1], cells[n, 2], blocks)
    return places


@njit
def face_normals(points, normals, camera, turn):
    """Return unit normals in the room, float32 [N, 3]; missing normals point to the camera."""
    result = np.empty((len(points), 3), np.float32)
    given = len(normals) > 0
    for n in range(len(points)):
        if given and (normals[n, 0] != 0 or normals[n, 1] != 0 or normals[n, 2] != 0):
            for axis in range(3):
                value = 0.0
                for other in range(3):
                    value += turn[axis, other] * normals[n, other]
                result[n, axis] = value
            continue
        length = 1e-6
        for axis in range(3):
            length += (points[n, axis] - camera[axis]) ** 2
        for axis in range(3):
            result[n, axis] = (camera[axis] - points[n, axis]) / np.sqrt(length)
    return result


@njit
def number_cells(points, normals, nudge, blocks: BlockTable, mark, base):
    """Number the cells in which a view saw surface.

    Args:
        points: Points in cells of the room, float32 [N, 3].
        normals: Normals towards the camera, float32 [N, 3].
        nudge: Distance in cells by which points are moved behind the surface into the matter.
        blocks: Table of the cell blocks.
        mark: State of each cell, int64 [C]; see the module docstring.
        base: Base number of the view in ``mark``.

    Returns:
        ``owner``, the cell number of each point, int32 [N]; ``cells``, int64 [M, 3]; and
        ``places``, the indices of the cells in the flat arrays, int64 [M].
    """
    owner = np.empty(len(points), np.int32)
    cells = np.empty((len(points), 3), np.int64)
    places = np.empty(len(points), np.int64)
    count, last = 0, -1
    for n in range(len(points)):
        i = int(np.floor(points[n, 0] - normals[n, 0] * nudge))
        j = int(np.floor(points[n, 1] - normals[n, 1] * nudge))
        k = int(np.floor(points[n, 2] - normals[n, 2] * nudge))
        # Neighbouring pixels mostly lie in one cell.
        if last < 0 or cells[last, 0] != i or cells[last, 1] != j or cells[last, 2] != k:
            place = place_of(i, j, k, blocks)
            if mark[place] <= base:
                mark[place] = base + 1 + count
                cells[count] = i, j, k
                places[count] = place
                count += 1
            last = mark[place] - base - 1
        owner[n] = last
    return owner, cells[:count], places[:count]


@njit
def sum_cells(points, normals, weight, trust, camera, owner, cells, voxel_m):
    """Compute the ``CellSums`` of a view.

    Args:
        points: Points in cells of the room, float32 [N, 3].
        normals: Normals towards the camera, float32 [N, 3].
        weight: Area that each point represents, float32 [N].
        trust: Confidence of each point, float32 [N], or an empty array.
        camera: Camera position in cells of the room, float64 [3].
        owner: Cell number of each point from ``number_cells``, int32 [N].
        cells: Cells from ``number_cells``, int64 [M, 3].
        voxel_m: Cell size in metres.
    """
    count = np.zeros(len(cells), np.int64)
    sure = np.zeros(len(cells), np.float64)
    area = np.zeros(len(cells), np.float64)
    target = np.zeros((len(cells), 3), np.float64)
    faces = np.zeros((len(cells), FACES, FACE_SUMS), np.float64)
    for n in range(len(points)):
        s = owner[n]
        count[s] += 1
        sure[s] += trust[n] if len(trust) else 1.0
        area[s] += weight[n]
        side = 0
        for axis in range(1, 3):
            if abs(normals[n, axis]) > abs(normals[n, side]):
                side = axis
        f = 2 * side + (1 if normals[n, side] > 0 else 0)
        faces[s, f, 0] += 1
        square = 0.0
        for axis in range(3):
            target[s, axis] += points[n, axis]
            faces[s, f, 1 + axis] += (points[n, axis] - cells[s, axis] - 0.5) * voxel_m
            faces[s, f, 4 + axis] += normals[n, axis]
            away = points[n, axis] - camera[axis]
            square += away * away
        faces[s, f, 7] += np.sqrt(square) * voxel_m
    for s in range(len(cells)):
        sure[s] /= max(count[s], 1)
    return CellSums(count, area, target, faces, sure)


@njit
def add_hits(
    places, sums: CellSums, rules: ViewRules, used, cells: CellArrays, records: RecordArrays
):
    """Increase the log-odds of sufficiently seen cells and return their mask, bool [M].

    Each face of such a cell adds one measurement of its plane, weighted by the inverse of its
    variance, which combines the pose error at this distance and the error of the mean of the
    points. Both the log-odds and the planes are weighted by the confidence of the points.

    Args:
        places: Indices of the cells in the flat arrays, int64 [M].
        sums: Sums of the view in these cells.
        rules: Thresholds and noise model.
        used: Numbers of used blocks and records, int64 [2]; updated in place.
        cells: Cell arrays, modified in place.
        records: Record arrays, modified in place.
    """
    count, area, faces, trust = sums.hits, sums.area, sums.faces, sums.trust
    log_odds, record = cells.log_odds, cells.record
    taken = np.zeros(len(places), np.bool_)
    for s in range(len(places)):
        if count[s] < rules.min_points or area[s] < rules.min_area_m2:
            continue
        taken[s] = True
        place = places[s]
        log_odds[place] = min(rules.limit_log_odds, log_odds[place] + rules.hit_log_odds * trust[s])
        if record[place] == 0:
            used[1] += 1
            record[place] = used[1]
        row = record[place]
        records.hits[row] += count[s]
        for f in range(FACES):
            points = faces[s, f, 0]
            if points == 0:
                continue
            for axis in range(3):
                records.offset_sum[row, axis] += faces[s, f, 1 + axis]
            z = faces[s, f, 7] / points
            sigma = rules.sigma_m + rules.sigma_growth * (z - 0.4) ** 2
            pose = rules.pose_m + rules.pose_growth * z
            share = min(area[s] * points / count[s] / rules.face_m2, 1.0)
            w = trust[s] * share / (pose * pose + sigma * sigma / points)
            records.faces[row, f, 0] += w
            for m in range(1, 7):
                records.faces[row, f, m] += w * faces[s, f, m] / points
            records.faces[row, f, 7] += w * sigma
    return taken


@njit
def add_colours(colour, rows, colour_sum):
    """Add the colours uint8 [N, 3] of points to their records, int32 [N]; record 0 is ignored."""
    for n in range(len(colour)):
        if rows[n] > 0:
            for channel in range(3):
                colour_sum[rows[n], channel] += colour[n, channel]


@njit
def add_labels(labels, rows, votes):
    """Add one vote per point for its label, uint8 [N]; 0 and invalid classes are ignored."""
    for n in range(len(labels)):
        if rows[n] > 0 and 0 < labels[n] < votes.shape[1]:
            votes[rows[n], labels[n]] += 1


@njit
def add_votes(shares, of_point, rows, votes):
    """Add the votes of points to their records; record 0 is ignored.

    Args:
        shares: Votes, float32 [P, 12].
        of_point: Row of ``shares`` of each point, int32 [N].
        rows: Record of each point, int32 [N].
        votes: Sums of the records, float32 [R, 12], modified in place.
    """
    for n in range(len(rows)):
        if rows[n] > 0:
            for label in range(shares.shape[1]):
                votes[rows[n], label] += shares[of_point[n], label]


@njit
def carve_free_space(
    camera, sums: CellSums, rules: ViewRules, blocks: BlockTable, cells: CellArrays, base
):
    """Lower the log-odds of each cell that rays cross in front of a surface, once per view.

    One ray is cast to the mean point of each cell with enough points and a confidence of at least
    one half.

    Args:
        camera: Camera position in cells of the room, float64 [3].
        sums: Sums of the view in its cells.
        rules: Log-odds of a ray, and its stopping distance.
        blocks: Table of the cell blocks.
        cells: Cell arrays, modified in place.
        base: Base number of the view in ``mark``.
    """
    for s in range(len(sums.hits)):
        if sums.hits[s] >= rules.min_points and sums.trust[s] >= 0.5:
            _carve_ray(camera, sums.target[s] / sums.hits[s], rules, blocks, cells, base)


@njit
def _carve_ray(camera, target, rules: ViewRules, blocks: BlockTable, cells: CellArrays, base):
    """Lower the log-odds along the ray from the camera to a surface point.

    A cell counts as crossed if the middle of the ray's segment inside it is closer to the camera
    than the clearance in front of the point. Cells with surface in this view are not changed.
    """
    way = target - camera
    length = np.sqrt((way * way).sum())
    end = length - rules.clear_cells - rules.clear_growth * length
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
            place = place_of(cell[0], cell[1], cell[2], blocks)
            if cells.mark[place] < base:
                cells.log_odds[place] = max(
                    -rules.limit_log_odds, cells.log_odds[place] + rules.free_log_odds
                )
                cells.mark[place] = base
        cell[axis] += step[axis]
        at[axis] += gap[axis]
        entry = leave
