"""One photo becomes a room: its lens, its place, and what is said where nothing can be told."""

import json
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image
from tests.exact_room import BoxRoom
from tests.reconstruction.occupancy.tiny_network import FACTS, write_network

from world2minecraft.capture import describe_capture
from world2minecraft.capture.format_detection import find_capture
from world2minecraft.capture.options import parse_options
from world2minecraft.capture.summary import summary_lines
from world2minecraft.core.coordinates import look_at
from world2minecraft.core.errors import CaptureError, UsageError
from world2minecraft.core.types import Camera
from world2minecraft.reconstruction.opening import one_photo, prepare_and_open
from world2minecraft.reconstruction.parameters import Parameters
from world2minecraft.runs import run_capture

CAMERA = Camera(320, 240, 260.0, 260.0, 160.0, 120.0)
FOV_DEG = 2 * np.degrees(np.arctan(120 / 260))
ROOM = BoxRoom()
POSE = look_at(np.array([2.0, 0.2, 1.4]), np.array([2.2, 3.0, 0.9]))


class KnowsTheRoom:
    """A depth network that is right but for 3 % of scale."""

    name, kind = "fake:room", "metric"

    def predict(self, colour, camera):
        return ROOM.render(POSE, camera)[0] * np.float32(1.03)


@pytest.fixture
def photo(tmp_path):
    path = tmp_path / "photo.png"
    Image.fromarray(ROOM.render(POSE, CAMERA)[1]).save(path)
    return path


@pytest.fixture
def network(tmp_path):
    """A network to which the floor is floor and all else is free."""
    bias = np.zeros((12, *FACTS.grid_shape))
    bias[0] = 6.0
    bias[0, :, :, 0], bias[2, :, :, 0] = 0.0, 6.0
    bias[0, :, 20, :], bias[3, :, 20, 1:] = 0.0, 6.0
    return write_network(tmp_path / "n.onnx", bias=bias)


def test_a_photo_becomes_a_world_by_the_monocular_network(tmp_path, photo, network):
    out = tmp_path / "OUT"
    chosen = Parameters(predictor=f"mono:{network}", capture={"fov_deg": str(FOV_DEG)})
    facts = run_capture(photo, out, chosen)
    assert (out / "build" / "world" / "level.dat").is_file() and facts
    scan = json.loads((out / "scan.json").read_text())
    assert scan["source"] == "photo" and scan["scale"] == "estimated"
    assert any("be 1.5 m above the floor and to look straight ahead" in n for n in scan["notes"])
    room = np.load(out / "room.npz")
    at_floor = room["labels"][:, :, round((0.0 - room["origin_m"][2]) / 0.08) - 1]
    assert (at_floor == 2).sum() > 200
    manifest = json.loads((out / "manifest.json").read_text())
    assert len(manifest["networks"]) == 1
    again = tmp_path / "AGAIN"
    run_capture(photo, again, chosen)
    for name in ("evidence.npz", "room.npz", "manifest.json", "objects.json"):
        assert (again / name).read_bytes() == (out / name).read_bytes(), name


def test_network_depth_places_the_photo_in_its_room(tmp_path, photo, monkeypatch):
    monkeypatch.setattr(one_photo, "load_depth_model", lambda name: KnowsTheRoom())
    chosen = Parameters(depth_model="fake:room", capture={"fov_deg": str(FOV_DEG)})
    scan = prepare_and_open(photo, tmp_path / "OUT", chosen)
    (view,) = scan.views
    eye = scan.scan_to_room @ view.camera_to_scan
    assert eye[2, 3] == pytest.approx(1.4 * 1.03, abs=0.05)
    pitch_deg = np.degrees(np.arcsin(eye[2, 2]))
    assert pitch_deg == pytest.approx(np.degrees(np.arcsin(POSE[2, 2])), abs=1.0)
    assert scan.depth_kind == "network" and scan.scale == "estimated"
    assert any("fake:room estimated the depth" in note for note in scan.notes)


def test_a_network_without_metres_is_refused(tmp_path, photo, monkeypatch):
    shallow = KnowsTheRoom()
    shallow.kind = "inverse"
    monkeypatch.setattr(one_photo, "load_depth_model", lambda name: shallow)
    with pytest.raises(CaptureError, match="requires depth in metres"):
        prepare_and_open(photo, tmp_path / "OUT", Parameters(depth_model="fake:room"))


def test_a_photo_alone_is_refused_with_what_would_help(tmp_path, photo):
    with pytest.raises(CaptureError, match="--depth hf:ORG/NAME or --predictor mono"):
        prepare_and_open(photo, tmp_path / "OUT", Parameters())
    assert not (tmp_path / "OUT").exists()


def test_the_lens_is_as_told_else_by_exif_else_a_usual_one(tmp_path, photo):
    told = find_capture(photo, parse_options({"fov_deg": str(FOV_DEG)})).frames[0].colour_camera
    assert told is not None and told.fy_px == pytest.approx(260.0) == told.fx_px
    usual = find_capture(photo)
    assert usual.frames[0].colour_camera.fx_px == 0.8 * 320
    assert "set --fov to change it" in usual.notes[0]
    exif = Image.Exif()
    exif.get_ifd(0x8769)[0xA405] = 26
    path = tmp_path / "by_phone.jpg"
    Image.open(photo).save(path, exif=exif)
    by_exif = find_capture(path).frames[0].colour_camera
    assert by_exif.fx_px == pytest.approx(26 / np.hypot(36, 24) * 400, rel=1e-3)


@pytest.mark.parametrize(
    ("height_m", "pitch_deg"), [(1.5, 0.0), (1.2, -20.0), (1.7, 15.0)]
)  # fmt: skip
def test_where_a_photo_without_depth_is_taken_to_stand(height_m, pitch_deg):
    pose, size_m = one_photo.place_photo(height_m, pitch_deg)
    assert pose[2, 3] == height_m
    assert np.degrees(np.arcsin(pose[2, 2])) == pytest.approx(pitch_deg)
    assert abs(pose[2, 0]) < 1e-9, "it is not rolled"
    np.testing.assert_allclose(size_m, [4.8, 4.8, 2.88])


@pytest.mark.parametrize(
    ("option", "value"), [("fov_deg", "200"), ("eye_height_m", "-1"), ("pitch_deg", "up")]
)
def test_wrong_options_are_refused(option, value):
    with pytest.raises(UsageError, match=f"{option} must be"):
        parse_options({option: value})


def test_another_predictor_makes_the_photo_anew(tmp_path, photo, network, monkeypatch):
    """What was kept of it has a place without depth; with depth it is another."""
    monkeypatch.setattr(one_photo, "load_depth_model", lambda name: KnowsTheRoom())
    out = tmp_path / "OUT"
    bare = prepare_and_open(photo, out, Parameters(predictor=f"mono:{network}"))
    assert next(iter(bare.views)).depth_m is None
    chosen = Parameters(predictor=f"mono:{network}", depth_model="fake:room")
    assert next(iter(prepare_and_open(photo, out, chosen).views)).depth_m is not None
    assert (
        next(iter(prepare_and_open(photo, out, replace(chosen, depth_model="")).views)).colour
        is not None
    )


def test_a_look_at_one_photo_names_what_would_help(photo):
    lines = summary_lines(describe_capture(photo))
    (stop,) = [line for line in lines if line.strip().startswith("stop")]
    assert (
        "only 1 image" in stop and "or estimate depth with a network: --depth hf:ORG/NAME" in stop
    )
