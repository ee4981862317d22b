"""Planning of smooth, collision-free walks through a room, between stops on its free floor.

Each stop is chosen far from the previous ones. Paths keep a distance from walls if there is space.
"""

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from scipy.ndimage import gaussian_filter1d

from world2minecraft.minecraft.physics.body_fit import bodies_fit
from world2minecraft.minecraft.physics.player_body import HEIGHT, STEP_HEIGHT
from world2minecraft.minecraft.physics.shortest_paths import (
    clearance_m,
    connected_parts,
    distances_m,
    shortest_path,
)
from world2minecraft.minecraft.physics.walk_graph import CollisionGrid, WalkGraph

STOP_M2 = 2.0  # Floor area per stop.
STOPS = (2, 10)  # Minimum and maximum number of stops.
ELBOW_M = 0.5  # Preferred distance from walls.
NARROW_COST = 3.0  # Increase of path lengths at a wall.
SAMPLE_M = 0.05
SMOOTH_M = 0.35  # Radius by which corners are rounded.
ROUNDS = 6  # Attempts to undo rounding where the path collides.


@dataclass(frozen=True, eq=False)
class WalkArea:
    """The floor of a room.

    Attributes:
        graph: Part of the walk graph inside the room.
        solid: Collision grid of the volume.
        corner: Minimum corner of the volume in world blocks.
    """

    graph: WalkGraph
    solid: CollisionGrid
    corner: tuple[int, int, int]

    @cached_property
    def part(self) -> np.ndarray:
        """Number of the connected part that each position belongs to, int32 [N]."""
        return connected_parts(self.graph)

    @cached_property
    def weights(self) -> np.ndarray:
        """Factor for path lengths at each position, which increases near walls, float64 [N]."""
        return 1 + NARROW_COST * np.maximum(0.0, 1 - clearance_m(self.graph) / ELBOW_M)

    @property
    def cell_m2(self) -> float:
        """Floor area per position in square metres."""
        return (self.graph.spacing / self.graph.blocks_per_metre) ** 2


def plan_walk(area: WalkArea, rng: np.random.Generator) -> np.ndarray:
    """Plan a smooth random walk.

    Returns:
        The feet positions every ``SAMPLE_M`` in world block coordinates, float64 [N, 3].
    """
    stops = _stops(area, rng)
    feet = [area.graph.feet[stops[:1]]]
    for a, b in pairwise(_in_order(area.graph, stops)):
        path = shortest_path(area.graph, a, b, area.weights)
        if path is not None:
            feet.append(path.feet[1:])
    if len(feet) == 1:
        return feet[0]
    first = area.graph.feet[[_in_order(area.graph, stops)[0]]]
    way = np.concatenate([first, *feet[1:]])
    return _smooth(area, _resample(way, SAMPLE_M * area.graph.blocks_per_metre))


def _stops(area: WalkArea, rng: np.random.Generator) -> np.ndarray:
    """Return well-spread positions in a random connected part, preferring large parts."""
    sizes = np.bincount(area.part).astype(float)
    sizes[sizes < max(sizes.max() / 4, 2)] = 0  # Small parts are unreachable corners.
    if not sizes.any():
        sizes = np.bincount(area.part).astype(float)
    own = np.flatnonzero(area.part == rng.choice(len(sizes), p=sizes / sizes.sum()))
    count = int(np.clip(round(len(own) * area.cell_m2 / STOP_M2), *STOPS))
    stops = [int(rng.choice(own))]
    near = distances_m(area.graph, stops[0])[own]
    while len(stops) < min(count, len(own)):
        worth = np.where(np.isfinite(near), near, 0.0) * rng.uniform(0.5, 1.0, len(own))
        stops.append(int(own[worth.argmax()]))
        near = np.minimum(near, distances_m(area.graph, stops[-1])[own])
    return np.array(stops)


def _in_order(graph: WalkGraph, stops: np.ndarray) -> list[int]:
    """Order stops by always continuing to the nearest remaining one."""
    order, left = [int(stops[0])], [int(stop) for stop in stops[1:]]
    while left:
        away = np.linalg.norm(graph.feet[left] - graph.feet[order[-1]], axis=1)
        order.append(left.pop(int(away.argmin())))
    return order


def _resample(points: np.ndarray, spacing: float) -> np.ndarray:
    """Return evenly spaced points on a polyline, including its ends."""
    along = np.r_[0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    places = np.linspace(0, along[-1], max(2, int(np.ceil(along[-1] / spacing)) + 1))
    return np.column_stack([np.interp(places, along, column) for column in points.T])


def _smooth(area: WalkArea, feet: np.ndarray) -> np.ndarray:
    """Round the corners of a path, except where it would collide."""
    sigma = SMOOTH_M / SAMPLE_M
    best = gaussian_filter1d(feet, sigma, axis=0, mode="nearest")
    share = np.ones(len(feet))
    for _ in range(ROUNDS):
        mixed = share[:, None] * best + (1 - share[:, None]) * feet
        free = fits_at(area, mixed)
        if free.all():
            return mixed
        share[~free] = 0
        share = np.minimum(share, gaussian_filter1d(share, sigma / 3, mode="nearest"))
    return feet


def fits_at(area: WalkArea, feet: np.ndarray) -> np.ndarray:
    """Return whether a body fits at each feet position above step height, bool [N]."""
    scale, blocks = area.graph.scale, area.graph.blocks_per_metre
    half = 0.3 * scale - 0.02 * blocks
    heights = (STEP_HEIGHT * scale, HEIGHT * scale)
    return bodies_fit(area.solid, area.corner, feet, half, heights)
