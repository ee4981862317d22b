"""The colour camera is found where it is another, and left alone where it is the same."""

import sys
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from world2minecraft.capture import open_scan
from world2minecraft.capture.calibration import corrected_camera, estimate_colour_camera
from world2minecraft.core.types import Camera, View
from world2minecraft.formats.scan_record import write_scan

DEPTH = Camera(320, 240, 270.0, 270.0, 160.0, 120.0)

RENDERED = {}


def rendered(room, pose, camera):
    """The box room from a place; the same places are asked for often."""
    key = (pose.tobytes(), camera)
    if key not in RENDERED:
        RENDERED[key] = room.render(pose, camera)
    return RENDERED[key]


def _views(room, scale, shift, count=12):
    """Return views whose colour was taken with another lens while the depth's is stated."""
    lens = replace(DEPTH, fx_px=270 * scale, fy_px=270 * scale, cx_px=160 + shift, cy_px=120.0)
    for index, pose in enumerate(room.poses(count)):
        depth, _ = rendered(room, pose, DEPTH)
        _, colour = rendered(room, pose, lens)
        yield View(str(index), pose, colour, DEPTH, depth, DEPTH)


@pytest.mark.parametrize(("scale", "shift"), [(0.9, -4.0), (1.1, 6.0)])
def test_another_lens_is_found(box_room, scale, shift):
    found = estimate_colour_camera(_views(box_room, scale, shift))
    assert found.clear
    assert found.scale == pytest.approx(scale, abs=0.011)
    assert found.shift_x_px == pytest.approx(shift, abs=2)
    assert found.shift_y_px == pytest.approx(0, abs=1.5)
    applied = corrected_camera(DEPTH, found.correction)
    assert applied.fx_px == pytest.approx(270 * found.scale)
    assert applied.cx_px == pytest.approx(160 + found.shift_x_px)


def test_one_camera_stays_as_stated(box_room):
    found = estimate_colour_camera(_views(box_room, 1.0, 0.0))
    assert not found.clear
    assert found.gain == pytest.approx(1, abs=0.1)


def test_without_edges_there_is_no_estimate(box_room):
    views = _views(box_room, 0.9, -4.0)
    flat = [replace(view, depth_m=np.full_like(view.depth_m, 2)) for view in views]
    assert estimate_colour_camera(flat) is None
    assert estimate_colour_camera([]) is None


def test_the_real_kitchen_has_its_known_colour_camera(shared_data):
    scan = open_scan(shared_data / "redkitchen_rgbd")
    view = next(iter(scan.views))
    assert 519 < view.colour_camera.fx_px < 531  # Structure from motion gives 520 to 527.
    assert view.colour_camera.cx_px - 320 == pytest.approx(-6, abs=3)
    assert view.colour_camera.cy_px - 240 == pytest.approx(0, abs=3)
    assert view.depth_camera.fx_px == 585
    assert any("colour camera is estimated from edges" in note for note in scan.notes)
    stated = open_scan(shared_data / "redkitchen_rgbd", options={"colour_camera": "stated"})
    assert next(iter(stated.views)).colour_camera.fx_px == 585


def test_a_recorded_scan_is_opened_without_estimating(shared_data, tmp_path, monkeypatch):
    kitchen = shared_data / "redkitchen_rgbd"
    first = open_scan(kitchen)
    write_scan(tmp_path / "scan.json", first)
    module = sys.modules["world2minecraft.capture.open_scan"]
    monkeypatch.setattr(module, "align", None)
    monkeypatch.setattr(module, "estimate_colour_camera", None)
    again = open_scan(kitchen, recorded=tmp_path / "scan.json")
    assert again.colour_correction == first.colour_correction != (1, 0, 0)
    assert again.notes == first.notes and again.frame_sigmas == first.frame_sigmas
    assert np.array_equal(again.scan_to_room, first.scan_to_room)
    one, other = next(iter(first.views)), next(iter(again.views))
    assert one.colour_camera == other.colour_camera and one.depth_camera == other.depth_camera


def test_a_synthetic_living_room_of_others_stays_as_stated(shared_data):
    folder = shared_data / "open3d_rgbd_samples" / "RGBD"
    camera = Camera(640, 480, 525.0, 525.0, 320.0, 240.0)
    views = []
    for index in range(5):
        depth = np.asarray(Image.open(folder / "depth" / f"{index:05d}.png"), np.float32) / 1000
        colour = np.asarray(Image.open(folder / "color" / f"{index:05d}.jpg"), np.uint8)
        views.append(View(str(index), np.eye(4), colour, camera, depth.astype(np.float32), camera))
    found = estimate_colour_camera(views)
    assert not found.clear
    assert found.scale == pytest.approx(1, abs=0.01)
    assert abs(found.shift_x_px) < 3
