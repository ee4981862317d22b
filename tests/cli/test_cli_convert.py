"""``w2m convert``: any pair of formats, and nothing lost when it goes wrong."""

import os

import numpy as np
import pytest

from world2minecraft import cli
from world2minecraft.minecraft import formats
from world2minecraft.minecraft.formats import read_blocks, write_blocks
from world2minecraft.types import AIR, BlockVolume


@pytest.fixture
def volume():
    """A corner of stone with an oak stair, so that a mirror image would differ."""
    states = np.zeros((3, 4, 5), np.uint16)
    states[0, 0, :], states[:, 0, 0], states[1, 1, 1] = 1, 1, 2
    stair = "minecraft:oak_stairs[facing=east,half=bottom,shape=straight,waterlogged=false]"
    return BlockVolume(
        states,
        (AIR, "minecraft:stone", stair),
        np.zeros(states.shape, np.uint8),
        np.zeros(states.shape, np.uint16),
        (0, 64, 0),
        np.eye(4),
    )


@pytest.fixture
def schem(volume, tmp_path):
    write_blocks(volume, tmp_path / "a.schem")
    return tmp_path / "a.schem"


def names(volume):
    """The state of each block, without the air around them."""
    states = np.array(volume.palette, object)[volume.states]
    filled = np.argwhere(volume.states)
    low, high = filled.min(0), filled.max(0) + 1
    return states[low[0] : high[0], low[1] : high[1], low[2] : high[2]].tolist()


def convert(*words):
    return cli.run(["convert", *map(str, words)])


def test_a_schematic_goes_to_a_world_and_back(schem, volume, tmp_path, capsys):
    assert convert(schem, tmp_path / "worlds" / "house") == 0
    assert convert(tmp_path / "worlds" / "house", tmp_path / "b.schem") == 0
    assert names(read_blocks(tmp_path / "b.schem")) == names(volume)
    assert f"{tmp_path / 'b.schem'}: 8 blocks of 2 kinds" in capsys.readouterr().out


def test_a_schematic_goes_to_a_datapack(schem, tmp_path):
    assert convert(schem, tmp_path / "house.zip") == 0
    assert (tmp_path / "house.zip").read_bytes()[:2] == b"PK"


def test_what_is_there_stays_without_force(schem, volume, tmp_path, capsys):
    (tmp_path / "b.schem").write_bytes(b"mine")
    assert convert(schem, tmp_path / "b.schem") == 2
    assert capsys.readouterr().err == (
        f"error: {tmp_path / 'b.schem'} is there already; add --force to replace it\n"
    )
    assert (tmp_path / "b.schem").read_bytes() == b"mine"
    assert convert(schem, tmp_path / "b.schem", "--force") == 0
    assert names(read_blocks(tmp_path / "b.schem")) == names(volume)


def test_a_world_is_replaced_whole(schem, tmp_path):
    world = tmp_path / "house"
    assert convert(schem, world) == 0
    (world / "stray.txt").write_text("old")
    assert convert(schem, world, "--force") == 0
    assert not (world / "stray.txt").exists()
    assert (world / "level.dat").is_file()


def test_a_world_comes_back_where_its_successor_cannot_be_put(schem, tmp_path, monkeypatch):
    world, replace = tmp_path / "house", os.replace
    assert convert(schem, world) == 0
    (world / "stray.txt").write_text("old")

    def full(source, target):
        if os.path.basename(source) == "house" and os.path.dirname(source) != str(tmp_path):
            raise OSError(28, "No space left on device")
        replace(source, target)

    monkeypatch.setattr(os, "replace", full)
    assert convert(schem, world, "--force") == 3
    assert (world / "stray.txt").read_text() == "old"


def test_a_folder_that_is_no_world_is_never_replaced(schem, tmp_path, capsys):
    (tmp_path / "thesis").mkdir()
    (tmp_path / "thesis" / "chapter").write_text("years of work")
    assert convert(schem, tmp_path / "thesis", "--force") == 2
    assert "no world (no level.dat)" in capsys.readouterr().err
    assert (tmp_path / "thesis" / "chapter").read_text() == "years of work"


def test_a_file_is_not_converted_to_itself(schem, capsys):
    before = schem.read_bytes()
    assert convert(schem, schem, "--force") == 2
    assert "is both A and B" in capsys.readouterr().err
    assert schem.read_bytes() == before


@pytest.mark.parametrize("step", ["write", "rename"])
def test_a_write_that_fails_leaves_the_old_one_and_no_litter(schem, tmp_path, monkeypatch, step):
    target = tmp_path / "b.schem"
    target.write_bytes(b"old")

    def full(*_):
        raise OSError(28, "No space left on device", str(target))

    if step == "write":
        monkeypatch.setattr(formats, "write_blocks", full)
    else:
        monkeypatch.setattr(os, "replace", full)
    assert convert(schem, target, "--force") == 3
    assert target.read_bytes() == b"old"
    assert sorted(os.listdir(tmp_path)) == ["a.schem", "b.schem"]


@pytest.mark.parametrize(
    ("a", "b", "code", "reason"),
    [
        ("gone.schem", "b.schem", 3, "gone.schem: is not there"),
        ("damaged.schem", "b.schem", 3, "damaged.schem: "),
        ("notes.txt", "b.schem", 3, "notes.txt: is no block file"),
        ("a.schem", "b.xyz", 2, "b.xyz: no block format ends in .xyz; known: "),
        ("a.schem", "notes.txt/b.schem", 3, "notes.txt: is a file"),
    ],
)
def test_bad_input_is_one_line_and_writes_nothing(schem, tmp_path, capsys, a, b, code, reason):
    (tmp_path / "damaged.schem").write_bytes(schem.read_bytes()[:50])
    (tmp_path / "notes.txt").write_text("hello")
    before = sorted(os.listdir(tmp_path))
    assert convert(tmp_path / a, tmp_path / b) == code
    out, err = capsys.readouterr()
    assert reason in err
    assert err.count("\n") == 1
    assert out == ""
    assert sorted(os.listdir(tmp_path)) == before


def test_the_same_input_gives_the_same_bytes(schem, tmp_path):
    for name in ("one.schem", "two.schem"):
        assert convert(schem, tmp_path / name) == 0
    assert (tmp_path / "one.schem").read_bytes() == (tmp_path / "two.schem").read_bytes()
