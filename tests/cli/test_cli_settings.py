"""``w2m settings``: every key of --set with its unit, default and meaning."""

import json

import pytest

from world2minecraft import cli
from world2minecraft.api import settings
from world2minecraft.reconstruction.parameters import parameter_keys


def test_every_key_that_set_changes_is_listed_once():
    keys = [one.key for one in settings()]
    copies = {"fuse.voxel_m"}
    assert sorted(keys) == sorted(set(parameter_keys()) - copies)


@pytest.mark.parametrize("setting", settings(), ids=lambda one: one.key)
def test_every_setting_has_a_meaning(setting):
    assert setting.meaning


def test_a_prefix_selects_a_group(capsys):
    assert cli.run(["settings", "clean"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.partition(" ")[0] for line in lines if line[0] != " "] == [
        "clean.floater_cells",
        "clean.hole_m",
    ]
    assert lines[1].startswith("    Number of cells below which an isolated part")


def test_a_prefix_may_be_a_single_key():
    assert [one.key for one in settings("find.min_cells")] == ["find.min_cells"]


def test_json_is_a_list_of_settings(capsys):
    assert cli.run(["settings", "find", "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)
    assert rows[0].keys() == {"key", "default", "unit", "meaning", "origin"}
    assert all(row["key"].startswith("find.") for row in rows)


@pytest.mark.parametrize(("prefix", "nearest"), [("fnd", "find"), ("find.min_cell", "find.min_ce")])
def test_an_unknown_prefix_suggests_the_nearest(prefix, nearest, capsys):
    assert cli.run(["settings", prefix]) == 2
    line = capsys.readouterr().err
    assert f"no setting is named '{prefix}'; did you mean '{nearest}" in line
