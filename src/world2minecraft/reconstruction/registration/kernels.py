"""The sums of the joint solve, one pass over the observations each.

Every observation i is a patch of frame ``frame[i]`` on surfel ``surfel[i]``. Its residual is
``r = n . (p - c)`` and its row ``J = ((p - eye) x n, n, n . (p - eye))``: what a small turn of the
frame about its eye, a shift and a stretch of its depth do to r. A surfel's own offset takes up the
weighted mean of its observations, so every sum is that of differences from the mean.
"""

import numpy as np

from world2minecraft.core.jit import njit

UNKNOWNS = 7


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
