"""Any-angle shortest paths in a walkable graph, computed with lazy Theta*.

A path leads straight from one place to another if the line between them is free. A body at any
point of the line occupies part of the space of bodies at the four places around it, and these must
be connected by steps in both directions, so that a straight path is as free as the steps. Paths
turn only at places, so a graph with ``at_corners`` contains the exact shortest paths. Where the
ground drops, paths use the steps of the graph.
"""

from typing import NamedTuple

import numpy as np

from world2minecraft.core.jit import njit
from world2minecraft.minecraft.physics.shortest_paths import pop, push
from world2minecraft.minecraft.physics.walk_graph import WalkGraph

MIN_GAIN_M = 1e-9
TOLERANCE = 1e-9  # Shares of a way that differ by less are one: there it passes a place.
SWEEPS = 1  # Over all places, in which bends of neighbours are tried; a second gains nothing.


class Lattice(NamedTuple):
    """The places of a graph arranged in rows and columns, with the two-way steps between them."""

    at: np.ndarray  # int64 [N, 2], column index along x and z.
    xs_m: np.ndarray  # float64 [X], positions of the columns.
    zs_m: np.ndarray  # float64 [Z]
    height_m: np.ndarray  # float64 [N]
    link: np.ndarray  # int32 [N, 9], neighbour by 3 * (dx + 1) + dz + 1; -1 if there is none.


def build_lattice(graph: WalkGraph) -> Lattice:
    """Return the lattice of a graph that has at least one place."""
    feet_m = graph.feet / graph.blocks_per_metre
    (xs_m, x), (zs_m, z) = (np.unique(feet_m[:, axis], return_inverse=True) for axis in (0, 2))
    at = np.stack([x, z], axis=1).astype(np.int64)
    begins, ends = graph.edge_from.astype(np.int64), graph.edge_to.astype(np.int64)
    way = at[ends] - at[begins] + 1
    link = np.full((len(graph), 9), -1, np.int32)
    link[begins, 3 * way[:, 0] + way[:, 1]] = ends
    for side in range(9):  # Steps down without a way back are taken out.
        there = link[:, side]
        link[(there < 0) | (link[there, 8 - side] != np.arange(len(graph))), side] = -1
    return Lattice(at, xs_m, zs_m, feet_m[:, 1].copy(), link)


def straight_distances_m(
    graph: WalkGraph, lattice: Lattice, places: int | np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Compute the any-angle distance and the first turn from each place to the nearest target.

    Args:
        graph: The walkable graph.
        lattice: The lattice of the graph.
        places: The target place or places.

    Returns:
        Distances in metres, float64 [N], infinite if no path exists; and turning places, int32 [N].
        The path leads straight from a place to its turning place, which is the place itself at a
        target and -1 if no path exists.
    """
    sources = np.atleast_1d(np.asarray(places, np.int64))
    away, bend, order = _lazy_theta_star(lattice, graph.edges, graph.backward, sources)
    for _ in range(SWEEPS):
        _relax_bends(lattice, graph.edges, order, away, bend)
    return away, bend


@njit
def straight_m(lattice, here, there):
    """Return the length of the straight path between two places, or infinity if it is blocked.

    Rises and falls of the ground add to the length. The path must be free in both directions.
    """
    i, k = lattice.at[here, 0], lattice.at[here, 1]
    to_i, to_k = lattice.at[there, 0], lattice.at[there, 1]
    begin_x, begin_z = lattice.xs_m[i], lattice.zs_m[k]
    wide, deep = lattice.xs_m[to_i] - begin_x, lattice.zs_m[to_k] - begin_z
    right, down = np.sign(to_i - i), np.sign(to_k - k)
    whole = np.sqrt(wide * wide + deep * deep)
    gone, length = 0.0, 0.0
    while i != to_i or k != to_k:
        over_x = (lattice.xs_m[i + right] - begin_x) / wide if i != to_i else 2.0
        over_z = (lattice.zs_m[k + down] - begin_z) / deep if k != to_k else 2.0
        if right != 0 and down != 0 and lattice.link[here, 3 * right + down + 4] < 0:
            return np.inf
        move_x = right if over_x <= over_z + TOLERANCE else 0
        move_z = down if over_z <= over_x + TOLERANCE else 0
        to = lattice.link[here, 3 * move_x + move_z + 4]
        if to < 0:
            return np.inf
        rise = lattice.height_m[to] - lattice.height_m[here]
        piece = (min(over_x, over_z) - gone) * whole
        length += np.sqrt(piece * piece + rise * rise)
        here, i, k, gone = to, i + move_x, k + move_z, min(over_x, over_z)
    return length if here == there else np.inf


@njit
def _lazy_theta_star(lattice, edges, back, sources):
    """Return distances, turning places, and the places in order of distance (lazy Theta* search).

    ``edges`` and ``back`` are the outgoing and incoming steps of each place. A place first inherits
    the turning place of its predecessor without a check. The line of sight is checked when the
    place is processed. If it is blocked, or a path along steps is shorter, the best step to a
    finished place is used instead.
    """
    start, to = back.start, back.to
    count = len(start) - 1
    away, bend = np.full(count, np.inf), np.full(count, -1, np.int32)
    keys = np.empty(len(to) + len(sources) + 1)
    values = np.empty(len(to) + len(sources) + 1, np.int32)
    order, found, size = np.empty(count, np.int32), 0, 0
    for source in sources:
        away[source], bend[source] = 0.0, source
        size = push(keys, values, size, 0.0, source)
    done = np.zeros(count, np.bool_)
    while size > 0:
        here = values[0]
        size = pop(keys, values, size)
        if done[here]:
            continue
        if bend[here] != here:
            _confirm_bend(lattice, edges, done, away, bend, here)
        done[here], order[found] = True, here
        found += 1
        for edge in range(start[here], start[here + 1]):
            there = to[edge]
            if not done[there]:
                length = _level_distance(lattice, there, bend[here]) + away[bend[here]]
                if length < away[there]:
                    away[there], bend[there] = length, bend[here]
                    size = push(keys, values, size, length, there)
    return away, bend, order[:found].copy()


@njit
def _confirm_bend(lattice, edges, done, away, bend, here):
    """Check the straight path to a turning place, or use a step if that is shorter."""
    start, to, cost = edges.start, edges.to, edges.length_m
    away[here] = straight_m(lattice, here, bend[here]) + away[bend[here]]
    for edge in range(start[here], start[here + 1]):
        length = away[to[edge]] + cost[edge]
        if done[to[edge]] and length < away[here] - MIN_GAIN_M:
            away[here], bend[here] = length, to[edge]


@njit
def _relax_bends(lattice, edges, order, away, bend):
    """Shorten paths with the turning places of neighbours, starting with the nearest places."""
    start, to, cost = edges.start, edges.to, edges.length_m
    for here in order:
        for edge in range(start[here], start[here + 1]):
            if away[to[edge]] + cost[edge] < away[here] - MIN_GAIN_M:
                away[here], bend[here] = away[to[edge]] + cost[edge], to[edge]
            turn = bend[to[edge]]
            for _ in range(2):
                if turn < 0 or turn == here or turn == bend[here]:
                    break
                if _level_distance(lattice, here, turn) + away[turn] < away[here] - MIN_GAIN_M:
                    length = straight_m(lattice, here, turn) + away[turn]
                    if length < away[here]:
                        away[here], bend[here] = length, turn
                turn = bend[turn]


@njit
def _level_distance(lattice, here, there):
    """Return the horizontal distance between two places."""
    x = lattice.xs_m[lattice.at[here, 0]] - lattice.xs_m[lattice.at[there, 0]]
    z = lattice.zs_m[lattice.at[here, 1]] - lattice.zs_m[lattice.at[there, 1]]
    return np.sqrt(x * x + z * z)
