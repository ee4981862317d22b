"""Houses by other people: through every format and back, nothing changes but what is told."""

from pathlib import Path

import numpy as np
import pytest
from block_volumes import state_texts
from nbt_equality import same_block_entities, same_entities

from world2minecraft.core.types import AIR, BlockVolume
from world2minecraft.minecraft.file_format import Losses, WriteOptions
from world2minecraft.minecraft.formats import read_blocks, write_blocks
from world2minecraft.minecraft.schematics.structure import write_structure
from world2minecraft.minecraft.versions import game_version

TARGETS = {
    "world": ("room", {}),
    "Sponge 2": ("room.schem", {"schem_version": 2}),
    "Sponge 3": ("room.schem", {"schem_version": 3}),
    "Litematica": ("room.litematic", {}),
    "structure": ("room.nbt", {}),
}


@pytest.fixture(scope="session")
def real_files(shared_data: Path) -> list[Path]:
    folders = ("mcprefab_builds", "mvs_structures_nbt", "litemapy_litematics")
    found = [path for name in folders for path in sorted((shared_data / name).iterdir())]
    found = [path for path in found if path.suffix in (".schem", ".nbt", ".litematic")]
    assert len(found) == 20
    return found


def texts_at_home(volume: BlockVolume) -> dict[tuple[int, ...], str]:
    """The blocks that are not air, by their place in the world."""
    texts = state_texts(volume)
    cells = np.argwhere(texts != AIR)
    return {tuple(c): str(texts[tuple(c - volume.corner)]) for c in cells + volume.corner}


@pytest.mark.parametrize("target", TARGETS)
def test_a_house_goes_through_a_format_unchanged(target, real_files, tmp_path):
    name, options = TARGETS[target]
    mods = 0
    for number, path in enumerate(real_files):
        before = read_blocks(path)
        losses = Losses()
        out = tmp_path / str(number) / name
        write_blocks(before, out, WriteOptions(**options), losses)
        after = read_blocks(out)
        assert not list(losses), path.name
        assert texts_at_home(after) == texts_at_home(before), path.name
        assert same_block_entities(after, before), path.name
        same = sorted_by_place(before), sorted_by_place(after)
        assert same_entities(*same, places=1e-6), path.name
        mods += sum(not state.startswith("minecraft:") for state in after.palette)
    assert mods > 0  # Blocks of mods keep their names.


def sorted_by_place(volume: BlockVolume) -> BlockVolume:
    from dataclasses import replace

    return replace(volume, entities=tuple(sorted(volume.entities, key=lambda e: e.position)))


def test_reading_and_writing_a_format_twice_changes_no_byte(real_files, tmp_path):
    for number, path in enumerate(real_files):
        first, second = (tmp_path / f"{number}_{turn}{path.suffix}" for turn in "ab")
        write_blocks(read_blocks(path), first)
        write_blocks(read_blocks(first), second)
        assert first.read_bytes() == second.read_bytes()


def test_what_is_listed_stays_listed(shared_data, tmp_path):
    """A structure that leaves places as they are is written so again where that is asked."""
    path = shared_data / "mvs_structures_nbt" / "barn.nbt"
    before, told = read_blocks(path), Losses()
    write_structure(before, tmp_path / "a.nbt", version=game_version(), clears=False)
    read_blocks(tmp_path / "a.nbt", told)
    ((what, count),) = told
    assert what == "positions that the structure leaves unchanged"
    assert count == (state_texts(before) == AIR).sum()
