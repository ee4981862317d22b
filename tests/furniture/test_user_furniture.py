"""Furniture of the user's own: from blocks to a file, from the file to the same blocks."""

import json
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.core.errors import DamagedFileError, LimitError, UnknownNameError, UsageError
from world2minecraft.core.files import write_json
from world2minecraft.core.types import BlockVolume
from world2minecraft.furniture import rasterize
from world2minecraft.furniture.block_designs import block_size, lay_template
from world2minecraft.furniture.library import template, templates_of_class, variants_of
from world2minecraft.furniture.user_import import ImportRequest, front_of, import_blocks
from world2minecraft.furniture.user_library import (
    read_user_design,
    template_from_json,
    user_design_files,
    user_design_folder,
)
from world2minecraft.minecraft.turn_and_mirror import turn_volume

AIR = "minecraft:air"
STAIR = "minecraft:oak_stairs[facing=north,half=bottom]"
WISH = ImportRequest("my_chair", "chair", 2.0)


def volume_of(blocks, side=5):
    """A volume with some states at some cells of block axes."""
    palette = (AIR, *sorted(set(blocks.values())))
    states = np.zeros((side,) * 3, np.uint16)
    for cell, state in blocks.items():
        states[cell] = palette.index(state)
    empty = np.zeros(states.shape, np.uint16)
    return BlockVolume(states, palette, empty.astype(np.uint8), empty, (0, 64, 0), np.eye(4))


def chair():
    """A stair that looks south, a panel as its back, an arm at its west side."""
    back = "minecraft:oak_trapdoor[facing=south,half=bottom,open=true]"
    return volume_of({(2, 1, 2): STAIR, (2, 2, 2): back, (1, 1, 2): "minecraft:birch_planks"})


def blocks_of(content, scale=2.0):
    one = template_from_json(content)
    return one.blocks(block_size(np.array(one.typical_m), scale))


def test_a_chair_comes_out_as_it_was_built():
    adopted = import_blocks(chair(), WISH)
    assert adopted.front == "south"
    found = {block.cell: block.state.partition(",")[0] for block in blocks_of(adopted.content)}
    # The front is east now, so what was west is on the right, which is j = 0.
    assert found == {
        (0, 0, 0): "minecraft:birch_planks",
        (0, 1, 0): "minecraft:oak_stairs[facing=west",
        (0, 1, 1): "minecraft:oak_trapdoor[facing=east",
    }


@given(st.integers(0, 3))
def test_which_way_it_stood_does_not_matter(turns):
    assert (
        import_blocks(turn_volume(chair(), turns), WISH).content
        == import_blocks(chair(), WISH).content
    )


@given(st.integers(0, 3))
def test_a_front_that_is_said_is_the_front(turns):
    cube = volume_of({(1, 1, 1): "minecraft:stone", (2, 1, 1): "minecraft:dirt"})
    sides = ("east", "north", "west", "south")
    wish = WISH._replace(front=sides[turns])
    turned = turn_volume(cube, turns)
    assert (
        import_blocks(turned, wish).content
        == import_blocks(cube, WISH._replace(front="east")).content
    )


def test_its_size_is_that_of_what_is_seen():
    content = import_blocks(chair(), WISH).content
    one = template_from_json(content)
    assert one.typical_m == pytest.approx((0.5, 1.0, 1.0))
    solid = rasterize(one, (8, 16, 16), (), 1 / 16)
    expected = np.zeros((8, 16, 16), bool)
    expected[:, :8, :8] = True  # The planks.
    expected[:, 8:, :4] = True  # The low half of the stair,
    expected[:4, 8:, 4:8] = True  # its high half,
    expected[:2, 8:, 8:] = True  # and the panel, two eighths of a block thick.
    assert np.array_equal(solid, expected)


def test_own_scale_uses_the_blocks_and_others_the_shape():
    one = template_from_json(import_blocks(chair(), WISH).content)
    size = np.array(one.typical_m)
    for scale, kept in ((1.0, False), (1.7, True), (2.0, True), (2.4, True), (4.0, False)):
        assert (lay_template(one, block_size(size, scale), None, 0) is not None) == kept


def test_materials_are_of_its_blocks_or_the_objects_colour():
    kept = template_from_json(import_blocks(chair(), WISH).content).materials
    assert {role: one.value for role, one in kept.items()} == {
        "birch_planks": "birch_planks",
        "oak_stairs": "oak_planks",
        "oak_trapdoor": "oak_planks",
    }
    taken = template_from_json(
        import_blocks(chair(), WISH._replace(recolour=True)).content
    ).materials
    assert all(one.takes_colour and one.kind == "wood" for one in taken.values())


@pytest.mark.parametrize(
    ("blocks", "turns"),
    [
        ({(1, 1, 1): "minecraft:stone"}, 1),
        ({(1, 1, 1): "minecraft:stone", (2, 1, 1): "minecraft:stone"}, 2),
        ({(1, 1, 1): "minecraft:stone", (2, 1, 1): "minecraft:dirt"}, 4),
    ],
)
def test_the_turns_that_differ_are_found(blocks, turns):
    assert import_blocks(volume_of(blocks), WISH._replace(front="east")).content["turns"] == turns


@pytest.mark.parametrize(
    ("state", "kind", "front"),
    [
        ("minecraft:oak_stairs[facing=north]", "chair", "south"),
        ("minecraft:red_bed[facing=west,part=head]", "bed", "east"),
        ("minecraft:barrel[facing=west]", "furn", "west"),
        ("minecraft:oak_stairs[facing=north]", "furn", None),
        ("minecraft:oak_stairs[facing=north,half=top]", "chair", None),
        ("minecraft:oak_trapdoor[facing=north]", "furn", None),
        ("minecraft:stone", "furn", None),
    ],
)
def test_a_front_is_seen_by_what_has_one(state, kind, front):
    assert front_of(volume_of({(1, 1, 1): state}), kind) == front


def test_fences_are_joined_as_the_game_joins_them():
    fences = volume_of({(1, 1, 1): "minecraft:oak_fence", (2, 1, 1): "minecraft:oak_fence"})
    content = import_blocks(fences, WISH._replace(front="east")).content
    assert sorted("east=true" in state for state in content["blocks"]["palette"]) == [False, True]


def test_what_would_not_stay_and_what_is_a_mods_is_told():
    torch = volume_of({(1, 2, 1): "minecraft:torch", (1, 1, 1): "somemod:chair"})
    notes = import_blocks(torch, WISH._replace(front="east")).notes
    assert "unknown in vanilla Minecraft, treated as full blocks: chair" in notes
    hanging = volume_of({(1, 2, 1): "minecraft:torch", (2, 1, 1): "minecraft:stone"})
    assert any(
        "need support" in n for n in import_blocks(hanging, WISH._replace(front="east")).notes
    )


@pytest.mark.parametrize(
    ("wish", "message"),
    [
        ({"name": "My Chair"}, "a furniture name must start with a letter and have up to 40"),
        ({"name": "../etc"}, "add --name my_chair"),
        ({"kind": "chairs"}, "no furniture class is named 'chairs'; did you mean 'chair'?"),
        ({"front": "up"}, "no side is named 'up'"),
        ({"mount": "roof"}, "no mount is named 'roof'"),
        ({"blocks_per_metre": 0.0}, "the scale must be 0.1 to 64 blocks per metre, got 0"),
        ({"blocks_per_metre": float("nan")}, "the scale must be 0.1 to 64 blocks per metre"),
        ({"size_m": (1.0, 1.0, 100.0)}, "of the piece must be 0.02 to 20 m, got 1.00 x 1.00 x 100"),
    ],
)
def test_a_wish_that_cannot_be_is_refused(wish, message):
    with pytest.raises((UsageError, UnknownNameError)) as caught:
        import_blocks(chair(), WISH._replace(**wish))
    assert message in str(caught.value)


def test_blocks_that_cannot_be_are_refused():
    with pytest.raises(UsageError, match="the selection contains no blocks"):
        import_blocks(volume_of({}), WISH)
    with pytest.raises(UsageError, match="cannot determine the front side from the blocks; set it"):
        import_blocks(volume_of({(1, 1, 1): "minecraft:stone"}), WISH)
    far = volume_of({(0, 0, 0): "minecraft:stone", (39, 0, 0): "minecraft:stone"}, side=40)
    with pytest.raises(UsageError, match="a piece may have at most 32 blocks per side"):
        import_blocks(far, WISH._replace(front="east"))


def _changed(**changes):
    content = json.loads(json.dumps(import_blocks(chair(), WISH).content))
    blocks = content["blocks"] | changes.pop("blocks", {})
    return content | {"blocks": blocks} | changes


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"class": "wall"}, "class must be an object class, got 'wall'"),
        ({"name": "a/b"}, "a furniture name must start with a letter"),
        ({"turns": 3}, "turns must be one of 1, 2, 4, got 3"),
        ({"match": "yes"}, "match must be one of True, False, got 'yes'"),
        ({"size_m": 3}, "size_m must be a JSON object, got 3"),
        ({"size_m": {"depth": [1, 1]}}, "depth must be a list of 3 to 3 items, got [1, 1]"),
        ({"blocks_per_metre": 1e9}, "blocks_per_metre must be a number from 0.1 to 64"),
        ({"blocks": {"size": [10**9, 1, 1]}}, "size must be an integer from 1 to 32"),
        ({"blocks": {"size": [32, 32, 32]}}, "size must have at most 8,192 blocks"),
        (
            {"blocks": {"palette": ["a b"]}},
            "block name 'a b' is invalid; expected a name such as minecraft:oak_log",
        ),
        ({"blocks": {"palette": ["stone; op me"]}}, "is invalid; expected a name such as"),
        ({"blocks": {"runs": [[1, 10**9]]}}, "run length must be an integer"),
        (
            {"blocks": {"runs": [[0, 4]]}},
            "runs must contain 4 blocks, at least one of them not air",
        ),
        ({"blocks": {"runs": [[9, 4]]}}, "run state index must be an integer from 0 to 3"),
        ({"parts": []}, "parts must be a list of 1 to 512"),
        (
            {"parts": [["gold", 0, 0, 0, 1, 1, 1]]},
            "the block of a part must be a block of the piece",
        ),
        ({"parts": [["oak_stairs", 1, 0, 0, 1, 1, 1]]}, "a part must have a positive volume"),
    ],
)
def test_a_file_that_says_what_none_may_is_refused(changes, message, tmp_path):
    path = tmp_path / "my_chair.json"
    write_json(path, _changed(**changes))
    with pytest.raises(DamagedFileError) as caught:
        read_user_design(path)
    assert message in str(caught.value)
    assert str(caught.value).endswith("add it again with w2m furniture add, or remove the file")


def test_a_file_of_another_name_or_too_large_is_refused(tmp_path):
    path = tmp_path / "other.json"
    write_json(path, import_blocks(chair(), WISH).content)
    with pytest.raises(DamagedFileError, match="the template name must match the file name, got"):
        read_user_design(path)
    path.write_text(" " * (5 << 20))
    with pytest.raises(LimitError):
        read_user_design(path)


@given(st.binary(max_size=200))
def test_any_bytes_are_a_template_or_a_typed_error(tmp_path_factory, data):
    path = tmp_path_factory.getbasetemp() / "noise.json"
    path.write_bytes(data)
    with pytest.raises(DamagedFileError):
        read_user_design(path)


@pytest.fixture
def library(tmp_path, monkeypatch):
    """An empty folder of the user's own furniture, and a library that forgets what it read."""
    monkeypatch.setenv("W2M_FURNITURE", str(tmp_path / "own"))
    for function in (template, templates_of_class, variants_of):
        function.cache_clear()
    yield tmp_path / "own"
    for function in (template, templates_of_class, variants_of):
        function.cache_clear()


def test_an_own_piece_is_in_the_library_and_is_matched(library):
    assert user_design_files() == {}
    write_json(library / "my_chair.json", import_blocks(chair(), WISH).content)
    write_json(library / "Not A Name.json", {})
    assert list(user_design_files()) == ["my_chair"]
    assert template("my_chair").title == "My chair"
    assert "my_chair" in [one.name for one in templates_of_class(5)]


def test_a_library_name_is_never_taken_over(library):
    write_json(library / "chair.json", import_blocks(chair(), WISH).content | {"name": "chair"})
    assert template("chair").title == "Chair"


def test_a_design_file_of_a_family_is_furniture_too(library):
    raw = {
        "name": "tall_vase",
        "title": "Tall vase",
        "class": "objs",
        "family": "on_plinth",
        "size_m": {"depth": [0.2, 0.3, 0.4], "width": [0.2, 0.3, 0.4], "height": [0.5, 1.0, 1.5]},
        "front": "any side",
        "clearance_m": {"front": 0, "back": 0, "side": 0},
        "materials": {
            "plinth": {"kind": "stone", "of": "andesite"},
            "thing": {"kind": "fixed", "of": "decorated_pot"},
        },
    }
    write_json(library / "tall_vase.json", raw)
    assert template("tall_vase").typical_m == (0.3, 0.3, 1.0)


def test_the_folder_is_where_settings_lie():
    assert str(user_design_folder({"W2M_FURNITURE": "/a/b"})) == "/a/b"
    linux = user_design_folder({"XDG_CONFIG_HOME": "/settings"}, "linux")
    assert linux.as_posix() == "/settings/world2minecraft/furniture"
    windows = user_design_folder({"APPDATA": "C:/Users/me/Roaming"}, "win32")
    assert windows.as_posix() == "C:/Users/me/Roaming/world2minecraft/furniture"


def test_entities_and_labels_do_not_matter():
    labelled = replace(chair(), semantic=np.full((5, 5, 5), 5, np.uint8))
    assert import_blocks(labelled, WISH).content == import_blocks(chair(), WISH).content
