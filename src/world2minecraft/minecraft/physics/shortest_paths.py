"""Shortest paths, distances and reachability in a walkable graph."""

from typing import NamedTuple

import numpy as np

from world2minecraft.core.jit import njit
from world2minecraft.minecraft.physics.walk_graph import WalkGraph


class WalkPath(NamedTuple):
    """A path through a walkable graph, from the first place to the last."""

    places: np.ndarray  # int32 [M], place indices in the graph.
    feet: np.ndarray  # float64 [M, 3], world block coordinates
    length_m: float


def shortest_path(
    graph: WalkGraph, start: int, goal: int, weights: np.ndarray | None = None
) -> WalkPath | None:
    """Return the shortest path between two places, or None if no path exists.

    The path is found with A*.

    Args:
        graph: The walkable graph.
        start: Index of the first place.
        goal: Index of the last place.
        weights: Cost per metre at each place, float64 [N], at least 1. The default is 1.
    """
    target = graph.feet[goal] / graph.blocks_per_metre
    heuristic = np.linalg.norm(graph.feet / graph.blocks_per_metre - target, axis=1) * (1 - 1e-9)
    away, before = _search(
        graph.edge_start, graph.edge_to, _costs(graph, weights), np.array([start]), goal, heuristic
    )
    if not np.isfinite(away[goal]):
        return None
    places = [goal]
    while places[-1] != start:
        places.append(int(before[places[-1]]))
    feet = graph.feet[places[::-1]]
    steps = np.linalg.norm(np.diff(feet, axis=0), axis=1)
    return WalkPath(
        np.array(places[::-1], np.int32), feet, float(steps.sum()) / graph.blocks_per_metre
    )


def distances_m(
    graph: WalkGraph, places: int | np.ndarray, *, backward: bool = False
) -> np.ndarray:
    """Return the distance in metres from the nearest of some places to each place, as float64 [N].

    The distance is infinite if no path exists. With ``backward``, paths lead to the given places
    instead. The results differ if the graph has steps down without a way back.
    """
    ahead = (graph.edge_start, graph.edge_to, graph.edge_m)
    start, to, cost = graph.backward if backward else ahead
    sources = np.atleast_1d(np.asarray(places, np.int64))
    return _search(start, to, cost, sources, -1, np.zeros(len(graph)))[0]


def reachable(graph: WalkGraph, start: int) -> np.ndarray:
    """Return which places can be reached from a place, including the place itself, as bool [N]."""
    return _flood(graph.edge_start, graph.edge_to, start)


def connected_parts(graph: WalkGraph) -> np.ndarray:
    """Return the number of the connected part that each place belongs to, as int32 [N].

    Two places are connected if a step leads from one to the other in at least one direction. Parts
    are numbered in the order of their first places.
    """
    back_start, back_to, _ = graph.backward
    return _label_parts(graph.edge_start, graph.edge_to, back_start, back_to)


def clearance_m(graph: WalkGraph) -> np.ndarray:
    """Return each place's distance in metres to the nearest place at an edge, as float64 [N].

    A place is at an edge if it has fewer than eight neighbours. The distance is infinite if no
    place is at an edge.
    """
    edges = np.flatnonzero(np.diff(graph.edge_start) < 8)
    if not len(edges):
        return np.full(len(graph), np.inf)
    return distances_m(graph, edges)


def _costs(graph: WalkGraph, weights: np.ndarray | None) -> np.ndarray:
    if weights is None:
        return graph.edge_m
    return graph.edge_m * (weights[graph.edge_from] + weights[graph.edge_to]) / 2


@njit
def _search(start, to, cost, sources, goal, heuristic):
    """Return distances and predecessors from a Dijkstra search, or A* if a goal is given."""
    away = np.full(len(start) - 1, np.inf)
    before = np.full(len(start) - 1, -1, np.int32)
    keys, values = (
        np.empty(len(to) + len(sources) + 1),
        np.empty(len(to) + len(sources) + 1, np.int32),
    )
    size = 0
    for source in sources:
        away[source] = 0.0
        size = push(keys, values, size, heuristic[source], source)
    done = np.zeros(len(away), np.bool_)
    while size > 0:
        here = values[0]
        size = pop(keys, values, size)
        if done[here]:
            continue
        done[here] = True
        if here == goal:
            break
        for edge in range(start[here], start[here + 1]):
            there, length = to[edge], away[here] + cost[edge]
            if length < away[there]:
                away[there], before[there] = length, here
                size = push(keys, values, size, length + heuristic[there], there)
    return away, before


@njit
def push(keys, values, size, key, value):
    """Push a value onto a binary heap and return the new size.

    Of values with equal keys, the smaller value is popped first.
    """
    n = size
    while n > 0:
        up = (n - 1) // 2
        if keys[up] < key or (keys[up] == key and values[up] <= value):
            break
        keys[n], values[n] = keys[up], values[up]
        n = up
    keys[n], values[n] = key, value
    return size + 1


@njit
def pop(keys, values, size):
    """Remove the first value from a binary heap and return the new size."""
    size -= 1
    key, value, n = keys[size], values[size], 0
    while 2 * n + 1 < size:
        low = 2 * n + 1
        if low + 1 < size and (
            keys[low + 1] < keys[low]
            or (keys[low + 1] == keys[low] and values[low + 1] < values[low])
        ):
            low += 1
        if key < keys[low] or (key == keys[low] and value <= values[low]):
            break
        keys[n], values[n] = keys[low], values[low]
        n = low
    keys[n], values[n] = key, value
    return size


@njit
def _flood(start, to, first):
    found = np.zeros(len(start) - 1, np.bool_)
    stack = np.empty(len(found), np.int32)
    found[first], stack[0], size = True, first, 1
    while size > 0:
        size -= 1
        here = stack[size]
        for edge in range(start[here], start[here + 1]):
            if not found[to[edge]]:
                found[to[edge]] = True
                stack[size] = to[edge]
                size += 1
    return found


@njit
def _label_parts(start, to, back_start, back_to):
    number = np.full(len(start) - 1, -1, np.int32)
    stack = np.empty(len(number), np.int32)
    count = 0
    for first in range(len(number)):
        if number[first] >= 0:
            continue
        number[first], stack[0], size = count, first, 1
        while size > 0:
            size -= 1
            here = stack[size]
            for n in range(start[here], start[here + 1]):
                if number[to[n]] < 0:
                    number[to[n]] = count
                    stack[size] = to[n]
                    size += 1
            for n in range(back_start[here], back_start[here + 1]):
                if number[back_to[n]] < 0:
                    number[back_to[n]] = count
                    stack[size] = back_to[n]
                    size += 1
        count += 1
    return number
