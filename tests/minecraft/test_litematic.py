from pathlib import Path

import nbtlib
import numpy as np
import pytest
from block_volumes import furnished_volume, random_volume, state_texts, volume_of
from hypothesis import given
from hypothesis import strategies as st
from nbt_equality import same_block_entities, same_entities

from world2minecraft.core.errors import InputError, LimitError, UsageError
from world2minecraft.core.types import AIR, Entity
from world2minecraft.minecraft.bit_packing import (
    bit_width,
    pack_straddled,
    straddled_word_count,
    unpack_straddled,
)
from world2minecraft.minecraft.file_format import Losses
from world2minecraft.minecraft.nbt import pack_gzip, read_nbt, unpack, write_nbt
from world2minecraft.minecraft.schematics import litematic
from world2minecraft.minecraft.schematics.litematic import (
    read_litematic,
    read_regions,
    write_litematic,
    write_regions,
)
from world2minecraft.minecraft.state_nbt import state_text
from world2minecraft.minecraft.versions import game_version

STONE, WOOD = "minecraft:stone", "minecraft:oak_planks"
VOLUMES = {
    "small": random_volume((5, 4, 3), 10, (-2, 63, 8)),
    "of 300 states": random_volume((23, 9, 31), 300, (0, 64, 0), seed=4),
    "of 17,000 states": volume_of(
        np.arange(20_000).reshape(40, 20, 25) % 17_000,
        (AIR, *(f"mod:block_{number}" for number in range(17_000 - 1))),
        (7, -60, 7),
    ),
    "one block": volume_of(np.ones((1, 1, 1)), (AIR, STONE), (0, 0, 0)),
    "air": volume_of(np.zeros((3, 1, 2)), (AIR,), (0, 0, 0)),
}
each_volume = pytest.mark.parametrize("volume", VOLUMES.values(), ids=VOLUMES.keys())


def bits_slowly(words: np.ndarray, bits: int, count: int) -> list[int]:
    """The numbers in packed words, read as one long binary number."""
    whole = int.from_bytes(words.astype("<u8").tobytes(), "little")
    return [whole >> (bits * index) & ((1 << bits) - 1) for index in range(count)]


def texts_slowly(path: Path) -> dict[tuple[int, int, int], str]:
    """The blocks of a file by their place, read by nbtlib and plain arithmetic."""
    root = nbtlib.load(path)
    found: dict[tuple[int, int, int], str] = {}
    for region in root["Regions"].values():
        size = [int(region["Size"][axis]) for axis in "xyz"]
        start = [int(region["Position"][axis]) for axis in "xyz"]
        low = [p + (s + 1 if s < 0 else 0) for p, s in zip(start, size, strict=True)]
        width, height, length = map(abs, size)
        names = [state_text(entry.unpack()) for entry in region["BlockStatePalette"]]
        bits = max(2, (len(names) - 1).bit_length())
        words = np.array(region["BlockStates"]).astype(np.int64).view(np.uint64)
        numbers = bits_slowly(words, bits, width * height * length)
        for index, number in enumerate(numbers):
            y, rest = divmod(index, width * length)
            z, x = divmod(rest, width)
            place = (low[0] + x, low[1] + y, low[2] + z)
            if place not in found or names[number] != AIR:
                found[place] = names[number]
    return found


@given(st.integers(1, 16), st.lists(st.integers(0, 0xFFFF), min_size=1, max_size=200))
def test_straddled_numbers_come_back(bits, values):
    cells = np.array(values, np.uint16) & np.uint16((1 << bits) - 1)
    words = np.zeros(straddled_word_count(len(cells), bits), np.uint64)
    pack_straddled(cells, bits, words)
    assert bits_slowly(words, bits, len(cells)) == cells.tolist()
    out = np.zeros((1, 1, len(cells)), np.uint16)
    assert unpack_straddled(words, bits, np.arange(1 << bits).astype(np.uint16), out) == -1
    assert out.ravel().tolist() == cells.tolist()


def test_the_bits_of_a_palette():
    assert [bit_width(count, 2) for count in (1, 4, 5, 256, 257)] == [2, 2, 3, 8, 9]


@each_volume
def test_a_file_comes_back_block_for_block(volume, tmp_path):
    write_litematic(volume, tmp_path / "a.litematic")
    found = read_litematic(tmp_path / "a.litematic")
    assert found.corner == volume.corner
    np.testing.assert_array_equal(state_texts(found), state_texts(volume))


@each_volume
def test_another_reader_finds_the_same_blocks(volume, tmp_path):
    write_litematic(volume, tmp_path / "a.litematic")
    theirs = texts_slowly(tmp_path / "a.litematic")
    texts = state_texts(volume)
    assert theirs == {place: texts[place] for place in np.ndindex(texts.shape)}


def test_block_entities_and_entities_come_back(tmp_path):
    volume = furnished_volume()
    write_litematic(volume, tmp_path / "a.litematic")
    found = read_litematic(tmp_path / "a.litematic")
    assert same_block_entities(found, volume)
    (entity,) = found.entities
    assert (entity.position, entity.id) == (volume.entities[0].position, volume.entities[0].id)
    assert entity.nbt.items() >= volume.entities[0].nbt.items()
    region = nbtlib.load(tmp_path / "a.litematic")["Regions"]["room"]
    assert [int(region["TileEntities"][0][axis]) for axis in "xyz"] == [3, 1, 2]
    assert list(region["Entities"][0]["Pos"]) == [1.75, 1.5, 4.75]


@pytest.mark.parametrize(
    ("name", "file_version"), [("1.20.1", 6), ("1.20.4", 6), ("1.20.5", 7), ("1.21.4", 7)]
)
def test_the_file_says_its_version_and_what_it_holds(name, file_version, tmp_path):
    write_litematic(VOLUMES["small"], tmp_path / "a", name="Küche", version=game_version(name))
    root = nbtlib.load(tmp_path / "a")
    assert root["Version"] == file_version
    assert root["MinecraftDataVersion"] == game_version(name).data_version
    held = root["Metadata"]
    assert (held["Name"], held["RegionCount"]) == ("Küche", 1)
    assert held["TotalVolume"] == 60
    assert held["TotalBlocks"] == (VOLUMES["small"].states > 0).sum()
    assert {axis: int(held["EnclosingSize"][axis]) for axis in "xyz"} == {"x": 5, "y": 4, "z": 3}
    assert list(root["Regions"]) == ["Küche"]


def test_several_regions_are_written_and_joined(tmp_path):
    parts = {
        "left": volume_of(np.ones((2, 3, 2)), (AIR, STONE), (-5, 60, 0)),
        "right": volume_of(np.ones((4, 1, 1)), (AIR, WOOD), (-4, 62, 1)),
    }
    write_regions(parts, tmp_path / "a.litematic")
    apart = read_regions(tmp_path / "a.litematic")
    assert {name: part.corner for name, part in apart.items()} == {
        "left": (-5, 60, 0),
        "right": (-4, 62, 1),
    }
    losses = Losses()
    found = read_litematic(tmp_path / "a.litematic", losses)
    assert list(losses) == [("names of regions", 2)]
    assert found.corner == (-5, 60, 0)
    assert found.states.shape == (5, 3, 2)
    texts = state_texts(found)
    assert texts[0, 2, 1] == STONE  # The first part alone.
    assert texts[1, 2, 1] == WOOD  # Where both are the later one stands.
    assert texts[4, 2, 1] == WOOD
    assert texts[4, 0, 0] == AIR


def test_a_later_regions_air_takes_nothing_away(tmp_path):
    parts = {
        "block": volume_of(np.ones((1, 1, 1)), (AIR, STONE), (0, 0, 0)),
        "air": volume_of(np.zeros((2, 1, 1)), (AIR,), (0, 0, 0)),
    }
    write_regions(parts, tmp_path / "a.litematic")
    assert state_texts(read_litematic(tmp_path / "a.litematic")).tolist() == [[[STONE]], [[AIR]]]


@pytest.mark.parametrize("turned", ["x", "y", "z", "xyz"])
def test_a_negative_size_goes_back_from_its_position(turned, tmp_path):
    """The same box, said from another of its corners."""
    volume = furnished_volume()
    path = tmp_path / "a.litematic"
    write_litematic(volume, path)
    _, tree = read_nbt(unpack(path.read_bytes(), path), path)
    region = tree["Regions"]["room"]
    before = read_litematic(path)
    for axis in turned:
        side = region["Size"][axis]
        region["Position"][axis] += side - 1
        region["Size"][axis] = -side
        for entity in region["Entities"]:  # They count from Position.
            entity["Pos"]["xyz".index(axis)] -= side - 1
    path.write_bytes(pack_gzip(write_nbt(tree)))
    after = read_litematic(path)
    assert after.corner == before.corner
    np.testing.assert_array_equal(state_texts(after), state_texts(before))
    assert same_block_entities(after, before) and same_entities(after, before)


@pytest.mark.parametrize("key", ["TileX", "block_pos"])
def test_what_hangs_on_a_block_keeps_it(key, tmp_path):
    block = (4, 65, 1)
    tags = dict(zip(("TileX", "TileY", "TileZ"), block, strict=True))
    nbt = tags if key == "TileX" else {"block_pos": np.array(block, np.int32)}
    frame = Entity((4.5, 65.5, 1.03), "minecraft:item_frame", nbt)
    volume = volume_of(np.ones((3, 3, 3)), (AIR, STONE), (3, 64, -1), entities=(frame,))
    path = tmp_path / "a.litematic"
    write_litematic(volume, path)
    _, tree = read_nbt(unpack(path.read_bytes(), path), path)
    held = tree["Regions"]["room"]["Entities"][0]
    assert [held[k] for k in tags] == [1, 1, 2]  # In the form of 1.20.1.
    (entity,) = read_litematic(path).entities
    assert tuple(entity.nbt[k] for k in tags) == block


# Files of others.


def test_files_made_by_others_come_back_as_they_are(shared_data, tmp_path):
    for path in sorted((shared_data / "litemapy_litematics").glob("*.litematic")):
        found = read_litematic(path)
        slow = texts_slowly(path)
        texts = state_texts(found)
        for place in np.ndindex(texts.shape):
            stated = slow.get(tuple(np.add(place, found.corner).tolist()), AIR)
            assert texts[place] == stated
        write_litematic(found, tmp_path / "again.litematic")
        again = read_litematic(tmp_path / "again.litematic")
        np.testing.assert_array_equal(state_texts(again), texts)
        assert again.corner == found.corner
        assert same_block_entities(again, found) and same_entities(again, found)


def test_what_was_left_behind_is_told(shared_data):
    losses = Losses()
    read_litematic(shared_data / "litemapy_litematics" / "Lite.litematic", losses)
    assert list(losses) == [("names of regions", 4), ("preview images", 1)]


# Damaged files.


def region_with(**changes) -> dict:
    region = {
        "Position": {"x": 0, "y": 0, "z": 0},
        "Size": {"x": 2, "y": 1, "z": 2},
        "BlockStatePalette": [{"Name": AIR}, {"Name": STONE}],
        "BlockStates": np.array([0b01010100], np.int64),
        "TileEntities": [],
        "Entities": [],
    }
    return {key: value for key, value in (region | changes).items() if value is not None}


def tree_with(region: dict | None = None, **changes) -> dict:
    tree = {"Version": 6, "Regions": {"a": region or region_with()}}
    return {key: value for key, value in (tree | changes).items() if value is not None}


HUGE = {"x": 2**31 - 1, "y": -(2**31), "z": 2**31 - 1}
DAMAGED = {
    "no regions": (tree_with(Regions={}), "has 0 regions; expected 1 to 4,096"),
    "regions that are a list": (tree_with(Regions=[1]), "is not a valid Litematica file"),
    "nothing": ({}, "is not a valid Litematica file ('Version' is missing)"),
    "a version of 1.12": (tree_with(Version=3), "version 3; supported: 4 to 7"),
    "a version to come": (tree_with(Version=99), "version 99; supported: 4 to 7"),
    "a version that is text": (tree_with(Version="six"), "version six; supported: 4 to 7"),
    "no size": (
        tree_with(region_with(Size=None)),
        "is not a valid Litematica file ('Size' is missing)",
    ),
    "a size of nothing": (
        tree_with(region_with(Size={"x": 0, "y": 1, "z": 1})),
        "a size of 0 x 1 x 1",
    ),
    "a huge size": (tree_with(region_with(Size=HUGE)), "blocks; expected 1 to 67,108,864 blocks"),
    "regions far apart": (
        tree_with(
            Regions={
                "a": region_with(),
                "b": region_with(Position={"x": 2**31 - 9, "y": 0, "z": 2**31 - 9}),
            }
        ),
        "blocks; expected 1 to 67,108,864 blocks",
    ),
    "too few words": (
        tree_with(region_with(BlockStates=np.zeros(0, np.int64))),
        "declares 4 blocks but contains fewer",
    ),
    "words of another kind": (
        tree_with(region_with(BlockStates=np.zeros(9, np.int32))),
        "declares 4 blocks but contains fewer",
    ),
    "words that are text": (
        tree_with(region_with(BlockStates="a")),
        "is not a valid Litematica file",
    ),
    "a number out of range": (
        tree_with(region_with(BlockStates=np.array([3], np.int64))),
        "contains the block index 3, which is not in the palette",
    ),
    "an empty palette": (
        tree_with(region_with(BlockStatePalette=[])),
        "contains the block index 0, which is not in the palette",
    ),
    "a palette of numbers": (
        tree_with(region_with(BlockStatePalette=[1])),
        "contains an invalid palette entry",
    ),
    "a name that is none": (
        tree_with(region_with(BlockStatePalette=[{"Name": "Rock & Roll"}])),
        "contains an invalid palette entry: block name 'Rock & Roll' is invalid",
    ),
    "an entity without a place": (
        tree_with(region_with(Entities=[{"id": "a"}])),
        "is not a valid Litematica file ('Pos' is missing)",
    ),
    "a block entity without a place": (
        tree_with(region_with(TileEntities=[{"id": "a"}])),
        "is not a valid Litematica file ('x' is missing)",
    ),
    "a corner of two": (
        tree_with(World2Minecraft={"Corner": [1, 2]}),
        "contains a tag World2Minecraft without a Corner of three numbers",
    ),
}


@pytest.mark.parametrize(("tree", "reason"), DAMAGED.values(), ids=DAMAGED.keys())
def test_a_damaged_file_is_refused_by_name(tree, reason, tmp_path):
    path = tmp_path / "bad.litematic"
    path.write_bytes(pack_gzip(write_nbt(tree)))
    with pytest.raises(InputError) as caught:
        read_litematic(path)
    text = str(caught.value)
    assert text.startswith(f"{path}: ") and reason in text and "\n" not in text


def test_nested_regions_too_large_together_are_refused(tmp_path, monkeypatch):
    small = VOLUMES["small"]
    write_regions({"a": small, "b": small}, tmp_path / "a.litematic")
    assert len(read_regions(tmp_path / "a.litematic")) == 2
    monkeypatch.setattr(litematic, "MAX_CELLS", 2 * small.states.size - 1)
    with pytest.raises(LimitError, match="has regions with 120 blocks in total, the limit is 119"):
        read_regions(tmp_path / "a.litematic")


def test_an_empty_volume_is_refused(tmp_path):
    with pytest.raises(UsageError, match="at least one region, each with blocks"):
        write_litematic(volume_of(np.zeros((0, 1, 1)), (AIR,), (0, 0, 0)), tmp_path / "a")
    with pytest.raises(UsageError, match="at least one region"):
        write_regions({}, tmp_path / "a")
