"""One robust point-to-plane Gauss-Newton step of all frames, with priors that fix the gauge.

The unknowns are seven numbers per frame (rotation, translation, log of the depth scale) and one
offset per surfel. The offsets are eliminated, and the remaining system is solved by conjugate
gradients without a matrix, so time and memory grow linearly with the number of patches.

Observation i is a patch of frame ``frame[i]`` on surfel ``surfel[i]``. Its residual is
``r = n . (p - c)`` and its row ``J = ((p - eye) x n, n, n . (p - eye))``, the derivative of r with
respect to a small rotation of the frame about its eye, a translation, and a scaling of its depth.
The offset of a surfel absorbs the weighted mean of its observations, so all sums are over
differences from this mean.
"""

from dataclasses import dataclass

import numpy as np

from world2minecraft.core.jit import njit

UNKNOWNS = 7

REWEIGHTINGS = 4
CG_STEPS = 60
CG_TOLERANCE = 1e-3


@njit
def surfel_means(values, weight, surfel, count):
    """Return the weighted mean of values [N] on each surfel, or 0 without weight."""
    total, mass = np.zeros(count), np.zeros(count)
    for i in range(len(values)):
        total[surfel[i]] += weight[i] * values[i]
        mass[surfel[i]] += weight[i]
    for k in range(count):
        if mass[k] > 0:
            total[k] /= mass[k]
    return total


@njit
def apply_rows(rows, frame, change):
    """Compute J x for every observation, float64 [N]."""
    result = np.empty(len(rows))
    for i in range(len(rows)):
        total = 0.0
        for a in range(UNKNOWNS):
            total += rows[i, a] * change[frame[i], a]
        result[i] = total
    return result


@njit
def gather_rows(rows, frame, weight, values, means, surfel, frames):
    """Compute the sum of w J (value - mean of its surfel) for each frame, float64 [F, 7]."""
    result = np.zeros((frames, UNKNOWNS))
    for i in range(len(rows)):
        scaled = weight[i] * (values[i] - means[surfel[i]])
        for a in range(UNKNOWNS):
            result[frame[i], a] += rows[i, a] * scaled
    return result


@njit
def frame_blocks(rows, frame, weight, surfel, mass, frames):
    """Compute the sum of w (1 - w / mass) J J' for each frame, float64 [F, 7, 7]."""
    blocks = np.zeros((frames, UNKNOWNS, UNKNOWNS))
    for i in range(len(rows)):
        total = mass[surfel[i]]
        if total <= 0:
            continue
        share = weight[i] * (1 - weight[i] / total)
        for a in range(UNKNOWNS):
            for b in range(UNKNOWNS):
                blocks[frame[i], a, b] += share * rows[i, a] * rows[i, b]
    return blocks


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


@dataclass(frozen=True, eq=False)
class Observations:
    """The observations of one Gauss-Newton step.

    Attributes:
        rows: Jacobian row of each observation, float64 [N, 7].
        residual: Residual in metres, float64 [N].
        weight: Weight, float64 [N].
        frame: Frame index, int [N].
        surfel: Surfel index, int [N].
        frames: Number of frames.
        surfels: Number of surfels.
    """

    rows: np.ndarray
    residual: np.ndarray
    weight: np.ndarray
    frame: np.ndarray
    surfel: np.ndarray
    frames: int
    surfels: int


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
    rows = np.where(free, seen.rows, 0.0)
    inverse = np.zeros((seen.frames, UNKNOWNS, UNKNOWNS))
    weight = seen.weight
    for _ in range(REWEIGHTINGS):
        left = seen.residual + apply_rows(rows, seen.frame, change)
        weight = _robust(left, seen, width_m)
        means = surfel_means(left, weight, seen.surfel, seen.surfels)
        slope = gather_rows(rows, seen.frame, weight, left, means, seen.surfel, seen.frames)
        slope += pull * (so_far + change)
        mass = np.bincount(seen.surfel, weight, seen.surfels)
        blocks = frame_blocks(rows, seen.frame, weight, seen.surfel, mass, seen.frames)
        blocks[:, range(UNKNOWNS), range(UNKNOWNS)] += np.where(free, pull, 1.0)
        inverse = np.linalg.inv(blocks)
        change = change + _conjugate_gradients(seen, rows, weight, pull, -slope, inverse)
    variance = np.where(free, inverse[:, range(UNKNOWNS), range(UNKNOWNS)], 0.0)
    left = seen.residual + apply_rows(rows, seen.frame, change)
    off = left - surfel_means(left, weight, seen.surfel, seen.surfels)[seen.surfel]
    spread_m = 1.4826 * float(np.median(np.abs(off))) if len(off) else 0.0
    return Step(np.where(free, change, 0.0), variance, spread_m)


def _robust(left: np.ndarray, seen: Observations, width_m: float) -> np.ndarray:
    """Return the weights after two rounds about each surfel's own middle."""
    weight = seen.weight
    for _ in range(2):
        off = left - surfel_means(left, weight, seen.surfel, seen.surfels)[seen.surfel]
        weight = seen.weight / (1 + (off / width_m) ** 2) ** 2
    return weight


def _conjugate_gradients(seen, rows, weight, pull, target, inverse) -> np.ndarray:
    found = np.zeros_like(target)
    left = target
    ahead = np.einsum("fab,fb->fa", inverse, left)
    direction, size = ahead, float(np.sum(left * ahead))
    start = size
    for _ in range(CG_STEPS):
        if size <= CG_TOLERANCE**2 * start:
            break
        moved = apply_rows(rows, seen.frame, direction)
        means = surfel_means(moved, weight, seen.surfel, seen.surfels)
        image = gather_rows(rows, seen.frame, weight, moved, means, seen.surfel, seen.frames)
        image += pull * direction
        length = size / float(np.sum(direction * image))
        found = found + length * direction
        left = left - length * image
        ahead = np.einsum("fab,fb->fa", inverse, left)
        size, before = float(np.sum(left * ahead)), size
        direction = ahead + size / before * direction
    return found
