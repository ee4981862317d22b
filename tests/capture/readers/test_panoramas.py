"""Panoramas: cut where they show what a camera would see, found out, and refused with advice."""

import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from world2minecraft.capture.format_detection import find_capture
from world2minecraft.capture.options import parse_options
from world2minecraft.capture.readers.panoramas import (
    VIEWS,
    cut_view,
    is_panorama_size,
    view_camera,
    view_to_panorama,
    wraps_around,
)
from world2minecraft.core.coordinates import opengl_to_opencv_pose
from world2minecraft.core.errors import CaptureError

WIDTH, HEIGHT = 1024, 512


def sky(rays):
    """A smooth colour of each direction, float [..., 3]; OpenCV axes."""
    unit = rays / np.linalg.norm(rays, axis=-1, keepdims=True)
    return 128 + 100 * unit


def panorama(width=WIDTH, height=HEIGHT):
    across = ((np.arange(width) + 0.5) / width - 0.5) * 2 * np.pi
    down = ((np.arange(height) + 0.5) / height - 0.5) * np.pi
    lon, lat = np.meshgrid(across, down)
    rays = np.stack([np.cos(lat) * np.sin(lon), np.sin(lat), np.cos(lat) * np.cos(lon)], axis=-1)
    return np.round(sky(rays)).astype(np.uint8)


@settings(max_examples=10)
@given(st.integers(0, VIEWS - 1))
def test_views_show_what_a_camera_there_sees(view):
    camera, rotation = view_camera(400), view_to_panorama(view)[:3, :3]
    u, v = np.meshgrid(np.arange(camera.width_px) + 0.5, np.arange(camera.height_px) + 0.5)
    rays = np.stack(
        [(u - camera.cx_px) / camera.fx_px, (v - camera.cy_px) / camera.fy_px, np.ones(u.shape)],
        axis=-1,
    )
    seen = cut_view(panorama(), camera, rotation).astype(float)
    assert np.abs(seen - sky(rays @ rotation.T)).max() <= 1.5


def test_views_are_level_and_turn_to_the_right():
    first, second = view_to_panorama(0), view_to_panorama(1)
    assert (first == np.eye(4)).all()
    assert second[:3, 2] @ first[:3, 0] > 0.8  # Ahead of the second is right of the first.
    assert second[:3, 1] == pytest.approx([0, 1, 0])


def test_a_wide_photo_is_no_panorama():
    ramp = np.repeat(np.linspace(0, 255, 600).astype(np.uint8)[None, :, None], 3, axis=2)
    assert wraps_around(panorama()) and not wraps_around(np.repeat(ramp, 300, axis=0))
    assert is_panorama_size(4096, 2048) and not is_panorama_size(4000, 3000)


def write(folder, count):
    folder.mkdir(exist_ok=True)
    for n in range(count):
        Image.fromarray(np.roll(panorama(), 7 * n, axis=1)).save(folder / f"place {n}.png")
    return folder


def test_a_folder_of_panoramas_is_a_capture(tmp_path):
    found = find_capture(write(tmp_path / "room", 4))
    assert (found.source, found.scale, len(found.frames)) == ("panoramas", "unknown", 4 * VIEWS)
    places = {frame.rig.place for frame in found.frames}
    assert places == {f"place_{n}" for n in range(4)}
    frame = found.frames[1]
    assert frame.name == "place_0.1" and frame.camera_to_world is None
    colour = frame.colour_path.colour()
    assert colour.shape == (frame.colour_camera.height_px, frame.colour_camera.width_px, 3)
    few = find_capture(tmp_path / "room", parse_options({"frames": "3"}))
    assert len(few.frames) == 3 * VIEWS


@pytest.mark.parametrize("count", [1, 2])
def test_too_few_panoramas_are_refused_with_advice(tmp_path, count):
    folder = write(tmp_path / "room", count)
    with pytest.raises(CaptureError, match=rf"{count} panorama.*take at least 4 panoramas"):
        find_capture(folder)
    with pytest.raises(CaptureError, match="1 panorama"):
        find_capture(folder / "place 0.png")


def test_panoramas_with_poses_are_read_from_transforms(tmp_path):
    write(tmp_path, 2)
    pose = np.eye(4)
    pose[:3, 3] = 1, 2, 3
    frames = [{"file_path": f"place {n}.png", "transform_matrix": pose.tolist()} for n in range(2)]
    path = tmp_path / "transforms.json"
    path.write_text(json.dumps({"camera_model": "EQUIRECTANGULAR", "frames": frames}))
    found = find_capture(tmp_path)
    assert found.source == "nerfstudio" and len(found.frames) == 2 * VIEWS
    for view, frame in enumerate(found.frames[:VIEWS]):
        expected = opengl_to_opencv_pose(pose) @ view_to_panorama(view)
        assert frame.camera_to_world == pytest.approx(expected)
    Image.fromarray(panorama()[:, :700]).save(tmp_path / "place 0.png")
    with pytest.raises(CaptureError, match="twice as wide as high"):
        find_capture(tmp_path)
