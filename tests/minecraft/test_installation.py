"""A world is copied whole under a free name, and nothing that is there is touched."""

import os
import shutil

import nbtlib
import numpy as np
import pytest
from block_volumes import volume_of
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.core.errors import InputError, OutputError, UsageError
from world2minecraft.core.file_names import free_name, portable_name
from world2minecraft.core.types import AIR
from world2minecraft.minecraft.worlds import installation as installing
from world2minecraft.minecraft.worlds.installation import install_world
from world2minecraft.minecraft.worlds.world_writer import write_world


@pytest.fixture
def world(tmp_path):
    volume = volume_of(np.ones((2, 2, 2)), (AIR, "minecraft:stone"), (0, 64, 0))
    write_world(volume, tmp_path / "world", name="My room", spawn=(0, 66, 0), spawn_yaw_deg=0)
    (tmp_path / "world" / "session.lock").write_bytes("\u2603".encode())
    return tmp_path / "world"


@pytest.fixture
def saves(tmp_path):
    (tmp_path / "saves").mkdir()
    return tmp_path / "saves"


def files(folder):
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file() and path.name != "session.lock"
    }


def test_a_world_is_copied_byte_by_byte_without_its_lock(world, saves):
    target = install_world(world, saves)
    assert target == saves / "My room"
    assert files(target) == files(world)
    assert not (target / "session.lock").exists()
    assert os.listdir(saves) == ["My room"]


def test_a_taken_name_gets_a_number_in_the_list_too(world, saves):
    (saves / "my ROOM").mkdir()
    (saves / "my ROOM" / "level.dat").write_text("years of play")
    first, second = install_world(world, saves), install_world(world, saves)
    assert (first.name, second.name) == ("My room (2)", "My room (3)")
    assert str(nbtlib.load(second / "level.dat")["Data"]["LevelName"]) == "My room (3)"
    assert (saves / "my ROOM" / "level.dat").read_text() == "years of play"


def test_links_are_not_followed(world, saves, tmp_path):
    (tmp_path / "secret").write_text("mine")
    (world / "icon.png").symlink_to(tmp_path / "secret")
    assert "icon.png" not in files(install_world(world, saves))


def test_the_saves_folder_is_made_but_not_its_parents(world, tmp_path):
    assert install_world(world, tmp_path / "saves").is_dir()
    with pytest.raises(OutputError, match=r"cannot be written: No such file or directory$"):
        install_world(world, tmp_path / "no" / "saves")


def test_no_world_is_refused(tmp_path, saves):
    with pytest.raises(InputError, match="is not a world folder: level.dat not found$"):
        install_world(tmp_path, saves)
    assert not os.listdir(saves)


@pytest.mark.parametrize("moment", ["copyfile", "rename"])
def test_a_full_disk_leaves_nothing_behind(world, saves, monkeypatch, moment):
    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(shutil if moment == "copyfile" else os, moment, full)
    with pytest.raises(OutputError) as raised:
        install_world(world, saves)
    assert str(raised.value) == f"{saves}: cannot be written: No space left on device"
    assert not os.listdir(saves)


def test_too_little_space_is_told_before(world, saves, monkeypatch):
    free = type("Usage", (), {"free": 3 << 20})()
    monkeypatch.setattr(installing.shutil, "disk_usage", lambda _: free)
    with pytest.raises(OutputError, match="not enough disk space: 16 MB required, 3 MB free$"):
        install_world(world, saves)


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("My room", "My room"),
        ("../../etc", "etc"),
        ("a/b\\c:d", "a b c d"),
        ("CON", "CON world"),
        ("com1.txt", "com1.txt world"),
        ("dots...", "dots"),
        ("  wide \t name ", "wide name"),
        ("café \u2603", "café \u2603"),
        ("bell\x07\x1b[0m", "bell [0m"),
        ("x" * 100, "x" * 60),
    ],
)
def test_names_are_those_that_every_system_takes(name, expected):
    assert portable_name(name) == expected


@pytest.mark.parametrize("name", ["", "...", "///", "\0\x1f", " . "])
def test_a_name_of_nothing_is_refused(name):
    with pytest.raises(UsageError, match="name must contain letters or digits"):
        portable_name(name)


@given(st.text(max_size=80))
def test_any_name_is_one_part_of_a_path_or_refused(name):
    try:
        found = portable_name(name)
    except UsageError:
        return
    assert portable_name(found) == found
    assert found == os.path.basename(found)
    assert 0 < len(found) <= 66


@given(st.lists(st.sampled_from(["Room", "room (2)", "Room (3)", "other"]), max_size=4))
def test_a_free_name_is_free_and_the_lowest(taken):
    name = free_name("room", set(taken))
    known = {other.casefold() for other in taken}
    assert name.casefold() not in known
    tried = ["room", "room (2)", "room (3)", "room (4)"]
    assert all(other in known for other in tried[: tried.index(name)])
