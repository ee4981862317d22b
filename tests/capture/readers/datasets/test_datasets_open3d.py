"""Open3D's trajectories, written from the description of its file formats."""

import json

import numpy as np
import pytest
from tests.capture.readers.datasets.writing import millimetres, save, save_text, zipped

from world2minecraft.capture import open_scan
from world2minecraft.capture.format_detection import find_capture
from world2minecraft.capture.options import ScanOptions
from world2minecraft.capture.validation import validate_capture


def camera_json(camera):
    matrix = camera.matrix
    matrix[:2, 2] -= 0.5
    return {
        "width": camera.width_px,
        "height": camera.height_px,
        "intrinsic_matrix": matrix.T.reshape(-1).tolist(),
    }


def write_images(folder, views, colour="color"):
    for index, view in enumerate(views):
        save(folder / colour / f"{index:05d}.png", view.colour)
        save(folder / "depth" / f"{index:05d}.png", millimetres(view))


def log_text(views):
    lines = []
    for index, view in enumerate(views):
        lines.append(f"{index} {index} {index + 1}")
        lines += [" ".join(f"{value:.9f}" for value in row) for row in view.camera_to_scan]
    return "\n".join(lines) + "\n"


def write_open3d(folder, views, colour="color"):
    write_images(folder, views, colour)
    save_text(folder / "trajectory.log", log_text(views))
    save_text(folder / "camera.json", json.dumps(camera_json(views[0].colour_camera)))


@pytest.mark.parametrize("colour", ["color", "rgb", "image"])
def test_a_log_gives_the_views_that_were_written(tmp_path, views, same_views, colour):
    write_open3d(tmp_path, views, colour)
    scan = open_scan(tmp_path)
    assert scan.source == "open3d"
    same_views(scan, views)


def test_a_zip_of_it_is_the_same(tmp_path, views, same_views):
    write_open3d(tmp_path / "room", views)
    same_views(open_scan(zipped(tmp_path, tmp_path / "a.zip")), views)


def test_json_trajectory_is_world_to_camera_column_major(tmp_path, views, same_views):
    write_images(tmp_path, views)
    parameters = [
        {
            "class_name": "PinholeCameraParameters",
            "extrinsic": np.linalg.inv(view.camera_to_scan).T.reshape(-1).tolist(),
            "intrinsic": camera_json(view.colour_camera),
        }
        for view in views
    ]
    stated = {"class_name": "PinholeCameraTrajectory", "parameters": parameters}
    save_text(tmp_path / "views.json", json.dumps(stated))
    same_views(open_scan(tmp_path), views)


def test_of_two_trajectories_odometry_is_left_alone(tmp_path, views):
    write_open3d(tmp_path, views)
    save_text(tmp_path / "odometry.log", log_text(views[::-1]))
    capture = find_capture(tmp_path)
    assert capture.notes == ("using the poses of trajectory.log; ignoring odometry.log",)
    np.testing.assert_allclose(
        capture.frames[0].camera_to_world, views[0].camera_to_scan, atol=1e-8
    )


def test_without_a_camera_the_default_is_taken_and_said(tmp_path, views):
    write_open3d(tmp_path, views)
    (tmp_path / "camera.json").unlink()
    capture = find_capture(tmp_path)
    assert capture.notes == (
        "no camera.json found; using the default intrinsics of PrimeSense cameras (525 px)",
    )
    assert capture.frames[0].colour_camera.cx_px == 320.0


def test_frames_without_a_pose_are_listed(tmp_path, views):
    write_open3d(tmp_path, views)
    (tmp_path / "trajectory.log").write_text(log_text(views[:11]))
    assert open_scan(tmp_path).frames_skipped == (("00011", "has no pose in trajectory.log"),)


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("trajectory.log", "0 0 1\n1 0 0 0\n", "must contain three integers and a 4x4 matrix"),
        ("trajectory.log", "0 0 1\n" + "1 0 0 x\n" * 4, "contains 'x' where a number is expected"),
        ("trajectory.log", ("0 0 1\n" + "1 0 0 0\n" * 4) * 2, "contains two poses for frame 0"),
        (
            "trajectory.log",
            "99 99 1\n" + "1 0 0 0\n" * 4,
            "contains a pose for frame 99, but there are only 12",
        ),
        (
            "camera.json",
            '{"intrinsic_matrix": [1, 2]}',
            '"intrinsic_matrix" must be a list of 9 numbers',
        ),
        ("camera.json", '{"intrinsic_matrix": [1,0,0,0,1,0,0,0,1]}', '"width" and "height" must'),
        ("camera.json", "{", "is not JSON"),
    ],
)
def test_damaged_trajectories_and_cameras(tmp_path, views, refused, name, text, words):
    write_open3d(tmp_path, views)
    (tmp_path / name).write_text(text)
    refused(tmp_path, words)


def test_images_that_do_not_pair(tmp_path, views, refused):
    write_open3d(tmp_path, views)
    for index, path in enumerate(sorted((tmp_path / "depth").iterdir())):
        path.rename(path.with_name(f"d{index}.png"))
    assert find_capture(tmp_path).frames[3].depth_path.name == "d3.png"
    (tmp_path / "depth" / "d3.png").unlink()
    refused(tmp_path, "contains 12 images in color/ and 11 in depth/")


def test_a_json_trajectory_that_says_nothing(tmp_path, views, refused):
    write_images(tmp_path, views)
    stated = {"class_name": "PinholeCameraTrajectory", "parameters": []}
    save_text(tmp_path / "views.json", json.dumps(stated))
    refused(tmp_path, '"parameters" must be a list of cameras')


def test_the_shared_sample(shared_data):
    """Five frames of a synthetic living room by Open3D's authors, with two trajectories."""
    folder = shared_data / "open3d_rgbd_samples" / "RGBD"
    capture = find_capture(folder)
    assert (capture.source, len(capture.frames)) == ("open3d", 5)
    assert "trajectory.log; ignoring odometry.log" in capture.notes[0]
    camera = capture.frames[0].depth_camera
    assert (camera.fx_px, camera.cx_px, camera.cy_px) == (525.0, 320.0, 240.0)
    validated = validate_capture(folder, ScanOptions())
    assert validated.complete
    assert validated.encoding.description == "millimetres"
    assert validated.typical_depth_m == pytest.approx(1.86, abs=0.05)
