"""The page of ``w2m scan``: its size, its bytes, and that what it draws lies where it must."""

import io
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from world2minecraft.capture import describe_capture, write_plain
from world2minecraft.capture.options import ScanOptions
from world2minecraft.capture.poster import draw_poster, is_poster, poster_png
from world2minecraft.capture.poster.canvas import FIRST, PAPER, Sheet, blend_colours, to_ascii
from world2minecraft.capture.poster.page import picture_marks
from world2minecraft.capture.poster.panels import (
    PanelTransform,
    direction_heatmap,
    select_pictures,
    shade_top_view,
)
from world2minecraft.capture.quality.picture_quality import measure_picture
from world2minecraft.capture.source_types import Capture, FrameFiles
from world2minecraft.capture.summary import describe_validated
from world2minecraft.capture.validation import validate


@pytest.fixture(scope="module")
def scanned(box_room, tmp_path_factory):
    folder = tmp_path_factory.mktemp("scanned")
    write_plain(folder, box_room.views(18, noise_seed=4))
    return describe_capture(folder)


@pytest.fixture(scope="module")
def photos(box_room, tmp_path_factory):
    folder = tmp_path_factory.mktemp("photos")
    frames = []
    for index, view in enumerate(box_room.views(10)):
        path = folder / f"{index:02d}.png"
        Image.fromarray(view.colour if index != 4 else view.colour // 12).save(path)
        frames.append(FrameFiles(path.stem, None, path))
    return describe_validated(validate(Capture(folder, "photos", tuple(frames)), ScanOptions()))


def test_size_and_bytes(scanned, photos):
    for summary in (scanned, photos):
        data = poster_png(summary)
        assert Image.open(io.BytesIO(data)).size == (1600, 1040)
        assert data == poster_png(summary)


def test_the_same_capture_gives_the_same_page(scanned):
    again = describe_capture(scanned.folder)
    np.testing.assert_array_equal(draw_poster(again), draw_poster(scanned))


def test_the_way_of_the_camera_lies_within_the_plan(scanned):
    plan = scanned.survey.plan
    placed = PanelTransform(plan, (40, 140), (780, 800))
    for pose in plan.cameras:
        x, y = placed.at(*pose[:2, 3])
        assert 40 < x < 820
        assert 140 < y < 940
        left, low = placed.at(0, 0)
        right, high = placed.at(*plan.room_size_m[:2])
        assert left < x < right
        assert high < y < low


def test_north_is_up_and_metres_keep_their_shape(scanned):
    placed = PanelTransform(scanned.survey.plan, (0, 0), (700, 800))
    (left, low), (right, high) = placed.at(0, 0), placed.at(1, 1)
    assert right > left
    assert high < low
    assert right - left == pytest.approx(low - high)


def test_the_plan_has_the_room_s_size_and_walls(scanned):
    plan = scanned.survey.plan
    assert plan.seen.mean() > 0.4
    wall = [
        plan.tall[_row(plan, y), _column(plan, x)].max()
        for x, y in ((0.0, 2.0), (plan.room_size_m[0], 2.0), (1.0, 0.0), (1.0, plan.room_size_m[1]))
    ]
    assert min(wall) > 0.5
    assert shade_top_view(plan).shape == (*plan.seen.shape, 3)


def _row(plan, y_m):
    row = plan.seen.shape[0] - int((y_m - plan.corner_m[1]) / plan.cell_m)
    return slice(max(0, row - 12), row + 12)


def _column(plan, x_m):
    column = int((x_m - plan.corner_m[0]) / plan.cell_m)
    return slice(max(0, column - 12), column + 12)


def test_doubtful_pictures_are_marked_and_shown(photos):
    marks = picture_marks(photos)
    assert marks[4] == "dark"
    shown = select_pictures(photos.survey.pictures, marks, 4)
    assert [picture.index for picture in shown] == sorted(picture.index for picture in shown)
    assert 4 in [picture.index for picture in shown] or len(marks) > 1
    assert len(shown) == 4


def test_rendered_pictures_are_not_marked(photos):
    solid = replace(photos, route=replace(photos.route, kind="solid"))
    assert picture_marks(solid) == {}


def test_a_written_poster_is_recognised(scanned, tmp_path):
    (tmp_path / "a.png").write_bytes(poster_png(scanned))
    Image.new("RGB", (4, 4)).save(tmp_path / "b.png")
    (tmp_path / "c.png").write_bytes(b"no picture")
    assert is_poster(tmp_path / "a.png")
    assert not is_poster(tmp_path / "b.png")
    assert not is_poster(tmp_path / "c.png")
    assert not is_poster(tmp_path / "none.png")


def test_directions_are_darkest_where_most_pictures_look(scanned):
    seen = scanned.survey.directions.seen
    colours = direction_heatmap(scanned.survey.directions).astype(int).sum(axis=2)[::-1]
    assert colours[seen == seen.max()].max() < colours[seen == seen[seen > 0].min()].min()
    assert (colours[seen == 0] > colours[seen > 0].max()).all()


def test_lines_fit_their_width():
    sheet = Sheet(400, 100)
    lines = sheet.wrapped("some words that need more than one line of this width", 20, 150)
    assert len(lines) > 2
    assert max(sheet.width(line, 20) for line in lines) <= 150
    assert " ".join(lines).startswith("some words that need")
    long = "w2m reconstruct " + "a" * 200
    assert sheet.width(sheet.clipped(long, 20, 300), 20) <= 300
    assert sheet.clipped("short", 20, 300) == "short"
    assert to_ascii("K\u00fcche \u2192 3") == "Kuche ? 3"


def test_colours_blend_from_end_to_end():
    assert blend_colours(FIRST, PAPER, 0) == FIRST
    assert blend_colours(FIRST, PAPER, 1) == PAPER


def test_a_thumb_is_small_and_keeps_its_shape():
    picture = measure_picture("a", 0, np.zeros((640, 480, 3), np.uint8))
    assert picture.thumb.shape == (360, 270, 3)
