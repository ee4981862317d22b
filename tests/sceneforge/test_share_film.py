"""The film of a room that comes together."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

import world2minecraft as w2m
from world2minecraft.core.coordinates import apply, invert_rigid, look_at
from world2minecraft.core.errors import InputError
from world2minecraft.rendering.presentation.film import PAPER
from world2minecraft.rendering.views.cameras import camera_of
from world2minecraft.sceneforge.share.film import POINT_PX, RoomFilm, heights_m, splat

CAMERA = camera_of(24, 18, vertical_fov_deg=50.0)
POSE = look_at(np.array([3.0, -2.0, 2.5]), np.zeros(3))
coordinate = st.floats(-1.5, 1.5)


@given(st.lists(st.tuples(coordinate, coordinate, coordinate), max_size=20))
def test_points_are_drawn_as_one_by_one(points):
    points_m = np.array(points).reshape(-1, 3)
    colours = np.array([(n, 7, 9) for n in range(len(points_m))], np.uint8).reshape(-1, 3)
    seen = apply(invert_rigid(POSE), points_m)
    frame = np.full((18, 24, 3), PAPER, np.uint8)
    for number in sorted(range(len(seen)), key=lambda n: -seen[n, 2]):  # The nearest last.
        x = int(np.floor(CAMERA.fx_px * seen[number, 0] / seen[number, 2] + CAMERA.cx_px))
        y = int(np.floor(CAMERA.fy_px * seen[number, 1] / seen[number, 2] + CAMERA.cy_px))
        for row in range(max(y, 0), min(y + POINT_PX, 18)):
            for column in range(max(x, 0), min(x + POINT_PX, 24)):
                frame[row, column] = colours[number]
    drawn = splat(points_m, colours, CAMERA, POSE)
    assert np.array_equal((drawn == PAPER).all(axis=2), (frame == PAPER).all(axis=2))
    assert (drawn != frame).any(axis=2).sum() <= POINT_PX**2 * len(points)
    if len(points) == 1:
        assert np.array_equal(drawn, frame)


@given(st.tuples(coordinate, coordinate, coordinate))
def test_heights_are_those_of_the_points_seen(point):
    seen = apply(invert_rigid(POSE), np.array([point]))[0]
    x = int(CAMERA.fx_px * seen[0] / seen[2] + CAMERA.cx_px)
    y = int(CAMERA.fy_px * seen[1] / seen[2] + CAMERA.cy_px)
    if 0 <= x < 24 and 0 <= y < 18:
        found = heights_m(np.full((18, 24), seen[2]), CAMERA, POSE)[y, x]
        pixel_m = seen[2] / CAMERA.fy_px
        assert abs(found - point[2]) < pixel_m


def test_a_film_shows_the_room_first_and_last(example_run, tmp_path):
    film = RoomFilm.read(example_run.folder, (96, 60))
    frames = list(film.frames())
    assert len(frames) == film.length
    paper = [(frame == PAPER).all(axis=2).mean() for frame in frames]
    assert paper[0] < 0.9 and paper[-1] < 0.9
    assert max(paper) == max(paper[8:12])  # The first points.
    assert len({frame.tobytes() for frame in frames}) > 0.6 * len(frames)


def test_a_film_needs_a_reconstruction(tmp_path):
    (tmp_path / "world").mkdir()
    with pytest.raises(InputError, match=r"has no room.npz; a film needs a reconstruction"):
        w2m.share(tmp_path / "world", tmp_path / "room.gif")


def test_a_film_is_written_as_its_suffix_says(example_run, tmp_path, monkeypatch):
    frames = [np.full((6, 8, 3), shade, np.uint8) for shade in (0, 90, 180)]
    monkeypatch.setattr(RoomFilm, "frames", lambda self: iter(frames))
    made = w2m.share(example_run, tmp_path / "room.gif")
    assert (made.frames, made.things) == (3, 0)
    with Image.open(made.path) as picture:
        assert picture.format == "GIF" and picture.n_frames == 3
