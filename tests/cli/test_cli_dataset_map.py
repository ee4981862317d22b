"""``w2m dataset map``: what it tells and what it writes."""

import json

import pytest

from world2minecraft import cli


def test_it_tells_what_blocks_stand_for(capsys):
    assert cli.run(["dataset", "map", "bookshelf", "tmeo_ultra:chuanglian_1", "oak_planks"]) == 0
    first, second, third = capsys.readouterr().out.splitlines()
    assert first == "minecraft:bookshelf  furn"
    assert second == "tmeo_ultra:chuanglian_1  objs"
    assert third.startswith("minecraft:oak_planks  depends on surroundings: floor, ceiling, wall, ")


def test_the_papers_map_says_its_own(capsys):
    assert cli.run(["dataset", "map", "--map", "paper", "tmeo_ultra:chuanglian_1"]) == 0
    assert capsys.readouterr().out == "tmeo_ultra:chuanglian_1  empty\n"


@pytest.mark.parametrize("name", ["nyu", "paper"])
def test_a_map_is_shown_and_exported(name, tmp_path, capsys):
    assert cli.run(["dataset", "map", "--map", name]) == 0
    told = capsys.readouterr().out
    assert told.startswith(f"{name}: ") and told.count("\n  bed: black_bed, ") == 1
    path = tmp_path / "map.json"
    assert cli.run(["dataset", "map", "--map", name, "--json", str(path)]) == 0
    tree = json.loads(path.read_text())
    assert tree["name"] == name and tree["blocks"]["minecraft:bookshelf"] == "furn"
    assert "all vanilla blocks" in capsys.readouterr().out


def test_mistakes_have_their_exit_codes(tmp_path, capsys):
    assert cli.run(["dataset", "map", "--map", "paperr"]) == 2
    assert "did you mean 'paper'?" in capsys.readouterr().err
    bad = tmp_path / "bad.yaml"
    bad.write_text("name: m\nkinds: 3\n")
    assert cli.run(["dataset", "map", "--map", str(bad)]) == 3
    assert "kinds must be a mapping with text keys, got 3" in capsys.readouterr().err
    assert cli.run(["dataset", "map", "Oak Planks"]) == 2
