"""``w2m furniture``: list, show, add and draw."""

import json

import numpy as np
import pytest
from PIL import Image

from world2minecraft import cli
from world2minecraft.core.types import AIR, BlockVolume
from world2minecraft.furniture.library import TEMPLATES, template, templates_of_class, variants_of
from world2minecraft.minecraft.formats import write_blocks


@pytest.fixture
def own(tmp_path, monkeypatch):
    """The folder of the user's own furniture, and a library that forgets what it read."""
    monkeypatch.setenv("W2M_FURNITURE", str(tmp_path / "own"))
    for function in (template, templates_of_class, variants_of):
        function.cache_clear()
    yield tmp_path / "own"
    for function in (template, templates_of_class, variants_of):
        function.cache_clear()


@pytest.fixture
def volume():
    """A stair that looks south, in a box of air."""
    states = np.zeros((3, 3, 3), np.uint16)
    states[1, 0, 1] = 1
    stair = "minecraft:birch_stairs[facing=north,half=bottom,shape=straight,waterlogged=false]"
    empty = np.zeros(states.shape, np.uint16)
    return BlockVolume(states, (AIR, stair), empty.astype(np.uint8), empty, (0, 64, 0), np.eye(4))


def furniture(*words):
    return cli.run(["furniture", *map(str, words)])


@pytest.mark.parametrize("suffix", [".schem", ".litematic", ".nbt"])
def test_a_chair_is_added_from_any_format(suffix, own, volume, tmp_path, capsys):
    source = tmp_path / f"My Chair{suffix}"
    write_blocks(volume, source)
    assert furniture("add", source, "--class", "chair", "--blocks-per-metre", 1) == 0
    out = capsys.readouterr().out
    assert "my_chair: 1 blocks, 1.00 x 1.00 x 1.00 m (depth x width x height)" in out
    assert "The front faces south (inferred from its blocks; set it with --front)." in out
    assert (own / "my_chair.json").is_file()
    assert furniture("show", "my_chair") == 0
    assert "  1 per metre: 1 birch_stairs" in capsys.readouterr().out


def test_nothing_is_replaced_unless_it_is_said(own, volume, tmp_path, capsys):
    write_blocks(volume, tmp_path / "a.schem")
    words = ("add", tmp_path / "a.schem", "--class", "chair", "--blocks-per-metre", 1)
    assert furniture(*words) == 0
    before = (own / "a.json").read_bytes()
    assert furniture(*words) == 2
    assert "a.json exists; choose another name (--name), or use --force to replace it" in (
        capsys.readouterr().err
    )
    assert furniture(*words, "--force") == 0
    assert (own / "a.json").read_bytes() == before
    assert furniture(*words, "--name", "sofa") == 2
    assert (
        "the library already contains sofa; choose another name (--name)" in capsys.readouterr().err
    )


@pytest.mark.parametrize(
    ("words", "code", "message"),
    [
        (("add", "none.schem", "--class", "chair", "--blocks-per-metre", 1), 3, ": not found"),
        (("add", "x.schem", "--class", "chair", "--blocks-per-metre", 1, "--name", "../x"), 2,
         "a furniture name must start with a letter"),
        (("show", "bathtup"), 2, "no template is named 'bathtup'; did you mean 'bathtub'?"),
        (("list", "--class", "kitchen"), 2, "no class is named 'kitchen'"),
        (("sheet", "nothing"), 2, "no template is named 'nothing'"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_told_in_a_line(words, code, message, own, capsys):
    assert furniture(*words) == code
    error = capsys.readouterr().err
    assert message in error and error.count("\n") == 1
    assert not own.exists()


def test_the_list_holds_all(own, capsys):
    assert furniture("list") == 0
    out = capsys.readouterr().out
    assert (
        f"{len(TEMPLATES.names())} designs; objects are matched with the 24 designs marked *."
        in out
    )
    assert all(f" {name} " in out for name in TEMPLATES.names())


def test_the_list_and_each_piece_are_json(own, capsys):
    assert furniture("list", "--json") == 0
    listed = json.loads(capsys.readouterr().out)
    assert [one["name"] for one in listed] == list(TEMPLATES.names())
    assert furniture("show", "sofa", "--json") == 0
    assert json.loads(capsys.readouterr().out) in listed


def test_the_list_of_a_word(own, capsys):
    assert furniture("list", "bathtub", "--class", "furn") == 0
    assert "2 designs; objects are matched with the 0 designs" in capsys.readouterr().out


def test_a_sheet_is_drawn(own, tmp_path, capsys):
    assert furniture("sheet", "toilet", "rug", "--out", tmp_path / "sheet.png") == 0
    first = (tmp_path / "sheet.png").read_bytes()
    assert furniture("sheet", "toilet", "rug", "--out", tmp_path / "sheet.png") == 0
    assert (tmp_path / "sheet.png").read_bytes() == first
    image = np.asarray(Image.open(tmp_path / "sheet.png").convert("RGB"))
    assert image.shape[1] > 1000
    red = (image[..., 0] > 120) & (image[..., 1] < 60) & (image[..., 2] < 60)
    assert red.sum() > 500  # The rug.


def test_each_class_is_a_page_of_its_own(own, tmp_path, monkeypatch, capsys):
    few = [template(name) for name in ("rug", "toilet", "stool", "wall_shelf")]
    monkeypatch.setattr("world2minecraft.api.furniture.list_furniture", lambda: few)
    assert furniture("sheet", "--out", tmp_path / "all.png") == 0
    names = ["all_chair.png", "all_furniture.png", "all_object.png"]
    assert sorted(path.name for path in tmp_path.glob("*.png")) == names
    assert capsys.readouterr().out.count("designs") == len(names)


def test_classes_are_chosen_by_readable_names_or_codes(own, capsys):
    listed = []
    for name in ("television", "tvs"):
        assert furniture("list", "--class", name) == 0
        listed.append(capsys.readouterr().out)
    assert listed[0] == listed[1] and "tv" in listed[0].lower()


def test_a_piece_is_added_under_a_readable_class(own, volume, tmp_path):
    file = tmp_path / "shelf.schem"
    write_blocks(volume, file)
    words = ("--class", "furniture", "--blocks-per-metre", 2, "--front", "north")
    assert furniture("add", file, *words) == 0
    assert '"furn"' in (own / "shelf.json").read_text("utf-8")
