"""A phone as the sensor: photos, posed photos and videos of generated rooms, without depth."""

import json

import numpy as np
import pytest

from world2minecraft.capture.options import ScanOptions
from world2minecraft.capture.validation import validate_capture
from world2minecraft.procgen import generate_room, scan_room
from world2minecraft.procgen.sensors.phone import LOOK_PHOTOS, LOOK_TURN, plan_camera_track
from world2minecraft.procgen.sensors.photo_rendering import prepare_photos
from world2minecraft.procgen.sensors.scan_frames import ScanSettings
from world2minecraft.procgen.sensors.surface_textures import hash_to_unit

SMALL = {"width": 160, "height": 120, "seed": 3}


@pytest.fixture(scope="module")
def room():
    return generate_room(505, kind="bathroom")


def test_posed_photos_state_true_poses_and_no_depth(tmp_path, room):
    scan_room(room, tmp_path, sensor="photo", frames=4, **SMALL)
    judged = validate_capture(tmp_path, ScanOptions())
    assert judged.posed and not judged.has_depth
    with np.load(tmp_path / "truth.npz") as truth:
        to_scan = truth["truth_room_to_scan"]
        for frame, true in zip(judged.frames, truth["camera_to_truth"], strict=True):
            assert np.allclose(frame.camera_to_world, to_scan @ true, atol=1e-9)


def test_photos_are_jpegs_and_nothing_else_tells_of_them(tmp_path, room):
    scan_room(room, tmp_path, sensor="photos", frames=4, width=320, height=240, seed=3)
    names = sorted(path.name for path in tmp_path.iterdir())
    assert names == [f"frame-{n:06d}.jpg" for n in range(4)] + ["truth.json", "truth.npz"]
    judged = validate_capture(tmp_path, ScanOptions())
    assert judged.capture.source == "photos"
    assert not judged.posed and not judged.has_depth
    with np.load(tmp_path / "truth.npz") as truth:
        assert [frame.name for frame in judged.frames] == truth["frame_names"].tolist()


def test_a_video_has_a_picture_for_each_moment_of_its_truth(tmp_path, room):
    scan_room(room, tmp_path, sensor="video", frames=20, **SMALL)
    judged = validate_capture(tmp_path, ScanOptions())
    assert judged.capture.source == "video"
    with np.load(tmp_path / "truth.npz") as truth:
        assert len(truth["frame_names"]) == 20
        assert {frame.name for frame in judged.frames} <= set(truth["frame_names"].tolist())


@pytest.mark.parametrize("sensor", ["photos", "video"])
def test_the_same_seed_gives_the_same_bytes(tmp_path, room, sensor):
    for name in ("one", "other"):
        scan_room(room, tmp_path / name, sensor=sensor, frames=6, **SMALL)
    for path in sorted((tmp_path / "one").iterdir()):
        assert path.read_bytes() == (tmp_path / "other" / path.name).read_bytes(), path.name


def test_a_person_who_films_turns_evenly(room):
    camera = ScanSettings("photo").camera
    scene = prepare_photos(room).scene
    for smooth in (False, True):
        film = plan_camera_track(room, scene, camera, 40, np.random.default_rng(0), smooth=smooth)
        turns = np.abs(np.diff(film.angles, axis=0)).max(axis=0)
        assert (turns <= LOOK_TURN / LOOK_PHOTOS * 1.001).all()
        middle = film.pose(10.5)[:3, 3]
        assert np.allclose(middle, (film.pose(10)[:3, 3] + film.pose(11)[:3, 3]) / 2)


def slow_mixed(a, b, c, d):
    """The hash in whole numbers of 64 bits, word by word."""
    wrap = lambda value: (value + 2**63) % 2**64 - 2**63  # noqa: E731
    h = wrap(a * 73856093) ^ wrap(b * 19349663) ^ wrap(c * 83492791) ^ wrap(d * 49979687)
    h = wrap((h ^ (h >> 15)) * 1274126177) & 0x7FFFFFFF
    h = wrap((h ^ (h >> 13)) * 1103515245) & 0x7FFFFFFF
    return ((h ^ (h >> 16)) & 0xFFFFF) / 1048575.0


def test_the_hash_of_a_place_equals_its_slow_reading():
    rng = np.random.default_rng(1)
    for row in rng.integers(-5000, 5000, (200, 4)).tolist():
        assert hash_to_unit(*row) == slow_mixed(*row)
        assert 0 <= hash_to_unit(*row) <= 1


@pytest.mark.parametrize(
    "words, text",
    [
        ({"with_labels": True}, "labels require the sensor rgbd or clean"),
        ({"depth_scale_sigma": 0.1}, "photos, which has no depth"),
    ],
)
def test_a_phone_has_no_labels_and_no_depth(words, text):
    with pytest.raises(ValueError, match=text):
        ScanSettings("photos", **words)


def test_a_video_has_even_sides():
    with pytest.raises(ValueError, match="video width and height must be even, got 161x120"):
        ScanSettings("video", width=161, height=120)
    ScanSettings("photos", width=161, height=120)


def test_phones_take_more_pictures_by_default():
    assert [ScanSettings(s).planned for s in ("rgbd", "photo", "photos", "video")] == [
        40,
        100,
        100,
        240,
    ]
    assert ScanSettings("video", 7).planned == 7


def test_what_is_stated_of_posed_photos(tmp_path, room):
    scan_room(room, tmp_path, sensor="photo", frames=3, **SMALL)
    stated = json.loads((tmp_path / "capture.json").read_text())
    assert "depth_camera" not in stated
    assert stated["colour_camera"]["width_px"] == 160
