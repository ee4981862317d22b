"""Captures that cannot be used: one line that names the file and the reason, nothing written."""

import json
import re
import shutil
import struct
import zlib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from layouts import WRITERS, write_nerfstudio, write_seven_scenes
from PIL import Image

from world2minecraft.capture import describe_capture, open_scan, write_plain
from world2minecraft.capture.alignment.room_frame import Alignment
from world2minecraft.capture.images import read_header
from world2minecraft.capture.open_scan import check_cell_count
from world2minecraft.core.errors import CaptureError, InputError, LimitError, UsageError


@pytest.fixture(scope="module")
def views(box_room):
    return box_room.views(4)


def _refused(folder, *words, kind=CaptureError):
    """Both ways in refuse with the same line, and leave the folder as it is."""
    before = sorted(path for path in folder.rglob("*")) if folder.is_dir() else []
    lines = set()
    for enter in (open_scan, describe_capture):
        with pytest.raises(kind) as caught:
            enter(folder)
        assert caught.value.exit_code == 3
        lines.add(str(caught.value))
    assert len(lines) == 1
    line = lines.pop()
    assert "\n" not in line
    for word in words:
        assert word in line
    assert (sorted(path for path in folder.rglob("*")) if folder.is_dir() else []) == before
    return line


def _png_of_size(path, width, height):
    """Write a PNG whose header promises a size, with next to nothing behind it."""

    def chunk(kind, data):
        return (
            struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        )

    header = struct.pack(">IIBBBBB", width, height, 16, 0, 0, 0, 0)
    body = chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(b"\0")) + chunk(b"IEND", b"")
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + body)


def _cut(path, share=0.5):
    data = path.read_bytes()
    path.write_bytes(data[: int(len(data) * share)])


def test_missing_empty_and_unknown_captures_are_refused(tmp_path):
    assert _refused(tmp_path / "none").endswith("none: not found")
    (tmp_path / "scan.zip").write_bytes(b"PK")
    _refused(tmp_path / "scan.zip", "is a file (.zip) of an unknown format; supported formats")
    (tmp_path / "empty").mkdir()
    _refused(tmp_path / "empty", "is empty; supported formats", "plain layout")
    (tmp_path / "music").mkdir()
    (tmp_path / "music" / "song.txt").write_text("la")
    _refused(
        tmp_path / "music", "an unknown format, which contains 1 .txt;", "7-Scenes", "formats.md"
    )


def test_a_capture_one_folder_deeper_is_named(tmp_path, views):
    write_plain(tmp_path / "download" / "room", views)
    (tmp_path / "download" / "LICENSE").write_text("free")
    line = _refused(tmp_path / "download", "which contains 1 file without suffix, 1 folder; ")
    assert line.endswith(
        f"there is a capture one folder deeper, use {tmp_path / 'download' / 'room'}"
    )


def test_of_two_captures_one_folder_deeper_none_is_chosen(tmp_path, views):
    for name in ("kitchen", "hall"):
        write_plain(tmp_path / "flat" / name, views)
    _refused(tmp_path / "flat", "which contains 2 folders; supported formats")


@pytest.mark.parametrize("layout", list(WRITERS))
@pytest.mark.parametrize("kind", ["depth", "col"])
def test_images_cut_short_everywhere(tmp_path, views, layout, kind):
    WRITERS[layout](tmp_path, views)
    for path in tmp_path.rglob("*.*g"):
        if kind in str(path.relative_to(tmp_path)) or (kind == "col" and "images" in str(path)):
            _cut(path)
    _refused(tmp_path, "copy the file again", "(4 of 4 frames are damaged)", kind=InputError)


def test_one_image_cut_short_among_many_is_left_out_and_listed(tmp_path, box_room):
    write_seven_scenes(tmp_path, box_room.views(12))
    _cut(tmp_path / "frame-000003.depth.png")
    _cut(tmp_path / "frame-000007.color.jpg", 0.9)
    (tmp_path / "frame-000009.pose.txt").write_text("-1.#IND " * 16)
    np.savetxt(tmp_path / "frame-000010.pose.txt", np.full((4, 4), -np.inf))
    scan = open_scan(tmp_path)
    assert len(scan.frames_used) == len(list(scan.views)) == 8
    reasons = dict(scan.frames_skipped)
    assert list(reasons) == [f"frame-{index:06d}" for index in (3, 7, 9, 10)]
    assert reasons["frame-000003"].startswith("frame-000003.depth.png is damaged")
    assert "truncated" in reasons["frame-000007"]
    assert "tracking was lost" in reasons["frame-000009"]
    summary = describe_capture(tmp_path)
    assert (summary.usable, summary.lost_poses) == (8, 2)


def test_an_image_that_only_decoding_finds_damaged_is_left_out(tmp_path, box_room):
    write_plain(tmp_path, box_room.views(8), depth_unit="m")
    stream = open_scan(tmp_path).views
    _cut(tmp_path / "colour" / "000002.png")
    assert [view.name for view in stream] == [f"{i:06d}" for i in (0, 1, 3, 4, 5, 6, 7)]
    assert "damaged" in stream.damaged["000002"]


def test_frames_of_one_stream_that_differ_in_size(tmp_path, views):
    write_seven_scenes(tmp_path, views)
    Image.fromarray(np.ones((60, 80), np.uint16)).save(tmp_path / "frame-000002.depth.png")
    _refused(
        tmp_path, "frame-000002.depth.png: is 80x60 px, but frame-000000.depth.png is 160x120 px",
        "all depth images must have the same size",
    )  # fmt: skip


@pytest.mark.parametrize("layout", list(WRITERS))
def test_a_depth_size_that_its_intrinsics_do_not_speak_of(tmp_path, views, layout):
    WRITERS[layout](tmp_path, views)
    for path in tmp_path.rglob("*.png"):
        if "depth" in str(path.relative_to(tmp_path)):
            Image.fromarray(np.full((120, 200), 1500, np.uint16)).save(path)
    _refused(tmp_path, "does not match its intrinsics", "another aspect ratio than 160x120")


@pytest.mark.parametrize(
    ("pixels", "words"),
    [
        (
            np.full((120, 160), 90, np.uint8),
            "is an 8-bit image, but depth requires 16-bit or float values",
        ),
        (np.full((120, 160, 3), 90, np.uint8), "is a colour image (RGB)"),
        (
            np.zeros((120, 160), np.uint16),
            "contains no depth values, like all 4 sampled depth images",
        ),
        (np.full((120, 160), 65535, np.uint16), "contains no depth values"),
        (np.full((120, 160), 3, np.uint16), "a median depth of 0.003 m if read as millimetres"),
    ],
)
def test_depth_that_is_none(tmp_path, views, pixels, words):
    write_plain(tmp_path, views)
    for path in (tmp_path / "depth").glob("*"):
        Image.fromarray(pixels).save(path)
    _refused(tmp_path, "000000.png", words)


def test_captures_without_depth(tmp_path, views):
    write_plain(tmp_path, [replace(v, depth_m=None, depth_camera=None) for v in views])
    with pytest.raises(
        CaptureError, match="contains no depth images; use w2m reconstruct, which computes them"
    ):
        open_scan(tmp_path)


def test_missing_poses_and_intrinsics(tmp_path, views):
    write_seven_scenes(tmp_path / "a", views)
    (tmp_path / "a" / "camera-intrinsics.txt").unlink()
    _refused(tmp_path / "a", "does not contain camera-intrinsics.txt (3x3: fx 0 cx")
    write_seven_scenes(tmp_path / "b", views)
    for path in (tmp_path / "b").glob("*.pose.txt"):
        path.unlink()
    _refused(tmp_path / "b", "contains no camera poses (frame-000000.pose.txt next to the images)")
    for key, words in (("fl_x", "contains no intrinsics"), ("frames", 'must contain "frames"')):
        write_nerfstudio(tmp_path / "c", views)
        stated = json.loads((tmp_path / "c" / "transforms.json").read_text())
        del stated[key]
        (tmp_path / "c" / "transforms.json").write_text(json.dumps(stated))
        _refused(tmp_path / "c", words)
    write_plain(tmp_path / "d", views)
    stated = json.loads((tmp_path / "d" / "capture.json").read_text())
    del stated["depth_camera"]
    (tmp_path / "d" / "capture.json").write_text(json.dumps(stated))
    _refused(tmp_path / "d", 'capture.json: must contain "depth_camera", an object with width_px')


@pytest.mark.parametrize("size", [(20_000, 20_000), (10_000, 9_000)])
def test_huge_images_are_refused_from_their_header(tmp_path, views, size):
    write_seven_scenes(tmp_path, views)
    _png_of_size(tmp_path / "frame-000001.depth.png", *size)
    _refused(tmp_path, "frame-000001.depth.png", "the limit is 64", kind=LimitError)


@pytest.mark.parametrize(
    ("bend", "words"),
    [
        (np.diag([-1.0, 1, 1, 1]), "is mirrored (determinant -1.000)"),
        (np.diag([2.0, 2, 2, 1]), "is scaled by 2; divide the rotation by the scale"),
        (
            np.array([[1, 0.02, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]),
            "is not orthonormal",
        ),
    ],
)
def test_poses_that_are_no_rotation(tmp_path, views, bend, words):
    write_seven_scenes(tmp_path, views)
    for index, view in enumerate(views):
        np.savetxt(tmp_path / f"frame-{index:06d}.pose.txt", view.camera_to_scan @ bend)
    _refused(tmp_path, words)


def test_poses_in_millimetres(tmp_path, views):
    write_seven_scenes(tmp_path, views)
    for index, view in enumerate(views):
        pose = view.camera_to_scan.copy()
        pose[:3, 3] *= 1000
        np.savetxt(tmp_path / f"frame-{index:06d}.pose.txt", pose)
    _refused(tmp_path, "appear to be in millimetres: divide them by 1000")


def test_a_single_wrong_or_stray_pose_is_left_out(tmp_path, box_room):
    views = box_room.views(12)
    write_seven_scenes(tmp_path, views)
    far = views[4].camera_to_scan.copy()
    far[0, 3] = 900
    np.savetxt(tmp_path / "frame-000004.pose.txt", far)
    np.savetxt(tmp_path / "frame-000006.pose.txt", np.diag([-1, 1, 1, 1]))
    reasons = dict(open_scan(tmp_path).frames_skipped)
    assert list(reasons) == ["frame-000006", "frame-000004"]
    assert "is mirrored" in reasons["frame-000006"]
    assert "tracking jumped" in reasons["frame-000004"]


def test_poses_slightly_off_are_repaired(tmp_path, box_room):
    views = box_room.views(8)
    write_seven_scenes(tmp_path, views)
    for index, view in enumerate(views):
        pose = view.camera_to_scan.copy()
        pose[:3, :3] += 4e-4 * np.random.default_rng(index).uniform(-1, 1, (3, 3))
        np.savetxt(tmp_path / f"frame-{index:06d}.pose.txt", pose)
    for view in open_scan(tmp_path).views:
        rotation = view.camera_to_scan[:3, :3]
        np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-12)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"format": "other"}, 'must be a JSON object with "format"'),
        ({"version": 9}, '"version" must be 1, got 9'),
        ({"frames": []}, '"frames" must be a list'),
        ({"frames": [{"name": "../up"}]}, "name must be the stem of its files"),
        ({"frames": [{"name": "a", "camera_to_world": [[1, 2], [3]]}]}, "must be a 4x4 matrix"),
        ({"depth_unit": 5}, '"depth_unit" must be a string'),
        ({"depth_unit": "furlong"}, "no depth unit is named 'furlong'"),
        ({"colour_camera": {"width_px": 160}}, '"colour_camera" does not contain height_px'),
        ({"colour_camera": [1]}, 'must contain "colour_camera"'),
    ],
)
def test_invalid_values_in_a_plain_capture(tmp_path, views, change, words):
    write_plain(tmp_path, views)
    stated = json.loads((tmp_path / "capture.json").read_text())
    if "frames" in change and change["frames"] and "camera_to_world" in change["frames"][0]:
        change["frames"][0]["name"] = "000000"
    (tmp_path / "capture.json").write_text(json.dumps(stated | change))
    _refused(tmp_path, words, kind=InputError)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"camera_model": "OPENCV_FISHEYE"}, "'OPENCV_FISHEYE' is not supported; undistort"),
        ({"k4": 0.1}, "distortion coefficient k4"),
        ({"fl_x": "long"}, '"fl_x" must be a number, got long'),
        ({"fl_x": -5}, "fx_px must be above 0"),
        ({"applied_scale": 0}, '"applied_scale" must be above 0'),
        ({"w": 10**9}, "width_px must be 1 to"),
    ],
)
def test_invalid_values_in_transforms_json(tmp_path, views, change, words):
    write_nerfstudio(tmp_path, views)
    path = tmp_path / "transforms.json"
    path.write_text(json.dumps(json.loads(path.read_text()) | change))
    _refused(tmp_path, words)


def test_a_missing_image_is_listed_even_where_no_size_is_stated(tmp_path, box_room):
    write_nerfstudio(tmp_path, box_room.views(8))
    path = tmp_path / "transforms.json"
    stated = json.loads(path.read_text())
    del stated["w"], stated["h"]
    path.write_text(json.dumps(stated))
    (tmp_path / "images" / "000005.png").unlink()
    assert open_scan(tmp_path).frames_skipped == (("000005", "000005.png not found"),)


@pytest.mark.parametrize("name", ["../secret.png", "/etc/passwd", "images/../../x.png", ""])
def test_transforms_cannot_reach_out_of_the_folder(tmp_path, views, name):
    write_nerfstudio(tmp_path, views)
    path = tmp_path / "transforms.json"
    stated = json.loads(path.read_text())
    stated["frames"][0]["file_path"] = name
    path.write_text(json.dumps(stated))
    _refused(tmp_path, "must be relative and inside the folder")


def test_files_that_are_no_json_or_no_matrix(tmp_path, views):
    write_nerfstudio(tmp_path / "a", views)
    (tmp_path / "a" / "transforms.json").write_text("{")
    _refused(tmp_path / "a", "is not JSON", kind=InputError)
    write_seven_scenes(tmp_path / "b", views)
    (tmp_path / "b" / "camera-intrinsics.txt").write_text("1 2 3")
    _refused(tmp_path / "b", "must contain 9 numbers (a 3x3 matrix), got 3")
    write_seven_scenes(tmp_path / "c", views)
    for path in (tmp_path / "c").glob("*.pose.txt"):
        path.write_text("1 0 0 0")
    _refused(tmp_path / "c", "none of 4 frames can be used", "must contain 16 numbers")


def test_npy_depth_is_checked_against_its_length(tmp_path, views):
    write_plain(tmp_path, views, depth_unit="m")
    for path in (tmp_path / "depth").glob("*.npy"):
        _cut(path)
    _refused(tmp_path, "is not a complete .npy")
    for path in (tmp_path / "depth").glob("*.npy"):
        np.save(path, np.array([{"a": 1}], dtype=object), allow_pickle=True)
    _refused(tmp_path, "is not a complete .npy")
    for path in (tmp_path / "depth").glob("*.npy"):
        np.savez(tmp_path / "renamed.npz", np.ones((4, 4), np.float32))
        (tmp_path / "renamed.npz").replace(path)
    _refused(tmp_path, "is not a complete .npy")
    for shape in ("(0, 99999999999999999999)", "(", "(10000000, 10000000)"):
        header = f"{{'descr': '<f4', 'fortran_order': False, 'shape': {shape}}}\n".encode()
        for path in (tmp_path / "depth").glob("*.npy"):
            path.write_bytes(b"\x93NUMPY\x01\x00" + bytes((len(header), 0)) + header)
        _refused(tmp_path, "is not a complete .npy")
        packed = shutil.make_archive(f"{tmp_path}", "zip", tmp_path)
        _refused(Path(packed), "of 4 frames are damaged")


@pytest.mark.parametrize("content", [b"", b"GIF89a" + b"\0" * 40, b"\x89PNG\r\n\x1a\n"])
def test_files_that_are_no_image(tmp_path, content):
    path = tmp_path / "image.png"
    path.write_bytes(content)
    with pytest.raises(InputError, match=r"image\.png: is "):
        read_header(path)


@pytest.mark.parametrize(
    ("camera", "words"),
    [
        ({"fx_px": "130.0"}, "fx_px must be a number, got '130.0'"),
        ({"width_px": None}, "width_px must be a number, got None"),
    ],
)
def test_a_lens_in_quotes(tmp_path, views, camera, words):
    write_plain(tmp_path, views)
    path = tmp_path / "capture.json"
    stated = json.loads(path.read_text())
    stated["colour_camera"] |= camera
    path.write_text(json.dumps(stated))
    _refused(tmp_path, words)


def test_whole_numbers_too_long_for_a_matrix(tmp_path, views):
    write_plain(tmp_path, views)
    path = tmp_path / "capture.json"
    stated = json.loads(path.read_text())
    stated["frames"][0]["camera_to_world"] = [[10**400] * 4] * 4
    path.write_text(json.dumps(stated))
    _refused(tmp_path, "must be a 4x4 matrix")


def test_a_layout_none_of_whose_frames_is_there(tmp_path):
    (tmp_path / "results").mkdir()
    Image.fromarray(np.zeros((8, 8, 3), np.uint8)).save(tmp_path / "results" / "frame_one.jpg")
    np.savetxt(tmp_path / "traj.txt", np.eye(4).reshape(1, 16))
    _refused(tmp_path, "has the layout of a replica capture", "docs/reference/capture-formats.md")


def test_a_7_scenes_folder_without_a_readable_image(tmp_path):
    (tmp_path / "frame-000000.color.png").write_bytes(b"no image")
    np.savetxt(tmp_path / "frame-000001.pose.txt", np.eye(4))
    _refused(tmp_path, "contains poses but no readable image")


def test_other_archives_are_refused_with_advice(tmp_path):
    (tmp_path / "room.tgz").write_bytes(b"")
    _refused(tmp_path / "room.tgz", "is a .tgz archive", "unpack it and use the unpacked folder")


def test_a_fisheye_of_instant_ngp(tmp_path, views):
    write_nerfstudio(tmp_path, views)
    path = tmp_path / "transforms.json"
    path.write_text(json.dumps(json.loads(path.read_text()) | {"is_fisheye": True}))
    _refused(tmp_path, "uses a fisheye lens, which is not supported; undistort the images first")


def test_whole_numbers_of_npy_depth_must_be_unsigned(tmp_path, views):
    write_plain(tmp_path, views, depth_unit="m")
    for path in (tmp_path / "depth").glob("*.npy"):
        np.save(path, np.full((120, 160), 2000, np.int32))
    _refused(
        tmp_path, "must contain unsigned integers or floats of shape [H, W], got int32 (120, 160)",
        "save it as uint16 or float32",
    )  # fmt: skip


def test_depth_that_the_device_trusts_nowhere(tmp_path, views):
    write_plain(tmp_path, [replace(v, trust=np.zeros(v.depth_m.shape, np.uint8)) for v in views])
    with pytest.raises(
        CaptureError, match="contains no reliable depth in the 4 sampled depth images"
    ):
        describe_capture(tmp_path)


@pytest.mark.parametrize("size_m", [(4.0, 3.0, 2.5), (9.7, 8.3, 3.1)])
def test_the_reported_minimum_voxel_is_accepted(size_m):
    alignment = Alignment(np.eye(4), np.array(size_m), ())
    with pytest.raises(UsageError, match="use cells of at least") as caught:
        check_cell_count(alignment, 0.001)
    stated = re.search(r"at least ([0-9.]+) m ", str(caught.value))
    assert stated is not None
    check_cell_count(alignment, float(stated[1]))
