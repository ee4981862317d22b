"""One robust point-to-plane Gauss-Newton step of all frames, with priors that fix the gauge.

The unknowns are seven numbers per frame (rotation, translation, log of the depth scale) and one
offset per surfel. The offsets are eliminated, and the remaining system is solved by conjugate
gradients without a matrix, so time and memory grow linearly with the number of patches.

Observation i is a patch of frame ``frame[i]`` on surfel ``surfel[i]``. Its residual is
``r = n . (p - c)`` and its row ``J = ((p - eye) x n, n, n . (p - eye))``, the derivative of r with
respect to a small rotation of the frame about its eye, a translation, and a scaling of its depth.
The offset of a surfel absorbs the weighted mean of its observations.

The matrix of the system is ``sum w J J'`` of each frame, less ``g g' / mass`` of each surfel, where
``g`` is ``sum w J`` over the observations of one frame on one surfel, a pair. Each step of the
conjugate gradients visits the pairs alone, which are several times fewer than the observations.
"""

from dataclasses import dataclass

import numpy as np

from world2minecraft.core.jit import njit

UNKNOWNS = 7

REWEIGHTINGS = 4
CG_STEPS = 60
CG_TOLERANCE = 1e-3


@dataclass(frozen=True, eq=False)
class Observations:
    """The observations of one Gauss-Newton step, sorted by surfel and then by frame.

    Attributes:
        rows: Jacobian row of each observation, float64 [N, 7].
        residual: Residual in metres, float64 [N].
        weight: Weight, float64 [N].
        frame: Frame index, int32 [N].
        surfel: Surfel index, int64 [N].
        frames: Number of frames.
    """

    rows: np.ndarray
    residual: np.ndarray
    weight: np.ndarray
    frame: np.ndarray
    surfel: np.ndarray
    frames: int


@dataclass(frozen=True, eq=False)
class Step:
    """The result of one Gauss-Newton step.

    Attributes:
        change: Change of the seven numbers of each frame, float64 [F, 7].
        variance: Lower bound of their variance, float64 [F, 7].
        spread_m: Distance of patches from their surfels after the step: 1.48 times the median.
    """

    change: np.ndarray
    variance: np.ndarray
    spread_m: float


def solve(seen: Observations, so_far: np.ndarray, prior: np.ndarray, width_m: float) -> Step:
    """Solve for the step that aligns the patches with their surfels.

    Args:
        seen: Observations at the current poses.
        so_far: Changes by earlier steps, float64 [F, 7]; the priors pull the total to 0.
        prior: Standard deviation of each of the seven numbers, float64 [7]; 0 keeps the number
            fixed.
        width_m: Residual in metres above which the weight decreases (Geman and McClure).
    """
    change = np.zeros((seen.frames, UNKNOWNS))
    free = prior > 0
    pull = np.where(free, 1 / np.maximum(prior, 1e-12) ** 2, 0.0)
    rows = seen.rows if free.all() else np.where(free, seen.rows, 0.0)
    inverse = np.zeros((seen.frames, UNKNOWNS, UNKNOWNS))
    pairs, groups = pair_starts(seen.frame, seen.surfel)
    pair_frame = seen.frame[pairs[:-1]]
    weight = seen.weight.copy()
    diagonal = range(UNKNOWNS)
    for _ in range(REWEIGHTINGS):
        slope, whole, blocks, gathered, mass = normal_equations(
            rows, seen.residual, seen.weight, pair_frame, pairs, groups, change, width_m, weight
        )
        slope += pull * (so_far + change)
        blocks[:, diagonal, diagonal] += np.where(free, pull, 1.0)
        whole[:, diagonal, diagonal] += pull
        inverse = np.linalg.inv(blocks)
        change = change + conjugate_gradients(
            whole, gathered, mass, pair_frame, groups, -slope, inverse
        )
    variance = np.where(free, inverse[:, diagonal, diagonal], 0.0)
    off = offsets(rows, seen.residual, weight, pair_frame, pairs, groups, change)
    spread_m = 1.4826 * float(np.median(np.abs(off))) if len(off) else 0.0
    return Step(np.where(free, change, 0.0), variance, spread_m)


@njit
def pair_starts(frame, surfel):
    """Return where pairs begin among the observations, and surfels among the pairs.

    Both end with the number of all, int64 [P + 1] and [K + 1].
    """
    count = len(frame)
    pairs, groups = np.empty(count + 1, np.int64), np.empty(count + 1, np.int64)
    pair, group = 0, 0
    for i in range(count):
        is_new = i == 0 or surfel[i] != surfel[i - 1]
        if is_new:
            groups[group] = pair
            group += 1
        if is_new or frame[i] != frame[i - 1]:
            pairs[pair] = i
            pair += 1
    pairs[pair], groups[group] = count, pair
    return pairs[: pair + 1].copy(), groups[: group + 1].copy()


@njit
def residual_after(rows, residual, change, i, f):
    """Return the residual of observation i of frame f after a change of all frames."""
    left = residual[i]
    for a in range(UNKNOWNS):
        left += rows[i, a] * change[f, a]
    return left


@njit
def normal_equations(
    rows, residual, base, pair_frame, pairs, groups, change, width_m, weight
):  # fmt: skip
    """Return the slope and the parts of the matrix at a change, and fill ``weight``.

    The weights come from two rounds about each surfel's own middle, beginning with ``base``.

    Returns:
        Slope float64 [F, 7]; sums of ``w J J'`` and of ``w (1 - w / mass) J J'`` of each frame,
        both float64 [F, 7, 7]; ``g`` of each pair float64 [P, 7]; mass of each surfel float64 [K].
    """
    frames = len(change)
    slope = np.zeros((frames, UNKNOWNS))
    whole, blocks = np.zeros((2, frames, UNKNOWNS, UNKNOWNS))
    gathered = np.zeros((len(pair_frame), UNKNOWNS))
    mass = np.zeros(len(groups) - 1)
    left = np.empty(len(residual))
    for group in range(len(groups) - 1):
        first, last = groups[group], groups[group + 1]
        begin, end = pairs[first], pairs[last]
        for pair in range(first, last):
            for i in range(pairs[pair], pairs[pair + 1]):
                left[i] = residual_after(rows, residual, change, i, pair_frame[pair])
        for i in range(begin, end):
            weight[i] = base[i]
        for _ in range(2):
            middle = weighted_mean(left, weight, begin, end)
            for i in range(begin, end):
                weight[i] = base[i] / (1 + ((left[i] - middle) / width_m) ** 2) ** 2
        middle = weighted_mean(left, weight, begin, end)
        total = weight[begin:end].sum()
        mass[group] = total
        for pair in range(first, last):
            f = pair_frame[pair]
            for i in range(pairs[pair], pairs[pair + 1]):
                share = weight[i] * (1 - weight[i] / total)
                pulled = weight[i] * (left[i] - middle)
                for a in range(UNKNOWNS):
                    gathered[pair, a] += weight[i] * rows[i, a]
                    slope[f, a] += pulled * rows[i, a]
                    for b in range(a, UNKNOWNS):
                        square = rows[i, a] * rows[i, b]
                        whole[f, a, b] += weight[i] * square
                        blocks[f, a, b] += share * square
    for f in range(frames):
        for a in range(UNKNOWNS):
            for b in range(a):
                whole[f, a, b], blocks[f, a, b] = whole[f, b, a], blocks[f, b, a]
    return slope, whole, blocks, gathered, mass


@njit
def weighted_mean(values, weight, begin, end):
    """Return the weighted mean of the values from ``begin`` to ``end``, 0 without weight."""
    total, mass = 0.0, 0.0
    for i in range(begin, end):
        total += weight[i] * values[i]
        mass += weight[i]
    return total / mass if mass > 0 else 0.0


@njit
def multiply(whole, gathered, mass, pair_frame, groups, vector):
    """Return the product of the system's matrix and a vector float64 [F, 7]."""
    result = np.zeros_like(vector)
    for f in range(len(vector)):
        for a in range(UNKNOWNS):
            for b in range(UNKNOWNS):
                result[f, a] += whole[f, a, b] * vector[f, b]
    for group in range(len(mass)):
        if mass[group] <= 0:
            continue
        total = 0.0
        for pair in range(groups[group], groups[group + 1]):
            for a in range(UNKNOWNS):
                total += gathered[pair, a] * vector[pair_frame[pair], a]
        total /= mass[group]
        for pair in range(groups[group], groups[group + 1]):
            for a in range(UNKNOWNS):
                result[pair_frame[pair], a] -= gathered[pair, a] * total
    return result


@njit
def conjugate_gradients(whole, gathered, mass, pair_frame, groups, target, inverse):
    """Return the solution float64 [F, 7]; ``inverse`` of each frame's block preconditions."""
    found, left = np.zeros_like(target), target.copy()
    ahead = precondition(inverse, left)
    direction, size = ahead.copy(), (left * ahead).sum()
    start = size
    for _ in range(CG_STEPS):
        if size <= CG_TOLERANCE**2 * start:
            break
        image = multiply(whole, gathered, mass, pair_frame, groups, direction)
        length = size / (direction * image).sum()
        found += length * direction
        left -= length * image
        ahead = precondition(inverse, left)
        before = size
        size = (left * ahead).sum()
        direction = ahead + size / before * direction
    return found


@njit
def precondition(inverse, vector):
    """Return each frame's part of a vector multiplied by its block."""
    result = np.zeros_like(vector)
    for f in range(len(vector)):
        for a in range(UNKNOWNS):
            for b in range(UNKNOWNS):
                result[f, a] += inverse[f, a, b] * vector[f, b]
    return result


@njit
def offsets(rows, residual, weight, pair_frame, pairs, groups, change):
    """Return the distance of each observation from the mean of its surfel after a change."""
    off = np.empty(len(residual))
    for group in range(len(groups) - 1):
        begin, end = pairs[groups[group]], pairs[groups[group + 1]]
        for pair in range(groups[group], groups[group + 1]):
            for i in range(pairs[pair], pairs[pair + 1]):
                off[i] = residual_after(rows, residual, change, i, pair_frame[pair])
        middle = weighted_mean(off, weight, begin, end)
        for i in range(begin, end):
            off[i] -= middle
    return off


@njit
def move_patches(points, normals, frame, eyes, turns, shifts, stretches):
    """Rotate and scale points and normals about the eye of their frame, then translate them."""
    new_points, new_normals = np.empty_like(points), np.empty_like(normals)
    for i in range(len(points)):
        f = frame[i]
        for a in range(3):
            at, facing = 0.0, 0.0
            for b in range(3):
                at += turns[f, a, b] * (points[i, b] - eyes[f, b])
                facing += turns[f, a, b] * normals[i, b]
            new_points[i, a] = at * stretches[f] + eyes[f, a] + shifts[f, a]
            new_normals[i, a] = facing
    return new_points, new_normals


@njit
def jacobian_rows(points, cameras, frame, surfel, index, weight, centers, normals):
    """Return the rows and residuals of observations that are sorted by surfel.

    Residuals shrink with the whole room, so that plain least squares would shrink it. Measured in
    units of their frame's depth they do not; hence the residual in the derivative by the scale.

    Args:
        points: All patches in metres, float64 [M, 3].
        cameras: Poses of the frames, float64 [F, 4, 4].
        frame: Frame of each observation, int32 [N].
        surfel: Surfel of each observation, int64 [N].
        index: Patch of each observation, int64 [N].
        weight: Weight of each observation, float64 [N].
        centers: Centres of the surfels in metres, float64 [K, 3].
        normals: Normals of the surfels, float64 [K, 3].
    """
    rows, residual = np.empty((len(index), UNKNOWNS)), np.empty(len(index))
    begin = 0
    while begin < len(index):
        k, end = surfel[begin], begin
        nx, ny, nz = normals[k]
        while end < len(index) and surfel[end] == k:
            at, f = points[index[end]], frame[end]
            residual[end] = (
                nx * (at[0] - centers[k, 0])
                + ny * (at[1] - centers[k, 1])
                + nz * (at[2] - centers[k, 2])
            )
            x, y, z = at[0] - cameras[f, 0, 3], at[1] - cameras[f, 1, 3], at[2] - cameras[f, 2, 3]
            row = rows[end]
            row[0], row[1], row[2] = y * nz - z * ny, z * nx - x * nz, x * ny - y * nx
            row[3], row[4], row[5] = nx, ny, nz
            row[6] = nx * x + ny * y + nz * z
            end += 1
        middle = weighted_mean(residual, weight, begin, end)
        for i in range(begin, end):
            rows[i, 6] -= residual[i] - middle
        begin = end
    return rows, residual
