"""The graph of places to stand, which of them lie indoors, and a short way past many of them."""

from itertools import pairwise

import numpy as np
from scipy.ndimage import distance_transform_edt
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import connected_components, dijkstra

from world2minecraft.coordinates import eye_height_blocks
from world2minecraft.render.views.floor import Floor
from world2minecraft.render.views.sight import FAR_M, look_around

MOST_PLACES = 400_000  # Of a larger floor only the nearest part is walked.
MOST_RATED = 1500  # Places that are rated as stops.
SPACING_M = 1.6  # Between stops,
MOST_STOPS, LEAST_STOPS = 24, 4  # and so many of them, where there is room.
LEAST_NEW = 0.12  # Of what one sees at a stop is new, else it is none.
PATCH_M = 0.5  # Side of the patches that count as seen.
WALLED_SHARE = 0.8  # Of level rays that end at a wall, indoors.
OUTSIDE_COST = 2.0  # What a place outdoors costs more.
ELBOW_M = 0.7  # One keeps so far from walls where there is room.
NARROW_COST = 2.5  # What a place at a wall costs more.
LEAST_ROOM_M2 = 1.0  # A smaller roofed floor is no room.
_NEIGHBOURS = ((1, 0), (0, 1), (1, 1), (1, -1))


class Ways:
    """The N places of the part of a floor that is worth walking, and the ways between them."""

    def __init__(self, floor: Floor):
        """Find the places and join neighbours that one step leads between."""
        self.floor = floor
        cells = np.argwhere(floor.stands)[:MOST_PLACES]
        if not len(cells):
            self.cells, self.indoors, self._graph = cells, np.zeros(0, bool), None
            return
        room = _elbow_room(floor)[tuple(cells.T)]
        indoors = _indoors(floor, cells)
        graph = _joined(floor, cells, 1 + OUTSIDE_COST * ~indoors + _narrowness(room))
        kept = _best_part(graph, indoors, LEAST_ROOM_M2 * floor.blocks_per_metre**2)
        self.cells, self.indoors = cells[kept], indoors[kept]
        self.room_m = room[kept]
        self._graph = csr_array(graph[kept][:, kept])

    def feet(self, places: np.ndarray) -> np.ndarray:
        """Return where feet stand at places, float64 [M, 3] in world blocks."""
        cells = self.cells[places]
        feet = cells + np.array(self.floor.corner) + 0.5
        feet[:, 1] = self.floor.feet_y[tuple(cells.T)]
        return feet

    def stops(self) -> np.ndarray:
        """Return places from which, together, the rooms are seen from all sides."""
        lit = self.indoors if self.indoors.any() else np.ones(len(self.cells), bool)
        few = np.flatnonzero(lit)
        few = few[:: -(-len(few) // MOST_RATED)]
        up = eye_height_blocks(self.floor.blocks_per_metre)
        eyes = self.feet(few) + np.array([0, up, 0])
        seen, worth = _seen_from(self.floor, eyes)
        worth *= 0.4 + np.minimum(self.room_m[few], ELBOW_M)
        return few[_covering(seen, worth, eyes / self.floor.blocks_per_metre)]

    def way(self, start: np.ndarray | None = None) -> np.ndarray:
        """Return a short way past all stops, as places, from the stop nearest to ``start``.

        Args:
            start: float64 [3], world blocks; the best end where it is left out.
        """
        stops = self.stops()
        lengths, before = dijkstra(self._graph, indices=stops, return_predecessors=True)
        between = lengths[:, stops]
        firsts = range(len(stops))
        if start is not None:
            firsts = [int(np.linalg.norm(self.feet(stops) - start, axis=1).argmin())]
        tours = [_shortened(_greedy(between, first), between) for first in firsts]
        order = min(tours, key=lambda tour: _length(tour, between))
        way = [int(stops[order[0]])]
        for a, b in pairwise(order):
            way += _walked(before[a], int(stops[a]), int(stops[b]))
        return np.array(way)


def _indoors(floor: Floor, cells: np.ndarray) -> np.ndarray:
    """Tell which places, cells [N, 3], have a roof and see walls in nearly all directions."""
    result = floor.roofed[tuple(cells.T)]
    asked = np.flatnonzero(result)
    eyes = cells[asked] + np.array(floor.corner) + 0.5
    eyes[:, 1] += eye_height_blocks(floor.blocks_per_metre) - 0.5
    for part in np.array_split(np.arange(len(asked)), -(-len(asked) // 4096) or 1):
        yaws_deg = np.arange(0.0, 360.0, 22.5)
        around = look_around(floor, eyes[part], yaws_deg, np.array([0.0]))
        result[asked[part]] = (around.cell >= 0).mean(axis=(1, 2)) >= WALLED_SHARE
    return result


def _seen_from(floor: Floor, eyes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return what each eye sees, patches with sides [N, R], 0 for nothing, and its open view."""
    yaws_deg, pitches_deg = np.arange(0.0, 360.0, 10.0), np.array([-10.0, 5.0, 25.0])
    around = look_around(floor, eyes, yaws_deg, pitches_deg)
    patch = max(1, round(PATCH_M * floor.blocks_per_metre))
    places = np.stack(np.unravel_index(np.maximum(around.cell, 0), floor.hides.shape)) // patch
    coarse = tuple(-(-side // patch) for side in floor.hides.shape)
    number = np.ravel_multi_index(tuple(places), coarse)
    sides = (yaws_deg // 90).astype(np.int64)[None, None]
    seen = np.where(around.cell >= 0, number * 4 + sides + 1, 0)
    good = (around.far_m > 0.8) & (around.far_m < FAR_M)  # What is nearer is a wall in the face.
    seen = np.where(good, seen, 0).reshape(len(eyes), -1)
    open_view = np.clip(around.far_m / 3.0, 0, 1).mean(axis=(1, 2))
    return seen, open_view


def _covering(seen: np.ndarray, worth: np.ndarray, eyes_m: np.ndarray) -> np.ndarray:
    """Return few eyes that see most, one after another the one that sees most that is new."""
    known = np.zeros(int(seen.max(initial=0)) + 1, bool)
    known[0] = True
    chosen: list[int] = []
    apart = np.full(len(seen), np.inf)
    while len(chosen) < MOST_STOPS:
        share = (~known[seen]).mean(axis=1)
        gain = share * worth
        gain[apart < SPACING_M] = 0
        best = int(gain.argmax())
        if gain[best] <= 0 or (share[best] < LEAST_NEW and len(chosen) >= LEAST_STOPS):
            break
        chosen.append(best)
        known[seen[best]] = True
        apart = np.minimum(apart, np.linalg.norm(eyes_m - eyes_m[best], axis=1))
    return np.array(chosen or [int(worth.argmax())])


def _elbow_room(floor: Floor) -> np.ndarray:
    """Return how far, in metres, each cell is from the nearest where nobody stands."""
    reach = int(np.ceil(2 * ELBOW_M * floor.blocks_per_metre))
    result = np.zeros(floor.stands.shape, np.float32)
    for layer in np.flatnonzero(floor.stands.any(axis=(0, 2))):
        low = max(0, layer - floor.step_blocks)
        near = floor.stands[:, low : layer + floor.step_blocks + 1].any(axis=1)
        padded = np.asarray(distance_transform_edt(np.pad(near, 1)))[1:-1, 1:-1]
        result[:, layer] = np.minimum(padded, reach) / floor.blocks_per_metre
    return result


def _narrowness(room_m: np.ndarray) -> np.ndarray:
    return NARROW_COST * np.maximum(0, 1 - room_m / ELBOW_M)


def _joined(floor: Floor, cells: np.ndarray, cost_of: np.ndarray) -> csr_array:
    """Return the graph of places; a way's cost is its length in blocks times that of its ends."""
    number = np.full(floor.stands.shape, -1, np.int64)
    number[tuple(cells.T)] = np.arange(len(cells))
    padded = np.pad(number, ((1, 1), (floor.step_blocks,) * 2, (1, 1)), constant_values=-1)
    rows, columns, costs = [], [], []
    at = cells + np.array([1, floor.step_blocks, 1])
    for dx, dz in _NEIGHBOURS:
        for dy in range(-floor.step_blocks, floor.step_blocks + 1):
            other = padded[at[:, 0] + dx, at[:, 1] + dy, at[:, 2] + dz]
            there = other >= 0
            if dx and dz:  # A corner is cut only where both its sides are free.
                sides = (padded[at[:, 0] + dx, at[:, 1], at[:, 2]] >= 0) & (
                    padded[at[:, 0], at[:, 1], at[:, 2] + dz] >= 0
                )
                there &= sides & (dy == 0)
            a, b = np.flatnonzero(there), other[there]
            length = np.sqrt(dx * dx + dy * dy + dz * dz)
            rows.append(a)
            columns.append(b)
            costs.append(length * (cost_of[a] + cost_of[b]) / 2)
    a, b, cost = (np.concatenate(part) for part in (rows, columns, costs))
    size = (len(cells), len(cells))
    return csr_array(
        coo_array((np.r_[cost, cost], (np.r_[a, b], np.r_[b, a])), shape=size), dtype=np.float64
    )


def _best_part(graph: csr_array, indoors: np.ndarray, least: float) -> np.ndarray:
    """Return the places of the part with most places indoors, or most places where none is."""
    count, part = connected_components(graph, directed=False)
    inside = np.bincount(part, weights=indoors, minlength=count)
    sizes = np.bincount(part, minlength=count)
    best = int(inside.argmax() if inside.max() >= least else sizes.argmax())
    return np.flatnonzero(part == best)


def _greedy(between: np.ndarray, first: int) -> list[int]:
    tour, left = [first], set(range(len(between))) - {first}
    while left:
        after = min(sorted(left), key=lambda n: between[tour[-1], n])
        tour.append(after)
        left.remove(after)
    return tour


def _shortened(tour: list[int], between: np.ndarray) -> list[int]:
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


def _walked(before: np.ndarray, start: int, end: int) -> list[int]:
    """Return the places after ``start`` up to ``end``."""
    way = [end]
    while before[way[-1]] != start and before[way[-1]] >= 0:
        way.append(int(before[way[-1]]))
    return way[::-1]
