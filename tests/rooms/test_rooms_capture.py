"""Virtual scans: where the camera stands, what lands on disk, and that its truth is true."""

import json
from functools import cache

import numpy as np
import pytest

from world2minecraft.errors import UnknownNameError
from world2minecraft.files import read_npz
from world2minecraft.geometry.lifting import lift_depth
from world2minecraft.rooms import generate_room, room_views, scan_room
from world2minecraft.rooms.photo import prepare_photos
from world2minecraft.rooms.shots import room_to_scan
from world2minecraft.rooms.tour import free_floor, plan_tour
from world2minecraft.types import Camera

CAMERA = Camera(160, 120, 131.2, 131.2, 80.0, 60.0)
NAMES = ("labels", "instance", "voxel_m", "origin_m", "truth_room_to_scan")
room = cache(lambda: generate_room(1, kind="living"))
tour = cache(
    lambda: plan_tour(room(), prepare_photos(room()).scene, CAMERA, 24, np.random.default_rng(0))
)


def files(folder):
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


def test_the_eye_stands_on_free_floor_at_a_person_s_height():
    free = free_floor(room())
    for pose in tour():
        x, y, z = pose[:3, 3]
        assert 1.2 <= z <= 1.7
        i, j = ((pose[:2, 3] - room().origin_m[:2]) / 0.1).astype(int)
        assert free[max(i - 1, 0) : i + 2, max(j - 1, 0) : j + 2].any(), (x, y)
    assert len(tour()) == 24


def test_the_tour_is_a_walk_that_looks_all_around():
    steps = np.linalg.norm(np.diff(tour()[:, :2, 3], axis=0), axis=1)
    assert steps.max() < 1.5
    ahead = tour()[:, :2, 2]
    angles = np.degrees(np.arctan2(ahead[:, 1], ahead[:, 0]))
    assert len(set((angles // 60).tolist())) == 6
    assert np.allclose(tour()[:, 2, 0], 0, atol=1e-9)  # Held level.


def test_a_scan_is_the_same_bytes_twice_and_other_bytes_for_another_seed(tmp_path):
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
        points, pixels = lift_depth(view.depth_m, view.depth_camera, to_room @ view.camera_to_scan)
        inward = points - to_room[:3, :3] @ view.camera_to_scan[:3, 3] - to_room[:3, 3]
        inward *= 0.004 / np.linalg.norm(inward, axis=1, keepdims=True)
        cells = np.floor((points + inward - room().origin_m) / room().voxel_m).astype(int)
        found = room().labels[tuple(cells.T)]
        assert len(points) == 96 * 72  # The room is closed.
        said = view.labels.reshape(-1)[pixels]
        assert (found == said).mean() > 0.98


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


def test_depth_of_the_rgbd_sensor_has_holes_and_noise_but_is_near():
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


def test_wrong_arguments_are_refused(tmp_path):
    with pytest.raises(UnknownNameError, match="no sensor is named 'lidar'"):
        scan_room(room(), tmp_path, sensor="lidar")
    with pytest.raises(ValueError, match="frames must be 1 or more"):
        scan_room(room(), tmp_path, frames=0)
    assert not list(tmp_path.iterdir())
