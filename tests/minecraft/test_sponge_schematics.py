import gzip
import json
from dataclasses import replace
from pathlib import Path

import mcschematic
import nbtlib
import numpy as np
import pytest
from block_volumes import furnished_volume, random_volume, state_texts, volume_of

from world2minecraft.core.errors import DamagedFileError, InputError, LimitError, UsageError
from world2minecraft.core.types import AIR, Entity
from world2minecraft.minecraft.block_states import parse_state
from world2minecraft.minecraft.file_format import Losses
from world2minecraft.minecraft.formats import read_blocks
from world2minecraft.minecraft.nbt import Short, pack_gzip, read_nbt, unpack, write_nbt
from world2minecraft.minecraft.schematics.sponge import read_schem, write_schem
from world2minecraft.minecraft.versions import game_version

VOLUMES = {
    "small": random_volume((5, 4, 3), 10, (-2, 63, 8)),
    "numbers of two bytes": random_volume((23, 9, 31), 300, (0, 64, 0), seed=4),
    "numbers of three bytes": volume_of(
        np.arange(20_000).reshape(40, 20, 25) % 17_000,
        (AIR, *(f"mod:block_{number}" for number in range(17_000 - 1))),
        (7, -60, 7),
    ),
}
each_volume = pytest.mark.parametrize("volume", VOLUMES.values(), ids=VOLUMES.keys())
each_version = pytest.mark.parametrize("schem_version", [1, 2, 3])


@each_volume
@each_version
def test_a_schematic_comes_back_block_for_block(volume, schem_version, tmp_path):
    write_schem(volume, tmp_path / "a.schem", schem_version=schem_version)
    found = read_schem(tmp_path / "a.schem")
    assert found.corner == volume.corner
    np.testing.assert_array_equal(state_texts(found), state_texts(volume))


@each_version
def test_block_entities_and_entities_come_back(schem_version, tmp_path):
    volume = furnished_volume()
    write_schem(volume, tmp_path / "a.schem", schem_version=schem_version)
    found = read_schem(tmp_path / "a.schem")
    if schem_version == 1:  # It has no place for entities, and does not say its game.
        ids = [(held.id, held.block_pos) for held in volume.block_entities]
        assert [(held.id, held.block_pos) for held in found.block_entities] == ids
        assert not found.entities
        return
    assert found.block_entities == volume.block_entities
    (entity,) = found.entities
    assert (entity.position, entity.id) == (volume.entities[0].position, volume.entities[0].id)
    assert entity.nbt.items() >= volume.entities[0].nbt.items()


@pytest.mark.parametrize("name", ["small", "numbers of two bytes"])
def test_mcschematic_reads_the_same_blocks(name, tmp_path):
    volume = VOLUMES[name]
    write_schem(volume, tmp_path / "a.schem")
    found = mcschematic.MCSchematic(str(tmp_path / "a.schem"))
    texts = state_texts(volume)
    for cell in np.ndindex(volume.states.shape):
        assert found.getBlockStateAt(cell) == texts[cell]


@each_version
def test_nbtlib_reads_the_same_blocks(schem_version, tmp_path):
    volume = VOLUMES["small"]
    write_schem(volume, tmp_path / "a.schem", schem_version=schem_version)
    root = nbtlib.load(tmp_path / "a.schem")
    tree = root["Schematic"] if schem_version == 3 else root
    assert root.root_name == ("" if schem_version == 3 else "Schematic")
    assert tree["Version"] == schem_version
    assert tree.get("DataVersion") == (None if schem_version == 1 else 3465)
    assert list(tree["Offset"]) == list(volume.corner)
    blocks = tree["Blocks"] if schem_version == 3 else tree
    name_of = {int(number): str(text) for text, number in blocks["Palette"].items()}
    data = np.array(blocks["Data" if schem_version == 3 else "BlockData"]).astype(np.uint8)
    width, height, length = (int(tree[side]) for side in ("Width", "Height", "Length"))
    assert (width, height, length) == volume.states.shape
    texts = state_texts(volume)
    for x, y, z in np.ndindex(width, height, length):
        assert name_of[int(data[(y * length + z) * width + x])] == texts[x, y, z]


def test_a_schematic_of_mcschematic_is_read(tmp_path):
    theirs = mcschematic.MCSchematic()
    blocks = {
        (3, 60, -2): "minecraft:oak_stairs[facing=east,half=bottom]",
        (3, 61, -2): "minecraft:stone",
        (5, 60, 4): "minecraft:stone",
    }
    for place, state in blocks.items():
        theirs.setBlock(place, state)
    theirs.save(str(tmp_path), "theirs", mcschematic.Version.JE_1_20_1)
    found = read_schem(tmp_path / "theirs.schem")
    texts = state_texts(found)
    assert found.corner == (3, 60, -2)
    for place, state in blocks.items():
        assert texts[tuple(np.subtract(place, found.corner))] == state
    assert (found.states > 0).sum() == len(blocks)


def test_hanging_entities_of_worldedit_name_their_block(tmp_path):
    # Copied from 1200 70 -300 by a player at 1203 71 -295: version 3 counts from him. The
    # painting is 4 blocks wide, so that it names a block beside the one of its middle.
    names = dict(zip(("TileX", "TileY", "TileZ"), (1202, 71, -299), strict=True))
    frame = Entity((1201.5, 71.5, -298.97), "minecraft:painting", names)
    volume = volume_of(np.ones((4, 3, 2)), (AIR, "minecraft:stone"), (1200, 70, -300))
    write_schem(replace(volume, entities=(frame,)), tmp_path / "a.schem", schem_version=3)
    root = read_nbt(unpack((tmp_path / "a.schem").read_bytes(), "a"), "a")[1]
    root["Schematic"]["Offset"] = np.array((-3, -1, -5), np.int32)
    for tags, expected in (
        ({"WorldEdit": {"Origin": np.array((1203, 71, -295), np.int32)}}, (-1, 0, -4)),
        ({}, (-2, 0, -4)),  # What lies nowhere near becomes the entity's own block.
        ({"WorldEdit": 5}, (-2, 0, -4)),
    ):
        tree = {"Schematic": {**root["Schematic"], "Metadata": tags}}
        (tmp_path / "b.schem").write_bytes(pack_gzip(write_nbt(tree)))
        (found,) = read_schem(tmp_path / "b.schem").entities
        np.testing.assert_allclose(found.position, (-1.5, 0.5, -3.97))
        assert tuple(found.nbt[key] for key in names) == expected


@pytest.mark.parametrize(("schem_version", "key"), [(2, "BiomeData"), (3, "Biomes")])
def test_biomes_are_told_of(tmp_path, schem_version, key):
    write_schem(furnished_volume(), tmp_path / "a.schem", schem_version=schem_version)
    root = read_nbt(unpack((tmp_path / "a.schem").read_bytes(), "a"), "a")[1]
    root.get("Schematic", root)[key] = np.zeros(3, np.int8)
    (tmp_path / "b.schem").write_bytes(pack_gzip(write_nbt(root)))
    losses = Losses()
    read_blocks(tmp_path / "b.schem", losses)
    assert dict(losses) == {"biomes": 1}


def test_an_entity_that_is_nowhere_is_refused(tmp_path):
    write_schem(furnished_volume(), tmp_path / "a.schem")
    root = read_nbt(unpack((tmp_path / "a.schem").read_bytes(), "a"), "a")[1]
    root["Entities"][0]["Pos"] = [0.0, float("nan"), 0.0]
    (tmp_path / "a.schem").write_bytes(pack_gzip(write_nbt(root, "Schematic")))
    with pytest.raises(DamagedFileError, match="is not a valid Sponge schematic"):
        read_schem(tmp_path / "a.schem")


def test_names_follow_the_version(tmp_path):
    volume = volume_of(np.ones((1, 1, 1)), (AIR, "minecraft:chain[axis=y]"), (0, 0, 0))
    for name, expected in (("1.21.8", "minecraft:chain"), ("1.21.9", "minecraft:iron_chain")):
        write_schem(volume, tmp_path / "a.schem", version=game_version(name))
        assert read_schem(tmp_path / "a.schem").palette == volume.palette
        root = nbtlib.load(tmp_path / "a.schem")
        assert root["DataVersion"] == game_version(name).data_version
        assert set(root["Palette"]) == {AIR, f"{expected}[axis=y]"}


def test_a_side_that_is_too_long_is_refused(tmp_path):
    with pytest.raises(UsageError, match="must be 1 to 65,535 blocks"):
        write_schem(volume_of(np.zeros((65_536, 1, 1)), (AIR,), (0, 0, 0)), tmp_path / "a.schem")
    long = volume_of(np.ones((65_535, 1, 1)), (AIR, "minecraft:stone"), (0, 0, 0))
    write_schem(long, tmp_path / "a.schem")
    assert read_schem(tmp_path / "a.schem").states.shape == (65_535, 1, 1)


# Files of others.


def houses(folder: Path) -> list[Path]:
    return sorted((folder / "mcprefab_builds").glob("*.schem"))


def test_houses_made_by_others_read_as_nbtlib_reads_them(shared_data):
    for path in houses(shared_data):
        found = read_schem(path)
        root = nbtlib.load(path)
        tree = root.get("Schematic", root)
        name_of = {int(number): str(parse_state(t)) for t, number in tree["Palette"].items()}
        numbers, value, shift = [], 0, 0
        for byte in np.array(tree["BlockData"]).astype(np.uint8).tolist():
            value |= (byte & 127) << shift
            shift += 7
            if byte < 128:
                numbers.append(value)
                value, shift = 0, 0
        texts = state_texts(found).transpose(1, 2, 0).ravel()
        assert texts.tolist() == [name_of[number] for number in numbers]


def test_blocks_of_mods_survive_reading_and_writing(shared_data, tmp_path):
    strange = set()
    for path in houses(shared_data):
        found = read_schem(path)
        strange |= {state for state in found.palette if not state.startswith("minecraft:")}
        for schem_version in (2, 3):
            write_schem(found, tmp_path / "again.schem", schem_version=schem_version)
            again = read_schem(tmp_path / "again.schem")
            np.testing.assert_array_equal(state_texts(again), state_texts(found))
            assert again.block_entities == found.block_entities
    assert strange


# Damaged files.


def tree_with(**changes) -> dict:
    tree = {
        "Version": 2,
        "DataVersion": 3465,
        "Width": Short(2),
        "Height": Short(1),
        "Length": Short(2),
        "Palette": {"minecraft:air": 0, "minecraft:stone": 1},
        "BlockData": np.array([0, 1, 1, 0], np.int8),
    }
    return {key: value for key, value in (tree | changes).items() if value is not None}


DAMAGED = {
    "a palette index out of range": tree_with(BlockData=np.array([0, 1, 2, 0], np.int8)),
    "a huge palette index": tree_with(BlockData=np.array([0, 1, -1, -1, -1, 127, 0], np.int8)),
    "an endless varint": tree_with(BlockData=np.full(40, -1, np.int8)),
    "too few blocks": tree_with(BlockData=np.array([0, 1, 1], np.int8)),
    "a varint cut short": tree_with(BlockData=np.array([0, 1, 1, -128], np.int8)),
    "too many blocks": tree_with(BlockData=np.array([0, 1, 1, 0, 0], np.int8)),
    "no width": tree_with(Width=None),
    "a width of nothing": tree_with(Width=Short(0)),
    "a volume of 281 million million blocks": tree_with(
        Width=Short(-1), Height=Short(-1), Length=Short(-1)
    ),
    "no palette": tree_with(Palette=None),
    "a palette that is a list": tree_with(Palette=["minecraft:stone"]),
    "a palette of texts": tree_with(Palette={"minecraft:stone": "one"}),
    "two states of one number": tree_with(Palette={"minecraft:stone": 0, "minecraft:dirt": 0}),
    "a negative number": tree_with(Palette={"minecraft:stone": -1}),
    "a name that is none": tree_with(Palette={"minecraft:air": 0, "Rock & Roll": 1}),
    "block data that is text": tree_with(BlockData="blocks"),
    "an unknown version": tree_with(Version=9),
    "a version that is text": tree_with(Version="two"),
    "an offset of two": tree_with(Offset=np.zeros(2, np.int32)),
    "a block entity without a place": tree_with(BlockEntities=[{"Id": "minecraft:sign"}]),
    "a structure file": {"size": [1, 1, 1], "blocks": [], "palette": []},
}


def refused(path: Path) -> str:
    with pytest.raises(InputError) as caught:
        read_schem(path)
    text = str(caught.value)
    assert text.startswith(f"{path}: ")
    assert "\n" not in text
    assert isinstance(caught.value, DamagedFileError | LimitError | InputError)
    return text.removeprefix(f"{path}: ")


@pytest.mark.parametrize("tree", DAMAGED.values(), ids=DAMAGED.keys())
def test_a_damaged_schematic_is_refused_by_name(tree, tmp_path):
    path = tmp_path / "bad.schem"
    path.write_bytes(pack_gzip(write_nbt(tree, "Schematic")))
    refused(path)


def test_what_the_errors_say(tmp_path):
    path = tmp_path / "bad.schem"
    expected = {
        "a palette index out of range": "contains the block index 2, which is not in the palette",
        "too few blocks": "declares 4 blocks but contains fewer",
        "a volume of 281 million million blocks": "declares a size of 65535 x 65535 x"
        " 65535 blocks; expected 1 to"
        " 67,108,864 blocks",
        "no width": "is not a valid Sponge schematic ('Width' is missing)",
        "an unknown version": "has Sponge schematic version 9; supported: 1 to 3",
    }
    for name, text in expected.items():
        path.write_bytes(pack_gzip(write_nbt(DAMAGED[name], "Schematic")))
        assert refused(path) == text


def test_a_file_that_is_no_schematic_is_refused(tmp_path):
    path = tmp_path / "bad.schem"
    assert "cannot be read" in refused(path)
    for data in (b"", b"PK\3\4 a zip", json.dumps({"a": 1}).encode(), gzip.compress(b"text")):
        path.write_bytes(data)
        assert "is not valid NBT" in refused(path)


def test_a_file_cut_short_is_refused(tmp_path):
    write_schem(VOLUMES["small"], tmp_path / "a.schem")
    data = (tmp_path / "a.schem").read_bytes()
    for length in (1, 9, 20, len(data) // 2, len(data) - 1):
        (tmp_path / "a.schem").write_bytes(data[:length])
        refused(tmp_path / "a.schem")


def test_any_flipped_byte_is_refused_or_read(tmp_path):
    path = tmp_path / "a.schem"
    write_schem(VOLUMES["small"], path)
    plain = bytearray(unpack(path.read_bytes(), path))
    rng = np.random.default_rng(8)
    for at in rng.integers(0, len(plain), 200).tolist():
        changed = bytearray(plain)
        changed[at] ^= int(rng.integers(1, 256))
        path.write_bytes(bytes(changed))
        try:
            read_schem(path)
        except InputError as error:
            assert str(error).startswith(str(path))


def test_a_schematic_without_compression_is_read(tmp_path):
    path = tmp_path / "a.schem"
    write_schem(VOLUMES["small"], path)
    path.write_bytes(unpack(path.read_bytes(), path))
    assert read_nbt(path.read_bytes(), path)[0] == "Schematic"
    np.testing.assert_array_equal(state_texts(read_schem(path)), state_texts(VOLUMES["small"]))
