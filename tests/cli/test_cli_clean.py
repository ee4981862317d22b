"""``w2m clean``: repairs are made, listed, undone and redone; played worlds stay."""

import json

import numpy as np
import pytest

from world2minecraft import cli
from world2minecraft.construction import write_build
from world2minecraft.core.coordinates import block_to_room
from world2minecraft.core.types import AIR, BlockVolume
from world2minecraft.editing.journal import write_edits
from world2minecraft.evaluation.report.finished_run import read_built
from world2minecraft.minecraft.nbt import pack_gzip, write_nbt
from world2minecraft.minecraft.signs import sign_entity
from world2minecraft.minecraft.versions import game_version
from world2minecraft.minecraft.worlds.level_dat import level_data
from world2minecraft.minecraft.worlds.world_reader import read_level, read_world

SIGN = "minecraft:oak_sign[rotation=0,waterlogged=false]"
PALETTE = (AIR, SIGN, "minecraft:oak_planks", "minecraft:red_concrete", "minecraft:white_concrete")


def faulty():
    """A room with a hole in a wall, a chair in the air, and a sign."""
    shape = (14, 10, 14)
    states, semantic = np.zeros(shape, np.uint16), np.zeros(shape, np.uint8)
    instance = np.zeros(shape, np.uint16)
    for side in (0, -1):
        states[side], semantic[side] = 4, 3
        states[:, :, side], semantic[:, :, side] = 4, 3
    states[:, 0], semantic[:, 0] = 2, 2
    states[0, 5, 6], semantic[0, 5, 6] = 0, 0
    states[5:7, 3:5, 5:7], semantic[5:7, 3:5, 5:7], instance[5:7, 3:5, 5:7] = 3, 5, 1
    states[9, 1, 9], semantic[9, 1, 9] = 1, 11
    sign = sign_entity((9, 64, 9), ["My room", "two"])
    frame = block_to_room(np.array([0.0, 3.5]), 4.0)
    return BlockVolume(states, PALETTE, semantic, instance, (0, 63, 0), frame, (sign,))


@pytest.fixture(params=["1.20.1", "1.21.8"])
def out(tmp_path, request):
    write_build(tmp_path / "OUT" / "build", faulty(), mc_version=request.param, name="My room")
    return tmp_path / "OUT"


def clean(*words):
    return cli.run(["clean", *map(str, words)])


def texts(volume):
    return np.array(volume.palette, object)[volume.states]


def test_repairs_are_made_listed_undone_and_redone(out, capsys):
    before = texts(read_built(out / "build"))
    assert clean(out, "--dry-run") == 0
    assert capsys.readouterr().out == (
        "  1  fill     wall       1 block at 0 68 6: hole in the wall\n"
        "  2  move     chair 1    16 blocks at 5 64 5: floating piece, 2 blocks from a support\n"
    )
    assert (texts(read_built(out / "build")) == before).all()
    assert clean(out) == 0
    capsys.readouterr()
    after = texts(read_built(out / "build"))
    assert after[0, 5, 6] == "minecraft:white_concrete"
    assert (after[5:7, 1:3, 5:7] == "minecraft:red_concrete").all()
    world = read_world(out / "build" / "world")
    assert (texts(world) == after).all()
    assert [e.id for e in world.block_entities] == ["minecraft:sign"]
    assert read_level(out / "build" / "world")["LevelName"] == "My room"
    assert clean(out) == 0
    assert capsys.readouterr().out == "Nothing to repair.\n"
    assert clean(out, "--undo", 1) == 0
    assert clean(out, "--list") == 0
    said = capsys.readouterr().out
    assert clean(out, "--list", "--json") == 0
    assert [one["is_done"] for one in json.loads(capsys.readouterr().out)] == [False, True]
    assert "hole in the wall  (undone)\n" in said
    assert texts(read_built(out / "build"))[0, 5, 6] == AIR
    assert clean(out, "--redo", 1) == 0
    assert (texts(read_built(out / "build")) == after).all()
    assert clean(out, "--undo-all") == 0
    assert "2 repairs undone." in capsys.readouterr().out
    assert (texts(read_built(out / "build")) == before).all()


def test_only_the_rules_that_are_named(out, capsys):
    assert clean(out / "build", "--only", "holes") == 0
    assert "  1  fill " in capsys.readouterr().out
    assert clean(out, "--list") == 0
    assert capsys.readouterr().out.count("\n") == 1


def test_a_world_that_was_played_in_is_left_alone(out, capsys):
    data = level_data("My room", (5, 64, 5), 0.0, game_version())
    data["Data"].pop("MadeBy")  # As the game saves it.
    path = out / "build" / "world" / "level.dat"
    path.write_bytes(pack_gzip(write_nbt(data)))
    before = {p: p.read_bytes() for p in (out / "build" / "world").rglob("*") if p.is_file()}
    assert clean(out) == 3
    assert "has been played in or was not created by World2Minecraft" in capsys.readouterr().err
    assert before == {p: p.read_bytes() for p in before}
    assert not (out / "build" / "edits.journal").exists()


def test_a_journal_of_another_build_is_told(out, capsys):
    assert clean(out) == 0
    volume = faulty()
    write_build(out / "build", BlockVolume(**{**vars(volume), "states": volume.states * 0 + 2}))
    capsys.readouterr()
    assert clean(out, "--list") == 3
    err = capsys.readouterr().err
    assert "edits.journal: does not belong to the build in this folder" in err
    assert err.endswith("delete this file or build the room again\n")
    write_edits(out / "build", ())
    assert clean(out, "--list") == 0


@pytest.mark.parametrize(
    ("words", "code", "reason"),
    [
        (["nowhere"], 3, "nowhere: does not contain a build (build/scene.json)"),
        (
            ["{out}", "--list", "--undo", "1"],
            2,
            "use only one of --list, --undo, --undo-all and --redo",
        ),
        (["{out}", "--json"], 2, "--json requires --list"),
        (["{out}", "--undo", "1"], 2, "there is nothing to undo"),
        (["{out}", "--redo", "4"], 2, "edit 4 has not been undone"),
        (["{out}", "--only", "hole"], 2, "no clean-up rule is named 'hole'; did you mean 'holes'?"),
    ],
)
def test_what_cannot_be_is_one_line(out, capsys, words, code, reason):
    assert clean(*[word.format(out=out) for word in words]) == code
    err = capsys.readouterr().err
    assert (err.count("\n"), reason in err) == (1, True)
