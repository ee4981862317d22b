"""Broken files of every format: a result or a plain error, in bounded time and memory."""

from pathlib import Path

import numpy as np
import pytest
from benchmarks.check_fuzz import MAX_MEGABYTES, bombs, broken_files, outcome_of, read_apart
from block_volumes import furnished_volume, random_volume
from hypothesis import given, settings
from hypothesis import strategies as st

from world2minecraft.minecraft.file_format import WriteOptions
from world2minecraft.minecraft.formats import write_blocks
from world2minecraft.minecraft.nbt import Byte, Long, Short, pack_gzip, write_nbt

COUNT = 4  # Broken copies of each source here; ``benchmarks.check_fuzz`` makes as many as asked.
KNOWN = {"read", "DamagedFileError", "LimitError", "InputError", "UsageError"}


def sources(folder: Path) -> list[Path]:
    """Small files of every format that is written here."""
    volume = random_volume((9, 7, 8), 20, (3, 60, -2))
    for suffix in (".schem", ".litematic", ".nbt"):
        write_blocks(furnished_volume(), folder / f"furnished{suffix}")
        write_blocks(volume, folder / f"random{suffix}")
    write_blocks(volume, folder / "three.schem", WriteOptions(schem_version=3))
    write_blocks(furnished_volume(), folder / "world")
    write_blocks(volume, folder / "old_world", WriteOptions(mc_version="1.15.2"))
    old = {"Width": Short(2), "Height": Short(2), "Length": Short(2), "Materials": "Alpha"}
    old |= {"Blocks": np.arange(50, 58).astype(np.int8), "Data": np.arange(8).astype(np.int8)}
    old |= {"TileEntities": [{"id": "Sign", "x": 0, "y": 0, "z": 0, "Text1": "a"}]}
    (folder / "old.schematic").write_bytes(pack_gzip(write_nbt(old, "Schematic")))
    return sorted(folder.iterdir())


def test_broken_files_are_read_or_refused_in_bounds(tmp_path):
    for name in ("whole", "broken"):
        (tmp_path / name).mkdir()
    broken_files(sources(tmp_path / "whole"), tmp_path / "broken", COUNT)
    made = bombs(tmp_path / "broken", cheap=True)
    report = read_apart(tmp_path / "broken", timeout=120)
    assert {row["outcome"] for row in report["rows"]} <= KNOWN
    assert len(report["rows"]) == made > 10 * COUNT
    bombed = ("zeros", "nested", "lists", "counts", "empties")
    for row in report["rows"]:
        assert row["outcome"] != "read" or not row["name"].startswith(bombed)
    assert report["peak_mb"] < MAX_MEGABYTES


def test_broken_files_of_others_are_read_or_refused_in_bounds(shared_data, tmp_path):
    real = sorted(shared_data.glob("litemapy_litematics/*.litematic"))
    real += sorted(shared_data.glob("mvs_structures_nbt/*.nbt"))
    real += sorted(shared_data.glob("mcprefab_builds/*.schem"))
    broken_files(real, tmp_path, COUNT)
    report = read_apart(tmp_path, timeout=120)
    assert {row["outcome"] for row in report["rows"]} <= KNOWN
    assert report["peak_mb"] < MAX_MEGABYTES


# Trees of the right keys and any values.

NAMES = """
Version DataVersion Width Height Length Offset Palette BlockData Blocks Data BlockEntities
TileEntities Entities Regions Metadata Position Size BlockStatePalette BlockStates x y z Id id
Pos Name Properties size palette palettes blocks pos state nbt entities Materials AddBlocks
SchematicaMapping Schematic World2Minecraft Corner MinecraftDataVersion minecraft:stone
"""
keys = st.sampled_from(NAMES.split())
values = st.recursive(
    st.one_of(
        st.sampled_from([0, 1, -1, 2**31 - 1, -(2**31), 7]),
        st.sampled_from([Byte(1), Short(-1), Short(3), Long(-1), 1.5]),
        st.sampled_from(["", "minecraft:stone", "Alpha", "oak_log[axis=y]", "A b"]),
        st.lists(st.integers(-3, 300), max_size=9).map(lambda v: np.array(v, np.int32)),
        st.lists(st.integers(-3, 100), max_size=9).map(lambda v: np.array(v, np.int8)),
        st.lists(st.integers(-3, 300), max_size=9).map(lambda v: np.array(v, np.int64)),
    ),
    lambda inner: st.one_of(
        st.lists(st.integers(0, 3), max_size=4),
        st.lists(st.dictionaries(keys, inner, max_size=4), max_size=3),
        st.dictionaries(keys, inner, max_size=6),
    ),
    max_leaves=14,
)


@pytest.mark.parametrize("suffix", [".schem", ".litematic", ".nbt", ".schematic"])
@settings(max_examples=15)
@given(st.dictionaries(keys, values, max_size=12))
def test_any_tree_is_read_or_refused(suffix, tmp_path_factory, tree):
    path = tmp_path_factory.getbasetemp() / f"tree{suffix}"
    path.write_bytes(pack_gzip(write_nbt(tree)))
    assert outcome_of(path) in KNOWN


def near_tree(suffix: str, put: dict) -> dict:
    """A tree that is right but for some values."""
    stone = [{"Name": "minecraft:air"}, {"Name": "minecraft:stone"}]
    region = {"Position": {"x": 0, "y": 0, "z": 0}, "Size": {"x": 2, "y": 2, "z": 2}}
    region |= {"BlockStatePalette": stone, "BlockStates": np.array([1], np.int64)}
    sides = {"Width": Short(2), "Height": Short(2), "Length": Short(2)}
    cells = np.array([0, 1, 0, 1, 1, 0, 0, 1], np.int8)
    trees = {
        ".schem": {"Version": 2, "Palette": {"air": 0, "stone": 1}, "BlockData": cells, **sides},
        ".litematic": {"Version": 6, "Regions": {"a": {**region, **put}}},
        ".nbt": {"size": [2, 2, 2], "palette": stone, "blocks": [{"pos": [0, 0, 0], "state": 1}]},
        ".schematic": {"Blocks": cells, "Data": cells, **sides},
    }
    return {**trees[suffix], **put}


@pytest.mark.parametrize("suffix", [".schem", ".litematic", ".nbt", ".schematic"])
@settings(max_examples=25)
@given(st.dictionaries(keys, values, max_size=3))
def test_a_nearly_right_tree_is_read_or_refused(suffix, tmp_path_factory, put):
    path = tmp_path_factory.getbasetemp() / f"tree{suffix}"
    path.write_bytes(pack_gzip(write_nbt(near_tree(suffix, put))))
    assert outcome_of(path) in KNOWN
