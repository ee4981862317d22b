"""The outline of a room's floor: few straight corners, on the planes of its walls."""

from itertools import pairwise

import numpy as np
from scipy import ndimage

from world2minecraft.geometry.connected_components import connected_parts

MERGE_M = 0.09  # Lines nearer than a cell and a bit are one wall.
NEAR_WALL_M = 0.35  # A region ends at a wall this near; else it ends where it was seen to.
INSIDE_SHARE = 0.5


def outline_of(
    region: np.ndarray,
    corner_m: np.ndarray,
    voxel_m: float,
    lines_m: tuple[list[float], list[float]],
) -> np.ndarray | None:
    """Return the polygon of a region, float64 [N, 2], counter-clockwise; None where it is nothing.

    The walls' lines cut the plan into rectangles; those that the region fills by half are the room.

    Args:
        region: bool [X, Y], the columns of the room, not empty.
        corner_m: float [2], the minimum corner of the plan.
        voxel_m: the side of a column.
        lines_m: where walls stand, square to x and square to y.
    """
    edges = [
        _lines(np.flatnonzero(plan.any(axis=1)), corner_m[axis], voxel_m, lines_m[axis])
        for axis, plan in enumerate((region, region.T))
    ]
    share = _filled_shares(region, corner_m, voxel_m, edges)
    parts, count = connected_parts(share >= INSIDE_SHARE, corners=False)
    if not count:
        return None
    areas = np.outer(np.diff(edges[0]), np.diff(edges[1]))
    largest = 1 + int(np.argmax(ndimage.sum(areas, parts, range(1, count + 1))))
    mask = np.asarray(ndimage.binary_fill_holes(parts == largest))
    ring = _ring(mask)
    return np.array([[edges[0][i], edges[1][j]] for i, j in ring]).round(4)


def _lines(cells: np.ndarray, corner_m: float, voxel_m: float, walls_m: list[float]) -> list:
    """Return the sorted cuts along one axis: the walls', and the ends where none is near."""
    ends = corner_m + np.array([cells[0], cells[-1] + 1]) * voxel_m
    cuts = [x for x in walls_m if ends[0] - NEAR_WALL_M <= x <= ends[1] + NEAR_WALL_M]
    cuts += [float(end) for end in ends if all(abs(end - x) > NEAR_WALL_M for x in cuts)]
    merged: list[list[float]] = []
    for cut in sorted(cuts):
        if merged and cut - merged[-1][-1] <= MERGE_M:
            merged[-1].append(cut)
        else:
            merged.append([cut])
    return [sum(group) / len(group) for group in merged]


def _filled_shares(region: np.ndarray, corner_m: np.ndarray, voxel_m: float, edges) -> np.ndarray:
    """Return which share of each rectangle is region, float [columns, rows]."""
    total = np.pad(region.astype(np.int64).cumsum(axis=0).cumsum(axis=1), ((1, 0), (1, 0)))
    at = [
        np.clip(np.round((np.array(e) - corner_m[a]) / voxel_m).astype(int), 0, region.shape[a])
        for a, e in enumerate(edges)
    ]
    count = np.diff(np.diff(total[np.ix_(*at)], axis=0), axis=1)
    cells = np.outer(np.diff(at[0]), np.diff(at[1]))
    return count / np.maximum(cells, 1)


def _ring(mask: np.ndarray) -> list[tuple[int, int]]:
    """Return the corners around a mask without holes, counter-clockwise, straight runs as one."""
    steps: dict[tuple[int, int], list[tuple[int, int]]] = {}
    padded = np.pad(mask, 1)
    for i, j in np.argwhere(mask):
        corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
        beyond = [(i + 1, j), (i + 2, j + 1), (i + 1, j + 2), (i, j + 1)]
        for (a, b), side in zip(pairwise([*corners, corners[0]]), beyond, strict=True):
            if not padded[side]:
                steps.setdefault((int(a[0]), int(a[1])), []).append((int(b[0]), int(b[1])))
    start = min(steps)
    ring, at, way = [start], start, (1, 0)
    while True:
        ahead = sorted(steps[at], key=lambda to: -_turn(way, at, to))
        following = ahead[0]
        steps[at].remove(following)
        way = (following[0] - at[0], following[1] - at[1])
        at = following
        if at == start:
            break
        ring.append(at)
    count = len(ring)
    return [ring[n] for n in range(count) if _bends(ring[n - 1], ring[n], ring[(n + 1) % count])]


def _turn(way: tuple[int, int], at: tuple[int, int], to: tuple[int, int]) -> int:
    """Return how far left a step turns: 1 left, 0 straight, -1 right."""
    step = (to[0] - at[0], to[1] - at[1])
    return int(np.sign(way[0] * step[1] - way[1] * step[0]))


def _bends(a: tuple[int, int], b: tuple[int, int], c: tuple[int, int]) -> bool:
    return (b[0] - a[0]) * (c[1] - b[1]) != (b[1] - a[1]) * (c[0] - b[0])
