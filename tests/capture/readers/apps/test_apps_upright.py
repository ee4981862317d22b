"""Phones held upright: their pictures lie on their side, and the room comes out all the same."""

import numpy as np
import pytest
from app_writers import ROOM_TO_ARKIT, SIDEWAYS, WRITERS, shots_of
from PIL import Image

from world2minecraft.capture import open_scan
from world2minecraft.capture.format_detection import find_capture
from world2minecraft.capture.images import read_header
from world2minecraft.capture.options import ScanOptions
from world2minecraft.capture.validation import validate_capture
from world2minecraft.capture.view_stream import read_view

APPS = [app for app in WRITERS if app != "arkitscenes"]  # The same code turns its images.


@pytest.fixture(scope="module")
def shots(box_room):
    return shots_of(box_room, 12, roll=SIDEWAYS)


@pytest.mark.parametrize("app", APPS)
def test_a_phone_held_upright_gives_upright_views(tmp_path, box_room, shots, app):
    WRITERS[app](tmp_path / "room", shots)
    assert read_header(find_capture(tmp_path / "room").frames[0].colour_path).size == (160, 120)
    judged = validate_capture(tmp_path / "room", ScanOptions())
    assert judged.notes[-1].startswith("the images are not upright")
    for frame, pose, shot in zip(judged.frames, box_room.poses(12), shots, strict=True):
        view = read_view(frame, judged.encoding, judged.capture.full_trust)
        np.testing.assert_allclose(view.camera_to_scan, ROOM_TO_ARKIT @ pose, atol=1e-5)
        assert view.colour.shape == (160, 120, 3)
        np.testing.assert_allclose(
            view.depth_m, np.rot90(np.where(shot.trust > 0, shot.depth_m, 0), 3), atol=6e-4
        )
        np.testing.assert_array_equal(view.trust > 200, np.rot90(shot.trust == 2, 3))


@pytest.mark.parametrize("app", APPS)
def test_its_room_is_the_same(tmp_path, box_room, shots, app):
    WRITERS[app](tmp_path / "room", shots)
    scan = open_scan(tmp_path / "room")
    found = np.sort(scan.room_size_m[:2])[::-1]
    np.testing.assert_allclose([*found, scan.room_size_m[2]], box_room.size_m, atol=0.03)


def test_label_images_lie_on_the_pictures_as_they_are_stored(tmp_path, shots):
    WRITERS["polycam"](tmp_path / "room", shots)
    labels = tmp_path / "labels"
    labels.mkdir()
    marked = np.zeros((120, 160), np.uint8)
    marked[5, 150] = 7
    for frame in find_capture(tmp_path / "room").frames:
        Image.fromarray(marked).save(labels / f"{frame.name}.png")
    scan = open_scan(tmp_path / "room", labels=labels)
    view = next(iter(scan.views))
    np.testing.assert_array_equal(view.labels, np.rot90(marked, 3))
