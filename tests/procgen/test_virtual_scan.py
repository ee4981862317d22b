"""Virtual scans: where the camera stands, what lands on disk, and that its truth is true."""

import json
import weakref
from functools import cache

import numpy as np
import pytest

from world2minecraft.core.errors import UnknownNameError
from world2minecraft.core.files import read_npz
from world2minecraft.geometry.unprojection import unproject_depth
from world2minecraft.procgen import generate_room, room_views, scan_room
from world2minecraft.procgen.sensors.depth_camera import scale_factor
from world2minecraft.procgen.sensors.scan_frames import ScanSettings, room_shots, room_to_scan
from world2minecraft.rendering import cast_voxels, prepare_voxels

NAMES = (
    "labels", "instance", "voxel_m", "origin_m", "truth_room_to_scan", "frame_names",
    "camera_to_truth", "depth_scale",
)  # fmt: skip
room = cache(lambda: generate_room(1, kind="living"))


def files(folder):
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


def test_the_bytes_of_a_scan_depend_on_the_seed_alone(tmp_path):
    for name, seed in (("a", 3), ("b", 3), ("c", 4)):
        scan_room(room(), tmp_path / name, frames=2, seed=seed, width=64, height=48)
    assert files(tmp_path / "a") == files(tmp_path / "b")
    assert (
        files(tmp_path / "a")["colour/frame-000000.png"]
        != (files(tmp_path / "c")["colour/frame-000000.png"])
    )


def test_the_truth_lies_beside_the_capture(tmp_path):
    scan_room(room(), tmp_path, frames=1, seed=2, width=64, height=48)
    truth = read_npz(tmp_path / "truth.npz", NAMES)
    assert np.array_equal(truth["labels"], room().labels)
    assert np.array_equal(truth["instance"], room().instance)
    assert float(truth["voxel_m"]) == room().voxel_m
    stated = json.loads((tmp_path / "truth.json").read_text())
    assert stated["kind"] == "living"
    assert [item["name"] for item in stated["objects"]] == [
        item.name for item in room().layout.objects
    ]
    assert stated["objects"][0]["id"] == 1


def test_clean_depth_lifted_by_the_truth_lands_on_its_voxels():
    to_room = np.linalg.inv(room_to_scan(6))
    for view in room_views(
        room(), sensor="clean", frames=3, seed=6, with_labels=True, width=96, height=72
    ):
        points, pixels = unproject_depth(
            view.depth_m, view.depth_camera, to_room @ view.camera_to_scan
        )
        inward = points - to_room[:3, :3] @ view.camera_to_scan[:3, 3] - to_room[:3, 3]
        inward *= 0.004 / np.linalg.norm(inward, axis=1, keepdims=True)
        cells = np.floor((points + inward - room().origin_m) / room().voxel_m).astype(int)
        found = room().labels[tuple(cells.T)]
        assert len(points) == 96 * 72  # The room is closed.
        said = view.labels.reshape(-1)[pixels]
        assert (found == said).mean() > 0.98


def test_true_poses_are_the_stated_ones_without_jitter(tmp_path):
    size = {"frames": 4, "seed": 6, "width": 64, "height": 48}
    for sensor in ("clean", "rgbd"):
        scan_room(room(), tmp_path / sensor, sensor=sensor, **size)
    clean, rough = (read_npz(tmp_path / name / "truth.npz", NAMES) for name in ("clean", "rgbd"))
    assert np.array_equal(clean["camera_to_truth"], rough["camera_to_truth"])
    for name, moved in (("clean", 0.0), ("rgbd", 0.03)):
        stated = json.loads((tmp_path / name / "capture.json").read_text())["frames"]
        assert [frame["name"] for frame in stated] == clean["frame_names"].tolist()
        to_scan = np.array([frame["camera_to_world"] for frame in stated])
        true = clean["truth_room_to_scan"] @ clean["camera_to_truth"]
        # What undoes the true pose undoes the stated one, but for the jitter of the sensor.
        left = np.linalg.inv(true) @ to_scan - np.eye(4)
        assert np.abs(left).max() <= moved + 1e-9
        assert moved == 0 or np.abs(left).max() > 1e-4


def test_true_scales_correct_the_stated_depth():
    how = ScanSettings(
        sensor="clean", frames=5, seed=3, depth_scale_sigma=0.03, width=64, height=48
    )
    scene = prepare_voxels(room().labels, room().voxel_m, room().origin_m)
    scales = []
    for shot in room_shots(room(), how):
        true_m = cast_voxels(scene, how.camera, shot.truth.camera_to_truth).depth_m
        ratio = shot.view.depth_m / true_m
        assert np.allclose(ratio, shot.truth.depth_scale, rtol=1e-5)
        scales.append(shot.truth.depth_scale)
    assert len(set(scales)) == 5


def test_scales_spread_by_their_sigma_and_are_one_without():
    rngs = [np.random.default_rng([n, 4]) for n in range(3000)]
    drawn = np.array([scale_factor(0.03, rng) for rng in rngs])
    assert drawn.mean() == pytest.approx(1, abs=0.002)
    assert drawn.std() == pytest.approx(0.03, rel=0.05)
    assert np.abs(drawn - 1).max() <= 0.09 + 1e-12
    assert all(scale_factor(0.0, rng) == 1.0 for rng in rngs[:5])


def test_a_scale_changes_neither_the_walk_nor_the_holes():
    plain, scaled = (
        list(room_shots(room(), ScanSettings(frames=3, depth_scale_sigma=s, width=64, height=48)))
        for s in (0.0, 0.05)
    )
    for a, b in zip(plain, scaled, strict=True):
        assert np.array_equal(a.truth.camera_to_truth, b.truth.camera_to_truth)
        assert np.array_equal(a.view.depth_m == 0, b.view.depth_m == 0)
        assert np.array_equal(a.view.colour, b.view.colour)


@pytest.mark.parametrize(("coverage", "taken"), [(1.0, 10), (0.6, 6), (0.25, 2), (0.01, 1)])
def test_less_coverage_is_the_beginning_of_the_same_walk(coverage, taken):
    size = {"frames": 10, "seed": 2, "width": 32, "height": 24}
    whole = list(room_views(room(), **size))
    part = list(room_views(room(), coverage=coverage, **size))
    assert len(part) == taken
    for a, b in zip(whole, part, strict=False):
        assert a.name == b.name
        assert np.array_equal(a.camera_to_scan, b.camera_to_scan)
        assert np.array_equal(a.depth_m, b.depth_m)


def test_truth_states_the_layouts(tmp_path):
    scan_room(room(), tmp_path, frames=1, seed=2, width=64, height=48)
    (stated,) = json.loads((tmp_path / "truth.json").read_text())["layouts"]
    layout = room().layout
    assert np.allclose(stated["floor_polygon_m"], layout.floor_polygon_m, atol=1e-4)
    assert stated["floor_z_m"] == 0.0
    assert stated["wall_height_m"] == pytest.approx(layout.wall_height_m)
    assert [one["kind"] for one in stated["openings"]] == [one.kind for one in layout.openings]
    for one, opening in zip(stated["openings"], layout.openings, strict=True):
        assert np.allclose([one["start_m"], one["end_m"]], [opening.start_m, opening.end_m])
        assert (one["sill_m"], one["head_m"]) == pytest.approx((opening.sill_m, opening.head_m))


def test_the_world_frame_is_turned_and_tilted_but_rigid():
    tilts = []
    for seed in range(30):
        transform = room_to_scan(seed)
        assert np.allclose(transform[:3, :3] @ transform[:3, :3].T, np.eye(3))
        assert np.linalg.det(transform[:3, :3]) > 0
        tilts.append(np.degrees(np.arccos(transform[2, 2])))
    assert max(tilts) > 20
    assert max(tilts) <= 27.001
    assert min(tilts) > 5


@pytest.mark.parametrize("error", [0.0, 0.3])
def test_labels_err_by_the_stated_share(error):
    arguments = {"frames": 2, "seed": 8, "with_labels": True, "width": 320, "height": 240}
    exact = list(room_views(room(), **arguments))
    given = list(room_views(room(), **arguments, label_error=error))
    wrong = np.mean([(a.labels != b.labels).mean() for a, b in zip(exact, given, strict=True)])
    assert wrong == pytest.approx(error, abs=0.04)
    assert all((view.labels != 0).all() for view in given)


def test_without_labels_there_are_none(tmp_path):
    scan_room(room(), tmp_path, frames=1, seed=2, width=64, height=48)
    assert not (tmp_path / "labels").exists()


def test_the_pictures_show_the_colours_of_the_room():
    (view,) = room_views(room(), frames=1, seed=2, width=96, height=72)
    assert view.colour.std() > 15
    assert 60 < view.colour.mean() < 220


def test_rgbd_depth_has_holes_and_noise_but_is_near():
    settings = {"frames": 2, "seed": 5, "width": 160, "height": 120}
    for rough, exact in zip(
        room_views(room(), sensor="rgbd", **settings),
        room_views(room(), sensor="clean", **settings),
        strict=True,
    ):
        seen = rough.depth_m > 0
        assert 0.5 < seen.mean() < 0.99
        error = np.abs(rough.depth_m - exact.depth_m)[seen]
        assert 0.0005 < np.median(error) < 0.03


def test_progress_ends_with_all_frames(tmp_path):
    calls = []
    scan_room(
        room(), tmp_path, frames=3, width=64, height=48,
        progress=lambda *said: calls.append(said),
    )  # fmt: skip
    assert [call[:3] for call in calls] == [("capture", n, 3) for n in (1, 2, 3)]


def test_a_long_scan_keeps_no_picture():
    shots = room_shots(room(), ScanSettings(frames=6, width=32, height=24))
    kept = []
    for shot in shots:
        kept.append(weakref.ref(shot.view))
        del shot
    assert sum(view() is not None for view in kept) == 0


def test_wrong_arguments_are_refused(tmp_path):
    with pytest.raises(UnknownNameError, match="no sensor is named 'lidar'"):
        scan_room(room(), tmp_path, sensor="lidar")
    for wrong, text in (
        ({"frames": 0}, "frames must be 1 or more, got 0"),
        ({"label_error": 1.5}, "label_error must be from 0 to 1, got 1.5"),
        ({"depth_scale_sigma": -0.1}, "depth_scale_sigma must be from 0 to 0.2, got -0.1"),
        ({"coverage": 0.0}, "coverage must be above 0 and at most 1, got 0.0"),
        ({"coverage": 1.2}, "coverage must be above 0 and at most 1, got 1.2"),
    ):
        with pytest.raises(ValueError, match=f"^{text}$"):
            scan_room(room(), tmp_path, **wrong)
    assert not list(tmp_path.iterdir())
