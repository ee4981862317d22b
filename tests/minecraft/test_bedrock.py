"""Bedrock structures: by an independent reader of little-endian NBT, and there and back."""

import gzip
import json
import struct
from contextlib import suppress
from importlib.resources import files

import nbtlib
import numpy as np
import pytest
from block_volumes import random_volume, some_states, state_texts, volume_of
from hypothesis import given, settings
from hypothesis import strategies as st

from world2minecraft.core.errors import DamagedFileError, InputError, UsageError
from world2minecraft.core.types import AIR, BlockEntity, Entity
from world2minecraft.minecraft.bedrock.block_entities import bedrock_data, java_state, plain_text
from world2minecraft.minecraft.bedrock.mcstructure import read_mcstructure, write_mcstructure
from world2minecraft.minecraft.bedrock.nbt_little_endian import read_little, write_little
from world2minecraft.minecraft.bedrock.states import (
    bedrock_table,
    bedrock_to_java,
    changed_properties,
    java_to_bedrock,
)
from world2minecraft.minecraft.block_states import states_of
from world2minecraft.minecraft.block_table import block_table
from world2minecraft.minecraft.file_format import Losses
from world2minecraft.minecraft.formats import read_blocks, write_blocks
from world2minecraft.minecraft.nbt import Byte, Float, Long, NbtLimits, Short

STONE = "minecraft:stone"


def there_and_back(volume, tmp_path):
    written, read = Losses(), Losses()
    write_mcstructure(volume, tmp_path / "a.mcstructure", written)
    return read_mcstructure(tmp_path / "a.mcstructure", read), dict(written), dict(read)


def row_of(*states, **held):
    """Blocks along x, each with air beside it, so that none joins another."""
    cells = np.zeros((2 * len(states), 1, 1), np.uint16)
    cells[::2, 0, 0] = np.arange(1, len(states) + 1)
    return volume_of(cells, (AIR, *states), (4, 64, -7), **held)


# States.


def test_every_block_of_java_has_a_bedrock_state():
    table = bedrock_table()
    assert {f"minecraft:{name}" for name in table.written} == set(block_table().blocks)
    for name, block in block_table().blocks.items():
        held = table.written[name.removeprefix("minecraft:")]
        assert isinstance(held, int) or len(held) == block.state_count


def test_a_bedrock_state_goes_to_java_and_comes_back_as_itself():
    """What is written is found again; several Java states may share one Bedrock state."""
    for text in bedrock_table().states:
        name, _, rest = text[:-1].partition("[")
        pairs = (pair.split("=") for pair in rest.split(",") if pair)
        states = {k: {"true": Byte(1), "false": Byte(0)}.get(v, v) for k, v in pairs}
        java = bedrock_to_java(name, states)
        assert java is not None
        again = java_to_bedrock(java)
        assert again is not None and bedrock_to_java(*again) == java


@pytest.mark.parametrize(
    ("java", "bedrock"),
    [
        ("minecraft:oak_planks", ("minecraft:planks", {"wood_type": "oak"})),
        (
            "minecraft:oak_stairs[facing=west,half=top]",
            ("minecraft:oak_stairs", {"upside_down_bit": 1, "weirdo_direction": 1}),
        ),
        ("minecraft:light[level=7]", ("minecraft:light_block", {"block_light_level": 7})),
        ("minecraft:red_concrete", ("minecraft:concrete", {"color": "red"})),
        ("tmeo:shafa[facing=east]", None),
    ],
)
def test_states_as_the_game_has_them(java, bedrock):
    assert java_to_bedrock(java) == bedrock


def test_names_of_newer_and_older_games_are_read():
    assert bedrock_to_java("minecraft:oak_planks", {}) == "minecraft:oak_planks"  # From 1.20.50.
    assert bedrock_to_java("minecraft:wool", {"color": "red"}) == "minecraft:red_wool"  # Before.
    assert bedrock_to_java("minecraft:camera", {}) is None


@pytest.mark.parametrize(
    ("before", "after", "changed"),
    [
        ("oak_stairs[half=top,shape=inner_left]", "oak_stairs[half=bottom]", ("half", "shape")),
        ("glass_pane[north=true]", "glass_pane", ("north",)),
        ("oak_leaves[distance=1,waterlogged=true]", "oak_leaves", ("waterlogged",)),
        ("red_bed[occupied=true]", "red_bed", ()),
        ("red_bed", "white_bed", ("blocks",)),
        ("cave_air", "air", ()),
    ],
)
def test_only_what_time_computes_may_differ(before, after, changed):
    assert changed_properties(f"minecraft:{before}", f"minecraft:{after}") == changed


# Files.


def test_an_independent_reader_finds_the_blocks(tmp_path):
    volume = random_volume((5, 4, 3), 5, (-2, 60, 9))
    write_mcstructure(volume, tmp_path / "a.mcstructure")
    tree = nbtlib.File.load(tmp_path / "a.mcstructure", gzipped=False, byteorder="little")
    assert [int(side) for side in tree["size"]] == [5, 4, 3]
    assert [int(value) for value in tree["structure_world_origin"]] == [-2, 60, 9]
    assert int(tree["format_version"]) == 1
    palette = tree["structure"]["palette"]["default"]["block_palette"]
    numbers = np.array([int(n) for n in tree["structure"]["block_indices"][0]]).reshape(5, 4, 3)
    for cell in np.ndindex(5, 4, 3):
        name, states = java_to_bedrock(volume.palette[volume.states[cell]]) or ("minecraft:air", {})
        entry = palette[int(numbers[cell])]
        assert str(entry["name"]) == name
        assert {str(k): v for k, v in entry["states"].unpack().items()} == states
        assert int(entry["version"]) == bedrock_table().version
    seconds = [int(n) for n in tree["structure"]["block_indices"][1]]
    assert len(seconds) == 60


def test_a_plain_volume_comes_back_whole(tmp_path):
    states = (
        "minecraft:oak_log[axis=x]",
        "minecraft:red_concrete",
        "minecraft:barrel[facing=up,open=false]",
    )
    volume = row_of(*states)
    found, written, read = there_and_back(volume, tmp_path)
    assert found.corner == volume.corner
    np.testing.assert_array_equal(state_texts(found), state_texts(volume))
    assert written == read == {}


# What is worked out again from the blocks beside.
COMPUTED = {"shape", "north", "east", "south", "west", "up", "type", "in_wall", "waterlogged"}


def test_of_all_states_few_are_told_otherwise():
    """And those are counted as lost; none is a block that the program builds with."""
    lost = set()
    for state in some_states(6000, 0):
        bedrock = java_to_bedrock(state)
        assert bedrock is not None
        back = java_state(bedrock_to_java(*bedrock) or AIR, bedrock_data(state) or {})
        if set(changed_properties(state, back)) - COMPUTED:
            lost.add(state.partition("[")[0].removeprefix("minecraft:"))
    assert not [name for name in lost if name.endswith(("_stairs", "_slab", "_wall", "_bed"))]
    assert {"note_block", "mushroom_stem"} <= lost
    assert len(lost) < 80


def test_neighbours_are_worked_out_again(tmp_path):
    states = np.zeros((3, 1, 1), np.uint16)
    states[0], states[1], states[2] = 1, 2, 2
    sides = "north=false,south=false,waterlogged=false"
    volume = volume_of(
        states,
        (AIR, STONE, f"minecraft:glass_pane[east=true,{sides},west=true]"),
        (0, 0, 0),
    )
    found, written, _ = there_and_back(volume, tmp_path)
    assert (
        state_texts(found)[1, 0, 0]
        == "minecraft:glass_pane[east=true,north=false,south=false,waterlogged=false,west=true]"
    )
    assert "west=true" in state_texts(found)[2, 0, 0]
    assert "east=false" in state_texts(found)[2, 0, 0]
    assert written == {"east of minecraft:glass_pane, which Bedrock does not keep": 1}


@pytest.mark.parametrize(
    ("plant", "grows", "state"),
    [
        ("cave_vines", -1, "[berries=false]"),
        ("weeping_vines", -1, ""),
        ("twisting_vines", 1, ""),
        ("kelp", 1, ""),
    ],
)
def test_stems_of_plants_come_back(plant, grows, state, tmp_path):
    tip = "[age=0,berries=false]" if state else "[age=0]"
    palette = (AIR, f"minecraft:{plant}_plant{state}", f"minecraft:{plant}{tip}", STONE)
    column = [3, 1, 1, 2][:: 1 if grows > 0 else -1]
    volume = volume_of(np.array(column).reshape(1, 4, 1), palette, (0, 60, 0))
    found, written, _ = there_and_back(volume, tmp_path)
    np.testing.assert_array_equal(state_texts(found), state_texts(volume))
    assert written == {}


def test_each_kind_of_loss_has_a_line_with_its_count(tmp_path):
    volume = row_of(
        "minecraft:oak_button[face=floor,facing=east,powered=false]",
        "minecraft:oak_button[face=ceiling,facing=west,powered=false]",
        "minecraft:stone_button[face=wall,facing=east,powered=false]",
        "minecraft:vine[east=true,north=false,south=false,up=true,west=false]",
        "minecraft:oak_leaves[distance=2,persistent=true,waterlogged=true]",
    )
    found, written, _ = there_and_back(volume, tmp_path)
    assert written == {
        "facing of minecraft:oak_button, which Bedrock does not keep": 2,
        "up of minecraft:vine, which Bedrock does not keep": 1,
    }
    assert "waterlogged=true" in state_texts(found)[8, 0, 0]


@settings(max_examples=20)
@given(st.integers(0, 10_000))
def test_what_differs_is_what_is_listed(tmp_path_factory, seed):
    """Whatever the blocks and what stands beside them, nothing is lost without a word."""
    rng = np.random.default_rng(seed)
    palette = (AIR, *sorted(set(some_states(30, seed)) - {AIR}))
    cells = rng.integers(0, len(palette), (4, 5, 4))
    volume = volume_of(np.where(rng.random(cells.shape) < 0.4, 0, cells), palette, (0, 0, 0))
    found, written, _ = there_and_back(volume, tmp_path_factory.mktemp("bedrock"))
    expected: dict[str, int] = {}
    for before, after in zip(state_texts(volume).flat, state_texts(found).flat, strict=True):
        for key in changed_properties(before, after):
            line = f"{key} of {before.partition('[')[0]}, which Bedrock does not keep"
            expected[line] = expected.get(line, 0) + 1
    assert {line: count for line, count in written.items() if " of " in line} == expected


def test_water_lies_in_the_second_layer(tmp_path):
    wet = "minecraft:oak_slab[type=bottom,waterlogged=true]"
    found, written, _ = there_and_back(
        row_of(wet, "minecraft:oak_slab[type=top,waterlogged=false]"), tmp_path
    )
    assert state_texts(found)[:, 0, 0].tolist() == [
        wet, AIR, "minecraft:oak_slab[type=top,waterlogged=false]", AIR,
    ]  # fmt: skip
    assert written == {}


@pytest.mark.parametrize(
    "state",
    [
        "minecraft:red_bed[facing=north,occupied=false,part=foot]",
        "minecraft:light_blue_banner[rotation=5]",
        "minecraft:black_wall_banner[facing=west]",
        "minecraft:potted_poppy",
        "minecraft:potted_azalea_bush",
        "minecraft:potted_cactus",
        "minecraft:creeper_head[rotation=3]",
        "minecraft:wither_skeleton_wall_skull[facing=east]",
        "minecraft:white_shulker_box[facing=north]",
        "minecraft:chest[facing=west,type=single,waterlogged=false]",
    ],
)
def test_what_bedrock_keeps_in_data_comes_back(state, tmp_path):
    found, written, _ = there_and_back(row_of(state), tmp_path)
    assert state_texts(found)[0, 0, 0] == state
    assert written == {}


@pytest.mark.parametrize("facing", ["north", "east", "south", "west"])
def test_double_chests_stay_double(facing, tmp_path):
    clockwise = {"north": (1, 0), "east": (0, 1), "south": (-1, 0), "west": (0, -1)}[facing]
    states = np.zeros((3, 1, 3), np.uint16)
    states[1, 0, 1], states[1 + clockwise[0], 0, 1 + clockwise[1]] = 1, 2
    palette = [
        f"minecraft:chest[facing={facing},type={t},waterlogged=false]" for t in ("left", "right")
    ]
    volume = volume_of(states, (AIR, *palette), (-5, 3, 8))
    found, written, _ = there_and_back(volume, tmp_path)
    np.testing.assert_array_equal(state_texts(found), state_texts(volume))
    assert written == {}


def test_signs_keep_their_text(tmp_path):
    lines = ['{"text":"The"}', '{"text":"red ","extra":["kitchen"]}', '""', '""']
    nbt = {"front_text": {"messages": lines, "color": "black"}, "is_waxed": Byte(1)}
    sign = "minecraft:oak_sign[rotation=8,waterlogged=false]"
    volume = row_of(sign, block_entities=(BlockEntity((4, 64, -7), "minecraft:sign", nbt),))
    found, written, _ = there_and_back(volume, tmp_path)
    held = found.block_entities[0]
    assert (held.id, held.block_pos) == ("minecraft:sign", (4, 64, -7))
    texts = [plain_text(line) for line in held.nbt["front_text"]["messages"]]
    assert texts == ["The", "red kitchen", "", ""]
    assert held.nbt["is_waxed"] == 1
    assert written == {}


def test_older_signs_and_odd_lines_are_told():
    old = bedrock_data("minecraft:oak_sign", ("minecraft:sign", {"Text1": '"a"', "Text2": "b"}))
    assert old is not None and old["FrontText"]["Text"] == "a\nb"
    assert plain_text('[{"text":"a"},"b",3]') == "ab3"
    assert plain_text({"text": "new"}) == "new"
    assert plain_text("{broken") == "{broken"


def test_the_rest_is_counted_by_name(tmp_path):
    volume = row_of(
        "tmeo:shafa",
        "minecraft:note_block[instrument=bass,note=3,powered=false]",
        "minecraft:furnace[facing=north,lit=false]",
        block_entities=(
            BlockEntity((8, 64, -7), "minecraft:furnace", {"Items": [{"id": "minecraft:coal"}]}),
        ),
        entities=(Entity((4.0, 65.0, -7.0), "minecraft:cat"),),
    )
    found, written, _ = there_and_back(volume, tmp_path)
    assert written == {
        "blocks of tmeo:shafa, which Bedrock does not have": 1,
        "instrument of minecraft:note_block, which Bedrock does not keep": 1,
        "note of minecraft:note_block, which Bedrock does not keep": 1,
        "block entity data (furnace)": 1,
        "entities": 1,
    }
    assert state_texts(found)[0, 0, 0] == AIR


def test_a_block_that_java_has_not_keeps_its_name(tmp_path):
    write_mcstructure(row_of(STONE), tmp_path / "a.mcstructure")
    data = (tmp_path / "a.mcstructure").read_bytes()
    old, new = b"\x05\x00stone", b"\x06\x00camera"
    assert data.count(struct.pack("<H", 15) + b"minecraft:stone") == 1
    data = data.replace(
        struct.pack("<H", 15) + b"minecraft:stone", struct.pack("<H", 16) + b"minecraft:camera"
    )
    data = data.replace(old, new)
    (tmp_path / "b.mcstructure").write_bytes(data)
    losses = Losses()
    found = read_blocks(tmp_path / "b.mcstructure", losses)
    assert "minecraft:camera" in found.palette
    assert dict(losses) == {"blocks of minecraft:camera, which Java does not have": 1}


def test_data_that_java_keeps_otherwise_is_counted(tmp_path):
    entry = {"name": "minecraft:barrel", "states": {"facing_direction": 1, "open_bit": Byte(0)}}
    data = {"0": {"block_entity_data": {"id": "Barrel", "Items": [{"Name": "minecraft:coal"}]}}}
    held = {"block_palette": [{**entry, "version": 1}], "block_position_data": data}
    tree = {
        "size": np.array([1, 1, 1], np.int32),
        "structure": {
            "block_indices": [np.array([0], np.int32), np.array([-1], np.int32)],
            "palette": {"default": held},
        },
    }
    (tmp_path / "a.mcstructure").write_bytes(write_little(tree))
    losses = Losses()
    found = read_mcstructure(tmp_path / "a.mcstructure", losses)
    assert state_texts(found)[0, 0, 0] == "minecraft:barrel[facing=up,open=false]"
    assert dict(losses) == {"block entity data (Barrel)": 1}


def test_the_same_volume_gives_the_same_bytes(tmp_path):
    volume = random_volume((4, 4, 4), 6, (0, 0, 0))
    for name in ("a", "b"):
        write_blocks(volume, tmp_path / f"{name}.mcstructure")
    first, second = (tmp_path / f"{name}.mcstructure" for name in "ab")
    assert first.read_bytes() == second.read_bytes()


def test_houses_by_other_people_come_back(shared_data, tmp_path):
    """But for what is counted as lost, and what a neighbour that was lost had joined."""
    path = shared_data / "mcprefab_builds" / "modern_library.schem"
    volume = read_blocks(path)
    found, written, read = there_and_back(volume, tmp_path)
    assert written == {} and read == {}
    assert found.corner == volume.corner
    np.testing.assert_array_equal(state_texts(found), state_texts(volume))


# Bad input.


@given(st.data())
def test_a_mutated_file_is_refused_or_read(data):
    tree = {
        "format_version": 1,
        "size": np.array([1, 2, 1], np.int32),
        "structure": {
            "block_indices": [np.array([0, 1], np.int32), np.array([-1, -1], np.int32)],
            "entities": [],
            "palette": {
                "default": {
                    "block_palette": [
                        {"name": STONE, "states": {"stone_type": "stone"}, "version": 1},
                        {"name": "minecraft:bed", "states": {"direction": 0}, "version": 1},
                    ],
                    "block_position_data": {"1": {"block_entity_data": {"id": "Bed", "color": 3}}},
                }
            },
        },
        "structure_world_origin": np.array([0, 0, 0], np.int32),
    }
    raw = bytearray(write_little(tree))
    for _ in range(data.draw(st.integers(1, 4))):
        raw[data.draw(st.integers(0, len(raw) - 1))] = data.draw(st.integers(0, 255))
    cut = data.draw(st.integers(0, len(raw)))
    with suppress(InputError):
        read_mcstructure_bytes(bytes(raw[: cut or None]))


def read_mcstructure_bytes(raw: bytes):
    import tempfile
    from pathlib import Path

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.mcstructure"
        path.write_bytes(raw)
        return read_mcstructure(path)


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"size": np.array([1, 1], np.int32)}, "is not a valid Bedrock structure"),
        ({"size": np.array([5, 5, 5], np.int32)}, "declares 125 blocks, but a block layer has"),
        ({"size": np.array([0, 1, 1], np.int32)}, "declares a size of 0 x 1 x 1 blocks"),
        ({"structure": {}}, "is not a valid Bedrock structure ('block_indices' is missing)"),
        ({"structure": 3}, "is not a valid Bedrock structure"),
    ],
)
def test_what_is_wrong_is_named(change, reason, tmp_path):
    entry = {"name": STONE, "states": {}, "version": 1}
    tree = {
        "size": np.array([1, 1, 1], np.int32),
        "structure": {
            "block_indices": [np.array([0], np.int32), np.array([-1], np.int32)],
            "palette": {"default": {"block_palette": [entry]}},
        },
    }
    path = tmp_path / "b.mcstructure"
    path.write_bytes(write_little({**tree, **change}))
    with pytest.raises(InputError) as caught:
        read_mcstructure(path)
    assert str(caught.value).startswith(f"{path}: {reason}")


def test_an_empty_volume_is_refused(tmp_path):
    with pytest.raises(UsageError, match="1 to 12 million blocks, got 0"):
        write_mcstructure(volume_of(np.zeros((0, 1, 1)), (AIR,), (0, 0, 0)), tmp_path / "a")


# Little-endian NBT.

_LEAVES = st.one_of(
    st.integers(-(1 << 31), (1 << 31) - 1),
    st.integers(-128, 127).map(Byte),
    st.integers(-(1 << 15), (1 << 15) - 1).map(Short),
    st.integers(-(1 << 63), (1 << 63) - 1).map(Long),
    st.floats(allow_nan=False),
    st.floats(allow_nan=False, width=32).map(Float),
    st.text(max_size=20).filter(lambda t: t.isprintable()),
)


@given(
    st.dictionaries(
        st.text(max_size=8).filter(str.isprintable),
        st.recursive(
            _LEAVES,
            lambda inner: st.dictionaries(st.text(max_size=5).filter(str.isprintable), inner),
            max_leaves=8,
        ),
        max_size=5,
    )
)
def test_a_tree_comes_back_from_little_endian_nbt(tree):
    assert read_little(write_little(tree), "a") == tree


def test_bounds_hold_before_memory_is_taken():
    with pytest.raises(DamagedFileError, match="2,000,000,000 values are declared"):
        read_little(b"\x0a\0\0\x09\x01\0a\x03" + struct.pack("<i", 2_000_000_000), "a")
    deep = b"\x0a\0\0" + b"\x0a\x01\0a" * 300
    with pytest.raises(InputError, match="limit of 100 nested tags"):
        read_little(deep, "a")
    wide = write_little({"a": [Byte(0)] * 1000})
    with pytest.raises(InputError, match="limit of 100 NBT values"):
        read_little(wide, "a", NbtLimits(values=100))


def test_the_table_is_small_and_has_its_notice():
    data = files("world2minecraft.minecraft") / "data"
    assert len((data / "bedrock_states.json.gz").read_bytes()) < 200_000
    assert "bedrock_states.json.gz" in (data / "NOTICE-minecraft-data.txt").read_text()
    raw = gzip.decompress((data / "bedrock_states.json.gz").read_bytes())
    assert set(json.loads(raw)) == {"version", "states", "written", "read"}
    assert states_of("minecraft:stone")  # The names are those of the game's own table.
