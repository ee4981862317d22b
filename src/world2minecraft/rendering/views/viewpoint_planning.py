"""Viewpoints for a tour: standing positions, indoor areas and a short route between them."""

from itertools import pairwise

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components, dijkstra

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.coordinates import eye_height_blocks
from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraft.physics.shortest_paths import clearance_m
from world2minecraft.minecraft.physics.walk_graph import WalkGraph, walk_graph
from world2minecraft.rendering.views.visibility import MAX_VIEW_M, ViewBlockers, cast_view_rays

MAX_PLACES = 400_000  # Maximum number of cells; of a larger floor the nearest are used.
MAX_RATED = 1500  # Places that are rated as stops.
SPACING_M = 1.6  # Between stops,
MAX_STOPS, MIN_STOPS = 24, 4  # and so many of them, where there is room.
MIN_NEW_SHARE = 0.12  # Minimum share of a stop's view that is new.
PATCH_M = 0.5  # Side of the patches that count as seen.
WALLED_SHARE = 0.8  # Share of level rays that end at a wall indoors.
OUTSIDE_COST = 2.0  # Additional cost of a cell outdoors.
ELBOW_M = 0.7  # One keeps so far from walls where there is room.
NARROW_COST = 2.5  # Additional cost of a cell at a wall.
MIN_ROOM_M2 = 1.0  # A smaller roofed floor is no room.


class WalkRoutes:
    """The N positions in the part of a floor that is worth visiting, and the paths between them."""

    def __init__(self, volume: BlockVolume, hiding: ViewBlockers):
        """Find the places where a player can walk, and keep the part that is worth visiting."""
        self.hiding = hiding
        graph = walk_graph(volume)
        scale = graph.blocks_per_metre
        eyes = graph.feet + np.array([0, eye_height_blocks(scale), 0])
        free = ~_values_at(self.hiding.hides, eyes, self.hiding)  # Nothing stands in the eye.
        free &= graph.headroom >= eye_height_blocks(scale)
        graph = graph.part(np.flatnonzero(free)[:MAX_PLACES])
        self.feet, self.indoors, self.room_m = graph.feet, np.zeros(len(graph), bool), np.zeros(0)
        if not len(graph):
            return
        share_m2 = _shares_m2(graph)
        indoors = _indoors(self.hiding, graph.feet)
        room_m = clearance_m(graph)
        cost = _two_way_steps(graph, 1 + OUTSIDE_COST * ~indoors + _narrowness(room_m))
        kept = _best_part(cost, indoors, share_m2, graph.ground == SemanticClass.FLOOR)
        self.feet, self.indoors, self.room_m = graph.feet[kept], indoors[kept], room_m[kept]
        self._graph = csr_array(cost[kept][:, kept])

    def stops(self) -> np.ndarray:
        """Return positions from which all rooms together are visible from all sides."""
        lit = self.indoors if self.indoors.any() else np.ones(len(self.feet), bool)
        few = np.flatnonzero(lit)
        few = few[:: -(-len(few) // MAX_RATED)]
        up = eye_height_blocks(self.hiding.blocks_per_metre)
        eyes = self.feet[few] + np.array([0, up, 0])
        seen, worth = _seen_from(self.hiding, eyes)
        worth *= 0.4 + np.minimum(self.room_m[few], ELBOW_M)
        return few[_choose_stops(seen, worth, eyes / self.hiding.blocks_per_metre)]

    def way(self, start: np.ndarray | None = None) -> np.ndarray:
        """Return a short route past all stops as positions, from the stop nearest to ``start``.

        Args:
            start: Start position in world blocks, float64 [3]. None chooses the best end.
        """
        stops = self.stops()
        lengths, before = dijkstra(self._graph, indices=stops, return_predecessors=True)
        between = lengths[:, stops]
        firsts = range(len(stops))
        if start is not None:
            firsts = [int(np.linalg.norm(self.feet[stops] - start, axis=1).argmin())]
        tours = [_two_opt(_nearest_neighbour_tour(between, first), between) for first in firsts]
        order = min(tours, key=lambda tour: _length(tour, between))
        way = [int(stops[order[0]])]
        for a, b in pairwise(order):
            way += _trace_back(before[a], int(stops[a]), int(stops[b]))
        return np.array(way)


def _values_at(values: np.ndarray, points: np.ndarray, hiding: ViewBlockers) -> np.ndarray:
    """Return the values, bool [X, Y, Z], of the cells of points, float64 [N, 3]; False outside."""
    cells = np.floor(points - np.array(hiding.corner) + [0, 1e-6, 0]).astype(np.int64)
    inside = ((cells >= 0) & (cells < values.shape)).all(axis=1)
    return inside & values[tuple(np.clip(cells, 0, np.array(values.shape) - 1).T)]


def _shares_m2(graph: WalkGraph) -> np.ndarray:
    """Return the floor that each place stands for: its block's, shared by the places on it."""
    cells = np.floor(graph.feet).astype(np.int64)
    _, which, count = np.unique(cells, axis=0, return_inverse=True, return_counts=True)
    return 1 / count[which.reshape(-1)] / graph.blocks_per_metre**2


def _indoors(hiding: ViewBlockers, feet: np.ndarray) -> np.ndarray:
    """Return which feet [N, 3] are under a roof with walls in nearly all directions, bool [N]."""
    result = _values_at(hiding.roofed, feet, hiding)
    roofed = np.flatnonzero(result)
    eyes = feet[roofed] + np.array([0, eye_height_blocks(hiding.blocks_per_metre), 0])
    for part in np.array_split(np.arange(len(roofed)), -(-len(roofed) // 4096) or 1):
        yaws_deg = np.arange(0.0, 360.0, 22.5)
        around = cast_view_rays(hiding, eyes[part], yaws_deg, np.array([0.0]))
        result[roofed[part]] = (around.cell >= 0).mean(axis=(1, 2)) >= WALLED_SHARE
    return result


def _seen_from(hiding: ViewBlockers, eyes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return what each eye sees, patches with sides [N, R], 0 for nothing, and its open view."""
    yaws_deg, pitches_deg = np.arange(0.0, 360.0, 10.0), np.array([-10.0, 5.0, 25.0])
    around = cast_view_rays(hiding, eyes, yaws_deg, pitches_deg)
    patch = max(1, round(PATCH_M * hiding.blocks_per_metre))
    places = np.stack(np.unravel_index(np.maximum(around.cell, 0), hiding.hides.shape)) // patch
    coarse = tuple(-(-side // patch) for side in hiding.hides.shape)
    number = np.ravel_multi_index(tuple(places), coarse)
    sides = (yaws_deg // 90).astype(np.int64)[None, None]
    seen = np.where(around.cell >= 0, number * 4 + sides + 1, 0)
    good = (around.far_m > 0.8) & (
        around.far_m < MAX_VIEW_M
    )  # What is nearer is a wall in the face.
    seen = np.where(good, seen, 0).reshape(len(eyes), -1)
    open_view = np.clip(around.far_m / 3.0, 0, 1).mean(axis=(1, 2))
    return seen, open_view


def _choose_stops(seen: np.ndarray, worth: np.ndarray, eyes_m: np.ndarray) -> np.ndarray:
    """Return few eyes that see most, one after another the one that sees most that is new."""
    known = np.zeros(int(seen.max(initial=0)) + 1, bool)
    known[0] = True
    chosen: list[int] = []
    distance_m = np.full(len(seen), np.inf)
    while len(chosen) < MAX_STOPS:
        share = (~known[seen]).mean(axis=1)
        gain = share * worth
        gain[distance_m < SPACING_M] = 0
        best = int(gain.argmax())
        if gain[best] <= 0 or (share[best] < MIN_NEW_SHARE and len(chosen) >= MIN_STOPS):
            break
        chosen.append(best)
        known[seen[best]] = True
        distance_m = np.minimum(distance_m, np.linalg.norm(eyes_m - eyes_m[best], axis=1))
    return np.array(chosen or [int(worth.argmax())])


def _narrowness(room_m: np.ndarray) -> np.ndarray:
    return NARROW_COST * np.maximum(0, 1 - room_m / ELBOW_M)


def _two_way_steps(graph: WalkGraph, cost_of: np.ndarray) -> csr_array:
    """Return the steps that lead both ways; each costs its length times that of its ends."""
    cost = graph.edge_m * (cost_of[graph.edge_from] + cost_of[graph.edge_to]) / 2
    size = (len(graph), len(graph))
    ahead = csr_array((cost, graph.edge_to, graph.edge_start), shape=size)
    both = csr_array(ahead.minimum(csr_array(ahead.T)))
    both.eliminate_zeros()
    return both


def _best_part(
    graph: csr_array, indoors: np.ndarray, share_m2: np.ndarray, floor: np.ndarray
) -> np.ndarray:
    """Return the places of the part with most area indoors, else on blocks of the class floor.

    Where neither is as large as a room, the part with the largest area counts.
    """
    count, part = connected_components(graph, directed=False)
    areas = [
        np.bincount(part, weights=share_m2 * chosen, minlength=count)
        for chosen in (indoors, floor, np.ones(len(part)))
    ]
    best = next((area for area in areas if area.max() >= MIN_ROOM_M2 - 1e-9), areas[-1])
    return np.flatnonzero(part == best.argmax())


def _nearest_neighbour_tour(between: np.ndarray, first: int) -> list[int]:
    tour, left = [first], set(range(len(between))) - {first}
    while left:
        after = min(sorted(left), key=lambda n: between[tour[-1], n])
        tour.append(after)
        left.remove(after)
    return tour


def _two_opt(tour: list[int], between: np.ndarray) -> list[int]:
    """Turn parts of a tour round, but for its first stop, as long as that makes it shorter."""
    best, shorter = tour, True
    while shorter:
        shorter = False
        for i in range(1, len(best) - 1):
            for j in range(i + 1, len(best)):
                other = best[:i] + best[i : j + 1][::-1] + best[j + 1 :]
                if _length(other, between) < _length(best, between) - 1e-9:
                    best, shorter = other, True
    return best


def _length(tour: list[int], between: np.ndarray) -> float:
    return float(between[tour[:-1], tour[1:]].sum())


def _trace_back(before: np.ndarray, start: int, end: int) -> list[int]:
    """Return the places after ``start`` up to ``end``."""
    way = [end]
    while before[way[-1]] != start and before[way[-1]] >= 0:
        way.append(int(before[way[-1]]))
    return way[::-1]
