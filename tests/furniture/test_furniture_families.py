"""What each design is in blocks: it stays, the game knows it, and it is what its name says."""

from functools import cache

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.furniture import TEMPLATES, check_template, template
from world2minecraft.furniture.block_designs import block_size
from world2minecraft.furniture.families.fronts import MAX_REST, body_of, door_columns
from world2minecraft.furniture.family import FAMILIES
from world2minecraft.furniture.preview_scene import preview_volume
from world2minecraft.minecraft.block_states import check_state, parse_state
from world2minecraft.minecraft.collision_shapes import is_full_cube
from world2minecraft.minecraft.rules.stability import find_unstable
from world2minecraft.minecraft.visual_shapes import is_luminous

SCALES = (1.0, 2.0, 4.0)
MINE = ("bath", "cases", "decor", "greenery", "hangings", "kitchen", "lights", "shelving")


def _module(name):
    return FAMILIES.load(template(name).family).design.__module__.rpartition(".")[2]


NAMES = tuple(name for name in TEMPLATES.names() if _module(name) in MINE)
each_design = pytest.mark.parametrize("name", NAMES)


@cache
def built(name, scale, column=1):
    """A design on a floor, against a wall or under a ceiling, at one end of its sizes."""
    one = template(name)
    return preview_volume(one, scale, tuple(span[column] for span in one.size_m))


def states_of(name, scale):
    """The states of a design, each as often as it stands there."""
    one = template(name)
    return [block.state for block in one.blocks(block_size(np.array(one.typical_m), scale))]


def blocks_named(name, scale, *words):
    return [state for state in states_of(name, scale) if any(word in state for word in words)]


@each_design
def test_a_design_is_sound(name):
    assert check_template(template(name)) == ()


@each_design
def test_every_block_stays_where_it_is(name):
    for scale in SCALES:
        for column in range(3):
            assert find_unstable(built(name, scale, column)) == []


@each_design
def test_the_game_knows_every_state(name):
    for scale in SCALES:
        for state in built(name, scale).palette:
            check_state(parse_state(state))


@each_design
def test_a_turned_design_stays_too(name):
    for turns in (1, 2, 3):
        assert find_unstable(preview_volume(template(name), 4.0, quarter_turns=turns)) == []


@each_design
def test_a_larger_one_is_never_smaller_in_blocks(name):
    for scale in SCALES:
        small, large = (built(name, scale, column).states.shape for column in (0, 2))
        assert all(a <= b for a, b in zip(small, large, strict=True))


def test_there_are_many_designs_of_every_kind():
    assert len(NAMES) >= 45
    assert {_module(name) for name in NAMES} == set(MINE)


@given(st.floats(0.05, 40.0), st.sampled_from(SCALES))
def test_fronts_stand_before_the_body_and_within_the_size(depth, scale):
    size = block_size(np.array([depth, 1.0, 1.0]) / scale, scale)
    body = body_of(size)
    assert 1 <= body.depth <= size.depth and body.front in (None, body.depth)
    assert abs(body.depth - depth) <= max(MAX_REST, 1 - depth) + 1e-6
    assert body.front is not None or scale == 1.0


@given(st.integers(1, 40), st.sampled_from([1.0, 2.0, 4.0]))
def test_each_door_has_one_handle(width, scale):
    columns = door_columns(width, scale)
    assert columns == sorted(set(columns))
    assert columns and columns[0] >= 0 and columns[-1] < width


@pytest.mark.parametrize("name", [name for name in NAMES if _module(name) == "lights"])
def test_every_lamp_gives_light_at_every_scale(name):
    for scale in SCALES:
        assert any(map(is_luminous, states_of(name, scale)))


@pytest.mark.parametrize("name", [name for name in NAMES if _module(name) == "greenery"])
def test_leaves_stay_without_a_tree(name):
    for scale in SCALES:
        leaves = blocks_named(name, scale, "_leaves[")
        assert all("persistent=true" in state for state in leaves)


@pytest.mark.parametrize("name", [name for name in NAMES if name.startswith("rug")])
def test_a_rug_is_carpet_and_nothing_else(name):
    for scale in SCALES:
        assert {parse_state(s).name.rpartition("_")[2] for s in states_of(name, scale)} == {
            "carpet"
        }


@pytest.mark.parametrize("name", ["sink_unit", "vanity"])
def test_a_sink_holds_water(name):
    for scale in SCALES:
        assert blocks_named(name, scale, "water_cauldron[level=3]")


@pytest.mark.parametrize("scale", [2.0, 4.0])
def test_a_worktop_lies_over_all_of_a_counter(scale):
    one = template("counter")
    blocks = one.blocks(block_size(np.array(one.typical_m), scale))
    top = max(block.cell[2] for block in blocks)
    over = {block.cell[:2] for block in blocks if block.role == "body"}
    assert over == {block.cell[:2] for block in blocks if block.cell[2] == top}
    handles = [block for block in blocks if block.role == "handle"]
    assert handles and all(block.cell[:2] not in over for block in handles)


def test_doors_open_to_the_front_alone():
    for name in ("cabinet", "fridge", "stove", "washing_machine", "chest_of_drawers"):
        for scale in SCALES:
            for state in states_of(name, scale):
                facing = parse_state(state).get("facing", "east")
                assert facing == "east" or "stairs" in state


def test_an_open_curtain_leaves_the_window_free():
    one = template("curtain")
    blocks = one.blocks(block_size(np.array(one.typical_m), 4.0))
    cloth = {block.cell[1] for block in blocks if block.role == "cloth"}
    wide = {block.cell[1] for block in blocks}
    assert 0 < len(cloth) < len(wide) and {min(wide), max(wide)} <= cloth


def test_a_red_counter_keeps_full_blocks_for_its_fronts():
    """Full blocks alone exist in clear colours, so a body is of no other shape."""
    for name in ("counter", "cabinet", "wall_cabinet", "fridge", "dishwasher"):
        for scale in SCALES:
            one = template(name)
            for block in one.blocks(block_size(np.array(one.typical_m), scale)):
                if block.role == "body":
                    assert is_full_cube(block.state)
