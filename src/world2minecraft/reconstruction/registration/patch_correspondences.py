"""Correspondences: which patches of different frames show the same piece of surface.

Patches are sorted into columns by the axis they face and by cells across that axis. Along the axis,
the patches of a column are separated at gaps wider than the possible pose error. This way no cell
border coincides with a wall, which would separate views from both sides of the border.
"""

from dataclasses import dataclass

import numpy as np

from world2minecraft.core.jit import njit

STEPS = 1 << 21  # Along the axis, in which patches are sorted: 0.1 mm for a scene of 200 m.


@dataclass(frozen=True, eq=False)
class Surfels:
    """Groups of patches that show the same piece of surface.

    Attributes:
        owner: Surfel of each patch, int64 [N].
        order: The patches of one surfel after another, each in the given order, int64 [N].
        start: Where the patches of each surfel begin in ``order``, int64 [K + 1].
        centers_m: Centres in metres, float64 [K, 3].
        normals: Normals, float64 [K, 3].
        frames: Number of frames that see each surfel, int64 [K].
    """

    owner: np.ndarray
    order: np.ndarray
    start: np.ndarray
    centers_m: np.ndarray
    normals: np.ndarray
    frames: np.ndarray


def find_surfels(
    points_m: np.ndarray,
    normals: np.ndarray,
    weight: np.ndarray,
    frame: np.ndarray,
    *,
    cell_m: float,
    gap_m: float,
) -> Surfels:
    """Group patches into surfels.

    Args:
        points_m: Points in metres, float64 [N, 3], in a frame aligned with most walls.
        normals: Unit normals, float64 [N, 3].
        weight: Positive weights, float64 [N].
        frame: Frame that saw each patch, int32 [N] in ascending order.
        cell_m: Width of a column in metres.
        gap_m: Gap in metres that separates two surfaces of a column.
    """
    low = points_m.min(axis=0, initial=np.inf)
    size_m = float((points_m.max(axis=0, initial=-np.inf) - low).max()) if len(points_m) else 0.0
    step_m = max(size_m, gap_m) / (STEPS - 1)
    keys = column_keys(points_m, normals, low, cell_m, int(size_m / cell_m) + 2, step_m)
    owner, count = split_columns(keys, np.argsort(keys), gap_m / step_m)
    order, start = sort_by_owner(owner, count)
    centers_m, facing, frames = surfel_sums(points_m, normals, weight, frame, order, start)
    return Surfels(owner, order, start, centers_m, facing, frames)


@njit
def column_keys(points, normals, low, cell_m, across, step_m):
    """Return a number for each patch, by its column, then by its place along the column.

    ``across`` is the largest number of cells along any axis.
    """
    keys = np.empty(len(points), np.int64)
    for i in range(len(points)):
        axis = 0
        for a in range(1, 3):
            if abs(normals[i, a]) > abs(normals[i, axis]):
                axis = a
        p, q = (axis + 1) % 3, (axis + 2) % 3
        u = np.int64(np.floor(points[i, p] / cell_m) - np.floor(low[p] / cell_m))
        v = np.int64(np.floor(points[i, q] / cell_m) - np.floor(low[q] / cell_m))
        facing = 2 * axis + (1 if normals[i, axis] > 0 else 0)
        along = np.int64((points[i, axis] - low[axis]) / step_m)
        keys[i] = ((u * across + v) * 6 + facing) * STEPS + along
    return keys


@njit
def split_columns(keys, order, gap):
    """Return the surfel of each patch and their number; columns are split at wider gaps."""
    owner = np.empty(len(keys), np.int64)
    count, before = 0, np.int64(-1)
    for place in range(len(order)):
        key = keys[order[place]]
        if place == 0 or key // STEPS != before // STEPS or key - before > gap:
            count += 1
        owner[order[place]] = count - 1
        before = key
    return owner, count


@njit
def sort_by_owner(owner, count):
    """Return the indices sorted by owner, and where each owner's begin."""
    start = np.zeros(count + 1, np.int64)
    for one in owner:
        start[one + 1] += 1
    for k in range(count):
        start[k + 1] += start[k]
    place, order = start.copy(), np.empty(len(owner), np.int64)
    for i in range(len(owner)):
        order[place[owner[i]]] = i
        place[owner[i]] += 1
    return order, start


@njit
def surfel_sums(points, normals, weight, frame, order, start):
    """Return the centre, unit normal and number of frames of each surfel."""
    count = len(start) - 1
    centers, facing = np.zeros((count, 3)), np.zeros((count, 3))
    frames = np.zeros(count, np.int64)
    for k in range(count):
        mass, before = 0.0, -1
        for place in range(start[k], start[k + 1]):
            i = order[place]
            mass += weight[i]
            for a in range(3):
                centers[k, a] += weight[i] * points[i, a]
                facing[k, a] += weight[i] * normals[i, a]
            frames[k] += frame[i] != before
            before = frame[i]
        length = np.sqrt(facing[k, 0] ** 2 + facing[k, 1] ** 2 + facing[k, 2] ** 2)
        for a in range(3):
            centers[k, a] /= mass
            facing[k, a] /= max(length, 1e-12)
    return centers, facing, frames
