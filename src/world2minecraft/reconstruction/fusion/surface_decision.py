"""Decide which cells are solid, by the rule that is also used for ground truth.

Noise spreads the points of a surface over two or three cells along its normal. The planes of a cell
and its neighbours along the axis they face are merged if they may be one surface. The number of the
cell's 64 sub-cells behind the merged plane decides: with at least 4, the cell is solid. With fewer,
its points belong to the cell behind, and it is free. If all sub-cells are behind the plane and the
plane is in the cell in front, the points belong to that cell, and the state is unknown.
"""

import math
from typing import NamedTuple

import numpy as np

from world2minecraft.core.jit import njit
from world2minecraft.reconstruction.fusion.voxel_blocks import FACES

PER_SIDE = 4  # Sub-cells along a cell's edge, as in SSCNet's rule.
# More than the noise alone explains is let go as spill, because views err together; and never more
# than a fifth: then there is a second surface. docs/results/fusion.md has the figures.
SPILL_MORE, SPILL_MOST = 0.05, 0.2
SOLID, SPILL_BEFORE, SPILL_BEHIND = 1, 2, 3


class SurfaceRules(NamedTuple):
    """The rules that decide whether a cell is solid; see ``FusionParameters``."""

    min_sub_cells: int  # Sub-cells behind its surface that make a cell solid.
    merge_m: float  # Planes within this distance
    merge_sigmas: float  # plus this number of sigmas are one surface.
    sure_m: float  # Distance in metres that corresponds to a log-odds of 1.


@njit
def decide_surface(log_odds, record, faces, voxel_m, rules: SurfaceRules):
    """Decide every cell with a record by its planes.

    Args:
        log_odds: Log-odds after hits and rays, float32 [X, Y, Z].
        record: Record number of each cell, int32 [X, Y, Z]; 0 is no surface.
        faces: Plane measurements, float32 [R, 6, 8].
        voxel_m: Cell size in metres.
        rules: Rules of the decision.

    Returns:
        ``decided``, the log-odds of the decision, float32 [X, Y, Z]; and ``heir``, int32 [X, Y, Z],
        the
        record that takes over the sums of each cell: that of a neighbour if the cell's points
            belong to
        this neighbour, otherwise its own.
    """
    decided = log_odds.copy()
    heir = record.copy()
    verdict = np.zeros(log_odds.shape, np.uint8)
    facing = np.zeros(log_odds.shape, np.int8)
    size = log_odds.shape
    for i in range(size[0]):
        for j in range(size[1]):
            for k in range(size[2]):
                if record[i, j, k] == 0 or log_odds[i, j, k] <= 0:
                    continue
                decision, margin_m, face = _decide_cell(i, j, k, record, faces, voxel_m, rules)
                verdict[i, j, k], facing[i, j, k] = decision, face
                if decision == SOLID:
                    decided[i, j, k] = min(log_odds[i, j, k], margin_m / rules.sure_m)
                elif decision == SPILL_BEFORE:
                    decided[i, j, k] = max(-log_odds[i, j, k], margin_m / rules.sure_m)
                elif decision == SPILL_BEHIND:
                    decided[i, j, k] = 0
    for i in range(size[0]):
        for j in range(size[1]):
            for k in range(size[2]):
                if verdict[i, j, k] == SPILL_BEFORE or verdict[i, j, k] == SPILL_BEHIND:
                    heir[i, j, k] = _heir(i, j, k, facing[i, j, k], record, verdict)
    return decided, heir


@njit
def _decide_cell(i, j, k, record, faces, voxel_m, rules: SurfaceRules):
    """Return the verdict on a cell, its margin in metres and the face that decided it.

    Any face that leaves the cell solid decides, otherwise the face with the largest weight. A cell
    without planes, as from a network's grid, has no verdict (0).
    """
    best, best_face, heaviest = -np.inf, -1, 0.0
    decision, margin_m, face = 0, 0.0, 0
    plane = np.zeros(6)
    for f in range(FACES):
        weight = faces[record[i, j, k], f, 0]
        if weight <= 0:
            continue
        _joined_plane(i, j, k, f, record, faces, voxel_m, rules, plane)
        depth, whole = _depth_of_solid(plane, voxel_m, rules.min_sub_cells)
        # The same plane leaves the neighbour before this cell solid too, and this one whole.
        before = depth - abs(plane[3 + f // 2]) * voxel_m
        behind = False
        if whole and before > 0:
            front = _weight_before(i, j, k, f, record, faces)
            sigma = faces[record[i, j, k], f, 7] / weight
            behind = weight < (weight + front) * _spill_share(before, sigma)
        if depth > 0 and not behind and depth > best:
            best, best_face = depth, f
        if weight > heaviest:
            heaviest, face, margin_m = weight, f, depth
            decision = SPILL_BEHIND if behind else SPILL_BEFORE
    if best_face >= 0:
        return SOLID, best, best_face
    return decision, margin_m, face


@njit
def _spill_share(depth, sigma):
    """Return the maximum share of a surface's points that noise may put behind a cell.

    ``depth`` is the distance in metres from the surface to the edge of the cell, ``sigma`` the
    standard deviation of a point along its ray.
    """
    tail = 0.5 * math.erfc(depth / (math.sqrt(2) * max(sigma, 1e-6)))
    return min(tail + SPILL_MORE, SPILL_MOST)


@njit
def _weight_before(i, j, k, f, record, faces):
    """Return the weight of the same face in the cell in front, or 0 if it has none."""
    towards = 1 if f % 2 else -1
    if f < 2:
        i += towards
    elif f < 4:
        j += towards
    else:
        k += towards
    if min(i, j, k) < 0 or i >= record.shape[0] or j >= record.shape[1] or k >= record.shape[2]:
        return 0.0
    return faces[record[i, j, k], f, 0]


@njit
def _joined_plane(i, j, k, f, record, faces, voxel_m, rules: SurfaceRules, plane):
    """Fill ``plane``, float64 [6], with a point (metres from the cell centre) and a unit normal.

    Neighbours along the axis of the face are included by their weight if they may be the same
    surface.
    """
    own = faces[record[i, j, k], f]
    axis = f // 2
    weight = own[0]
    for m in range(6):
        plane[m] = own[1 + m]
    for step in (-1, 1):
        a, b, c = i, j, k
        if axis == 0:
            a += step
        elif axis == 1:
            b += step
        else:
            c += step
        if min(a, b, c) < 0 or a >= record.shape[0] or b >= record.shape[1]:
            continue
        if c >= record.shape[2] or record[a, b, c] == 0:
            continue
        other = faces[record[a, b, c], f]
        if other[0] <= 0:
            continue
        distance, length = 0.0, 0.0
        for m in range(3):
            shift = step * voxel_m if m == axis else 0.0
            normal = own[4 + m] + other[4 + m]
            distance += (other[1 + m] / other[0] + shift - own[1 + m] / own[0]) * normal
            length += normal * normal
        sigma = max(own[7] / own[0], other[7] / other[0])
        if abs(distance) < (rules.merge_m + rules.merge_sigmas * sigma) * np.sqrt(length):
            weight += other[0]
            for m in range(6):
                plane[m] += other[1 + m]
            plane[axis] += step * voxel_m * other[0]
    length = np.sqrt(plane[3] ** 2 + plane[4] ** 2 + plane[5] ** 2)
    for m in range(3):
        plane[m] /= weight
        plane[3 + m] /= length


@njit
def _depth_of_solid(plane, voxel_m, least):
    """Return the depth of the ``least``-deepest sub-cell centre, and whether all are behind.

    A positive depth, in metres, means that the plane leaves at least ``least`` sub-cells solid.
    """
    deepest = np.full(least, -np.inf)
    whole = True
    step = voxel_m / PER_SIDE
    middle = (PER_SIDE - 1) / 2
    for x in range(PER_SIDE):
        for y in range(PER_SIDE):
            for z in range(PER_SIDE):
                depth = (plane[0] - (x - middle) * step) * plane[3]
                depth += (plane[1] - (y - middle) * step) * plane[4]
                depth += (plane[2] - (z - middle) * step) * plane[5]
                whole = whole and depth > 0
                if depth <= deepest[least - 1]:
                    continue
                m = least - 1
                while m > 0 and deepest[m - 1] < depth:
                    deepest[m] = deepest[m - 1]
                    m -= 1
                deepest[m] = depth
    return deepest[least - 1], whole


@njit
def _heir(i, j, k, face, record, verdict):
    """Return the record of the solid neighbour that takes over a cell's points, or 0."""
    axis, towards = face // 2, 1 if face % 2 else -1
    for step in (-towards, towards):
        a, b, c = i, j, k
        if axis == 0:
            a += step
        elif axis == 1:
            b += step
        else:
            c += step
        if min(a, b, c) < 0 or a >= record.shape[0] or b >= record.shape[1]:
            continue
        if c < record.shape[2] and verdict[a, b, c] == SOLID:
            return record[a, b, c]
    return 0


@njit
def move_sums(record, heir, voxel_m, votes, colour_sum, offset_sum, hits):
    """Move the sums of cells whose points belong to a neighbour to that neighbour, in place.

    Args:
        record: Record number of each cell, int32 [X, Y, Z].
        heir: Target record of each cell from ``decide_surface``, int32 [X, Y, Z].
        voxel_m: Cell size in metres, used to shift offsets to the centre of the target cell.
        votes: Votes, float32 [R, 12].
        colour_sum: Sums of colours, float32 [R, 3].
        offset_sum: Sums of offsets from the cell centre, float32 [R, 3].
        hits: Numbers of points, int64 [R].
    """
    size = record.shape
    place = np.zeros((len(hits), 3), np.int32)
    for i in range(size[0]):
        for j in range(size[1]):
            for k in range(size[2]):
                place[record[i, j, k]] = i, j, k
    for i in range(size[0]):
        for j in range(size[1]):
            for k in range(size[2]):
                row, to = record[i, j, k], heir[i, j, k]
                if row == to:
                    continue
                if to != 0:
                    for label in range(votes.shape[1]):
                        votes[to, label] += votes[row, label]
                    hits[to] += hits[row]
                    shift = (i - place[to, 0], j - place[to, 1], k - place[to, 2])
                    for m in range(3):
                        colour_sum[to, m] += colour_sum[row, m]
                        offset_sum[to, m] += offset_sum[row, m] + hits[row] * shift[m] * voxel_m
                votes[row] = 0
                colour_sum[row] = 0
                offset_sum[row] = 0
                hits[row] = 0
