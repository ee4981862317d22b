"""Materials: what block each is in each shape, and what may stand for it."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.furniture import TEMPLATES, Look, Material, template
from world2minecraft.furniture.materials import (
    block_uses,
    kinds,
    list_swatches,
    shape_of,
    with_swatch,
)
from world2minecraft.minecraft.block_states import known_blocks

BLOCKS = sorted(
    block for kind in kinds().values() for held in kind.blocks.values() for block in held.values()
)


def test_every_block_of_the_table_is_the_games():
    assert set(BLOCKS) <= set(known_blocks())
    assert kinds()["wood"].blocks["oak"]["trapdoor"] == "minecraft:oak_trapdoor"
    assert kinds()["stone"].blocks["stone_brick"]["stairs"] == "minecraft:stone_brick_stairs"
    assert "stairs" not in kinds()["cloth"].blocks["red"]


@given(st.sampled_from(BLOCKS))
def test_a_block_is_found_where_it_stands(block):
    for place in block_uses(block):
        assert kinds()[place.kind].blocks[place.value][place.shape] == block


@given(st.sampled_from(sorted(kinds())), st.sampled_from(["full", "slab", "stairs", "fence"]))
def test_a_swatch_has_all_the_shapes_that_were_asked_for(kind, shape):
    for swatch in list_swatches(kind, frozenset(("full", shape))):
        assert {"full", shape} <= set(kinds()[swatch.kind].blocks[swatch.value])


def test_with_swatch_keeps_shape_and_properties():
    state = "minecraft:oak_stairs[facing=west,half=bottom]"
    (birch,) = [one for one in list_swatches("wood", frozenset({"stairs"})) if one.value == "birch"]
    shape = shape_of(state, "wood")
    assert shape == "stairs"
    assert with_swatch(state, shape, birch) == "minecraft:birch_stairs[facing=west,half=bottom]"
    assert shape_of("minecraft:lantern[hanging=false]", "wood") is None


def test_a_plain_block_has_the_shapes_of_its_own_material():
    assert Material("plain", "smooth_quartz").block("slab") == "minecraft:smooth_quartz_slab"
    assert Material("plain", "white_concrete").block("slab") is None
    assert Material("plain", "white_concrete").block("full") == "minecraft:white_concrete"


def test_a_fixed_material_has_the_shapes_that_it_names():
    screen = Material("fixed", "black_concrete", shapes=(("pane", "black_stained_glass_pane"),))
    assert screen.block("pane") == "minecraft:black_stained_glass_pane"
    assert screen.block("full") == "minecraft:black_concrete"
    assert screen.block("stairs") is None


def test_a_look_says_what_a_role_is_made_of():
    look = template("chair").look({"seat_height": 0.4})
    assert look["seat_height"] == 0.4
    assert dict(look) == {"seat_height": 0.4}
    assert look.has("seat", "stairs", "slab")
    assert look.state("leg", "fence") == "minecraft:oak_fence"
    assert look.state("seat", "slab", type="top") == "minecraft:oak_slab[type=top]"


@pytest.mark.parametrize(
    ("role", "shape", "message"),
    [
        ("wheel", "full", "template thing does not define the material of its wheel"),
        (
            "seat",
            "stairs",
            "template thing needs a stairs for its seat, but its material red has none",
        ),
    ],
)
def test_a_look_refuses_what_there_is_not(role, shape, message):
    look = Look("thing", {}, {}, {"seat": Material("cloth", "red")})
    with pytest.raises(ValueError) as caught:
        look.state(role, shape)
    assert str(caught.value) == message


def test_every_role_of_every_design_has_a_material():
    for name in TEMPLATES.names():
        one = template(name)
        if one.materials:
            assert {part.role for part in one.parts(one.typical_m)} <= set(one.materials)
