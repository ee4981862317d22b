"""What lacks depth or poses is completed; posing and stereo are stood in for by the truth."""

import json
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image
from tests.exact_room import BoxRoom

from world2minecraft.capture import open_scan, write_plain
from world2minecraft.capture.options import ScanOptions
from world2minecraft.capture.validation import validate_capture
from world2minecraft.core.coordinates import apply, invert_rigid
from world2minecraft.core.errors import CaptureError, UnknownNameError, UsageError
from world2minecraft.core.types import Camera, DepthMap, SparseScene, View
from world2minecraft.geometry.unprojection import project, unproject_depth
from world2minecraft.reconstruction.opening import open_capture as preparing
from world2minecraft.reconstruction.opening import prepare_and_open, prepare_capture
from world2minecraft.reconstruction.opening.metric_scale import (
    clicked,
    depth_ratios,
    normalise_scale,
    scale_capture,
)
from world2minecraft.reconstruction.parameters import Parameters

CAMERA = Camera(320, 240, 260.0, 260.0, 160.0, 120.0)
UNIT_M = 0.37  # What one unit of the stand-in's scene is.


def scene_of(views, unit_m=1.0):
    """The sparse scene of views with depth: each point seen by the frame that it was lifted of."""
    points, owners, pixels = [], [], []
    for index, view in enumerate(views):
        depth = np.zeros_like(view.depth_m)
        depth[::10, ::10] = view.depth_m[::10, ::10]
        lifted, _ = unproject_depth(depth, view.depth_camera, view.camera_to_scan)
        points.append(lifted)
        owners.append(np.full(len(lifted), index, np.int32))
        inside = apply(invert_rigid(view.camera_to_scan), lifted.astype(np.float64))
        pixels.append(project(inside, view.depth_camera))
    poses = np.array([view.camera_to_scan for view in views])
    poses[:, :3, 3] /= unit_m
    points_m = (np.concatenate(points) / unit_m).astype(np.float32)
    return SparseScene(
        names=tuple(view.name for view in views),
        cameras=tuple(view.colour_camera for view in views),
        camera_to_scan=poses,
        points_m=points_m,
        colour=np.zeros((len(points_m), 3), np.uint8),
        track_frame=np.concatenate(owners),
        track_point=np.arange(len(points_m), dtype=np.int32),
        track_px=np.concatenate(pixels).astype(np.float32),
        error_px=0.5,
        left_out=(("blurred", "shows too little"),),
        notes=("all photos were placed",),
        facts={"registered": len(views)},
    )


@pytest.fixture(scope="module")
def views():
    room = BoxRoom()
    shots = [(pose, *room.render(pose, CAMERA)) for pose in room.poses(16)]
    return [
        View(f"{index:06d}", pose, colour, CAMERA, depth, CAMERA)
        for index, (pose, depth, colour) in enumerate(shots)
    ]


@pytest.fixture
def stood_in(views, monkeypatch):
    """Posing and stereo that know the truth; each call is noted."""
    calls = []

    def posed(photos, parameters, progress):
        calls.append("check" if next(iter(photos)).camera_to_scan is not None else "find")
        return scene_of(views, UNIT_M if calls[-1] == "find" else 1.0)

    def deep(photos, scene, parameters, progress, guide):
        calls.append("stereo")
        size = np.linalg.norm(scene.camera_to_scan[1, :3, 3] - scene.camera_to_scan[0, :3, 3])
        true = np.linalg.norm(views[1].camera_to_scan[:3, 3] - views[0].camera_to_scan[:3, 3])
        for view in views:
            depth = (view.depth_m * (size / true)).astype(np.float32)
            trust = np.full(depth.shape, 255, np.uint8)
            trust[:, :5] = 96
            yield DepthMap(view.name, view.depth_camera, depth, trust)

    monkeypatch.setattr(preparing, "find_poses", posed)
    monkeypatch.setattr(preparing, "check_poses", posed)
    monkeypatch.setattr(preparing, "compute_depth_maps", deep)
    return calls


def write_photos(folder, views):
    folder.mkdir()
    for view in views:
        Image.fromarray(view.colour).save(folder / f"{view.name}.png")
    return folder


def write_posed(folder, views):
    write_plain(folder, [replace(v, depth_m=None, depth_camera=None) for v in views])
    return folder


def test_a_complete_capture_is_left_alone(tmp_path, views, stood_in):
    write_plain(tmp_path / "in", views)
    assert prepare_capture(tmp_path / "in", tmp_path / "OUT", Parameters()) == tmp_path / "in"
    assert not stood_in
    assert not (tmp_path / "OUT").exists()


def test_posed_photos_get_depth_and_keep_their_frame(tmp_path, views, stood_in):
    scan = prepare_and_open(write_posed(tmp_path / "in", views), tmp_path / "OUT", Parameters())
    assert stood_in == ["check", "stereo"]
    assert (scan.depth_kind, scan.scale) == ("stereo", "metric")
    assert np.allclose(scan.room_size_m, (3.1, 4.2, 2.6), atol=0.03)
    assert ("blurred", "shows too little") in scan.frames_skipped
    assert "all photos were placed" in scan.notes
    for view, true in zip(scan.views, views, strict=True):
        assert np.allclose(view.camera_to_scan, true.camera_to_scan, atol=1e-9)
        assert np.abs(view.depth_m - true.depth_m).max() < 2e-4
        assert (view.trust[:, :5] == 96).all() and (view.trust[:, 5:] == 255).all()


def test_photos_alone_get_poses_depth_and_a_scale(tmp_path, views, stood_in):
    folder = write_photos(tmp_path / "in", views)
    scan = prepare_and_open(folder, tmp_path / "OUT", Parameters())
    assert stood_in == ["find", "stereo"]
    assert scan.scale == "estimated"
    assert 0 < scan.scale_sigma < 0.5
    share = scan.room_size_m / (3.1, 4.2, 2.6)
    assert np.ptp(share) < 0.02
    assert abs(share.mean() - 1) < 0.25


@pytest.mark.parametrize("height_m", [2.6, 2.9])
def test_a_known_length_gives_the_scale(tmp_path, views, stood_in, height_m):
    folder = write_photos(tmp_path / "in", views)
    chosen = Parameters(known=("room height", height_m))
    scan = prepare_and_open(folder, tmp_path / "OUT", chosen)
    assert scan.scale == "metric"
    assert np.allclose(scan.room_size_m, np.array((3.1, 4.2, 2.6)) * height_m / 2.6, rtol=0.015)


def test_two_clicked_points_give_the_scale(tmp_path, views, stood_in):
    folder = write_photos(tmp_path / "in", views)
    view = views[0]
    points, pixels = unproject_depth(view.depth_m, view.depth_camera, view.camera_to_scan)
    wide = view.depth_camera.width_px
    a, b = 30 * wide + 40, 90 * wide + 120
    at = {int(pixel): points[n] for n, pixel in enumerate(pixels)}
    length = float(np.linalg.norm(at[a] - at[b]))
    named = [f"{view.name}.png:{p % wide + 0.5},{p // wide + 0.5}" for p in (a, b)]
    chosen = Parameters(known_points=(*named, length))
    scan = prepare_and_open(folder, tmp_path / "OUT", chosen)
    assert np.allclose(scan.room_size_m, (3.1, 4.2, 2.6), rtol=0.02)


@pytest.mark.parametrize(
    "points, error, words",
    [
        (("x", "y", 1.0), UsageError, "--known-points must be PHOTO:x,y"),
        (("none:1,1", "000000:1,1", 1.0), UnknownNameError, "no photo is named 'none'"),
    ],
)
def test_clicked_points_that_are_none(tmp_path, views, stood_in, points, error, words):
    folder = write_photos(tmp_path / "in", views)
    with pytest.raises(error, match=words):
        prepare_capture(folder, tmp_path / "OUT", Parameters(known_points=points))


def test_depth_without_poses_keeps_its_metres(tmp_path, views, stood_in):
    for kind in ("rgb", "depth"):
        (tmp_path / "in" / kind).mkdir(parents=True)
    for view in views:
        Image.fromarray(view.colour).save(tmp_path / "in" / "rgb" / f"{view.name}.png")
        millimetres = np.round(view.depth_m * 1000).astype(np.uint16)
        Image.fromarray(millimetres).save(tmp_path / "in" / "depth" / f"{view.name}.png")
    scan = prepare_and_open(tmp_path / "in", tmp_path / "OUT", Parameters())
    assert stood_in == ["find"]
    assert (scan.depth_kind, scan.scale) == ("sensor", "metric")
    assert np.allclose(scan.room_size_m, (3.1, 4.2, 2.6), atol=0.03)
    for view, true in zip(scan.views, views, strict=True):
        assert np.allclose(view.camera_to_scan, true.camera_to_scan, atol=2e-3)


def test_what_was_made_is_taken_again_until_something_changes(tmp_path, views, stood_in):
    folder, out = write_posed(tmp_path / "in", views), tmp_path / "OUT"
    first = prepare_capture(folder, out, Parameters())
    held = {path: path.read_bytes() for path in first.rglob("*") if path.is_file()}
    assert prepare_capture(folder, out, Parameters()) == first
    assert stood_in == ["check", "stereo"]
    prepare_capture(folder, out, Parameters(blocks_per_metre=2))
    assert stood_in == ["check", "stereo"]
    (first / "prepared.json").unlink()
    prepare_capture(folder, out, Parameters())
    assert stood_in == ["check", "stereo"] * 2
    assert held == {path: path.read_bytes() for path in first.rglob("*") if path.is_file()}
    Image.fromarray(views[3].colour[::-1]).save(folder / "colour" / "000003.png")
    prepare_capture(folder, out, Parameters())
    assert stood_in == ["check", "stereo"] * 3


def test_too_few_photos_and_a_known_length_of_what_has_depth(tmp_path, views, stood_in):
    with pytest.raises(CaptureError, match="contains 2 photos that can be used; take at least 30"):
        prepare_capture(write_photos(tmp_path / "two", views[:2]), tmp_path / "OUT", Parameters())
    write_plain(tmp_path / "in", views)
    with pytest.raises(UsageError, match="contains poses and depth, so its scale is fixed; omit"):
        prepare_capture(tmp_path / "in", tmp_path / "OUT", Parameters(known=("table height", 0.72)))


def test_a_scene_is_brought_to_a_handy_size(views):
    big, small = normalise_scale(scene_of(views, 0.001)), normalise_scale(scene_of(views, 90.0))
    assert np.allclose(big.camera_to_scan, small.camera_to_scan, atol=1e-4)
    assert np.allclose(big.points_m, small.points_m, atol=1e-3)
    depth = np.linalg.norm(
        big.points_m[big.track_point] - big.camera_to_scan[big.track_frame, :3, 3], axis=1
    )
    assert 2.4 < np.median(depth) < 3.6


def test_ratios_of_depth_are_the_scale(views):
    scene = scene_of(views, UNIT_M)
    view = replace(views[2], camera_to_scan=scene.camera_to_scan[2])
    ratios = depth_ratios(view, scene.points_m[scene.track_point[scene.track_frame == 2]])
    assert len(ratios) > 50
    assert np.allclose(np.median(ratios), UNIT_M, rtol=0.01)


def test_trust_scale_and_notes_go_through_a_plain_capture(tmp_path, views):
    trust = np.arange(views[0].depth_m.size, dtype=np.uint8).reshape(views[0].depth_m.shape)
    stated = {"scale": "estimated", "scale_sigma": 0.07, "notes": ["so it is"]}
    stated |= {"depth_kind": "stereo", "skipped": [["x", "blurred"]]}
    told = [replace(view, trust=np.maximum(trust, 1)) for view in views]
    write_plain(tmp_path, told, depth_unit="0.0002", stated=stated, jpeg=True)
    scan = open_scan(tmp_path)
    assert (scan.scale, scan.scale_sigma, scan.depth_kind) == ("estimated", 0.07, "stereo")
    assert "so it is" in scan.notes
    assert scan.frames_skipped == (("x", "blurred"),)
    for found, true in zip(scan.views, told, strict=True):
        assert (found.trust == true.trust).all()
        assert np.abs(found.depth_m - true.depth_m).max() <= 1.01e-4


@pytest.mark.parametrize(
    "key, value, words",
    [
        ("scale", "big", '"scale" must be one of metric, estimated, unknown'),
        ("scale_sigma", -1, '"scale_sigma" must be a relative error'),
        ("notes", "one", '"notes" must be a list'),
        ("skipped", [["x"]], '"skipped" must be a list of'),
        ("depth_kind", 3, '"depth_kind" must be one of'),
        ("world_up", [0, 0, 0], '"world_up" must be three numbers'),
        ("world_up", "up", '"world_up" must be three numbers'),
    ],
)
def test_what_a_plain_capture_states_is_checked(tmp_path, views, key, value, words):
    write_plain(tmp_path, views)
    stated = json.loads((tmp_path / "capture.json").read_text())
    (tmp_path / "capture.json").write_text(json.dumps(stated | {key: value}))
    with pytest.raises(CaptureError, match=words):
        open_scan(tmp_path)


def test_clicked_points_of_photos_with_dots_in_their_names(tmp_path, views, stood_in):
    named = [replace(view, name=f"2024.05.{n:02d}") for n, view in enumerate(views)]
    write_posed(tmp_path / "in", named)
    judged = validate_capture(tmp_path / "in", ScanOptions())
    pair = [f"{view.name}{suffix}:10,20" for view, suffix in zip(named, ("", ".jpg"), strict=False)]
    found = clicked(*pair, 1.0, judged, lambda name: (640, 480))
    assert (found.image_a, found.image_b) == ("2024.05.00", "2024.05.01")
    assert found.point_a == (5, 10)


def test_a_scale_reaches_what_single_frames_state(tmp_path, views):
    aside = np.eye(4)
    aside[0, 3] = 0.02
    written = [replace(views[0], depth_to_colour=aside), *views[1:]]
    write_plain(tmp_path, written, depth_unit="0.0002", stated={"scale": "unknown", "notes": []})
    before = json.loads((tmp_path / "capture.json").read_text())
    scale_capture(tmp_path, Parameters(known=("room height", 5.2)), lambda name: (320, 240))
    after = json.loads((tmp_path / "capture.json").read_text())
    for one, two in zip((before, *before["frames"]), (after, *after["frames"]), strict=True):
        for key in {"camera_to_world", "depth_to_colour"} & set(one):
            moved = np.array(two[key])[:3, 3], 2 * np.array(one[key])[:3, 3]
            np.testing.assert_allclose(*moved, rtol=0.02, atol=1e-9)


def test_nothing_is_written_into_the_photos_themselves(tmp_path, views, stood_in):
    folder = write_photos(tmp_path / "capture", views)
    with pytest.raises(UsageError, match="choose another output folder"):
        prepare_capture(folder, tmp_path, Parameters())
    assert len(list(folder.iterdir())) == len(views) and not stood_in
