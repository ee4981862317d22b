"""COLMAP models, written by pycolmap itself (an independent writer) and, for lies, byte by byte."""

import struct

import numpy as np
import pytest
from tests.capture.readers.datasets.writing import save, save_text, zipped

from world2minecraft.capture.format_detection import find_capture
from world2minecraft.capture.options import ScanOptions
from world2minecraft.capture.validation import validate_capture
from world2minecraft.core.errors import CaptureError

pycolmap = pytest.importorskip("pycolmap")


def reconstruction(views, lens=("PINHOLE", None)):
    model, parameters = lens
    camera = views[0].colour_camera
    values = [camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px]
    made = pycolmap.Reconstruction()
    stated = pycolmap.Camera(
        model=model,
        width=camera.width_px,
        height=camera.height_px,
        params=values if parameters is None else parameters,
        camera_id=7,
    )
    made.add_camera_with_trivial_rig(stated)
    for index, view in enumerate(views):
        world_to_camera = np.linalg.inv(view.camera_to_scan)[:3]
        points = np.random.default_rng(index).uniform(0, 100, (index % 3, 2))
        image = pycolmap.Image(
            name=f"walk one/{view.name}.jpg", camera_id=7, image_id=index + 3, keypoints=points
        )
        made.add_image_with_trivial_frame(image, pycolmap.Rigid3d(world_to_camera))
    return made


def write_colmap(folder, views, text=False, model="sparse/0", lens=("PINHOLE", None)):
    (folder / model).mkdir(parents=True)
    made = reconstruction(views, lens)
    (made.write_text if text else made.write_binary)(folder / model)
    for view in views:
        save(folder / "images" / "walk one" / f"{view.name}.jpg", view.colour)


@pytest.mark.parametrize("text", [True, False])
@pytest.mark.parametrize("model", ["sparse/0", "sparse", "colmap/sparse/0"])
def test_a_model_gives_the_poses_and_lenses_that_were_written(tmp_path, views, text, model):
    write_colmap(tmp_path, views, text, model)
    judged = validate_capture(tmp_path, ScanOptions())
    assert (judged.capture.source, judged.capture.scale) == ("colmap", "unknown")
    assert judged.posed
    assert not judged.has_depth
    assert [frame.name for frame in judged.frames[:2]] == ["walk one.000000", "walk one.000001"]
    for frame, view in zip(judged.frames, views, strict=True):
        np.testing.assert_allclose(frame.camera_to_world, view.camera_to_scan, atol=1e-9)
        assert frame.colour_camera == view.colour_camera


def test_a_zip_of_it_is_the_same(tmp_path, views):
    write_colmap(tmp_path / "x", views)
    frames = validate_capture(zipped(tmp_path / "x", tmp_path / "a.zip"), ScanOptions()).frames
    np.testing.assert_allclose(frames[5].camera_to_world, views[5].camera_to_scan, atol=1e-9)


@pytest.mark.parametrize("text", [True, False])
@pytest.mark.parametrize(
    ("model", "parameters", "lens"),
    [
        ("SIMPLE_PINHOLE", [130, 80, 60], (130, 130, 80, 60, 0, 0, 0, 0, 0)),
        ("SIMPLE_RADIAL", [130, 80, 60, 0.1], (130, 130, 80, 60, 0.1, 0, 0, 0, 0)),
        ("RADIAL", [130, 80, 60, 0.1, 0.2], (130, 130, 80, 60, 0.1, 0.2, 0, 0, 0)),
        ("OPENCV", [130, 131, 80, 60, 1, 2, 3, 4], (130, 131, 80, 60, 1, 2, 3, 4, 0)),
        ("FULL_OPENCV", [9, 8, 80, 60, 1, 2, 3, 4, 5, 0, 0, 0], (9, 8, 80, 60, 1, 2, 3, 4, 5)),
    ],
)  # fmt: skip
def test_lenses(tmp_path, views, model, parameters, lens, text):
    write_colmap(tmp_path, views[:2], text, lens=(model, parameters))
    camera = find_capture(tmp_path).frames[0].colour_camera
    found = (camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px, *camera.distortion)
    assert found == pytest.approx(lens)


@pytest.mark.parametrize("text", [True, False])
def test_lenses_that_are_not_read_say_what_to_do(tmp_path, views, text, refused):
    lens = ("OPENCV_FISHEYE", [130, 130, 80, 60, 0, 0, 0, 0])
    write_colmap(tmp_path, views[:2], text, lens=lens)
    refused(tmp_path, "unsupported model OPENCV_FISHEYE; run colmap image_undistorter")


def test_of_several_models_the_largest_is_read(tmp_path, views):
    write_colmap(tmp_path, views, model="sparse/1")
    (tmp_path / "sparse" / "0").mkdir()
    reconstruction(views[:3]).write_binary(tmp_path / "sparse" / "0")
    capture = find_capture(tmp_path)
    assert len(capture.frames) == 12
    assert capture.notes == ("read 1, the largest of 2 models",)


def test_the_folder_of_the_model_itself_and_photos_beside_it(tmp_path, views):
    write_colmap(tmp_path, views)
    assert len(find_capture(tmp_path / "sparse" / "0").frames) == 12
    for path in (tmp_path / "images" / "walk one").iterdir():
        path.unlink()
    with pytest.raises(CaptureError, match="none of its photos, such as images/walk one/000000"):
        find_capture(tmp_path)


def test_missing_photos_are_listed(tmp_path, views):
    write_colmap(tmp_path, views)
    (tmp_path / "images" / "walk one" / "000004.jpg").unlink()
    skipped = validate_capture(tmp_path, ScanOptions()).skipped
    assert skipped == (("walk one.000004", "000004.jpg not found"),)


def test_photos_of_another_size_than_most_are_left_out(tmp_path, views):
    write_colmap(tmp_path, views, text=True)
    model = tmp_path / "sparse" / "0"
    with (model / "cameras.txt").open("a") as cameras:
        cameras.write("9 PINHOLE 120 160 130 130 60 80\n")
    lines = (model / "images.txt").read_text()
    (model / "images.txt").write_text(lines.replace(" 7 walk one/000002", " 9 walk one/000002"))
    skipped = validate_capture(tmp_path, ScanOptions()).skipped
    assert skipped == (("walk one.000002", "is 120x160 px; most photos are 160x120 px"),)


def test_transforms_json_goes_first(tmp_path, views):
    write_colmap(tmp_path, views)
    save_text(tmp_path / "transforms.json", '{"frames": []}')
    with pytest.raises(CaptureError, match="transforms.json"):
        find_capture(tmp_path)


CAMERAS = struct.pack("<QIiQQ4d", 1, 1, 1, 160, 120, 130, 130, 80, 60)


def images(count=1, camera=1, name=b"walk one/000000.jpg\0", points=0):
    pose = (1.0, 0, 0, 0, 0, 0, 0)
    return struct.pack("<QI7dI", count, 1, *pose, camera) + name + struct.pack("<Q", points)


@pytest.mark.parametrize(
    ("name", "data", "words"),
    [
        ("images", b"", "images.bin: is truncated"),
        ("images", images()[:50], "images.bin: is truncated"),
        ("images", images(count=1 << 63), "images.bin: is truncated"),
        ("images", images(points=1 << 60), "images.bin: is truncated"),
        ("images", images(name=b"x" * 3000), "contains an image without a name"),
        ("images", images(name=b"../../etc/passwd\0"), "images must be inside the folder"),
        (
            "images",
            images(name=b"a\nb.jpg\0"),
            "contains the file name 'a\\nb.jpg'; images must be inside",
        ),
        ("images", images(camera=9), "image 1 refers to the missing camera 9"),
        ("images", struct.pack("<Q", 0), "contains no photos; run colmap mapper again"),
        ("cameras", CAMERAS[:-5], "cameras.bin: is truncated"),
        (
            "cameras",
            struct.pack("<QIiQQ", 1, 1, 77, 160, 120),
            "a camera of the unsupported model number 77",
        ),
        ("cameras", struct.pack("<QIiQQ4d", 1, 1, 1, 1 << 62, 120, 1, 1, 1, 1), "width_px must be"),
        ("cameras", struct.pack("<QIiQQ4d", 1, 1, 1, 160, 120, -1, 1, 1, 1), "fx_px must be above"),
    ],
)
def test_binary_models_that_lie(tmp_path, views, refused, name, data, words):
    write_colmap(tmp_path, views)
    model = tmp_path / "sparse" / "0"
    (model / "cameras.bin").write_bytes(CAMERAS)
    (model / "images.bin").write_bytes(images())
    (model / f"{name}.bin").write_bytes(data)
    refused(tmp_path, words)


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("cameras", "1 PINHOLE 160 120 130\n", "PINHOLE must have 4 parameters, got 1"),
        ("cameras", "1 PINHOLE x 120 130\n", "must contain lines of the form: id, model, width"),
        ("cameras", "1 PINHOLE 160 120 130 130 80 sixty\n", "contains 'sixty' where a number"),
        ("images", "3 1 0 0 0 0 0 0 7\n", "must contain lines of the form: id, QW QX QY QZ"),
        ("images", "3 1 0 0 0 0 0 zero 7 a.jpg\n\n", "contains 'zero' where a number"),
        ("images", "3 0 0 0 0 0 0 0 7 walk one/000000.jpg\n\n", "none of 1 frames can be used"),
    ],
)
def test_text_models_that_lie(tmp_path, views, refused, name, text, words):
    write_colmap(tmp_path, views, text=True)
    (tmp_path / "sparse" / "0" / f"{name}.txt").write_text("# a comment\n" + text)
    refused(tmp_path, words)
