"""Straight ways on foot against the exact ones among pillars, and against all pairs of places."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse.csgraph import dijkstra

from world2minecraft.core.coordinates import block_to_room
from world2minecraft.core.types import AIR, BlockVolume
from world2minecraft.minecraft.physics.any_angle_paths import (
    build_lattice,
    straight_distances_m,
    straight_m,
)
from world2minecraft.minecraft.physics.shortest_paths import distances_m
from world2minecraft.minecraft.physics.walk_graph import WalkRule, walk_graph

SIDE = 7
SCALE = 4  # Blocks a metre of the floor with pillars, as builds have it by default.
HALF = 0.3 * SCALE
PALETTE = (AIR, "minecraft:stone", "minecraft:oak_slab[type=bottom,waterlogged=false]")


def floor_with(pillars=(), slabs=()):
    """A floor of stone, pillars two blocks high and slabs on it; feet are at y = 1."""
    states = np.zeros((SIDE, 4, SIDE), np.uint16)
    states[:, 0] = 1
    for x, z in slabs:
        states[x, 1, z] = 2
    for x, z in pillars:
        states[x, 1:3, z] = 1
    return volume_of(states)


def volume_of(states, scale=1):
    none = np.zeros(states.shape, np.uint16)
    to_room = block_to_room(np.zeros(2), float(scale))
    return BlockVolume(states, PALETTE, none.astype(np.uint8), none, (0, 0, 0), to_room)


def crosses(a, b, low, high):
    """Whether a segment has a point strictly within a box (Liang and Barsky)."""
    begin, end = 0.0, 1.0
    for axis in range(2):
        step = b[axis] - a[axis]
        if abs(step) < 1e-12:
            if not low[axis] + 1e-9 < a[axis] < high[axis] - 1e-9:
                return False
            continue
        ends = sorted(((low[axis] - a[axis]) / step, (high[axis] - a[axis]) / step))
        begin, end = max(begin, ends[0]), min(end, ends[1])
    return begin < end - 1e-9


def exact_m(pillars, starts, goal, wide):
    """The shortest ways of a square body among pillars: bends are at corners of grown pillars."""
    boxes = [
        (np.array([x, z]) - HALF + 1e-6, np.array([x, z]) + 1 + HALF - 1e-6) for x, z in pillars
    ]
    corners = [
        np.array([box[i][0], box[k][1]]) for box in boxes for i in (0, 1) for k in (0, 1)
    ]  # fmt: skip
    inside = [one for one in corners if (one >= 0.5).all() and (one <= wide - 0.5).all()]
    points = [goal, *inside, *starts]
    ways = np.zeros((len(points), len(points)))
    for (i, a), (k, b) in itertools.combinations(enumerate(points), 2):
        if not any(crosses(a, b, *box) for box in boxes):
            ways[i, k] = ways[k, i] = max(np.linalg.norm(b - a), 1e-6)
    return dijkstra(ways, indices=0)[-len(starts) :]


@pytest.mark.parametrize("seed", range(6))
def test_ways_are_nearly_the_exact_ones(seed):
    rng = np.random.default_rng(seed)
    wide = 5 * SCALE
    pillars = [(int(x), int(z)) for x, z in rng.integers(0, wide, (3 + seed, 2))]
    states = np.zeros((wide, 9, wide), np.uint16)
    states[:, 0] = 1
    for x, z in pillars:
        states[x, 1:, z] = 1
    graph = walk_graph(volume_of(states, SCALE), WalkRule(at_corners=True))
    low = np.flatnonzero(graph.feet[:, 1] == 1)
    goal = int(rng.choice(low))
    away, _ = straight_distances_m(graph, build_lattice(graph), goal)
    some = rng.choice(low[low != goal], 60)
    flat = graph.feet[:, [0, 2]]
    slow = exact_m(pillars, list(flat[some]), flat[goal], wide) / SCALE
    told = np.isfinite(away[some])
    assert (away[some] >= slow - 1e-5).all() and told.mean() > 0.5
    longer = away[some][told] / slow[told]
    assert longer.max() < 1.02 and longer.mean() < 1.002


def test_with_nothing_in_the_way_ways_are_straight_lines():
    graph = walk_graph(floor_with())
    goal = graph.nearest((2.0, 1.0, 3.0))
    away, bend = straight_distances_m(graph, build_lattice(graph), goal)
    np.testing.assert_allclose(away, np.linalg.norm(graph.feet - graph.feet[goal], axis=1))
    assert (bend[bend] == goal).all()  # Some lie on a line with a place between.


pairs = st.tuples(st.integers(0, SIDE - 1), st.integers(0, SIDE - 1))


@settings(max_examples=10)
@given(pillars=st.lists(pairs, max_size=8), slabs=st.lists(pairs, max_size=8), goal=st.integers(0))
def test_no_pair_of_places_is_joined_shorter(pillars, slabs, goal):
    graph = walk_graph(floor_with(pillars, slabs))
    goal %= len(graph)
    lattice = build_lattice(graph)
    away, bend = straight_distances_m(graph, lattice, goal)
    eight = distances_m(graph, goal, backward=True)
    np.testing.assert_array_equal(np.isfinite(away), np.isfinite(eight))
    ends = np.isfinite(away)
    assert (away[ends] <= eight[ends] + 1e-9).all()
    assert (eight[ends] <= away[ends] * 1.0824 + 1e-9).all()  # An octagon holds its circle.
    for place in np.flatnonzero(ends)[::7]:
        way, length = int(place), 0.0
        while way != goal:
            to = int(bend[way])
            seen = straight_m(lattice, way, to)
            steps = graph.edge_to[graph.edge_start[way] : graph.edge_start[way + 1]]
            own = graph.edge_m[graph.edge_start[way] : graph.edge_start[way + 1]][steps == to]
            length += min(seen, own.min(initial=np.inf))
            way = to
        assert length <= away[place] + 1e-9


def test_ways_there_and_back_are_as_long_where_nothing_drops():
    graph = walk_graph(floor_with([(3, 2), (3, 3), (3, 4), (5, 1)]))
    lattice = build_lattice(graph)
    rng = np.random.default_rng(2)
    for a, b in rng.integers(0, len(graph), (200, 2)):
        assert straight_m(lattice, a, b) == pytest.approx(straight_m(lattice, b, a))


def test_a_way_over_a_slab_counts_its_height():
    graph = walk_graph(floor_with(slabs=[(3, z) for z in range(SIDE)]))
    away, _ = straight_distances_m(graph, build_lattice(graph), graph.nearest((0.5, 1.0, 0.5)))
    over = graph.nearest((6.5, 1.0, 0.5))
    assert away[over] == pytest.approx(6.0 - 2 * 0.25 + 2 * np.hypot(0.25, 0.5))


def test_one_drops_but_does_not_come_back():
    states = np.array(floor_with().states)
    states[:3, 1:3] = 1
    graph = walk_graph(volume_of(states))
    high, low = graph.nearest((0.5, 3.0, 3.5)), graph.nearest((6.5, 1.0, 3.5))
    lattice = build_lattice(graph)
    assert np.isinf(straight_m(lattice, high, low))
    down, _ = straight_distances_m(graph, lattice, low)
    up, _ = straight_distances_m(graph, lattice, high)
    assert 6 < down[high] < 8.5 and np.isinf(up[low])
