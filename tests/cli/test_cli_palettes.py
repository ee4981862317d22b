"""``w2m palettes`` and ``w2m convert --labels``."""

import json

import numpy as np

from world2minecraft import cli
from world2minecraft.core.types import AIR, BlockVolume
from world2minecraft.formats.gltf import read_glb
from world2minecraft.minecraft.formats import write_blocks


def test_the_palettes_are_listed(capsys):
    assert cli.run(["palettes"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == ["vanilla", "tmeo", "refurbished_furniture"]
    assert "16 pieces of furniture" in lines[2]


def test_a_file_is_checked_and_shown(tmp_path, capsys):
    path = tmp_path / "mine.yaml"
    path.write_text("name: mine\nblocks: [oak_planks, stone, glass]\n")
    assert cli.run(["palettes", str(path)]) == 0
    told = capsys.readouterr().out
    assert "restricted to 3 blocks" in told
    assert "  wall        oak_planks\n" in told and "  floor       oak_planks, stone\n" in told
    path.write_text("name: mine\nblocks: [oak_plank]\n")
    assert cli.run(["palettes", str(path)]) == 3
    assert "did you mean 'minecraft:oak_planks'?" in capsys.readouterr().err


def test_palettes_are_json(capsys):
    assert cli.run(["palettes", "--json"]) == 0
    listed = json.loads(capsys.readouterr().out)
    assert cli.run(["palettes", "vanilla", "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == listed[0]


def test_a_world_of_a_mod_becomes_labelled_meshes(tmp_path, capsys):
    states = np.zeros((5, 2, 3), np.uint16)
    states[:, 0], states[0, 1, 0], states[4, 1, 2] = 1, 2, 3
    volume = BlockVolume(
        states,
        (AIR, "minecraft:stone", "tmeo_ultra:bataiyizi", "tmeov:penzai"),
        np.zeros(states.shape, np.uint8),
        np.zeros(states.shape, np.uint16),
        (0, 64, 0),
        np.eye(4),
    )
    write_blocks(volume, tmp_path / "a.schem")
    out = tmp_path / "a.glb"
    assert cli.run(["convert", str(tmp_path / "a.schem"), str(out), "--labels", "tmeo"]) == 0
    tree, _ = read_glb(out)
    classes = {node["extras"].get("class") for node in tree["nodes"] if "extras" in node}
    assert {5, 11} <= classes
    assert cli.run(["convert", str(tmp_path / "a.schem"), str(out), "--labels", "temo"]) == 2
    capsys.readouterr()
