"""Kernels that integrate one view: surface points into cells, and rays into free space.

Coordinates are in cells of the room: a point at 3.7 is in cell 3, wherever the map begins, so a map
that has grown has the same bits as one that was large from the start. The ``mark`` of a cell is
``base`` if a ray of the view crossed it, ``base + 1 + n`` if it is the n-th cell with surface in
the view, and less otherwise. The tests contain a plain reference implementation of the kernels.
"""

from typing import NamedTuple

import numpy as np

from world2minecraft.core.jit import inlined, lean, njit
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

FIRST_CELLS = 1024  # Memory for the cells of a view grows from here.
_ZERO = (0.0, 0.0, 0.0)
_NO_NORMAL = (np.float32(0), np.float32(0), np.float32(0))


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
    colour: np.ndarray  # int64 [M, 3], of the points; 0 where none is given


class ViewPoints(NamedTuple):
    """The points of one view; arrays that a view does not have are empty."""

    cells: np.ndarray  # float32 [N, 3], in cells of the room
    normals: np.ndarray  # float32 [N, 3], in the scan; (0, 0, 0) where unknown
    weight: np.ndarray  # float32 [N], the area that each point represents, in square metres
    trust: np.ndarray  # float32 [N], the confidence of each point
    colour: np.ndarray  # uint8 [N, 3]


class ViewPlace(NamedTuple):
    """Where a view stands in the room, and how its points are assigned to cells."""

    camera: np.ndarray  # float64 [3], the camera's position in cells of the room
    turn: np.ndarray  # float64 [3, 3], the rotation from the scan to the room
    nudge: float  # Distance in cells by which points are moved behind the surface into the matter.
    voxel_m: float


@njit
def to_cells(points_m, scan_to_cells):
    """Transform points float32 [N, 3] by a 3x4 matrix and return them with their bounds."""
    m = scan_to_cells
    cells = np.empty((len(points_m), 3), np.float32)
    low_x, low_y, low_z = np.inf, np.inf, np.inf
    high_x, high_y, high_z = -np.inf, -np.inf, -np.inf
    for n in range(len(points_m)):
        a, b, c = points_m[n, 0], points_m[n, 1], points_m[n, 2]
        x = m[0, 3] + m[0, 0] * a + m[0, 1] * b + m[0, 2] * c
        y = m[1, 3] + m[1, 0] * a + m[1, 1] * b + m[1, 2] * c
        z = m[2, 3] + m[2, 0] * a + m[2, 1] * b + m[2, 2] * c
        cells[n, 0], cells[n, 1], cells[n, 2] = x, y, z
        low_x, low_y, low_z = min(low_x, x), min(low_y, y), min(low_z, z)
        high_x, high_y, high_z = max(high_x, x), max(high_y, y), max(high_z, z)
    return cells, np.array([low_x, low_y, low_z]), np.array([high_x, high_y, high_z])


@lean
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


@inlined
def _is_new_normal(n, normals):
    """Return whether the normal of a point differs from that of the point before."""
    if len(normals) == 0:
        return True
    a, b, c = normals[n, 0], normals[n, 1], normals[n, 2]
    is_missing = a == 0 and b == 0 and c == 0
    is_same = a == normals[n - 1, 0] and b == normals[n - 1, 1] and c == normals[n - 1, 2]
    return is_missing or not is_same


@inlined
def _room_normal(n, x, y, z, normals, place: ViewPlace):
    """Return the unit normal of a point in the room; a missing one points to the camera."""
    if len(normals) > 0:
        a, b, c = normals[n, 0], normals[n, 1], normals[n, 2]
        if a != 0 or b != 0 or c != 0:
            t = place.turn
            return (
                np.float32(t[0, 0] * a + t[0, 1] * b + t[0, 2] * c),
                np.float32(t[1, 0] * a + t[1, 1] * b + t[1, 2] * c),
                np.float32(t[2, 0] * a + t[2, 1] * b + t[2, 2] * c),
            )
    a, b, c = place.camera[0] - x, place.camera[1] - y, place.camera[2] - z
    length = np.sqrt(1e-6 + a * a + b * b + c * c)
    return np.float32(a / length), np.float32(b / length), np.float32(c / length)


@inlined
def _plus(total, count, vector):
    """Return the sum of a vector and ``count`` times another."""
    return (
        total[0] + count * vector[0],
        total[1] + count * vector[1],
        total[2] + count * vector[2],
    )


@inlined
def _facing_side(x, y, z):
    """Return the side, 0 to 5, that a normal mostly faces."""
    most, value = (1, y) if abs(y) > abs(x) else (0, x)
    if abs(z) > abs(value):
        most, value = 2, z
    return 2 * most + (1 if value > 0 else 0)


@njit
def _no_sums(count):
    """Return sums of so many cells, all of them 0."""
    return CellSums(
        np.zeros(count, np.int64),
        np.zeros(count, np.float64),
        np.zeros((count, 3), np.float64),
        np.zeros((count, FACES, FACE_SUMS), np.float64),
        np.zeros(count, np.float64),
        np.zeros((count, 3), np.int64),
    )


@njit
def _more_sums(sums: CellSums):
    """Return the sums with room for twice as many cells."""
    count = len(sums.hits)
    more = _no_sums(2 * count)
    more.hits[:count], more.area[:count], more.target[:count] = sums.hits, sums.area, sums.target
    more.faces[:count], more.trust[:count] = sums.faces, sums.trust
    more.colour[:count] = sums.colour
    return more


@njit
def _first_sums(sums: CellSums, count):
    """Return the sums of the first cells."""
    return CellSums(
        sums.hits[:count],
        sums.area[:count],
        sums.target[:count],
        sums.faces[:count],
        sums.trust[:count],
        sums.colour[:count],
    )


@inlined
def _add_run(run, points: ViewPoints, normal_sum, at, place: ViewPlace, sums: CellSums):
    """Add a run of points of one cell that face one side: first, end, cell number and side."""
    first, end, s, f = run
    target, colour, faces = sums.target, sums.colour, sums.faces
    x, y, z, away, area, trust = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    off_x, off_y, off_z = faces[s, f, 1], faces[s, f, 2], faces[s, f, 3]
    for n in range(first, end):
        a, b, c = points.cells[n, 0], points.cells[n, 1], points.cells[n, 2]
        x, y, z = x + a, y + b, z + c
        off_x += (a - at[0] - 0.5) * place.voxel_m
        off_y += (b - at[1] - 0.5) * place.voxel_m
        off_z += (c - at[2] - 0.5) * place.voxel_m
        i, j, k = a - place.camera[0], b - place.camera[1], c - place.camera[2]
        away += np.sqrt(i * i + j * j + k * k)
        area += points.weight[n]
    if len(points.trust) > 0:
        for n in range(first, end):
            trust += points.trust[n]
    if len(points.colour) > 0:
        red, green, blue = 0, 0, 0
        for n in range(first, end):
            red += np.int64(points.colour[n, 0])
            green += np.int64(points.colour[n, 1])
            blue += np.int64(points.colour[n, 2])
        colour[s, 0], colour[s, 1] = colour[s, 0] + red, colour[s, 1] + green
        colour[s, 2] += blue
    sums.hits[s] += end - first
    sums.area[s] += area
    sums.trust[s] += trust
    target[s, 0], target[s, 1] = target[s, 0] + x, target[s, 1] + y
    target[s, 2] += z
    faces[s, f, 0] += end - first
    faces[s, f, 1], faces[s, f, 2], faces[s, f, 3] = off_x, off_y, off_z
    faces[s, f, 4] += normal_sum[0]
    faces[s, f, 5] += normal_sum[1]
    faces[s, f, 6] += normal_sum[2]
    faces[s, f, 7] += away * place.voxel_m


@njit
def sum_cells(points: ViewPoints, place: ViewPlace, blocks: BlockTable, mark, base):
    """Number the cells in which a view saw surface and sum its points in each of them.

    Args:
        points: Points of the view.
        place: Place of the view.
        blocks: Table of the cell blocks.
        mark: State of each cell, int64 [C]; see the module docstring.
        base: Base number of the view in ``mark``.

    Returns:
        ``owner``, the cell number of each point, int32 [N]; ``places``, the indices of the cells
        in the flat arrays, int64 [M]; and the ``CellSums``.
    """
    owner = np.empty(len(points.cells), np.int32)
    places, sums = np.empty(FIRST_CELLS, np.int64), _no_sums(FIRST_CELLS)
    done, count = 0, 0
    while True:
        done, count = _sum_points(
            points, place, blocks, mark, base, owner, places, sums, done, count
        )
        if done == len(owner):
            break
        places, sums = np.concatenate((places, places)), _more_sums(sums)
    for s in range(count):
        sums.trust[s] = sums.trust[s] / sums.hits[s] if len(points.trust) > 0 else 1.0
    return owner, places[:count], _first_sums(sums, count)


@lean
def _sum_points(points, place, blocks, mark, base, owner, places, sums, done, count):
    """Sum the points from ``done`` on, as long as there is memory for their cells.

    Neighbouring points mostly lie in one cell and face one side, and many share a normal. Such a
    run is added at once. Returns the number of points done and the number of cells.
    """
    s, f, at, normal_sum = -1, -1, _ZERO, _ZERO
    normal, behind, side, turned, begun = _NO_NORMAL, _ZERO, 0, done, done
    first = done
    while done < len(owner):
        x, y, z = points.cells[done, 0], points.cells[done, 1], points.cells[done, 2]
        if done == first or _is_new_normal(done, points.normals):
            normal_sum, turned = _plus(normal_sum, done - turned, normal), done
            normal = _room_normal(done, x, y, z, points.normals, place)
            behind = normal[0] * place.nudge, normal[1] * place.nudge, normal[2] * place.nudge
            side = _facing_side(normal[0], normal[1], normal[2])
        here = np.floor(x - behind[0]), np.floor(y - behind[1]), np.floor(z - behind[2])
        moved = s < 0 or here[0] != at[0] or here[1] != at[1] or here[2] != at[2]
        if moved or side != f:
            if s >= 0:
                normal_sum = _plus(normal_sum, done - turned, normal)
                _add_run((begun, done, s, f), points, normal_sum, at, place, sums)
            normal_sum, f, begun, turned = _ZERO, side, done, done
            if moved:
                index = place_of(int(here[0]), int(here[1]), int(here[2]), blocks)
                if mark[index] <= base:
                    if count == len(places):
                        return done, count
                    mark[index] = base + 1 + count
                    places[count] = index
                    count += 1
                s, at = mark[index] - base - 1, here
        owner[done] = s
        done += 1
    if s >= 0:
        normal_sum = _plus(normal_sum, done - turned, normal)
        _add_run((begun, done, s, f), points, normal_sum, at, place, sums)
    return done, count


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
        for channel in range(3):
            records.colour_sum[row, channel] += sums.colour[s, channel]
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


@lean
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
            _carve_ray(camera, _mean_point(sums, s), rules, blocks, cells, base)


@inlined
def _mean_point(sums: CellSums, s):
    """Return the mean point of a cell as a tuple."""
    hits, target = sums.hits[s], sums.target
    return target[s, 0] / hits, target[s, 1] / hits, target[s, 2] / hits


@lean
def _carve_ray(camera, target, rules: ViewRules, blocks: BlockTable, cells: CellArrays, base):
    """Lower the log-odds along the ray from the camera to a surface point.

    A cell counts as crossed if the middle of the ray's segment inside it is closer to the camera
    than the clearance in front of the point. Cells with surface in this view are not changed.
    """
    x, y, z = target[0] - camera[0], target[1] - camera[1], target[2] - camera[2]
    length = np.sqrt(x * x + y * y + z * z)
    end = length - rules.clear_cells - rules.clear_growth * length
    if end <= 0:
        return
    i, step_i, at_i, gap_i = _first_edge(camera[0], x / length)
    j, step_j, at_j, gap_j = _first_edge(camera[1], y / length)
    k, step_k, at_k, gap_k = _first_edge(camera[2], z / length)
    entry = 0.0
    while entry < end:
        is_i, is_j = at_i <= at_j and at_i <= at_k, at_j <= at_k
        leave = at_i if is_i else (at_j if is_j else at_k)
        if (entry + leave) / 2 < end:
            place = place_of(i, j, k, blocks)
            if cells.mark[place] < base:
                cells.log_odds[place] = max(
                    -rules.limit_log_odds, cells.log_odds[place] + rules.free_log_odds
                )
                cells.mark[place] = base
        if is_i:
            i, at_i = i + step_i, at_i + gap_i
        elif is_j:
            j, at_j = j + step_j, at_j + gap_j
        else:
            k, at_k = k + step_k, at_k + gap_k
        entry = leave


@inlined
def _first_edge(start, way):
    """Return the cell of a coordinate, the step of a ray along it, and its edges on the ray.

    The last two are the distance to the first edge and that between edges, infinite where the ray
    does not move along this axis.
    """
    cell = int(np.floor(start))
    if way == 0:
        return cell, -1, np.inf, np.inf
    edge = cell + (1 if way > 0 else 0)
    return cell, 1 if way > 0 else -1, (edge - start) / way, abs(1.0 / way)
