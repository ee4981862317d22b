"""``w2m build --into`` and ``w2m undo``: what they say, and that they refuse in time."""

import json

import numpy as np
import pytest

from world2minecraft import cli
from world2minecraft.core.coordinates import block_to_room
from world2minecraft.core.types import AIR, BlockVolume, OccupancyGrid
from world2minecraft.formats.run_arrays import write_room
from world2minecraft.minecraft.formats import write_blocks
from world2minecraft.minecraft.worlds.world_reader import read_world
from world2minecraft.minecraft.worlds.world_writer import write_world


def filled(shape, corner, state):
    states = np.ones(shape, np.uint16)
    return BlockVolume(
        states,
        (AIR, state),
        np.zeros(shape, np.uint8),
        np.zeros(shape, np.uint16),
        corner,
        block_to_room(np.zeros(2), 4.0),
    )


@pytest.fixture
def world(tmp_path):
    volume = filled((40, 4, 40), (0, 60, 0), "minecraft:dirt")
    write_world(volume, tmp_path / "home", name="Home", spawn=(0, 70, 0), spawn_yaw_deg=0)
    return tmp_path / "home"


@pytest.fixture
def schem(tmp_path):
    write_blocks(filled((3, 2, 4), (-7, 5, 9), "minecraft:bricks"), tmp_path / "a.schem")
    return tmp_path / "a.schem"


def room_file(path):
    """A room of 2.4 m with a floor and two walls."""
    labels = np.zeros((32, 32, 20), np.uint8)
    labels[1:-1, 1:-1, 0] = 2
    labels[1, 1:-1, :], labels[1:-1, 1, :] = 3, 3
    grid = OccupancyGrid(
        labels,
        np.ones(labels.shape, np.float16),
        np.full((*labels.shape, 3), 200, np.uint8),
        np.ones(labels.shape, np.uint8),
        np.zeros(labels.shape, np.uint16),
        0.08,
        np.array([0.0, 0.0, -0.08]),
    )
    write_room(path, grid, np.eye(4))
    return path


def place_of(world, state):
    volume = read_world(world)
    found = np.argwhere(np.array(volume.palette, object)[volume.states] == state)
    return (found.min(0) + volume.corner).tolist(), len(found)


def build(*words):
    return cli.run(["build", *map(str, words)])


def test_blocks_are_built_at_a_place_and_taken_back(schem, world, capsys):
    assert build(schem, "--into", world, "--at", 5, 70, -3, "--new-chunks") == 0
    assert place_of(world, "minecraft:bricks") == ([5, 70, -3], 24)
    said = capsys.readouterr().out
    assert f"{world}: 24 blocks changed; the build is 3 x 2 x 4 blocks." in said
    assert "  go there   /tp @s 6 70 -1\n" in said
    assert f"  undo       w2m undo '{world}'\n" in said
    assert build(schem, "--into", world, "--at", 5, 70, -3) == 0
    assert "the build is already complete; nothing changed." in capsys.readouterr().out
    assert cli.run(["undo", str(world), "--list"]) == 0
    assert capsys.readouterr().out == (
        "0001  built at 5 70 -3, 2 files\n1 step to undo, newest first.\n"
    )
    assert cli.run(["undo", str(world), "--list", "--json"]) == 0
    (step,) = json.loads(capsys.readouterr().out)
    assert step == {"number": "0001", "what": "built at 5 70 -3", "files": 2}
    assert cli.run(["undo", str(world)]) == 0
    assert capsys.readouterr().out == (f"{world}: 2 files restored, byte for byte.\n")
    assert place_of(world, "minecraft:dirt") == ([0, 60, 0], 6400)


def test_a_turned_build_has_its_corner_at_the_place(schem, world):
    assert build(schem, "--into", world, "--at", 5, 70, 3, "--turns", 1) == 0
    volume = read_world(world, box=(0, 70, 0, 16, 75, 16))
    found = np.argwhere(volume.states)
    assert (found.min(0)[[0, 2]].tolist(), np.ptp(found, axis=0).tolist()) == ([5, 3], [3, 1, 2])


def test_one_stands_on_a_rooms_floor_at_the_height_that_is_given(tmp_path, world, capsys):
    room = room_file(tmp_path / "room.npz")
    assert build(room, "--into", world, "--at", 4, 64, 4, "--blocks-per-metre", 2) == 0
    volume = read_world(world, box=(4, 55, 4, 14, 80, 14))
    names = np.array(volume.palette, object)[volume.states]
    built = (names != AIR) & (names != "minecraft:dirt")
    assert built[:, 8].any()  # Layer 63: the floor; the dirt ends there too.
    assert not built[:, :8].any()
    assert "/function w2m:human_size" in capsys.readouterr().out
    assert (world / "datapacks" / "player_size.zip").is_file()


def test_a_world_that_was_saved_since_is_not_overwritten(schem, world, capsys):
    assert build(schem, "--into", world, "--at", 5, 70, 3) == 0
    path = world / "region" / "r.0.0.mca"
    path.write_bytes(path.read_bytes() + bytes(4096))  # As the game might leave it.
    capsys.readouterr()
    assert cli.run(["undo", str(world)]) == 3
    assert capsys.readouterr().err == (
        f"error: {world}: region/r.0.0.mca has changed since the build; pass blocks (--blocks) "
        "to undo only the build, or force (--force) to restore the old files\n"
    )
    assert cli.run(["undo", str(world), "--blocks"]) == 0
    assert f"{world}: 24 blocks restored." in capsys.readouterr().out
    assert place_of(world, "minecraft:dirt") == ([0, 60, 0], 6400)
    assert cli.run(["undo", str(world)]) == 2
    assert "no build by World2Minecraft to undo" in capsys.readouterr().err


def test_force_brings_the_old_files_back(schem, world):
    path = world / "region" / "r.0.0.mca"
    before = path.read_bytes()
    assert build(schem, "--into", world, "--at", 5, 70, 3) == 0
    path.write_bytes(b"")
    assert cli.run(["undo", str(world), "--force"]) == 0
    assert path.read_bytes() == before


@pytest.mark.parametrize(
    ("words", "code", "reason"),
    [
        (["{schem}"], 2, "choose where to build: --out FOLDER"),
        (["{schem}", "--into", "{world}"], 2, "--into requires a block position; add --at X Y Z"),
        (["{schem}", "--out", "x", "--at", "1", "2", "3"], 2, "--at"),
        (["{schem}", "--into", "{world}", "--at", "1", "2"], 2, "--at"),
        (
            ["{schem}", "--into", "nowhere", "--at", "1", "2", "3"],
            3,
            "nowhere: is not a world folder",
        ),
        (
            ["{schem}", "--into", "{world}", "--at", "1", "2", "3", "--air", "all"],
            2,
            "air must be one of room, box, none, got 'all'",
        ),
        (
            ["{schem}", "--into", "{world}", "--at", "1", "400", "3"],
            2,
            "the build would span y 400 to 401, but the world spans y -64 to 319",
        ),
        (
            ["{schem}", "--out", "x"],
            2,
            "contains blocks, but an output folder requires a room; use w2m convert",
        ),
        (["nothing.npz", "--into", "{world}", "--at", "1", "70", "3"], 3, "nothing.npz: not found"),
    ],
)
def test_what_cannot_be_is_one_line_and_changes_nothing(schem, world, capsys, words, code, reason):
    before = sorted(world.rglob("*"))
    assert build(*[word.format(schem=schem, world=world) for word in words]) == code
    err = capsys.readouterr().err
    assert reason in err
    assert err.strip().splitlines()[-1].startswith("error: ")
    assert sorted(world.rglob("*")) == before


@pytest.mark.parametrize(
    ("words", "code", "reason"),
    [
        (["undo", "{world}"], 2, "no build by World2Minecraft to undo"),
        (["undo", "{world}", "--blocks", "--force"], 2, "exclude each other"),
        (["undo", "nowhere", "--list"], 3, "nowhere: is not a world folder: level.dat not found"),
        (["undo", "{world}/..", "--list"], 3, "/home instead"),
        (["undo", "nowhere"], 3, "nowhere: is not a world folder: level.dat not found"),
    ],
)
def test_an_undo_of_nothing_is_one_line(world, capsys, words, code, reason):
    assert cli.run([word.format(world=world) for word in words]) == code
    assert reason in capsys.readouterr().err
