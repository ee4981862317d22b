"""The game's measured constants, laws of moving boxes, and the walks written down."""

import json
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.minecraft.physics.golden_cases import CASES, FLAGS, GOLDEN, crowd, walked

from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraft.physics import (
    TICKS_PER_S,
    BlockWorld,
    Body,
    BoxWorld,
    Keys,
    body_box,
    eye_height,
    find_standing_place,
    step,
)
from world2minecraft.minecraft.physics.collisions import find_overlaps, free_distance

PLAIN = BoxWorld([[-1e4, -1, -1e4, 1e4, 0, 1e4]])
STANDING = Body((0.0, 0.0, 0.0), on_ground=True)


def run(world, body, ticks, scale=1.0, **keys):
    bodies = [body]
    for _ in range(ticks):
        bodies.append(step(world, bodies[-1], Keys(**keys), scale))
    return bodies


@pytest.mark.parametrize(
    ("keys", "blocks_a_second"),
    [
        ({"forward": True}, 4.3172),
        ({"forward": True, "sprint": True}, 5.6123),
        ({"forward": True, "sneak": True}, 1.2952),
    ],
)
def test_speeds_are_those_of_the_game(keys, blocks_a_second):
    bodies = run(PLAIN, STANDING, 100, **keys)
    speed = (bodies[100].position[2] - bodies[80].position[2]) / 20 * TICKS_PER_S
    assert speed == pytest.approx(blocks_a_second, abs=5e-5)


def test_a_jump_is_as_high_and_as_long_as_in_the_game():
    first = step(PLAIN, STANDING, Keys(jump=True))
    heights = [body.position[1] for body in [STANDING, first, *run(PLAIN, first, 14)[1:]]]
    assert max(heights) == pytest.approx(1.2522, abs=5e-5)
    assert int(np.argmax(heights)) == 6
    assert next(tick for tick in range(1, 20) if heights[tick] == 0) == 12


def test_a_block_from_rest_takes_six_ticks():
    gone = [body.position[2] for body in run(PLAIN, STANDING, 8, forward=True)]
    assert gone[5] < 1 <= gone[6]


def test_one_looks_where_the_games_yaw_says():
    ways = {0: (0, 1), 90: (-1, 0), 180: (0, -1), -90: (1, 0)}
    for yaw, way in ways.items():
        x, _, z = run(PLAIN, STANDING, 10, forward=True, yaw_deg=float(yaw))[-1].position
        assert np.round(np.array([x, z]) / math.hypot(x, z), 9).tolist() == list(way)


def test_left_is_left_of_forward():
    x, _, z = run(PLAIN, STANDING, 10, left=True)[-1].position
    assert x > 1 and abs(z) < 1e-9  # Looking south, east is to the left.


def test_steps_up_to_0_6_are_climbed_and_higher_ones_not():
    for height, gets_up in ((0.5, True), (0.6, True), (0.61, False)):
        world = BoxWorld([[-9, -1, -9, 9, 0, 9], [-1, 0, 1, 1, height, 9]])
        assert (run(world, STANDING, 40, forward=True)[-1].position[1] == height) == gets_up


def test_a_jump_gets_up_one_block_and_not_a_fence():
    for height, gets_up in ((1.0, True), (1.5, False)):
        world = BoxWorld([[-9, -1, -9, 9, 0, 9], [-9, 0, 1, 9, height, 9]])
        body = run(world, STANDING, 60, forward=True, jump=True)[-1]
        assert (body.position[2] > 2) == gets_up


def test_one_who_sneaks_does_not_fall():
    world = BoxWorld([[-1, -1, -1, 1, 0, 1]])
    body = run(world, STANDING, 200, forward=True, sneak=True, yaw_deg=30.0)[-1]
    assert body.position[1] == 0 and body.on_ground
    assert run(world, STANDING, 200, forward=True, yaw_deg=30.0)[-1].position[1] < -5


def test_a_body_is_of_plain_values():
    body = step(PLAIN, STANDING, Keys(forward=True, sneak=True))
    told = [body.on_ground, body.crouched, body.hit_wall]
    assert [type(one) for one in told] == [bool] * 3
    assert {type(value) for value in (*body.position, *body.velocity)} == {float}


def test_eyes_are_where_the_game_has_them():
    assert eye_height(STANDING) == 1.62
    assert eye_height(STANDING._replace(crouched=True), 4.0) == pytest.approx(5.08)


keys_drawn = st.builds(
    Keys,
    **dict.fromkeys(FLAGS, st.booleans()),
    yaw_deg=st.floats(-180, 180, allow_nan=False),
)


@given(st.integers(0, 30), st.lists(keys_drawn, min_size=1, max_size=60))
def test_a_body_never_enters_a_box(seed, held):
    boxes = np.array([[-20, -1, -20, 20, 0, 20], *crowd(seed)])
    world, body = BoxWorld(boxes), STANDING
    for keys in held:
        body = step(world, body, keys)
        box = body_box(body.position, crouched=body.crouched)
        assert not find_overlaps(boxes, box, 1e-6).any()
        assert body.position[1] >= -1e-9


@given(st.integers(0, 5), st.lists(keys_drawn, min_size=1, max_size=40))
def test_a_world_as_many_times_larger_is_walked_alike(seed, held):
    boxes = np.array([[-20, -1, -20, 20, 0, 20], *crowd(seed)])
    small, large = STANDING, STANDING
    for keys in held:
        small = step(BoxWorld(boxes), small, keys)
        large = step(BoxWorld(boxes * 4), large, keys, 4.0)
        assert np.allclose(np.array(large.position), np.array(small.position) * 4, atol=1e-6)


@given(
    st.lists(st.lists(st.floats(-3, 3), min_size=6, max_size=6), max_size=8),
    st.sampled_from([0, 1, 2]),
    st.floats(-2, 2),
)
def test_a_free_way_is_the_longest_of_many_small_moves(corners, axis, way):
    """A slow twin: move by a thousandth of the way as long as nothing is entered."""
    pairs = np.array(corners).reshape(-1, 2, 3)
    boxes = np.concatenate([pairs.min(axis=1), pairs.max(axis=1)], axis=1)
    box = np.array([-0.3, 0.0, -0.3, 0.3, 1.8, 0.3])
    boxes = boxes[~find_overlaps(boxes, box, 0.0) & (boxes[:, 3:] - boxes[:, :3] > 0.1).all(axis=1)]
    moved, small = 0.0, way / 1000
    for _ in range(1000 if way else 0):
        ahead = box.copy()
        ahead[[axis, 3 + axis]] += moved + small
        if find_overlaps(boxes, ahead).any():
            break
        moved += small
    assert free_distance(boxes, box, axis, way) == pytest.approx(
        moved, abs=abs(small) * 1.01 + 1e-6
    )


def test_the_golden_walks_are_walked_so():
    golden = json.loads(GOLDEN.read_text())
    assert [one["name"] for one in golden] == [one["name"] for one in CASES]
    for one, told in zip(CASES, golden, strict=True):
        assert {**told, "path": None} == {**one, "path": None}, "run golden_cases.py"
        assert np.allclose(walked(one), told["path"], rtol=0, atol=1e-8), one["name"]


def volume_of(palette, cells, shape=(5, 4, 5), corner=(0, 64, 0)):
    states = np.zeros(shape, np.uint16)
    for cell, row in cells.items():
        states[cell] = row
    zeros = np.zeros(shape, np.uint8)
    return BlockVolume(states, palette, zeros, zeros.astype(np.uint16), corner, np.eye(4))


def test_the_boxes_of_blocks_are_in_world_coordinates():
    palette = ("minecraft:air", "minecraft:stone", "minecraft:oak_fence", "minecraft:light")
    volume = volume_of(palette, {(1, 0, 2): 1, (1, 1, 2): 2, (3, 0, 3): 3})
    world = BlockWorld.of_volume(volume)
    found = world.near(np.array([1.1, 66.2, 2.1]), np.array([1.9, 67, 2.9]))
    assert found.tolist() == [[1.375, 65, 2.375, 1.625, 66.5, 2.625]]  # A fence is 1.5 high.
    found = world.near(np.array([-50, 0, -50]), np.array([50, 99, 50]))
    assert found[0].tolist() == [1, 64, 2, 2, 65, 3]
    assert len(found) == 2, "invisible light is walked through"


def test_cells_walk_like_their_boxes():
    solid = np.zeros((6, 4, 6), bool)
    solid[:, 0] = True
    solid[:, 1, 4] = True
    boxes = [[0, 0, 0, 6, 1, 6], [0, 1, 4, 6, 2, 5]]
    start = Body((3.0, 1.0, 1.0))
    one = run(BlockWorld.of_cells(solid), start, 30, forward=True)[-1]
    two = run(BoxWorld(boxes), start, 30, forward=True)[-1]
    assert np.allclose(one.position, two.position, atol=1e-12)


def test_one_begins_where_one_fits():
    world = BoxWorld([[-9, -1, -9, 9, 0, 9], [-1, 0, -1, 1, 3, 1]])
    x, y, z = find_standing_place(world, (0.9, 0.0, 0.0))
    assert y == 0
    assert not find_overlaps(world.boxes, body_box((x, y, z))).any()
    assert math.hypot(x - 0.9, z) < 0.8


def test_one_begins_upon_what_is_there():
    world = BoxWorld([[-9, -1, -9, 9, 0.25, 9]])
    assert find_standing_place(world, (2.0, 0.0, 2.0)) == (2.0, 0.25, 2.0)


def test_one_begins_where_one_was_put_when_nothing_is_free():
    assert find_standing_place(BoxWorld([]), (1.0, 2.0, 3.0)) == (1.0, 2.0, 3.0)
    solid = BoxWorld([[-99, -99, -99, 99, 99, 99]])
    assert find_standing_place(solid, (1.0, 2.0, 3.0)) == (1.0, 2.0, 3.0)
