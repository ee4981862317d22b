"""Palettes: the shipped ones are sound, a user's restricts the room, and mistakes are told."""

import contextlib
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from build_samples import CHAIR, FURN, TABLE, furnished
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.construction import BuildParameters, build_volume
from world2minecraft.construction.mod_block_classes import Meaning, label_volume, parse_meanings
from world2minecraft.construction.mod_furniture import mod_furniture
from world2minecraft.construction.palette_restriction import UNSEEN, nearest_allowed
from world2minecraft.construction.palettes import (
    PALETTE_FILES,
    load_palette,
    parse_palette,
    parse_piece,
)
from world2minecraft.core.classes import CLASS_NAMES, SemanticClass
from world2minecraft.core.errors import InputError, UnknownNameError, UsageError
from world2minecraft.core.types import BlockVolume, Placement
from world2minecraft.furniture import TEMPLATES, template
from world2minecraft.geometry.colour import srgb_to_oklab
from world2minecraft.minecraft.block_colours import colour_of
from world2minecraft.minecraft.block_states import check_state, parse_state
from world2minecraft.minecraft.collision_shapes import is_full_cube

FEW = """
name: nordic
blocks:
  - white_concrete
  - light_gray_concrete
  - birch_planks
  - birch_slab
  - birch_stairs
  - dark_oak_planks
  - red_wool
  - glass
  - glass_pane
"""
MOD = load_palette("refurbished_furniture")


def placement(name: str, size_m, turns: int = 0) -> Placement:
    found = template(name)
    return Placement(1, found.class_id, name, [2.0, 2.0, size_m[2] / 2], size_m, turns, 0.8)


def states_of(name: str, size_m, scale=2.0, turns=0, colour=None) -> dict:
    found = mod_furniture(MOD.furniture, placement(name, size_m, turns), scale, colour)
    return (
        {} if found is None else {block.offset: parse_state(block.state) for block in found.blocks}
    )


# The palettes of the program.


@pytest.mark.parametrize("name", PALETTE_FILES)
def test_shipped_palettes_cover_every_class_with_full_blocks(name):
    palette = load_palette(name)
    assert palette.name == name
    for number in range(1, len(CLASS_NAMES)):
        assert palette.blocks[number]
        assert palette.defaults[number] in palette.blocks[number]
        for state in palette.blocks[number]:
            assert is_full_cube(str(check_state(parse_state(state))))
    assert palette.only is None
    assert palette.allows("minecraft:anything")


@pytest.mark.parametrize("name", PALETTE_FILES)
def test_furniture_and_meanings_name_designs_that_there_are(name):
    palette = load_palette(name)
    designs = set(TEMPLATES.names())
    families = {template(each).family for each in designs}
    for piece in palette.furniture:
        assert set(piece.designs) <= designs | families
    assert palette.meanings is not None
    for meaning in palette.meanings.words.values():
        assert not meaning.design or meaning.design in designs


# A mod's furniture.


def test_a_chair_of_the_mod_looks_where_the_chair_looks():
    for turns, back in enumerate(("west", "south", "east", "north")):
        (state,) = states_of("chair", [0.48, 0.45, 0.7], turns=turns).values()
        assert state.name == "refurbished_furniture:oak_chair"
        assert state.get("facing") == back
        assert state.get("tucked") == "false"


def test_it_takes_the_wood_or_dye_of_the_object():
    red = srgb_to_oklab(np.array([160, 40, 35], np.uint8))
    dark = srgb_to_oklab(np.array([60, 40, 22], np.uint8))
    (chair,) = states_of("chair", [0.48, 0.45, 0.7], colour=dark).values()
    assert chair.name == "refurbished_furniture:dark_oak_chair"
    sofa = states_of("sofa", [0.8, 1.5, 0.8], colour=red)
    assert {state.name for state in sofa.values()} == {"refurbished_furniture:red_sofa"}


def test_a_row_of_sofas_has_ends_and_a_middle():
    row = states_of("sofa", [0.8, 1.5, 0.8])
    # It looks east: its left end, to the north, has a neighbour to the south alone.
    shapes = [row[cell].get("shape") for cell in sorted(row, key=lambda cell: cell[2])]
    assert shapes == ["right", "middle", "left"]


def test_tables_join_on_every_side():
    table = states_of("dining_table", [1.0, 1.5, 0.75])
    assert len(table) == 6
    corner = table[(0, 0, 0)]
    assert [corner.get(side) for side in ("north", "east", "south", "west")] == [
        "false", "true", "true", "false",
    ]  # fmt: skip


def test_turning_a_table_turns_its_joins():
    table = states_of("dining_table", [1.0, 1.5, 0.75], turns=1)
    assert {cell[0] for cell in table} == {0, 1, 2}
    corner = table[(0, 0, 0)]
    assert [corner.get(side) for side in ("north", "east", "south", "west")] == [
        "false", "true", "true", "false",
    ]  # fmt: skip


def test_a_fridge_stands_on_its_freezer():
    fridge = states_of("fridge", [0.6, 0.6, 1.8], scale=1.0)
    assert fridge[(0, 0, 0)].name.endswith("light_freezer")
    assert fridge[(0, 1, 0)].name.endswith("light_fridge")


def test_what_is_far_larger_than_a_piece_is_built_otherwise():
    assert not states_of("chair", [0.48, 0.45, 0.88], scale=4.0)
    assert not states_of("dining_table", [1.0, 1.5, 0.75], scale=4.0)
    assert mod_furniture((), placement("chair", [0.5, 0.5, 0.9]), 2.0, None) is None


def test_a_room_of_a_mod_has_its_furniture_and_vanilla_walls():
    sketch = furnished()
    placements = [
        Placement(1, CHAIR, "chair", [1.2, 1.0, 0.4], [0.48, 0.48, 0.8], 1, 0.6),
    ]
    grid = sketch.put((12, 18), (9, 15), (0, 10), CHAIR, (160, 120, 70), 9).grid()
    placements = [replace(placements[0], object_id=9)]
    volume = build_volume(
        grid, placements, [], corner_m=sketch.corner_m, blocks_per_metre=2.0,
        parameters=BuildParameters(palette="refurbished_furniture"),
    )  # fmt: skip
    mod = [number for number, state in enumerate(volume.palette) if state.startswith("refurbished")]
    assert len(mod) == 1
    at = np.argwhere(volume.states == mod[0])
    assert len(at) == 1
    assert volume.instance[tuple(at[0])] == 9
    assert all(s.startswith(("minecraft:", "refurbished_furniture:")) for s in volume.palette)


# Meanings.


@pytest.mark.parametrize(
    ("palette", "state", "meaning"),
    [
        ("tmeo", "tmeo_ultra:shafa_1x_2", ("sofa", "sofa")),
        ("tmeo", "tmeo_ultra:shafazhuanjiao[facing=east]", ("sofa", "corner_sofa")),
        ("tmeo", "tmeo_ultra:changdeng_1x_3", ("chair", "bench")),
        ("tmeo", "tmeo_ultra:woshimenjijian_2baisezuokai", ("wall", "")),
        ("tmeo", "tmeo_ultra:diaoguadianshi", ("tvs", "wall_tv")),
        ("tmeo", "tmeo_ultra:chuanglian_bai", ("empty", "curtain")),
        ("tmeo", "tmeo_ultra:dachuangban2", ("bed", "double_bed")),
        ("tmeo", "tmeov:baiyechuang", ("window", "")),
        ("tmeo", "tmeov:shujia", ("furn", "bookcase")),
        ("tmeo", "tmeo_ultra:qqq", None),
        ("tmeo", "minecraft:red_bed", None),
        ("refurbished_furniture", "refurbished_furniture:oak_kitchen_drawer", ("furn", "counter")),
        ("refurbished_furniture", "refurbished_furniture:oak_drawer", ("furn", "chest_of_drawers")),
        ("refurbished_furniture", "refurbished_furniture:television", ("tvs", "tv_tube")),
        ("vanilla", "minecraft:red_bed[part=head]", ("bed", "single_bed")),
        ("vanilla", "bookshelf", ("furn", "bookcase")),
        ("vanilla", "minecraft:stone", None),
        ("vanilla", "minecraft:bedrock", None),
    ],
)
def test_a_block_means_what_its_longest_word_says(palette, state, meaning):
    found = load_palette(palette).meanings.of(state)
    said = None if found is None else (CLASS_NAMES[found.class_id], found.design)
    assert said == meaning


def test_a_world_is_labelled_and_things_that_touch_are_one():
    palette = ("minecraft:air", "tmeo_ultra:shafa_1x_2", "minecraft:stone", "tmeov:penzai")
    states = np.zeros((7, 2, 2), np.uint16)
    states[0:2, 0], states[4, 0], states[:, 1], states[5, 0, 0] = 1, 1, 2, 3
    volume = BlockVolume(
        states, palette, np.zeros(states.shape, np.uint8), np.zeros(states.shape, np.uint16),
        (0, 64, 0), np.eye(4),
    )  # fmt: skip
    told = label_volume(volume, load_palette("tmeo").meanings)
    assert (told.semantic[states == 1] == SemanticClass.SOFA).all()
    assert not told.semantic[states == 2].any()
    assert len(np.unique(told.instance[states == 1])) == 2
    assert len(np.unique(told.instance[told.instance > 0])) == 3
    again = label_volume(told, load_palette("tmeo").meanings)
    assert np.array_equal(again.instance, told.instance)


def test_meanings_that_are_none_are_told():
    with pytest.raises(
        ValueError,
        match="meaning of 'x' must be CLASS or CLASS/DESIGN, .* got 'chairs'",
    ):
        parse_meanings({"namespaces": ["mod"], "words": {"x": "chairs"}})
    with pytest.raises(ValueError, match="exactly the keys namespaces and words"):
        parse_meanings({"words": {}})
    assert parse_meanings({"namespaces": ["m"], "words": {"x": "bed"}}).of("m:x") == Meaning(6, "")


# A user's palette.


@pytest.fixture(scope="module")
def few(tmp_path_factory):
    path = tmp_path_factory.mktemp("palettes") / "nordic.yaml"
    path.write_text(FEW)
    return path


def seen(volume) -> set[str]:
    used = {volume.palette[number] for number in np.unique(volume.states)}
    return {state.partition("[")[0] for state in used} - UNSEEN


@pytest.mark.parametrize("scale", [1.0, 2.0, 4.0, 12.5])
@pytest.mark.parametrize("style", ["blocks", "display", "voxels"])
def test_a_room_of_few_blocks_has_no_others(few, scale, style):
    sketch = furnished()
    placements = [Placement(3, TABLE, "dining_table", [2.0, 1.0, 0.36], [0.8, 1.2, 0.72], 0, 0.7)]
    grid = sketch.put((20, 30), (5, 20), (8, 9), TABLE, (160, 120, 70), 3).grid()
    volume = build_volume(
        grid, placements, [], corner_m=sketch.corner_m, blocks_per_metre=scale,
        parameters=BuildParameters(palette=str(few), style=style),
    )  # fmt: skip
    named = load_palette(str(few)).only
    assert seen(volume) <= named
    shown = {one.nbt["block_state"]["Name"] for one in volume.entities}
    assert shown <= named


def test_a_few_blocks_serve_every_class(few):
    palette = load_palette(str(few))
    assert palette.name == "nordic"
    assert palette.glass == "minecraft:glass"
    assert palette.pane.startswith("minecraft:glass_pane[")
    for number in range(1, len(CLASS_NAMES)):
        assert {state.partition("[")[0] for state in palette.blocks[number]} <= palette.only
    assert palette.slabs == {"minecraft:birch_planks": "birch_slab"}


STRANGE = [
    "oak_stairs[facing=east,half=top]",
    "spruce_slab[type=top]",
    "stone",
    "blue_wool",
    "oak_button[face=wall]",
    "mod:thing",
    "red_bed[part=head]",
    "torch",
    "sea_lantern",
    "oak_door[half=upper]",
    "chain",
    "air",
]


@pytest.mark.parametrize("state", STRANGE)
def test_what_stands_for_a_block_is_named_or_nothing(state):
    palette = parse_palette(
        {"name": "x", "blocks": ["birch_stairs", "birch_planks", "stone", "glass"]}
    )
    found = nearest_allowed(str(parse_state(state)), palette)
    assert found.partition("[")[0] in palette.only | {"minecraft:air"}
    assert nearest_allowed(found, palette) == found


def test_an_extended_mod_palette_has_its_furniture_and_words():
    palette = parse_palette({"name": "x", "extends": "refurbished_furniture"})
    assert palette.furniture == MOD.furniture
    assert palette.meanings.words == MOD.meanings.words


def test_shapes_keep_their_way():
    palette = parse_palette({"name": "x", "blocks": ["birch_stairs", "birch_planks", "glass"]})
    found = parse_state(nearest_allowed("minecraft:oak_stairs[facing=west,half=top]", palette))
    assert found.name == "minecraft:birch_stairs"
    assert (found.get("facing"), found.get("half")) == ("west", "top")


def test_a_palette_may_give_classes_blocks_of_their_own():
    palette = parse_palette(
        {
            "name": "mine",
            "blocks": ["white_concrete", "oak_planks", "stone", "glass"],
            "classes": {"floor": ["oak_planks"], "wall": ["white_concrete"]},
        }
    )
    assert palette.blocks[SemanticClass.FLOOR] == ("minecraft:oak_planks",)
    assert palette.blocks[SemanticClass.WALL] == ("minecraft:white_concrete",)
    assert "minecraft:stone" in palette.blocks[FURN]


MISTAKES = json.loads(Path(__file__).with_name("palette_mistakes.json").read_text())


@pytest.mark.parametrize("text", MISTAKES)
def test_a_mistake_is_told_with_the_file_and_what_to_write(tmp_path, text):
    path = tmp_path / "p.yaml"
    path.write_text(text)
    with pytest.raises(InputError) as told:
        load_palette(str(path))
    assert str(told.value) == f"{path}: {MISTAKES[text]}"


def test_what_is_no_palette_file_is_told(tmp_path):
    bad = tmp_path / "b.yaml"
    bad.write_text("name: [")
    with pytest.raises(InputError, match="is not valid YAML"):
        load_palette(str(bad))
    deep = tmp_path / "d.yaml"
    deep.write_text("[" * 20_000)
    with pytest.raises(InputError, match="is not valid YAML"):
        load_palette(str(deep))
    aliases = tmp_path / "a.yaml"
    aliases.write_text("name: &n x\nabout: *n\n")
    with pytest.raises(
        InputError, match=r"is not valid YAML \(aliases \(\*name\) are not supported\)"
    ):
        load_palette(str(aliases))
    big = tmp_path / "big.yaml"
    big.write_text("#" * (2 << 20))
    with pytest.raises(InputError, match="the limit is 1,048,576"):
        load_palette(str(big))
    other = tmp_path / "x.txt"
    other.write_text("name: x")
    with pytest.raises(InputError, match=r"a palette file must end with \.yaml or \.yml or \.json"):
        load_palette(str(other))
    with pytest.raises(InputError):
        load_palette(str(tmp_path / "none.yaml"))
    with pytest.raises(UnknownNameError, match="did you mean 'vanilla'"):
        load_palette("vanila")


def test_yaml_makes_no_objects(tmp_path):
    path = tmp_path / "p.yaml"
    path.write_text("!!python/object/apply:os.getcwd []")
    with pytest.raises(InputError, match="is not valid YAML"):
        load_palette(str(path))


KEYS = ["name", "blocks", "classes", "furniture", "for", "id", "reads", "cells", "words"]
TREES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.text(max_size=8),
    lambda inner: (
        st.lists(inner, max_size=3) | st.dictionaries(st.sampled_from(KEYS), inner, max_size=4)
    ),
    max_leaves=12,
)


@given(TREES)
def test_any_tree_is_a_palette_or_a_typed_error(tree):
    with contextlib.suppress(ValueError, UsageError):
        parse_palette(tree)


def test_a_piece_of_several_cells_fills_no_place():
    raw = {
        "for": ["fridge"],
        "cells": [{"id": "m:a"}, {"id": "m:b", "at": [0, 0, 1]}],
        "fill": "box",
    }
    with pytest.raises(ValueError, match="several cells must have fill: one"):
        parse_piece(raw)


def test_a_mod_block_has_the_colour_that_its_name_states():
    assert colour_of("refurbished_furniture:dark_oak_chair") == colour_of("dark_oak_planks")
    assert colour_of("refurbished_furniture:light_blue_sofa[shape=left]") == colour_of(
        "light_blue_wool"
    )
    assert colour_of("tmeo_ultra:shafa") != colour_of("tmeo_ultra:yigui")
