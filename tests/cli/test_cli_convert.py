"""``w2m convert``: any pair of formats, and nothing lost when it goes wrong."""

import os
from dataclasses import replace

import numpy as np
import pytest

from world2minecraft import cli
from world2minecraft.core.types import AIR, BlockVolume, Entity, Placement
from world2minecraft.formats import volume_formats as forms
from world2minecraft.formats.gltf import GlbWriter, read_glb
from world2minecraft.formats.objects_and_placements import write_placements
from world2minecraft.formats.volume_formats import read_volume, write_volume
from world2minecraft.formats.world_labels import scene_from_volume, write_scene
from world2minecraft.minecraft.formats import read_blocks, write_blocks
from world2minecraft.minecraft.worlds import session_lock


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


def test_the_target_is_an_argument_or_an_option(schem, tmp_path, capsys):
    target = tmp_path / "b.schem"
    assert convert(schem, "--out", target) == 0 and target.is_file()
    assert convert(schem, "-o", tmp_path / "c.schem") == 0
    assert convert(schem) == 2
    assert "the output is missing; add TARGET or --out TARGET" in capsys.readouterr().err
    assert convert(schem, target, "-o", target) == 2
    assert "the output is given twice" in capsys.readouterr().err


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
        f"error: {tmp_path / 'b.schem'} exists; use --force to replace it\n"
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


def test_a_world_that_the_game_has_open_is_not_replaced(schem, tmp_path, monkeypatch, capsys):
    assert convert(schem, tmp_path / "house") == 0
    before = (tmp_path / "house" / "level.dat").stat().st_ino
    monkeypatch.setattr(session_lock, "_take", lambda *_: False)
    assert convert(schem, tmp_path / "house", "--force") == 3
    assert "is open in the game" in capsys.readouterr().err
    assert (tmp_path / "house" / "level.dat").stat().st_ino == before


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
    assert "exists and is not a world folder" in capsys.readouterr().err
    assert (tmp_path / "thesis" / "chapter").read_text() == "years of work"


def test_a_file_is_not_converted_to_itself(schem, capsys):
    before = schem.read_bytes()
    assert convert(schem, schem, "--force") == 2
    assert "is both the source and the target" in capsys.readouterr().err
    assert schem.read_bytes() == before


@pytest.mark.parametrize("step", ["write", "rename"])
def test_a_write_that_fails_leaves_the_old_one_and_no_litter(schem, tmp_path, monkeypatch, step):
    target = tmp_path / "b.schem"
    target.write_bytes(b"old")

    def full(*_):
        raise OSError(28, "No space left on device", str(target))

    if step == "write":
        monkeypatch.setattr(forms, "write_volume", full)
    else:
        monkeypatch.setattr(os, "replace", full)
    assert convert(schem, target, "--force") == 3
    assert target.read_bytes() == b"old"
    assert sorted(os.listdir(tmp_path)) == ["a.schem", "b.schem"]


@pytest.mark.parametrize(
    ("a", "b", "code", "reason"),
    [
        ("gone.schem", "b.schem", 3, "gone.schem: not found"),
        ("damaged.schem", "b.schem", 3, "damaged.schem: "),
        ("notes.txt", "b.schem", 3, "notes.txt: is not a supported block file"),
        ("a.schem", "b.xyz", 2, "b.xyz: unknown block format .xyz; known: "),
        ("a.schem", "My 1.20 World", 2, "; the name of a world folder has no dot"),
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


@pytest.mark.parametrize("name", ["a.schem", "house"])
def test_a_box_of_blocks_is_converted(schem, volume, tmp_path, name, capsys):
    if name != "a.schem":
        assert convert(schem, tmp_path / name) == 0
    x, y, z = volume.corner
    box = f"{x},{y},{z},{x + 1},{y + 3},{z + 2}"
    assert convert(tmp_path / name, tmp_path / "part.schem", "--box", box) == 0
    part = read_blocks(tmp_path / "part.schem")
    assert (part.corner, part.states.shape) == (volume.corner, (1, 1, 2))  # Air around is cut.
    assert convert(tmp_path / name, tmp_path / "b.schem", "--box", "1,2,3") == 2
    assert "--box must be six integers" in capsys.readouterr().err


def test_the_same_input_gives_the_same_bytes(schem, tmp_path):
    for name in ("one.schem", "two.schem"):
        assert convert(schem, tmp_path / name) == 0
    assert (tmp_path / "one.schem").read_bytes() == (tmp_path / "two.schem").read_bytes()


# Forms that are not the game's, and what is lost.

EVERY_PAIR = ("house", "a.schem", "a.litematic", "a.nbt", "a.zip", "a.mcfunction", "a.glb")


@pytest.mark.parametrize("target", EVERY_PAIR)
@pytest.mark.parametrize("source", [*EVERY_PAIR, "a.mcstructure"])
def test_any_form_becomes_any_other(volume, tmp_path, capsys, source, target):
    write_volume(volume, tmp_path / "from" / source)
    assert convert(tmp_path / "from" / source, tmp_path / "to" / target) == 0
    assert names(read_volume(tmp_path / "to" / target)) == names(volume)
    assert "not " not in capsys.readouterr().out


def test_what_is_lost_is_told(volume, tmp_path, capsys):
    sofa = "tmeo:shafa_1x_2[facing=east]"
    cat = Entity((1.0, 65.0, 1.0), "minecraft:cat")
    labels = np.where(volume.states > 0, 5, 0).astype(np.uint8)
    held = replace(volume, palette=(*volume.palette[:2], sofa), entities=(cat,), semantic=labels)
    write_volume(held, tmp_path / "a.glb")
    assert convert(tmp_path / "a.glb", tmp_path / "b.mcstructure") == 0
    assert capsys.readouterr().out.splitlines()[1:] == [
        "not written to b.mcstructure: 1 blocks of tmeo:shafa_1x_2, which Bedrock does not have",
        "not written to b.mcstructure: 1 entities",
        "not written to b.mcstructure: 8 labels of blocks (class and object)",
    ]


@pytest.fixture
def run_folder(volume, tmp_path):
    """A run as the program leaves it: a world, its labels, and the template of its object."""
    semantic = np.where(volume.states > 0, 3, 0).astype(np.uint8)
    semantic[1, 1, 1] = 5
    instance = np.where(semantic == 5, 7, 0).astype(np.uint16)
    scaled = np.diag([0.25, 0.25, 0.25, 1.0])
    held = replace(volume, semantic=semantic, instance=instance, block_to_room=scaled)
    run = tmp_path / "run"
    write_volume(held, run / "build" / "world")
    scene = scene_from_volume(
        held, mc_version="1.20.1", data_version=3465, spawn=(0, 64, 0), spawn_yaw_deg=0
    )
    write_scene(run / "build", scene)
    chair = Placement(7, 5, "chair", [0, 0, 0], [1, 1, 1], 0, 1.0)
    write_placements(run / "placements.json", (chair,))
    return run


def test_a_run_keeps_what_its_blocks_are(run_folder, tmp_path, capsys):
    assert convert(run_folder, tmp_path / "room.glb") == 0
    assert "not " not in capsys.readouterr().out
    tree, _ = read_glb(tmp_path / "room.glb")
    assert [node["name"] for node in tree["nodes"]] == ["wall", "chair_7"]
    assert tree["nodes"][1]["extras"] == {
        "class": 5,
        "class_name": "chair",
        "name": "chair",
        "nyu40": 5,
        "instance": 7,
        "size_m": [0.25, 0.25, 0.25],
        "template": "chair",
    }
    assert convert(run_folder / "build" / "world", tmp_path / "again.glb") == 0
    assert convert(run_folder / "build", tmp_path / "third.glb") == 0
    assert (tmp_path / "again.glb").read_bytes() == (tmp_path / "third.glb").read_bytes()


def test_a_run_becomes_a_scene_for_habitat(run_folder, tmp_path, capsys):
    target = tmp_path / "room.habitat"
    assert convert(run_folder, target) == 0
    assert (target / "room.scene_dataset_config.json").is_file()
    assert "not written to room.habitat: 8 block states" in capsys.readouterr().out
    assert convert(run_folder, target) == 2
    assert convert(run_folder, target, "--force") == 0
    (tmp_path / "mine.habitat").mkdir()
    (tmp_path / "mine.habitat" / "thesis").write_text("years of work")
    assert convert(run_folder, tmp_path / "mine.habitat", "--force") == 2
    assert "is a folder with unrelated files" in capsys.readouterr().err
    assert convert(target, tmp_path / "b.schem") == 3


def test_a_scale_may_be_said_where_there_is_none(schem, run_folder, tmp_path, capsys):
    assert convert(schem, tmp_path / "a.glb", "--blocks-per-metre", "4") == 0
    assert read_volume(tmp_path / "a.glb").blocks_per_metre == 4
    assert convert(schem, tmp_path / "b.glb", "--blocks-per-metre", "0") == 2
    assert convert(run_folder, tmp_path / "b.glb", "--blocks-per-metre", "2") == 2
    expected = "this room has a fixed scale of 4; omit blocks per metre (--blocks-per-metre)"
    assert expected in capsys.readouterr().err


def test_meshes_of_others_are_refused(tmp_path, capsys):
    writer = GlbWriter("another program")
    (tmp_path / "a.glb").write_bytes(writer.to_bytes())
    assert convert(tmp_path / "a.glb", tmp_path / "b.schem") == 3
    assert "contains no blocks; only .glb files written by this program can be read" in (
        capsys.readouterr().err
    )


def test_a_large_structure_brings_its_pieces(volume, tmp_path):
    states = np.ones((60, 2, 50), np.uint16)
    none = np.zeros(states.shape, np.uint8)
    long = replace(volume, states=states, semantic=none, instance=states * 0)
    write_volume(long, tmp_path / "a.schem")
    assert convert(tmp_path / "a.schem", tmp_path / "hall.nbt") == 0
    beside = [path.name for path in tmp_path.iterdir() if path.name.startswith("hall")]
    assert len(beside) == 2
    assert convert(tmp_path / "a.schem", tmp_path / "hall.nbt", "--force") == 0
    (tmp_path / "hall.nbt").unlink()
    assert convert(tmp_path / "a.schem", tmp_path / "hall.nbt") == 2
    assert not (tmp_path / "hall.nbt").exists()
