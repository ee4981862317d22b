"""The walkable graph as a table, so that a place between those of the graph finds them at once."""

from typing import NamedTuple

import numpy as np

from world2minecraft.core.jit import njit
from world2minecraft.minecraft.physics.graph import WalkGraph

REACH = 1.5  # Spacings: places so near to a body are on its own side of any wall,
LEVEL = 0.6  # and so near in height, in sizes of the body, are on its own floor.


class Floor(NamedTuple):
    """The places of a graph by columns of a regular grid; of each column those in a row."""

    origin: np.ndarray  # float64 [2], x and z of the first column, world blocks
    shape: np.ndarray  # int64 [2], columns along x and z
    start: np.ndarray  # int64 [C + 1]
    place: np.ndarray  # int32 [N]
    feet: np.ndarray  # float64 [N, 3], by place
    spacing: float  # blocks from a column to the next
    level: float  # blocks
    metres_per_block: float


def floor_of(graph: WalkGraph) -> Floor:
    """Return the table of a graph with one place or more."""
    origin = graph.feet[:, [0, 2]].min(axis=0)
    at = np.round((graph.feet[:, [0, 2]] - origin) / graph.spacing).astype(np.int64)
    shape = at.max(axis=0) + 1
    column = at[:, 0] * shape[1] + at[:, 1]
    counts = np.bincount(column, minlength=int(shape.prod()))
    start = np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)
    place = np.argsort(column, kind="stable").astype(np.int32)
    return Floor(
        origin, shape, start, place, graph.feet, graph.spacing, LEVEL * graph.scale,
        1 / graph.blocks_per_metre,
    )  # fmt: skip


@njit
def distance_over(floor, field, x, y, z):
    """Return the way in metres from feet by a field over places, float64 [N]; inf off the floor."""
    i = int(np.floor((x - floor.origin[0]) / floor.spacing))
    k = int(np.floor((z - floor.origin[1]) / floor.spacing))
    reach = REACH * floor.spacing
    best = np.inf
    for column_x in range(max(0, i - 1), min(floor.shape[0] - 1, i + 2) + 1):
        for column_z in range(max(0, k - 1), min(floor.shape[1] - 1, k + 2) + 1):
            column = column_x * floor.shape[1] + column_z
            for n in range(floor.start[column], floor.start[column + 1]):
                place = floor.place[n]
                there = floor.feet[place]
                dx, dy, dz = there[0] - x, there[1] - y, there[2] - z
                if abs(dy) > floor.level or dx * dx + dz * dz > reach * reach:
                    continue
                away = np.sqrt(dx * dx + dy * dy + dz * dz) * floor.metres_per_block
                best = min(best, away + field[place])
    return best
