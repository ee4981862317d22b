from dataclasses import replace

import numpy as np
import pytest
from block_volumes import random_volume, state_texts, volume_of

from world2minecraft.core.errors import InputError, OutputError, UnknownNameError, UsageError
from world2minecraft.core.types import AIR
from world2minecraft.minecraft.file_format import Losses, WriteOptions
from world2minecraft.minecraft.formats import (
    FORMATS,
    LABELS,
    default_spawn,
    read_blocks,
    write_blocks,
)

VOLUME = random_volume((9, 6, 7), 6, (2, 60, -3))


@pytest.mark.parametrize("name", ["room", "room.schem"])
def test_blocks_come_back_from_every_format_that_is_read(name, tmp_path):
    write_blocks(VOLUME, tmp_path / name)
    found = read_blocks(tmp_path / name)
    assert found.corner == VOLUME.corner
    np.testing.assert_array_equal(state_texts(found), state_texts(VOLUME))


def test_one_format_becomes_another(tmp_path):
    write_blocks(VOLUME, tmp_path / "a.schem", WriteOptions(schem_version=3))
    write_blocks(read_blocks(tmp_path / "a.schem"), tmp_path / "b")
    write_blocks(read_blocks(tmp_path / "b"), tmp_path / "c.schem")
    found = read_blocks(tmp_path / "c.schem")
    np.testing.assert_array_equal(state_texts(found), state_texts(VOLUME))


def test_a_data_pack_is_written_and_read(tmp_path):
    write_blocks(VOLUME, tmp_path / "pack.zip", WriteOptions(name="flat"))
    found = read_blocks(tmp_path / "pack.zip")
    np.testing.assert_array_equal(state_texts(found), state_texts(VOLUME))


def test_labels_are_counted_as_lost_where_a_format_has_none(tmp_path):
    labels = np.where(VOLUME.states > 0, 5, 0).astype(np.uint8)
    losses = Losses()
    write_blocks(replace(VOLUME, semantic=labels), tmp_path / "a.schem", losses=losses)
    assert list(losses) == [(LABELS, int((labels > 0).sum()))]


def test_every_format_of_the_registry_loads():
    assert FORMATS.names()[:3] == ("world", "schem", "datapack")
    for name in FORMATS.names():
        assert FORMATS.load(name)().suffix.startswith(".") or name == "world"
    with pytest.raises(UnknownNameError, match="did you mean 'schem'"):
        FORMATS.load("schematic")


def test_what_is_not_there_or_unknown_is_refused(tmp_path):
    with pytest.raises(InputError, match="not found"):
        read_blocks(tmp_path / "missing.schem")
    (tmp_path / "a.txt").write_text("blocks")
    with pytest.raises(InputError, match="is not in a supported format"):
        read_blocks(tmp_path / "a.txt")
    with pytest.raises(InputError, match="is not in a supported format"):
        read_blocks(tmp_path)
    with pytest.raises(
        UsageError, match="unknown file suffix for blocks; use one of: a world folder, .schem"
    ):
        write_blocks(VOLUME, tmp_path / "a.obj")
    with pytest.raises(UsageError, match="schem_version must be 1, 2 or 3"):
        write_blocks(VOLUME, tmp_path / "a.schem", WriteOptions(schem_version=4))
    with pytest.raises(UnknownNameError, match="no Minecraft version"):
        write_blocks(VOLUME, tmp_path / "a.schem", WriteOptions(mc_version="1.7.10"))
    with pytest.raises(OutputError):
        write_blocks(VOLUME, tmp_path / "a.txt" / "b.schem")


def test_default_spawn_is_on_the_floor_of_the_middle():
    states = np.zeros((7, 5, 7))
    states[:, 0] = states[:, 4] = 1  # A floor and a ceiling.
    states[3, 1:3, 3] = 1  # On a pillar in the middle a head would be in the ceiling.
    room = volume_of(states, (AIR, "minecraft:stone"), (10, 63, 10))
    x, y, z = default_spawn(room)
    assert y == 64.0
    assert max(abs(x - 13.5), abs(z - 13.5)) == 1.0


def test_the_player_stands_on_a_slab_and_above_nothing():
    slab = volume_of(np.ones((1, 1, 1)), (AIR, "minecraft:oak_slab[type=bottom]"), (0, 63, 0))
    assert default_spawn(slab) == (0.5, 63.5, 0.5)
    air = volume_of(np.zeros((2, 3, 4)), (AIR,), (0, 63, 0))
    assert default_spawn(air) == (1.0, 66.0, 2.0)
