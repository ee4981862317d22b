"""``w2m dataset tour`` and ``w2m dataset sheet``: what is written and told, and what is refused."""

import json

import numpy as np
import pytest
from PIL import Image

from world2minecraft import cli
from world2minecraft.procgen.worlds import generate_world, write_house


@pytest.fixture(scope="module")
def world(tmp_path_factory):
    folder = tmp_path_factory.mktemp("worlds") / "house_0001"
    write_house(generate_world(11, rooms=4, storeys=1), folder, name="house 1")
    return folder


@pytest.fixture(scope="module")
def tour(world):
    path = world.parent / "tour.jsonl"
    assert cli.run(["dataset", "tour", str(world), "--count", "14", "--out", str(path)]) == 0
    return path


def lines_of(path):
    return [json.loads(line) for line in path.read_text().splitlines()]


def test_a_tour_file_is_written_and_told(world, tour, capsys):
    again = tour.with_name("again.jsonl")
    words = ["dataset", "tour", str(world), "--count", "14", "--out", str(again)]
    assert cli.run(words) == 0
    told = capsys.readouterr().out
    assert f"{again}: 14 views (" in told and "tours of" in told
    assert f"look   w2m dataset sheet {again} --world {world}" in told
    assert again.read_bytes() == tour.read_bytes()
    line = lines_of(tour)[0]
    assert line["scene_id"] == "house_0001" and line["frame"] == 0
    assert (line["width"], line["height"]) == (640, 480)
    assert set(line) >= {"t", "x", "y", "z", "yaw", "pitch", "vertical_fov_deg", "tour_id", "kind"}


def test_the_camera_and_the_spawn_are_heeded(world, tmp_path):
    out = tmp_path / "t.jsonl"
    words = ["dataset", "tour", str(world), "--count", "5", "--out", str(out), "--reachable"]
    assert cli.run([*words, "--camera", "paper"]) == 0
    line = lines_of(out)[0]
    assert (line["width"], line["height"], line["vertical_fov_deg"]) == (1920, 1129, 70.0)
    assert "intrinsics" not in line


def test_a_sheet_shows_the_views_of_a_tour(world, tour, tmp_path, capsys):
    out = tmp_path / "sheet.png"
    words = ["dataset", "sheet", str(tour), "--world", str(world), "--out", str(out)]
    assert cli.run([*words, "--most", "6", "--columns", "3", "--width", "64", "--first"]) == 0
    page = np.asarray(Image.open(out))
    assert page.shape == (2 * (48 + 16 + 6) + 6, 3 * (64 + 6) + 6, 3)
    assert page[10:50, 10:60].std() > 5
    assert "216x146 pixels" not in capsys.readouterr().err


def test_screenshots_become_a_tour_file(world, tmp_path, capsys):
    Image.fromarray(np.zeros((18, 32, 3), np.uint8)).save(tmp_path / "6.5_64_5.5_90_10.png")
    out = tmp_path / "shots.jsonl"
    words = ["dataset", "tour", str(world), "--screenshots", str(tmp_path), "--out", str(out)]
    assert cli.run([*words, "--at", "feet"]) == 0
    assert "1 screenshots (1 by file name with pattern" in capsys.readouterr().out
    (line,) = lines_of(out)
    assert line["image"] == "6.5_64_5.5_90_10.png" and line["y"] == pytest.approx(
        64 + 1.62 * 25 / 6
    )
    assert cli.run([*words, "--at", "eye"]) == 0
    assert lines_of(out)[0]["y"] == 64


@pytest.mark.parametrize(
    ("words", "code", "text"),
    [
        (["--at", "feet"], 2, "--at, --poses and --pattern require --screenshots DIR"),
        (
            ["--screenshots", "."],
            2,
            "feet (as shown by F3 and most mods) or eye (--at feet, --at eye)",
        ),
        (["--screenshots", "none", "--at", "eye"], 3, "expected a folder of screenshots"),
        (["--count", "0"], 2, "the number of views must be 1 or more, got 0"),
        (["--camera", "nyy"], 2, "no camera is named 'nyy'; did you mean 'nyu'?"),
    ],
)
def test_tours_that_cannot_be(world, tmp_path, monkeypatch, capsys, words, code, text):
    monkeypatch.chdir(tmp_path)
    assert cli.run(["dataset", "tour", str(world), *words]) == code
    error = capsys.readouterr().err.strip().splitlines()[-1]
    assert error.startswith("error: ") and text in error


def test_sheets_that_cannot_be(tour, tmp_path, capsys):
    for words, code, text in (
        ([str(tour)], 2, "name its world with --world WORLD"),
        ([str(tour), "--most", "0"], 2, "--most and --columns must be 1 or more"),
        ([str(tmp_path)], 3, ""),
    ):
        assert cli.run(["dataset", "sheet", *words]) == code
        assert text in capsys.readouterr().err
