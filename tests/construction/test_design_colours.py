"""Designs in the real colours: one material one colour, and what is meant to stay stays."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.construction.design_placement import (
    ObjectColours,
    filled_blocks,
    recolour_design,
)
from world2minecraft.construction.palettes import load_palette
from world2minecraft.construction.parameters import BuildParameters
from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import Placement
from world2minecraft.furniture import block_design, template
from world2minecraft.geometry.colour import srgb_to_oklab

RED, BLUE, WHITE, OAK, DARK = (
    (160, 36, 33),
    (44, 46, 143),
    (240, 239, 233),
    (162, 130, 79),
    (60, 38, 23),
)


def _lab(rgb):
    return srgb_to_oklab(np.array(rgb, np.uint8))


def _design(name, scale=4.0, size_m=None, quarter_turns=0):
    one = template(name)
    size = np.array(size_m or one.typical_m)
    return block_design(
        Placement(1, one.class_id, name, np.zeros(3), size, quarter_turns, 1.0), scale
    )


def _states(name, rgb, *, scale=4.0, paint=None, known=True):
    design = _design(name, scale)
    east, up, south = design.size
    shape = (east, south, up)
    cells = np.array([block.offset for block in design.blocks])[:, [0, 2, 1]]
    colours = np.broadcast_to(_lab(rgb), (*shape, 3)).astype(np.float32)
    hue = ObjectColours(colours, np.full(shape, known), None if paint is None else _lab(paint))
    kind = template(name).class_id
    palette, how = load_palette("vanilla"), BuildParameters()
    states = recolour_design(design.blocks, cells, design.materials, hue, kind, palette, how)
    return design, states


def _names(states):
    return {state.partition("[")[0].removeprefix("minecraft:") for state in states}


def test_a_blue_sofa_is_blue_wool_and_a_leather_one_dark_wood():
    _, states = _states("sofa", BLUE)
    assert "blue_wool" in _names(states)
    assert not {"light_gray_wool", "gray_wool"} & _names(states)
    _, states = _states("sofa_leather", DARK)
    assert all(name.startswith("dark_oak") for name in _names(states))


def test_all_of_a_chair_is_of_one_wood():
    _, states = _states("chair", OAK)
    assert {name.rpartition("_")[0] for name in _names(states)} == {"oak"}
    _, states = _states("chair", WHITE, paint=DARK)
    assert {name.rpartition("_")[0] for name in _names(states)} == {"dark_oak"}


def test_a_low_sofa_of_cloth_takes_stairs_of_its_colour():
    _, states = _states("sofa", RED, scale=1.0)
    assert all("stairs" in state for state in states)
    assert "spruce_stairs" not in _names(states)


def test_books_stay_in_wood_and_give_way_in_red():
    _, states = _states("bookcase", OAK)
    assert "minecraft:bookshelf" in states
    _, states = _states("bookcase", RED)
    assert "minecraft:bookshelf" not in states
    assert any("red" in state for state in states)


def test_a_white_pillow_stays_white_on_a_red_bed():
    _, states = _states("double_bed", RED)
    assert {"white_wool", "red_wool"} <= _names(states)


def test_a_screen_stays_black():
    before = [block.state for block in _design("wall_tv").blocks]
    assert _states("wall_tv", WHITE)[1] == before


def test_nothing_is_changed_where_no_colour_is_known():
    design, states = _states("sofa", BLUE, known=False)
    assert states == [block.state for block in design.blocks]


@pytest.mark.parametrize("name", ["chair", "sofa", "counter", "dining_table", "double_bed"])
@given(rgb=st.tuples(*[st.integers(0, 255)] * 3), scale=st.sampled_from([1.0, 2.0, 4.0]))
def test_a_tinted_block_keeps_its_shape_and_its_way(name, rgb, scale):
    design, states = _states(name, rgb, scale=scale)
    for block, state in zip(design.blocks, states, strict=True):
        before, after = block.state.partition("["), state.partition("[")
        if after[0].rpartition("_")[2] in ("stairs", "slab", "trapdoor", "fence", "bed"):
            assert after[0].rpartition("_")[2] == before[0].rpartition("_")[2]
            assert after[2] == before[2]


def test_the_cells_of_a_turned_design_are_in_room_axes():
    straight, turned = _design("sofa"), _design("sofa", quarter_turns=1)
    assert (
        filled_blocks(turned).shape
        == filled_blocks(straight).shape[1::-1] + filled_blocks(straight).shape[2:]
    )
    assert filled_blocks(turned).sum() == len(turned.blocks)
    # Its back lies at the low end of room x, and of room y once it is turned counter-clockwise.
    top = filled_blocks(straight)[:, :, -1]
    assert top[0].all() and not top[-1].all()
    top = filled_blocks(turned)[:, :, -1]
    assert top[:, 0].all() and not top[:, -1].all()


def test_a_room_of_red_counters_and_a_blue_sofa_is_built_so():
    from build_samples import Sketch, placement

    from world2minecraft.construction import build_volume

    sketch = Sketch().put((18, 30), (0, 8), (0, 11), int(SemanticClass.SOFA), BLUE, 1)
    sofa = placement("sofa", int(SemanticClass.SOFA), (1.92, 0.32, 0.44), (0.64, 0.96, 0.88), 1)
    volume = build_volume(sketch.grid(), [sofa], (), corner_m=sketch.corner_m, blocks_per_metre=4.0)
    held = {volume.palette[i] for i in volume.states[volume.instance == 1]}
    assert "minecraft:blue_wool" in held


@pytest.mark.parametrize("name", ["curtain", "curtain_single"])
@given(rgb=st.tuples(*[st.integers(0, 255)] * 3))
def test_curtains_are_of_cloth_and_never_of_stone_or_wood(name, rgb):
    design, states = _states(name, rgb)
    cloth = [
        state for block, state in zip(design.blocks, states, strict=True) if "chain" not in state
    ]
    soft = set(load_palette("vanilla").blocks[int(SemanticClass.SOFA)])
    assert set(cloth) <= soft and len(set(cloth)) == 1
