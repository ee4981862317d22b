"""The walkable graph against a slow reading of the same rules, and a player who walks its paths."""

import math

import numpy as np
import pytest
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from world2minecraft.core.coordinates import block_to_room
from world2minecraft.core.types import AIR, BlockVolume
from world2minecraft.minecraft.physics import BlockWorld, Body, Keys, body_box, step
from world2minecraft.minecraft.physics.collisions import find_overlaps
from world2minecraft.minecraft.physics.shortest_paths import (
    clearance_m,
    connected_parts,
    distances_m,
    reachable,
    shortest_path,
)
from world2minecraft.minecraft.physics.walk_graph import (
    WalkRule,
    is_shut,
    open_all_doors,
    open_door,
    walk_graph,
)

DOOR = "minecraft:oak_door[facing=west,half={half},hinge=left,open=false,powered=false]"
PALETTE = (
    AIR,
    "minecraft:stone",
    "minecraft:oak_slab[type=bottom,waterlogged=false]",
    "minecraft:white_carpet",
    "minecraft:oak_stairs[facing=east,half=bottom,shape=straight,waterlogged=false]",
    "minecraft:oak_fence[east=false,north=false,south=false,west=false,waterlogged=false]",
    "minecraft:water[level=0]",
    DOOR.format(half="lower"),
    DOOR.format(half="upper"),
)  # fmt: skip
STONE, SLAB, CARPET, STAIRS, FENCE, WATER, LOWER, UPPER = range(1, 9)


def volume_of(states, scale=1.0, semantic=None):
    states = np.asarray(states, np.uint16)
    if semantic is None:
        semantic = np.zeros(states.shape, np.uint8)
    return BlockVolume(
        states,
        PALETTE,
        semantic,
        np.zeros(states.shape, np.uint16),
        (-3, 60, 7),
        block_to_room(np.array([0.0, 2.0]), scale),
    )


def hall(x=8, y=5, z=7):
    """A floor without walls."""
    states = np.zeros((x, y, z), np.uint16)
    states[:, 0] = STONE
    return states


def clutter(seed, shape=(9, 7, 8), share=0.12):
    rng = np.random.default_rng(seed)
    states = hall(*shape)
    things = rng.choice([STONE, SLAB, CARPET, STAIRS, FENCE, WATER], shape)
    states[:, 1:] = np.where(rng.random(shape) < share, things, 0)[:, 1:]
    return states


def area(graph, places):
    return set(map(tuple, np.round(graph.feet[places], 6).tolist()))


# What the graph says of each place, read slowly.


def fits(world, feet, scale, top=None):
    """Whether a body's box is free, up to a height where one is told."""
    box = body_box(feet, scale)
    box[4] = box[4] if top is None else top
    boxes = world.near(box[:3] - 1, box[3:] + 1)
    return not find_overlaps(boxes, box, 1e-6).any()


def slow_stands(volume, spacing, scale):
    """Every height of every column at which a body's feet touch something, and its box is free."""
    world = BlockWorld.of_volume(volume)
    found = set()
    wide, _, deep = volume.states.shape
    for x in np.arange(0.5, wide - 0.5 + 1e-9, spacing):
        for z in np.arange(0.5, deep - 0.5 + 1e-9, spacing):
            at = np.add(volume.corner, [x, 0, z])
            box = body_box(tuple(at), scale)
            box[[1, 4]] = -1e6, 1e6
            boxes = world.near(box[:3], box[3:])
            touched = boxes[find_overlaps(boxes, box, 1e-6)]
            for top in set(np.round(touched[:, 4], 6)):
                if fits(world, (at[0], top, at[2]), scale):
                    found.add(
                        (round(float(at[0]), 6), round(float(top), 6), round(float(at[2]), 6))
                    )
    return found


@pytest.mark.parametrize(("seed", "scale"), [(0, 1.0), (2, 2.0), (4, 4.0)])
def test_one_stands_where_a_slow_search_says(seed, scale):
    shape = (7, 6, 6) if scale < 3 else (9, 11, 8)
    states = clutter(seed, shape, 0.12 / scale)
    states[states == WATER] = STONE
    volume = volume_of(states, scale)
    graph = walk_graph(volume)
    assert area(graph, slice(None)) == slow_stands(volume, graph.spacing, scale)


@pytest.mark.parametrize("seed", range(2))
def test_every_step_is_one_a_body_can_take(seed):
    volume = volume_of(clutter(seed, (6, 6, 6)))
    graph, world = walk_graph(volume), BlockWorld.of_volume(volume)
    assert len(graph.edge_to) > 100
    for start, end in zip(graph.feet[graph.edge_from], graph.feet[graph.edge_to], strict=True):
        climb = end[1] - start[1]
        assert -3.0 <= climb <= 0.6
        lift = max(start[1], end[1])
        for x in {start[0], end[0]}:  # All four corners: a diagonal step cuts none.
            for z in {start[2], end[2]}:
                assert fits(world, (x, lift, z), 1.0)


@pytest.mark.parametrize("seed", range(3))
def test_no_step_is_left_out_on_level_ground(seed):
    """Two free places beside each other at one height are always joined, both ways."""
    graph = walk_graph(volume_of(clutter(seed)))
    steps = set(zip(graph.edge_from.tolist(), graph.edge_to.tolist(), strict=True))
    number = {tuple(feet): n for n, feet in enumerate(np.round(graph.feet, 6).tolist())}
    for (x, y, z), n in number.items():
        for other in ((x + graph.spacing, y, z), (x, y, z + graph.spacing)):
            if other in number:
                assert (n, number[other]) in steps and (number[other], n) in steps


def test_turning_the_world_turns_the_graph():
    states = clutter(5)
    states[(states == STAIRS) | (states == FENCE)] = STONE
    volume = volume_of(states)
    turned = volume_of(np.rot90(states, axes=(0, 2)))
    one, other = walk_graph(volume), walk_graph(turned)
    assert len(one) == len(other) and len(one.edge_to) == len(other.edge_to)
    x, y, z = (one.feet - np.array(volume.corner)).T
    # rot90 over (x, z) sends cell (i, k) to (deep - 1 - k, i).
    moved = np.column_stack([states.shape[2] - z, y, x]) + np.array(volume.corner)
    assert area(other, slice(None)) == set(map(tuple, np.round(moved, 6).tolist()))


# Rules.


def test_a_block_is_climbed_by_a_jump_alone():
    states = hall()
    states[4:, 1] = STONE
    volume = volume_of(states)
    low, high = (-2.5, 61.0, 10.5), (3.5, 62.0, 10.5)
    for jump in (False, True):
        graph = walk_graph(volume, WalkRule(jump=jump))
        path = shortest_path(graph, graph.nearest(low), graph.nearest(high))
        assert (path is not None) is jump
        assert shortest_path(graph, graph.nearest(high), graph.nearest(low)) is not None


@pytest.mark.parametrize(("height", "falls"), [(3, True), (4, False)])
def test_one_drops_three_blocks_and_no_more(height, falls):
    states = hall(8, 8, 5)
    states[4:, 1 : 1 + height] = STONE
    graph = walk_graph(volume_of(states))
    high, low = graph.nearest((3.5, 61.0 + height, 9.5)), graph.nearest((-2.5, 61.0, 9.5))
    assert graph.feet[high, 1] == 61 + height
    assert (shortest_path(graph, high, low) is not None) is falls
    assert shortest_path(graph, low, high) is None
    assert connected_parts(graph)[low] == connected_parts(graph)[high] or not falls


def test_doors_are_opened_on_the_way_and_iron_ones_are_not():
    states = hall(9, 4, 5)
    states[4, 1:] = STONE
    states[4, 1:3, 2] = LOWER, UPPER
    volume = volume_of(states)
    ends = (-1.5, 61.0, 9.5), (4.5, 61.0, 9.5)

    def leads(volume, **rule):
        graph = walk_graph(volume, WalkRule(**rule))
        return shortest_path(graph, graph.nearest(ends[0]), graph.nearest(ends[1])) is not None

    assert leads(volume)
    assert not leads(volume, opens_doors=False)
    assert leads(open_all_doors(volume), opens_doors=False)
    iron = tuple(state.replace("oak_door", "iron_door") for state in PALETTE)
    locked = BlockVolume(
        states, iron, volume.semantic, volume.instance, volume.corner, volume.block_to_room
    )
    assert not leads(locked)
    assert is_shut(PALETTE[LOWER]) and not is_shut(open_door(PALETTE[LOWER]))
    assert open_door("minecraft:stone") == "minecraft:stone"


def test_a_one_block_gap_admits_scale_one_and_no_larger():
    states = hall(9, 9, 7)
    states[4, 1:] = STONE
    states[4, 1:, 3] = 0
    for scale, leads in ((1.0, True), (1.5, True), (2.0, False)):
        volume = volume_of(states, scale)
        graph = walk_graph(volume)
        ends = (-1.5, 61, 10.5), (4.5, 61, 10.5)
        path = shortest_path(graph, graph.nearest(ends[0]), graph.nearest(ends[1]))
        assert (path is not None) is leads
        small = walk_graph(volume, WalkRule(scale=1.0))
        assert shortest_path(small, small.nearest(ends[0]), small.nearest(ends[1])) is not None


def test_no_corner_is_cut():
    states = hall(5, 4, 5)
    states[2, 1:3, 2] = STONE
    volume = volume_of(states)
    graph = walk_graph(volume)
    world, level = BlockWorld.of_volume(volume), graph.feet[:, 1] == 61
    for start, end in zip(graph.edge_from, graph.edge_to, strict=True):
        if level[start] and level[end]:
            for share in (0.25, 0.5, 0.75):
                at = graph.feet[start] * (1 - share) + graph.feet[end] * share
                assert fits(world, tuple(at), 1.0)


def test_water_is_no_way_and_furniture_no_ground():
    states = hall(9, 5, 3)
    states[3, 1] = WATER
    states[6, 1] = SLAB
    semantic = np.zeros(states.shape, np.uint8)
    semantic[6, 1] = 7
    volume = volume_of(states, semantic=semantic)
    graph = walk_graph(volume)
    assert not ((graph.feet[:, 0] > -0.3) & (graph.feet[:, 0] < 1.3)).any()
    assert not (graph.feet[:, 1] == 61.5).any()
    assert (walk_graph(volume, WalkRule(on_furniture=True)).feet[:, 1] == 61.5).any()


def test_headroom_and_ground_are_told():
    states = hall(3, 6, 3)
    states[:, 5] = STONE
    semantic = np.zeros(states.shape, np.uint8)
    semantic[:, 0] = 2
    graph = walk_graph(volume_of(states, semantic=semantic))
    inside = graph.feet[:, 1] == 61
    assert (graph.headroom[inside] == 4).all() and (graph.ground[inside] == 2).all()
    assert np.isinf(graph.headroom[~inside]).all() and (graph.feet[~inside, 1] == 66).all()


@pytest.mark.parametrize("states", [np.zeros((4, 4, 4)), np.zeros((0, 0, 0)), np.ones((1, 1, 1))])
def test_worlds_without_much_in_them(states):
    graph = walk_graph(volume_of(states))
    assert len(graph) == int(states.sum()) and len(graph.edge_to) == 0
    assert len(connected_parts(graph)) == len(graph)
    if not len(graph):
        with pytest.raises(ValueError, match="no places to stand"):
            graph.nearest((0, 0, 0))


# Paths.


@pytest.mark.parametrize("seed", range(4))
def test_searches_agree_with_those_of_scipy(seed):
    graph = walk_graph(volume_of(clutter(seed)))
    size = (len(graph), len(graph))
    slow = csr_array((graph.edge_m, graph.edge_to, graph.edge_start), shape=size)
    start = graph.nearest((0, 61, 10))
    away = dijkstra(slow, indices=start)
    np.testing.assert_allclose(distances_m(graph, start), away)
    np.testing.assert_allclose(
        distances_m(graph, start, backward=True), dijkstra(csr_array(slow.T), indices=start)
    )
    np.testing.assert_array_equal(reachable(graph, start), np.isfinite(away))
    rng = np.random.default_rng(seed)
    for goal in rng.choice(len(graph), 20):
        path = shortest_path(graph, start, int(goal))
        if path is None:
            assert np.isinf(away[goal])
            continue
        assert path.length_m == pytest.approx(away[goal])
        assert path.places[0] == start and path.places[-1] == goal


def test_weights_lead_around_what_is_costly():
    graph = walk_graph(volume_of(hall(9, 4, 9)))
    start, goal = graph.nearest((-2.5, 61, 11.5)), graph.nearest((5.5, 61, 11.5))
    x, z = graph.feet[:, 0], graph.feet[:, 2]
    weights = np.where((np.abs(x - 1.5) < 1.1) & (np.abs(z - 11.5) < 2), 50.0, 1.0)
    straight, around = (shortest_path(graph, start, goal, w) for w in (None, weights))
    assert straight is not None and straight.length_m == pytest.approx(8.0)
    assert around is not None and around.length_m > 9.0
    assert (weights[around.places] == 1).all()


def test_distance_to_the_edge_grows_inward():
    graph = walk_graph(volume_of(hall(9, 4, 9)))
    room = clearance_m(graph)
    assert room[graph.nearest((1.5, 61, 11.5))] == pytest.approx(4.0)
    assert room.min() == 0


# A player of the game's physics walks the paths.


def arrives(world, path, scale, jump=False):
    """Walk a path by the keys; whether that leads to its last place within 400 ticks."""
    body = Body(tuple(path.feet[0].tolist()), on_ground=True)
    ahead = 1
    for _ in range(400):
        away = path.feet[ahead] - np.array(body.position)
        is_last = ahead == len(path.feet) - 1
        high = 0.1 if is_last else 0.7
        if math.hypot(away[0], away[2]) < 0.12 * scale and abs(away[1]) < high * scale:
            if is_last:
                return True
            ahead += 1
            away = path.feet[ahead] - np.array(body.position)
        yaw_deg = math.degrees(math.atan2(-away[0], away[2]))
        coasts = 1.3 * math.hypot(body.velocity[0], body.velocity[2])
        up = jump and away[1] > 0.6 * scale
        ahead_key = math.hypot(away[0], away[2]) > coasts
        body = step(world, body, Keys(ahead_key, jump=up, yaw_deg=yaw_deg), scale)
    return False


@pytest.mark.parametrize(("scale", "jump"), [(1.0, False), (1.0, True), (2.0, False)])
def test_a_player_walks_the_paths(scale, jump):
    done = 0
    for seed in range(3):
        shape = (10, 7, 9) if scale == 1 else (14, 9, 12)
        volume = volume_of(clutter(seed, shape, 0.1 / scale), scale)
        graph, world = walk_graph(volume, WalkRule(jump=jump)), BlockWorld.of_volume(volume)
        inside = np.flatnonzero(graph.feet[:, 1] < 63)
        rng = np.random.default_rng(seed)
        for start, goal in rng.choice(inside, (12, 2)):
            path = shortest_path(graph, int(start), int(goal))
            if path is None or len(path.places) < 2:
                continue
            assert arrives(world, path, scale, jump), (seed, path.feet[[0, -1]])
            done += 1
    assert done > 15
