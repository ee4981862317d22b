"""SUN RGB-D and SUN3D, written from the description of their folders."""

import numpy as np
import pytest
from tests.capture.readers.datasets.writing import millimetres, save, save_text, zipped

from world2minecraft.capture import describe_capture, open_scan
from world2minecraft.capture.format_detection import find_capture
from world2minecraft.capture.images import read_raw
from world2minecraft.capture.options import ScanOptions
from world2minecraft.capture.validation import validate_capture


def rotated(view):
    """Sixteen bits turned left by three."""
    bits = millimetres(view)
    return (bits << 3) | (bits >> 13)


def write_sun(folder, views, poses=None, depth="depth"):
    camera = views[0].colour_camera
    for index, view in enumerate(views):
        stamp = f"{index + 1:07d}-{33_367 * index:012d}"
        save(folder / "image" / f"{stamp}.png", view.colour)
        save(folder / depth / f"{stamp}.png", rotated(view))
    matrix = camera.matrix
    matrix[:2, 2] -= 0.5
    save_text(folder / "intrinsics.txt", " ".join(f"{value:.6f}" for value in matrix.reshape(-1)))
    for pose in [] if poses is None else [poses]:
        rows = [" ".join(f"{value:.9f}" for value in row) for one in pose for row in one[:3]]
        save_text(folder / "extrinsics" / "20140808220511.txt", "\n".join(rows) + "\n")


def test_a_sequence_gives_the_views_that_were_written(tmp_path, views, same_views):
    write_sun(tmp_path, views, [view.camera_to_scan for view in views])
    scan = open_scan(tmp_path)
    assert scan.source == "sun"
    same_views(scan, views)
    assert find_capture(tmp_path).frames[3].time_s == pytest.approx(0.100101)


def test_a_zip_of_it_is_the_same(tmp_path, views, same_views):
    write_sun(tmp_path / "room", views, [view.camera_to_scan for view in views])
    same_views(open_scan(zipped(tmp_path, tmp_path / "a.zip")), views)


def test_one_frame_is_a_capture_with_up_from_its_extrinsics(tmp_path, views):
    pitch = np.eye(4)
    angle = np.radians(20)
    pitch[1:3, 1:3] = [[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]]
    pitch[:3, 3] = [5, 6, 7]
    write_sun(tmp_path, views[:1], [pitch], depth="depth_bfx")
    capture = find_capture(tmp_path)
    assert capture.notes == (
        "the capture is a single frame; everything that it does not show stays unknown",
    )
    np.testing.assert_array_equal(capture.world_up, [0, -1, 0])
    pose = capture.frames[0].camera_to_world
    np.testing.assert_allclose(pose[:3, :3], pitch[:3, :3], atol=1e-8)
    assert not pose[:3, 3].any()
    assert "only 1 frame" in " ".join(describe_capture(tmp_path).warnings)


def test_the_true_depth_goes_before_the_filled_one(tmp_path, views):
    write_sun(tmp_path, views[:1], depth="depth_bfx")
    write_sun(tmp_path, views[:1], depth="depth")
    assert find_capture(tmp_path).frames[0].depth_path.parent.name == "depth"


def test_pictures_and_depth_of_other_counts_pair_by_their_times(tmp_path, views):
    write_sun(tmp_path, views)
    sorted((tmp_path / "depth").iterdir())[4].unlink()
    frames = find_capture(tmp_path).frames
    assert len(frames) == 11
    assert frames[4].colour_path.stem == frames[4].depth_path.stem
    assert not validate_capture(tmp_path, ScanOptions()).posed


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("intrinsics.txt", "1 2 3", "must contain 9 (3x3) or 16 (4x4) numbers, got 3"),
        ("intrinsics.txt", "130 0 80 0 130 60 0 0 nan", "must have the form fx 0 cx"),
        ("intrinsics.txt", "0 0 80 0 130 60 0 0 1", "fx_px must be above 0"),
        (
            "extrinsics/20140808220511.txt",
            "1 0 0 0",
            "a 3x4 matrix for each of 12 frames (144 numbers), got 4",
        ),
        ("extrinsics/20140808220511.txt", "1 " * 143 + "x", "contains 'x' where a number"),
        ("image/0.png", "no image", "contains 13 colour and 12 depth images; the counts"),
    ],
)
def test_damaged_folders(tmp_path, views, refused, name, text, words):
    write_sun(tmp_path, views, [view.camera_to_scan for view in views])
    (tmp_path / name).write_text(text)
    refused(tmp_path, words)


def test_the_shared_frame(tmp_path, shared_data):
    """One real frame of SUN RGB-D: its depth is rotated, and a room deep."""
    found = shared_data / "open3d_rgbd_samples" / "RGBD" / "other_formats"
    for kind, name in (("image", "SUN_color.jpg"), ("depth", "SUN_depth.png")):
        (tmp_path / kind).mkdir()
        (tmp_path / kind / name).symlink_to(found / name)
    save_text(tmp_path / "intrinsics.txt", "520.5 0 319.5 0 520.5 239.5 0 0 1")
    validated = validate_capture(tmp_path, ScanOptions())
    assert validated.encoding.description == "millimetres, bits rotated by three"
    assert 1 < validated.typical_depth_m < 4
    assert read_raw(validated.frames[0].depth_path).shape == (480, 640)
