"""One Gauss-Newton step of all frames: point to plane, robust, with priors that hold the gauge.

Unknown are seven numbers a frame (turn, shift, log of the depth's scale) and one offset a surfel.
The offsets are eliminated; conjugate gradients solve the rest without a matrix, so that time and
memory grow with the patches alone.

Observation i is a patch of frame ``frame[i]`` on surfel ``surfel[i]``. Its residual is
``r = n . (p - c)`` and its row ``J = ((p - eye) x n, n, n . (p - eye))``: what a small turn of the
frame about its eye, a shift and a stretch of its depth do to r. A surfel's own offset takes up the
weighted mean of its observations, so every sum is that of differences from the mean.
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
    """Return the weighted mean of values [N] on each surfel, 0 where nothing weighs."""
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
    """Return J x for every observation: float64 [N]."""
    result = np.empty(len(rows))
    for i in range(len(rows)):
        total = 0.0
        for a in range(UNKNOWNS):
            total += rows[i, a] * change[frame[i], a]
        result[i] = total
    return result


@njit
def gather_rows(rows, frame, weight, values, means, surfel, frames):
    """Return the sum of w J (value - mean of its surfel) of each frame: float64 [F, 7]."""
    result = np.zeros((frames, UNKNOWNS))
    for i in range(len(rows)):
        scaled = weight[i] * (values[i] - means[surfel[i]])
        for a in range(UNKNOWNS):
            result[frame[i], a] += rows[i, a] * scaled
    return result


@njit
def frame_blocks(rows, frame, weight, surfel, mass, frames):
    """Return the sum of w (1 - w / mass) J J' of each frame: float64 [F, 7, 7]."""
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
    """Return points and normals after each frame's turn and stretch about its eye, and shift."""
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
    """``rows`` float64 [N, 7], ``residual`` and ``weight`` float64 [N], ``frame``, ``surfel``."""

    rows: np.ndarray
    residual: np.ndarray
    weight: np.ndarray
    frame: np.ndarray
    surfel: np.ndarray
    frames: int
    surfels: int


@dataclass(frozen=True, eq=False)
class Step:
    """``change`` float64 [F, 7], and ``variance`` [F, 7]: how unsure each number is, at least.

    ``spread_m`` is how far patches are from their surfels after it: 1.48 times the median.
    """

    change: np.ndarray
    variance: np.ndarray
    spread_m: float


def solve(seen: Observations, so_far: np.ndarray, prior: np.ndarray, width_m: float) -> Step:
    """Return the step that makes patches meet their surfels.

    Args:
        seen: the observations at the present poses.
        so_far: float64 [F, 7], what earlier steps changed; the priors pull the sum to 0.
        prior: float64 [7], the sigma of each number; 0 keeps it as it is.
        width_m: residuals beyond lose their weight (Geman and McClure).
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
