"""``w2m paper figure``: cells become blocks where they are, and the page holds all pictures."""

import json
from dataclasses import asdict

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image
from tests.exact_room import BoxRoom

from world2minecraft.capture.readers.capture_json import write_plain
from world2minecraft.cli import run
from world2minecraft.core.coordinates import invert
from world2minecraft.core.errors import InputError
from world2minecraft.core.types import OccupancyGrid
from world2minecraft.navigation.running.simulator import SceneSimulator
from world2minecraft.navigation.scene import open_scene
from world2minecraft.navigation.types import Stance
from world2minecraft.paper import figure
from world2minecraft.paper.figure import spread, views_of_walk


def grid(labels):
    return OccupancyGrid(
        labels,
        np.ones(labels.shape, np.float16),
        np.zeros((*labels.shape, 3), np.uint8),
        (labels != 255).astype(np.uint8),
        np.zeros(labels.shape, np.uint16),
        0.08,
        np.array([0.96, -2.0, 0.48]),
    )


def test_each_cell_is_a_block_in_its_place():
    labels = np.random.default_rng(0).integers(0, 12, (5, 7, 3)).astype(np.uint8)
    labels[0, 0, 0] = 255
    cells = grid(labels)
    volume = figure.volume_of_cells(cells)
    to_block = invert(volume.block_to_room)
    for index in np.ndindex(labels.shape):
        middle = cells.origin_m + (np.array(index) + 0.5) * cells.voxel_m
        block = tuple(np.floor(to_block[:3, :3] @ middle + to_block[:3, 3]).astype(int))
        known = labels[index] if labels[index] != 255 else 0
        assert volume.semantic[block] == known
        assert (volume.states[block] > 0) == (known > 0)


def test_pictures_are_cut_about_their_middle():
    wide = np.zeros((10, 40, 3), np.uint8)
    wide[:, 15:25] = 200
    assert (figure._fitted(wide, (20, 20)) == 200).all()
    assert figure._fitted(wide, (30, 7)).shape == (7, 30, 3)


def test_white_takes_the_colour_of_its_class():
    shade = np.full((1, 2, 3), 128, np.uint8)
    shade[0, 1] = 240  # The background, of no class.
    found = figure._coloured(shade, np.array([[8, 0]], np.uint8))
    assert found[0, 1].tolist() == [240, 240, 240]
    assert found[0, 0].tolist() == [15, 60, 91]


@pytest.fixture
def finished(tmp_path):
    """A small room, its run, and a walk."""
    write_plain(tmp_path / "scan", BoxRoom().views(6))
    out = tmp_path / "OUT"
    assert run(["reconstruct", str(tmp_path / "scan"), "--out", str(out)]) == 0
    (tmp_path / "walk" / "views").mkdir(parents=True)
    for n in range(9):
        Image.new("RGB", (64, 48), (20 * n, 0, 0)).save(tmp_path / "walk" / "views" / f"{n:04}.jpg")
    return tmp_path


def test_a_room_is_drawn(finished, capsys, monkeypatch):
    monkeypatch.setattr(figure, "CELL_PX", (96, 72))
    out = finished / "figure.png"
    words = ["paper", "figure", str(finished / "OUT"), "--capture", str(finished / "scan")]
    assert run([*words, "--walk", str(finished / "walk"), "--out", str(out)]) == 0
    page = np.asarray(Image.open(out)).astype(int)
    assert page.shape[1] == 4 * (96 + 8) + 8
    for column in range(4):  # No picture is of one colour, none is left out.
        for row in range(3):
            left, top = 8 + column * 104, 34 + row * 80
            assert page[top : top + 72, left : left + 96].std() > 2, (column, row)
    strip = page[-20, 8:].reshape(-1, 3)
    assert strip[5, 0] < 10 and 150 < strip[-30, 0] < 170  # The first step, and the last.
    assert run([*words, "--walk", str(finished / "scan"), "--out", str(out)]) == 3
    assert "no recorded walk found; give a folder written by w2m vln run" in capsys.readouterr().err


def test_what_an_agent_saw_that_kept_no_views_is_drawn_again(finished, tmp_path):
    scene = open_scene(finished / "OUT")
    east, north = (Stance(*scene.graph.feet[0], yaw_deg=yaw) for yaw in (270.0, 180.0))
    walk = tmp_path / "run" / "episodes" / "wish"
    walk.mkdir(parents=True)
    lines = [{"scene": "OUT"}, {"stance": asdict(east)}, {"end": "x", "stance": asdict(north)}]
    (walk / "trace.jsonl").write_text("".join(json.dumps(line) + "\n" for line in lines))
    views = views_of_walk(finished / "OUT", walk, 6)
    ground = SceneSimulator(scene)
    assert len(views) == 2
    for view, stance in zip(views, (east, north), strict=True):
        np.testing.assert_array_equal(view, ground.view(stance))
    with pytest.raises(
        InputError, match=("the folder contains 1 walks; give one of them, such as .*wish")
    ):
        views_of_walk(finished / "OUT", tmp_path / "run", 6)


@given(st.integers(1, 40), st.integers(1, 9))
def test_views_are_spread_over_the_whole_walk(count, most):
    numbers = list(spread(count, most))
    assert len(numbers) == min(count, most) == len(set(numbers))
    assert numbers[0] == 0 and (numbers[-1] == count - 1 or most == 1)
    apart = np.diff(numbers)
    assert not len(apart) or apart.max() - apart.min() <= 1
