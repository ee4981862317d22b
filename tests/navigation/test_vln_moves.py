"""Discrete moves and the oracle: laws of bodies and turns, and ways that are walked."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.core.coordinates import block_to_room
from world2minecraft.core.errors import UnknownNameError
from world2minecraft.core.types import AIR, BlockVolume
from world2minecraft.minecraft.physics import BlockWorld, body_box
from world2minecraft.minecraft.physics.collisions import find_overlaps
from world2minecraft.minecraft.physics.walk_graph import collision_grid
from world2minecraft.navigation.moves import (
    BodySize,
    apply_move,
    forward_blocks,
    get_move_set,
    move_body,
    wrap_yaw,
)
from world2minecraft.navigation.oracle import plan_expert_path
from world2minecraft.navigation.types import MOVE_SETS, Move, Stance

SIZE = BodySize(0.3, 1.8, 0.6, 3.0)
PALETTE = (
    AIR,
    "minecraft:stone",
    "minecraft:oak_slab[type=bottom,waterlogged=false]",
    "minecraft:oak_fence[east=false,north=false,south=false,west=false,waterlogged=false]",
)
STONE, SLAB, FENCE = 1, 2, 3


def volume_of(states, semantic=None):
    classes = np.zeros(states.shape, np.uint8) if semantic is None else semantic
    none = np.zeros(states.shape, np.uint16)
    to_room = block_to_room(np.zeros(2), 1.0)
    return BlockVolume(states, PALETTE, classes, none, (-2, 60, 3), to_room)


def floor_with(*blocks, holes=(), semantic=None):
    """A floor of 9 x 9 with blocks on it; its feet are at 61, x from -2 and z from 3."""
    states = np.zeros((9, 6, 9), np.uint16)
    states[:, 0] = STONE
    for (x, y, z), block in blocks:
        states[x, y, z] = block
    for x, z in holes:
        states[x, 0, z] = 0
    return volume_of(states, semantic)


def walk(volume, begin, way, sliding=False):
    corner = np.array(volume.corner, np.int64)
    feet = tuple(float(a + b) for a, b in zip(begin, volume.corner, strict=True))
    x, y, z, stopped = move_body(collision_grid(volume), corner, *feet, *way, SIZE, sliding)
    return tuple(
        round(float(a - b), 6) for a, b in zip((x, y, z), volume.corner, strict=True)
    ), stopped


@pytest.mark.parametrize(
    ("blocks", "holes", "way", "end", "stopped"),
    [
        ((), (), (2.0, 0.0), (6.5, 1.0, 4.5), False),
        ((((6, 1, 4), STONE),), (), (2.0, 0.0), (4.5, 1.0, 4.5), True),  # A wall: one stays.
        ((((6, 1, 4), SLAB),), (), (2.0, 0.0), (6.5, 1.5, 4.5), False),  # A slab is a step up.
        ((((6, 1, 4), FENCE),), (), (2.0, 0.0), (4.5, 1.0, 4.5), True),
        ((((6, 3, 4), STONE),), (), (2.0, 0.0), (6.5, 1.0, 4.5), False),  # Over one's head.
        ((((6, 2, 4), STONE),), (), (2.0, 0.0), (4.5, 1.0, 4.5), True),  # At one's head.
        ((), [(6, z) for z in range(9)], (2.0, 0.0), (4.5, 1.0, 4.5), True),  # An abyss.
    ],
)
def test_a_way_ends_where_the_rules_say(blocks, holes, way, end, stopped):
    assert walk(floor_with(*blocks, holes=holes), (4.5, 1.0, 4.5), way) == (end, stopped)


def test_one_steps_down_and_not_onto_furniture():
    states = np.zeros((9, 6, 9), np.uint16)
    states[:, 0], states[:5, 1] = STONE, STONE
    assert walk(volume_of(states), (4.4, 2.0, 4.5), (2.0, 0.0)) == ((6.4, 1.0, 4.5), False)
    semantic = np.zeros((9, 6, 9), np.uint8)
    semantic[6, 1, 4] = 7  # A sofa as high as a slab.
    sofa = floor_with(((6, 1, 4), SLAB), semantic=semantic)
    assert walk(sofa, (4.5, 1.0, 4.5), (2.0, 0.0)) == ((4.5, 1.0, 4.5), True)


def test_one_who_slides_goes_on_along_the_wall():
    wall = floor_with(*[((6, y, z), STONE) for y in (1, 2) for z in range(9)])
    (x, y, z), stopped = walk(wall, (4.5, 1.0, 2.5), (2.0, 2.0), sliding=True)
    assert stopped and y == 1.0 and z == pytest.approx(4.5)
    assert 5.5 < x <= 5.7 + 1e-6  # The wall begins at 6, and half a body is 0.3.


places = st.tuples(st.integers(0, 8), st.integers(1, 3), st.integers(0, 8))


@given(
    blocks=st.lists(st.tuples(places, st.integers(1, 3)), max_size=12),
    angle=st.floats(0, 2 * math.pi),
    length=st.floats(0.05, 2.0),
    sliding=st.booleans(),
)
def test_a_body_never_ends_in_a_block_nor_in_the_air(blocks, angle, length, sliding):
    volume = floor_with(*(one for one in blocks if one[0][:1] != (4,) or one[0][2] != 4))
    world = BlockWorld.of_volume(volume)
    begin = np.add((4.5, 1.0, 4.5), volume.corner)
    boxes = world.near(begin - 6, begin + 6)
    if find_overlaps(boxes, body_box(tuple(begin))).any():
        return
    way = (length * math.cos(angle), length * math.sin(angle))
    end, stopped = walk(volume, (4.5, 1.0, 4.5), way, sliding)
    box = body_box(tuple(np.add(end, volume.corner)))
    assert not find_overlaps(boxes, box, 1e-5).any()
    below = box - np.array([0, 1e-3, 0, 0, 1e-3, 0])
    assert find_overlaps(boxes, below, 1e-5).any()
    gone = math.hypot(end[0] - 4.5, end[2] - 4.5)
    assert gone == pytest.approx(length, abs=1e-5) if not stopped else gone <= length + 1e-6
    if stopped and not sliding:
        assert end == (4.5, 1.0, 4.5)


@given(st.lists(st.sampled_from([Move.LEFT, Move.RIGHT]), max_size=60), st.floats(-180, 179.9))
def test_turns_there_and_back_are_exact(flat, turns, yaw_deg):
    begin = Stance(3.0, 65.0, 3.0, wrap_yaw(yaw_deg))
    stance = begin
    back = [Move.LEFT if turn == Move.RIGHT else Move.RIGHT for turn in turns]
    for turn in turns + back[::-1]:
        stance, collided = apply_move(flat, stance, turn)
        assert not collided and -180 <= stance.yaw_deg < 180
    assert stance == begin


def test_left_is_counter_clockwise_from_above(flat):
    south = Stance(3.0, 65.0, 3.0, 0.0)  # Left of one who looks south, to +z, is east, +x.
    stance, _ = apply_move(flat, south, Move.LEFT, "block")
    ahead, collided = apply_move(flat, stance, Move.FORWARD, "block")
    assert not collided and ahead.feet == pytest.approx((4.0, 65.0, 3.0))
    assert apply_move(flat, south, Move.STOP) == (south, False)


def test_a_step_has_the_length_of_its_set(flat):
    lengths = {name: forward_blocks(flat, get_move_set(name)) for name in MOVE_SETS}
    assert lengths == {"vlnce": 0.5, "rxr": 0.5, "block": 1.0, "macro": 0.5}
    with pytest.raises(UnknownNameError, match="no move set is named 'vlncee'; did you mean"):
        get_move_set("vlncee")


def test_one_ends_before_a_wall(flat):
    stance, steps = Stance(3.0, 65.0, 3.0, 90.0), 0  # Looks west; the wall's face is at x = 1.
    while True:
        stance, collided = apply_move(flat, stance, Move.FORWARD)
        if collided:
            break
        steps += 1
    assert steps == 2 and stance.x == pytest.approx(2.0)  # Half the body is 0.6.


@pytest.mark.parametrize("move_set", ["vlnce", "rxr", "block"])
def test_the_oracle_comes_to_every_thing_from_everywhere(flat, move_set):
    rng = np.random.default_rng(3)
    shares = []
    for landmark in flat.landmarks:
        goals = flat.goals_at(landmark)
        for place in rng.choice(flat.main_places, 8):
            x, y, z = flat.graph.feet[place].tolist()
            stance = Stance(x, y, z, 90.0 * float(rng.integers(4)) - 180)
            way = plan_expert_path(flat, stance, goals, move_set)
            if way is None and move_set == "block":
                continue  # Steps of a block may miss a doorway of two.
            assert way is not None and way.moves[-1] == Move.STOP
            assert len(way.stances) == len(way.moves)
            assert flat.distance_m(way.stances[-1].feet, goals) < 0.5
            shortest = flat.distance_m(stance.feet, goals)
            if shortest > 1:
                shares.append(shortest / max(shortest, way.length_m))
    assert np.mean(shares) >= (0.8 if move_set == "block" else 0.95)


def test_the_expert_path_is_the_same_from_any_of_its_places(flat):
    goals = flat.goals_at(flat.landmark("piano"))
    way = plan_expert_path(flat, flat.start, goals)
    assert way is not None and way == plan_expert_path(flat, flat.start, goals)
    stance, steps = flat.start, 0
    while (move := plan_expert_path(flat, stance, goals).moves[0]) != Move.STOP:
        stance, collided = apply_move(flat, stance, move)
        steps += 1
        assert not collided and steps < 2 * len(way.moves)
    assert flat.distance_m(stance.feet, goals) <= 0.25


def test_the_oracle_looks_at_what_it_went_to(flat):
    piano = flat.landmark("piano")
    middle = (15.5, 66.0, 8.0)
    way = plan_expert_path(flat, flat.start, flat.goals_at(piano), facing=middle)
    assert way is not None and len(way.stances) == len(way.moves)
    last = way.stances[-1]
    wanted = math.degrees(math.atan2(-(middle[0] - last.x), middle[2] - last.z))
    assert abs(wrap_yaw(wanted - last.yaw_deg)) <= 7.5 + 1e-6


def test_where_no_way_leads_the_oracle_says_so(flat):
    roof = [tuple(flat.graph.feet[flat.graph.feet[:, 1].argmax()].tolist())]
    assert plan_expert_path(flat, flat.start, roof) is None
