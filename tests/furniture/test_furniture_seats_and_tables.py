"""Seats, beds, tables and screens in blocks: they stay, and they are what their names say."""

from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from world2minecraft.furniture import TEMPLATES, template
from world2minecraft.furniture.block_designs import block_size
from world2minecraft.furniture.family import FAMILIES
from world2minecraft.furniture.preview_scene import preview_volume
from world2minecraft.minecraft.block_states import check_state, parse_state
from world2minecraft.minecraft.rules.stability import find_unstable
from world2minecraft.minecraft.visual_shapes import visual_boxes

SCALES = (1.0, 2.0, 4.0)
MINE = ("chairs", "sofas", "beds", "tables", "screens")


def _module(name):
    return FAMILIES.load(template(name).family).design.__module__.rpartition(".")[2]


NAMES = tuple(name for name in TEMPLATES.names() if _module(name) in MINE)
each_design = pytest.mark.parametrize("name", NAMES)


@cache
def blocks_of(name, scale, size_m=None, **parameters):
    one = template(name)
    return one.blocks(block_size(np.array(size_m or one.typical_m), scale), parameters)


def _top(name, scale, size_m=None):
    """Return how high a design reaches, in blocks, as it is seen."""
    return max(
        block.cell[2] + visual_boxes(block.state)[:, 4].max()
        for block in blocks_of(name, scale, size_m)
    )


def test_there_are_many_of_them():
    assert len(NAMES) >= 60
    kinds = {template(name).class_id for name in NAMES}
    assert len(kinds) == 5


@each_design
def test_every_block_stays_where_it_is(name):
    one = template(name)
    for scale in SCALES:
        for column in range(3):
            volume = preview_volume(one, scale, tuple(span[column] for span in one.size_m))
            assert find_unstable(volume) == []


@each_design
def test_the_game_knows_every_state_and_no_cell_is_filled_twice(name):
    for scale in SCALES:
        blocks = blocks_of(name, scale)
        assert blocks
        for block in blocks:
            check_state(parse_state(block.state))
        cells = [block.cell for block in blocks]
        assert len(set(cells)) == len(cells)
        assert {block.role for block in blocks} <= set(template(name).materials)


@settings(max_examples=30)
@given(st.sampled_from(NAMES), st.tuples(*[st.floats(0, 1)] * 3), st.floats(0.5, 5.9))
def test_any_size_and_scale_has_blocks_near_its_box(name, shares, scale):
    spans = template(name).size_m
    size_m = [a + (b - a) * share for (a, _, b), share in zip(spans, shares, strict=True)]
    size = block_size(np.array(size_m), scale)
    cells = np.array([block.cell for block in template(name).blocks(size)])
    assert (cells >= 0).all()
    assert (cells.max(axis=0)[:2] < (size.depth, size.width)).all() or size.depth == 1
    assert cells[:, 2].max() <= size.height + 1
    assert cells[:, 2].min() == 0


@pytest.mark.parametrize("name", ["chair", "chair_white", "office_chair", "armchair", "sofa"])
@pytest.mark.parametrize("scale", [2.0, 4.0])
def test_a_seat_is_lower_than_its_back_and_looks_to_the_front(name, scale):
    blocks = blocks_of(name, scale)
    high = {role: [b.cell for b in blocks if b.role == role] for role in ("seat", "back")}
    assert max(k for *_, k in high["back"]) > max(k for *_, k in high["seat"])
    assert np.mean([i for i, *_ in high["back"]]) <= np.mean([i for i, *_ in high["seat"]])


@pytest.mark.parametrize("name", [name for name in NAMES if name.endswith(("bed", "king"))])
def test_a_bed_lies_with_its_pillow_at_the_back(name):
    pillows = [block.cell[0] for block in blocks_of(name, 4.0) if block.role == "pillow"]
    depth = 1 + max(block.cell[0] for block in blocks_of(name, 4.0))
    assert pillows
    assert max(pillows) < depth / 2


@pytest.mark.parametrize("scale", [2.0, 4.0])
@pytest.mark.parametrize("name", ["dining_table", "desk", "round_table", "table_bar"])
def test_a_top_is_level_and_within_half_a_block_of_its_height(name, scale):
    tops = {b.cell[2] for b in blocks_of(name, scale) if b.role == "top"}
    assert len(tops) == 1
    assert abs(_top(name, scale) - template(name).typical_m[2] * scale) <= 0.5


def test_things_on_a_table_survive_at_four_blocks_per_metre():
    layers = {block.cell[2] for block in blocks_of("dining_table", 4.0, (0.85, 1.5, 0.75))}
    assert layers == {0, 1, 2}


@pytest.mark.parametrize("scale", SCALES)
@pytest.mark.parametrize("name", ["wall_tv", "tv_on_foot", "monitor", "monitor_wide"])
def test_a_screen_is_black(name, scale):
    states = [block.state for block in blocks_of(name, scale) if block.role == "screen"]
    assert states
    assert all("black" in state for state in states)


def test_a_cloth_sofa_is_of_wool_and_a_leather_one_of_wood():
    assert {"minecraft:light_gray_wool"} <= {b.state for b in blocks_of("sofa", 4.0)}
    names = {b.state.partition("[")[0] for b in blocks_of("sofa_leather", 4.0)}
    assert names == {"minecraft:dark_oak_planks", "minecraft:dark_oak_slab"}
