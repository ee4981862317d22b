"""Exported ScanNet scenes, written as ScanNet's own exporter is described to write them."""

import numpy as np
import pytest
from PIL import Image
from tests.capture.readers.datasets.writing import encoded, millimetres, save, save_text, zipped

from world2minecraft.capture import open_scan
from world2minecraft.capture.format_detection import find_capture
from world2minecraft.core.errors import CaptureError


def write_folder(folder, views, *, nested=True, lost=(), suffix="png"):
    camera = views[0].colour_camera
    for index, view in enumerate(views):
        save(folder / "color" / f"{index}.{suffix}", view.colour)
        save(folder / "depth" / f"{index}.png", millimetres(view))
        pose = np.full((4, 4), -np.inf) if index in lost else view.camera_to_scan
        rows = "\n".join(" ".join(f"{value:.9f}" for value in row) for row in pose)
        save_text(folder / "pose" / f"{index}.txt", rows + "\n")
    matrix = np.eye(4)
    matrix[:3, :3] = camera.matrix
    matrix[:2, 2] -= 0.5
    text = "\n".join(" ".join(f"{value:.6f}" for value in row) for row in matrix)
    for kind in ("color", "depth"):
        inner = f"intrinsic/intrinsic_{kind}.txt" if nested else f"intrinsics_{kind}.txt"
        save_text(folder / inner, text)


@pytest.mark.parametrize("nested", [True, False])
def test_an_export_gives_the_views_that_were_written(tmp_path, views, same_views, nested):
    write_folder(tmp_path, views, nested=nested)
    scan = open_scan(tmp_path)
    assert scan.source == "scannet_folder"
    assert scan.frames_used[10] == "000010"
    same_views(scan, views, pose_off=1e-6)


def test_a_zip_of_it_is_the_same(tmp_path, views, same_views):
    write_folder(tmp_path / "scene0000_00", views)
    same_views(open_scan(zipped(tmp_path, tmp_path / "a.zip")), views)


def test_lost_frames_and_frames_without_pose_are_listed(tmp_path, views):
    write_folder(tmp_path, views, lost=(2,))
    (tmp_path / "pose" / "5.txt").unlink()
    (tmp_path / "pose" / "6.txt").write_text("1 2 3")
    skipped = dict(open_scan(tmp_path).frames_skipped)
    assert skipped["000002"] == "tracking was lost (the pose is not finite)"
    assert skipped["000005"] == "has no pose/5.txt"
    assert skipped["000006"].startswith("6.txt: must contain 16 numbers")


def test_smaller_images_have_the_camera_of_their_size(tmp_path, views):
    """The matrix speaks of 1296x968, as ScanNet's does; the images were made 160x120."""
    write_folder(tmp_path, views)
    matrix = "1170.187988 0 647.75 0\n0 1170.187988 483.75 0\n0 0 1 0\n0 0 0 1\n"
    (tmp_path / "intrinsic" / "intrinsic_color.txt").write_text(matrix)
    view = next(iter(open_scan(tmp_path).views))
    assert view.colour_camera.fx_px == pytest.approx(1170.188 * 160 / 1296)
    assert view.colour_camera.cx_px == pytest.approx(648.25 * 160 / 1296)


def test_labels_of_the_benchmark_frames_are_nyu40_numbers(tmp_path, views):
    write_folder(tmp_path, views)
    for index in range(12):
        save(tmp_path / "label" / f"{index}.png", np.full((120, 160), index, np.uint8))
    seen = [int(view.labels[0, 0]) for view in open_scan(tmp_path).views]
    assert seen == [255, 3, 2, 10, 6, 5, 7, 8, 11, 4, 10, 11]


def test_all_forty_classes_are_mapped():
    from world2minecraft.core.vocabulary import nyu40_classes

    classes = nyu40_classes()
    assert classes[0] == classes[41] == 255
    assert set(classes[1:41].tolist()) == set(range(1, 12))
    assert [int(classes[n]) for n in (14, 20, 22, 25, 32, 39)] == [8, 2, 1, 9, 10, 10]


def remove_matrices(folder):
    for path in folder.rglob("intrinsic_*.txt"):
        path.write_text("1 2 3")


def cut_depth(folder):
    for path in (folder / "depth").glob("*.png"):
        path.write_bytes(path.read_bytes()[:200])


def depth_8_bit(folder):
    for path in (folder / "depth").glob("*.png"):
        Image.fromarray(np.full((120, 160), 9, np.uint8)).save(path)


def all_lost(folder):
    for path in (folder / "pose").glob("*.txt"):
        path.write_text(" ".join(["-inf"] * 16))


def mirrored(folder):
    for path in (folder / "pose").glob("*.txt"):
        path.write_text("-1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1")


@pytest.mark.parametrize(
    ("damage", "words"),
    [
        (remove_matrices, "must contain 16 (4x4) or 9 (3x3) numbers, got 3"),
        (cut_depth, "12 of 12 frames are damaged"),
        (depth_8_bit, "is an 8-bit image, but depth requires 16-bit"),
        (all_lost, "none of 12 frames can be used"),
        (mirrored, "is mirrored"),
    ],
)
def test_damaged_exports(tmp_path, views, refused, damage, words):
    write_folder(tmp_path, views)
    damage(tmp_path)
    refused(tmp_path, words)


def test_one_matrix_that_is_missing(tmp_path, views):
    write_folder(tmp_path, views)
    (tmp_path / "intrinsic" / "intrinsic_depth.txt").unlink()
    with pytest.raises(CaptureError, match="does not contain intrinsic/intrinsic_depth.txt"):
        find_capture(tmp_path)


def test_a_jpeg_export_is_read(tmp_path, views):
    write_folder(tmp_path, views, suffix="jpg")
    assert encoded(views[0].colour, "jpeg")[:2] == b"\xff\xd8"
    assert len(open_scan(tmp_path).frames_used) == 12
