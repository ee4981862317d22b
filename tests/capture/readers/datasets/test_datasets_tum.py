"""TUM RGB-D, written from the benchmark's description of its file formats."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation, Slerp
from tests.capture.readers.datasets.writing import quaternion, save, save_text, zipped

from world2minecraft.capture import open_scan
from world2minecraft.capture.format_detection import find_capture
from world2minecraft.capture.options import ScanOptions
from world2minecraft.capture.readers.datasets.time_sync import interpolate_pose, pair_times
from world2minecraft.capture.validation import validate_capture
from world2minecraft.core.types import Camera
from world2minecraft.geometry.rotations import rotation_from_quaternion


def write_tum(folder, views, *, calibration=True, poses=True, late_s=0.004):
    colours, depths, truth = [], [], ["# ground truth trajectory"]
    for index, view in enumerate(views):
        seconds = 1305031102.0 + index / 30
        save(folder / "rgb" / f"{seconds:.6f}.png", view.colour)
        colours.append(f"{seconds:.6f} rgb/{seconds:.6f}.png")
        stored = np.round(view.depth_m * 5000).astype(np.uint16)
        save(folder / "depth" / f"{seconds + late_s:.6f}.png", stored)
        depths.append(f"{seconds + late_s:.6f} depth/{seconds + late_s:.6f}.png")
        values = [*view.camera_to_scan[:3, 3], *quaternion(view.camera_to_scan[:3, :3])]
        truth.append(f"{seconds:.6f} " + " ".join(f"{value:.9f}" for value in values))
    save_text(folder / "rgb.txt", "# color images\n# file: x\n" + "\n".join(colours) + "\n")
    save_text(folder / "depth.txt", "# depth maps\n" + "\n".join(depths) + "\n")
    save_text(folder / "accelerometer.txt", "1305031102.1 0 0 9.8\n")
    if poses:
        save_text(folder / "groundtruth.txt", "\n".join(truth) + "\n")
    if calibration:
        save_text(folder / "calibration.txt", "130.0 130.0 79.5 59.5\n")


def test_a_sequence_gives_the_views_that_were_written(tmp_path, views, same_views):
    write_tum(tmp_path, views)
    scan = open_scan(tmp_path)
    assert scan.source == "tum"
    same_views(scan, views, depth_off=2e-4)
    assert find_capture(tmp_path).frames[1].time_s == pytest.approx(1305031102.033333)


def test_a_zip_of_it_is_the_same(tmp_path, views, same_views):
    write_tum(tmp_path / "rgbd_dataset", views)
    same_views(open_scan(zipped(tmp_path, tmp_path / "a.zip")), views, depth_off=2e-4)


def test_the_camera_published_for_a_name(tmp_path, box_room):
    """freiburg3 has no lens distortion; its views are rendered through its own camera."""
    camera = Camera(160, 120, 535.4 / 4, 539.2 / 4, 320.6 / 4, 248.1 / 4)
    folder = tmp_path / "rgbd_dataset_freiburg3_long_office"
    views = []
    for view in box_room.views(12):
        depth, colour = box_room.render(view.camera_to_scan, camera)
        views.append(type(view)(view.name, view.camera_to_scan, colour, camera, depth, camera))
    write_tum(folder, views, calibration=False)
    scan = open_scan(folder)
    assert "using the intrinsics published for freiburg3" in scan.notes[0]
    np.testing.assert_allclose(sorted(scan.room_size_m), sorted(box_room.size_m), atol=0.01)
    assert next(iter(scan.views)).colour_camera.fy_px == pytest.approx(539.2 / 4)


@pytest.mark.parametrize(
    ("name", "focal", "k3"),
    [("rgbd_dataset_freiburg1_desk", 517.3, 1.1633), ("fr2_xyz", 520.9, 0.9172), ("mine", 525, 0)],
)
def test_cameras_by_name(tmp_path, views, name, focal, k3):
    write_tum(tmp_path / name, views[:2], calibration=False)
    capture = find_capture(tmp_path / name)
    camera = capture.frames[0].colour_camera
    assert (camera.fx_px, camera.distortion[4]) == (focal, k3)
    assert capture.notes[0].startswith(
        "no calibration.txt" if name == "mine" else "using the intrinsics"
    )
    assert capture.frames[0].depth_camera == camera


def test_without_poses_it_is_a_capture_of_depth_and_colour_alone(tmp_path, views):
    write_tum(tmp_path, views, poses=False)
    judged = validate_capture(tmp_path, ScanOptions())
    assert judged.has_depth
    assert not judged.posed
    assert len(judged.frames) == 12


def test_poses_between_two_measurements_and_far_from_any(tmp_path, views):
    write_tum(tmp_path, views)
    rows = (tmp_path / "groundtruth.txt").read_text().splitlines()
    near = [rows[0], *rows[1:4], *rows[8:]]  # Frames 3 to 6 have none within 0.2 s ... 0.167 s.
    (tmp_path / "groundtruth.txt").write_text("\n".join(near))
    frames = find_capture(tmp_path).frames
    assert frames[4].camera_to_world is not None
    (tmp_path / "groundtruth.txt").write_text("\n".join([rows[1], *rows[9:]]))
    frames = find_capture(tmp_path).frames
    assert frames[4].camera_to_world is None
    assert frames[4].problem == "has no pose near its time in groundtruth.txt"
    assert frames[0].camera_to_world is not None


def test_slerp_is_that_of_scipy(views):
    first, second = views[0].camera_to_scan, views[3].camera_to_scan
    ends = [np.array([*p[:3, 3], *quaternion(p[:3, :3])]) for p in (first, second)]
    turns = Slerp([0, 1], Rotation.from_matrix([first[:3, :3], second[:3, :3]]))
    for share in (0.0, 0.3, 1.0):
        for sign in (1, -1):
            end = ends[1] * np.array([1, 1, 1, *[sign] * 4])
            pose = interpolate_pose(ends[0], end, share)
            np.testing.assert_allclose(pose[:3, :3], turns(share).as_matrix(), atol=1e-12)
    np.testing.assert_allclose(
        rotation_from_quaternion(ends[1][3:] * 7), second[:3, :3], atol=1e-12
    )
    assert np.isnan(rotation_from_quaternion(np.zeros(4))).all()


def test_pairs_are_the_nearest_and_each_image_is_used_once():
    first = np.array([0.0, 1.0, 2.0, 3.0])
    assert pair_times(first, first[::-1] + 0.01, 0.02) == [(0, 3), (1, 2), (2, 1), (3, 0)]
    assert pair_times(first, np.array([1.01, 0.99]), 0.02) == [(1, 0)]
    assert pair_times(np.array([0.0, 0.01]), np.array([0.012]), 0.02) == [(1, 0)]
    assert pair_times(first, np.zeros(0), 0.02) == []
    rng = np.random.default_rng(3)
    one, other = np.sort(rng.random(40)), rng.random(50)
    rivals = sorted(
        (abs(one[i] - other[j]), i, j) for i in range(40) for j in range(50)
    )  # The slow way, over all pairs: the fast one must give no worse pairs.
    taken, used = {}, set()
    for gap, i, j in rivals:
        if gap <= 0.02 and i not in taken and j not in used:
            taken[i] = j
            used.add(j)
    found = dict(pair_times(one, other, 0.02))
    assert len(found) >= 0.8 * len(taken)
    assert all(taken[i] == j for i, j in found.items() if i in taken) or len(found) > 30


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("rgb.txt", "", "rgb.txt: must contain lines of the form: seconds file"),
        ("rgb.txt", "1.0 ../../etc/passwd\n", "images must be inside the folder"),
        ("depth.txt", "zero depth/0.png\n", "contains 'zero' where a number is expected"),
        ("depth.txt", "5.0 depth/0.png\n", "contains no colour and depth images within 0.02 s"),
        (
            "groundtruth.txt",
            "1.0 2 3 4\n",
            "must contain lines of the form: seconds tx ty tz qx qy qz qw",
        ),
        ("groundtruth.txt", "1.0 0 0 0 nan 0 0 1\n", "contains no finite pose"),
        (
            "calibration.txt",
            "130 130\n",
            "must contain fx fy cx cy and up to five distortion coefficients, got 2 values",
        ),
        ("calibration.txt", "-130 130 80 60\n", "fx_px must be above 0"),
    ],
)
def test_damaged_lists(tmp_path, views, refused, name, text, words):
    write_tum(tmp_path, views)
    (tmp_path / name).write_text(text)
    refused(tmp_path, words)


def test_images_that_are_not_there_are_listed(tmp_path, views):
    write_tum(tmp_path, views)
    sorted((tmp_path / "depth").iterdir())[3].unlink()
    assert len(open_scan(tmp_path).frames_skipped) == 1
