"""``--formats``: further forms of a build, and what each left out."""

import json

import numpy as np
import pytest

from world2minecraft.cli import run
from world2minecraft.core.errors import UnknownNameError
from world2minecraft.minecraft.formats import read_blocks
from world2minecraft.reconstruction.parameters import Parameters


@pytest.fixture
def room(tmp_path):
    labels = np.zeros((20, 16, 12), np.uint8)
    labels[:, :, 0] = 2
    labels[0, :, 1:], labels[:, -1, 1:] = 3, 3
    labels[5:12, 5:10, 1:8] = 10
    np.save(tmp_path / "room.npy", labels)
    return tmp_path / "room.npy"


def test_each_form_holds_the_world_and_says_what_it_left_out(room, tmp_path, capsys):
    out = tmp_path / "out"
    words = ["build", str(room), "--out", str(out), "--formats", "litematic, nbt,glb"]
    assert run(words) == 0
    rows = json.loads((out / "build" / "forms.json").read_text())
    assert sorted(rows) == ["glb", "litematic", "nbt"]
    world = read_blocks(out / "build" / "world")
    for name in ("litematic", "nbt"):
        held = read_blocks(out / "build" / rows[name]["file"])
        assert (held.states > 0).sum() == (world.states > 0).sum()
        assert sum(rows[name]["lost"].values()) > 0
    said = capsys.readouterr().out
    assert "room.litematic (not included:" in said
    assert "w2m install" in said


def test_forms_of_an_earlier_build_are_not_left_beside_the_next(room, tmp_path, capsys):
    out = tmp_path / "out"
    words = ["build", str(room), "--out", str(out), "--blocks-per-metre", "1"]
    assert run([*words, "--formats", "litematic,nbt"]) == 0
    assert run([*words, "--formats", "nbt"]) == 0
    build = out / "build"
    assert not (build / "room.litematic").exists() and (build / "room.nbt").is_file()
    assert list(json.loads((build / "forms.json").read_text())) == ["nbt"]
    capsys.readouterr()
    assert run(words) == 0
    assert not list(build.glob("room.nbt")) and not (build / "forms.json").exists()
    assert "room.nbt" not in capsys.readouterr().out
    assert (build / "room.schem").is_file()


def test_a_form_that_is_none_is_told_before_any_work():
    with pytest.raises(UnknownNameError, match="did you mean 'litematic'"):
        Parameters(formats="litematik")
