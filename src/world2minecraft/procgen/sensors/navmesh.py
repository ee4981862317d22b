"""The navigation mesh of a room or a house, which contains the places where a person can walk.

The floor is divided into squares of 10 cm. A person can stand on a solid surface if 1.9 m above it
and the space around the body are free. Steps up and down are at most 26 cm, so that paths lead
through doorways and up stairs but not over tables.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components

from world2minecraft.core.types import Layout
from world2minecraft.procgen.rooms.room import Room

STEP_M = 0.1  # Side of a square of floor.
HEAD_M = 1.9  # Free height over a foot.
STRIDE_M = 0.26  # The highest step that is climbed.
BODY_M = 0.25  # Minimum distance from a person's centre to solids, in metres.
ANKLE_M, KNEE_M, SHOULDER_M = 0.1, 0.5, 1.76  # A body is free from its ankle up, or squeezes.
SQUEEZE_COST = 6.0  # A squeezed metre is walked only where it saves six others.
FLOOR_TOLERANCE_M = 0.06
DOORWAY_M, SLAB_M = 0.4, 0.6  # Walls, and what stairs pass between two storeys, are thinner.


@dataclass(frozen=True, eq=False)
class NavMesh:
    """The places where a person can stand or pass, and the links between them.

    ``easy`` places are on a floor with free space around the whole body. The other places, such as
    stairs and narrow gaps, can only be passed. ``storey_room`` is the index of the layout that
    contains a place, or -1 in a doorway or wall.
    """

    places_m: np.ndarray  # float64 [N, 3], in the frame of the room.
    easy: np.ndarray  # bool [N]
    storey_room: np.ndarray  # int64 [N]
    links: csr_matrix  # float64 [N, N], cost of each step, in metres.

    @cached_property
    def part(self) -> np.ndarray:
        """The number of the connected part that each place belongs to, int32 [N]."""
        return connected_components(self.links, directed=False)[1]


def build_navmesh(room: Room) -> NavMesh:
    """Build the navigation mesh of a room or a house, which may be empty."""
    squares = _squares(room)
    below = np.zeros((*squares.shape[:2], squares.shape[2] + 1), np.int32)
    np.cumsum(squares, axis=2, out=below[:, :, 1:])
    spots = _tops(room, squares, below)
    places_m = _places_m(room, spots)
    inside, storey_room, on_floor = _where(room.layouts, places_m)
    reachable = inside & _is_free_around(room, below, spots, KNEE_M)
    spots, places_m, storey_room, on_floor = (
        values[reachable] for values in (spots, places_m, storey_room, on_floor)
    )
    easy = on_floor & _is_free_around(room, below, spots, ANKLE_M)
    return NavMesh(places_m, easy, storey_room, _links(room, spots, easy))


def _squares(room: Room) -> np.ndarray:
    """Return whether each floor square contains solid voxels, by height, as bool [A, B, Z]."""
    step = _cells(room, STEP_M)
    nx, ny, nz = room.labels.shape
    rows = np.zeros((nx // step, ny // step, nz), bool)
    for n in range(len(rows)):  # Row by row: a house is too large for a copy.
        slab = room.labels[n * step : (n + 1) * step, : ny // step * step] != 0
        rows[n] = slab.any(axis=0).reshape(ny // step, step, nz).any(axis=1)
    return rows


def _tops(room: Room, squares: np.ndarray, below: np.ndarray) -> np.ndarray:
    """Return the squares and height indices where a person can stand, int64 [N, 3]."""
    spots = np.argwhere(squares[:, :, :-1] & ~squares[:, :, 1:]) + np.array([0, 0, 1])
    return spots[_solid_between(below, spots, 0, _cells(room, HEAD_M)) == 0]


def _solid_between(below: np.ndarray, spots: np.ndarray, low: int, high: int) -> np.ndarray:
    """Count the solid cells from ``low`` to ``high`` above each spot. Cells outside are solid.

    ``below``, int32 [A, B, Z + 1], is the cumulative number of solid cells in each square.
    """
    i, j, k = spots.T
    inside = (i >= 0) & (j >= 0) & (i < below.shape[0]) & (j < below.shape[1])
    inside &= k + high < below.shape[2]
    i, j, k = (np.where(inside, values, 0) for values in (i, j, k))
    return np.where(inside, below[i, j, k + high * inside] - below[i, j, k + low * inside], 1)


def _is_free_around(room: Room, below: np.ndarray, spots: np.ndarray, low_m: float) -> np.ndarray:
    """Return where a body has free space from ``low_m`` above its feet to its shoulders."""
    low, high = _cells(room, low_m), _cells(room, SHOULDER_M)
    free = np.ones(len(spots), bool)
    for di, dj in _offsets():
        free &= _solid_between(below, spots + np.array([di, dj, 0]), low, high) == 0
    return free


def _offsets() -> np.ndarray:
    """Return the offsets of the squares that a body overlaps, int64 [M, 2]."""
    reach = round(BODY_M / STEP_M) + 1
    grid = np.mgrid[-reach : reach + 1, -reach : reach + 1].reshape(2, -1).T
    nearest = np.maximum(np.abs(grid) * STEP_M - STEP_M / 2, 0)
    return grid[np.hypot(*nearest.T) < BODY_M - 1e-9]


def _cells(room: Room, length_m: float) -> int:
    return max(1, round(length_m / room.voxel_m))


def _places_m(room: Room, spots: np.ndarray) -> np.ndarray:
    across = (spots[:, :2] + 0.5) * _cells(room, STEP_M) * room.voxel_m
    return np.column_stack([across, spots[:, 2] * room.voxel_m]) + room.origin_m


def _where(layouts: tuple[Layout, ...], places_m: np.ndarray):
    """Return whether each place is near a room, its room index, and whether it is on a floor."""
    near, on_floor = np.zeros(len(places_m), bool), np.zeros(len(places_m), bool)
    index = np.full(len(places_m), -1)
    for n, layout in enumerate(layouts):
        up = places_m[:, 2] - layout.floor_z_m
        level = (up > -SLAB_M) & (up < layout.wall_height_m)
        index[level & is_inside(layout.floor_polygon_m, places_m[:, :2])] = n
        # A doorway belongs to no polygon: it lies in the wall between two of them.
        low, high = layout.floor_polygon_m.min(axis=0), layout.floor_polygon_m.max(axis=0)
        grown = (places_m[:, :2] > low - DOORWAY_M) & (places_m[:, :2] < high + DOORWAY_M)
        around = level & grown.all(axis=1)
        near |= around
        on_floor |= around & (np.abs(up) < FLOOR_TOLERANCE_M)
    return near, index, on_floor


def is_inside(polygon: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Return which points, float64 [N, 2], are inside a polygon, float64 [M, 2]."""
    x, y = points[:, 0], points[:, 1]
    odd = np.zeros(len(points), bool)
    for (ax, ay), (bx, by) in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        if ay != by:
            crosses = (ay > y) != (by > y)
            odd ^= crosses & (x < (bx - ax) * (y - ay) / (by - ay) + ax)
    return odd


def _links(room: Room, spots: np.ndarray, easy: np.ndarray) -> csr_matrix:
    """Link neighbouring squares, including diagonals, whose heights differ by at most one step."""
    stride = int(STRIDE_M / room.voxel_m + 1e-9)
    side = spots.max(axis=0, initial=0) + 2
    # Spots of one column follow each other, so that few candidates lie at each neighbour.
    column = spots[:, 0] * side[1] + spots[:, 1]
    order = np.argsort(column, kind="stable")
    starts, pairs = column[order], []
    for di, dj in ((1, 0), (0, 1), (1, 1), (1, -1)):
        wanted = column + di * side[1] + dj
        first, last = np.searchsorted(starts, wanted), np.searchsorted(starts, wanted, "right")
        for n in range(int((last - first).max(initial=0))):
            here = np.flatnonzero(first + n < last)
            there = order[first[here] + n]
            level = np.abs(spots[here, 2] - spots[there, 2]) <= stride
            length = np.full(int(level.sum()), np.hypot(di, dj) * STEP_M)
            pairs.append((here[level], there[level], length))
    a, b, length = (np.concatenate(values) for values in zip(*pairs, strict=True)) if pairs else (
        np.zeros(0, int), np.zeros(0, int), np.zeros(0)
    )  # fmt: skip
    cost = np.where(easy[a] & easy[b], length, SQUEEZE_COST * length)
    return csr_matrix((cost, (a, b)), shape=(len(spots), len(spots)))
