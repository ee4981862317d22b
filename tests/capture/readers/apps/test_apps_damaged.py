"""Damaged and hostile captures of apps: one line that says why, or the frame is left out."""

import json
import shutil
import struct
import sys
import zipfile

import numpy as np
import pytest
from app_writers import ROOM_TO_ARKIT, WRITERS, shots_of, stored_lzfse, zipped
from PIL import Image

from world2minecraft.capture.options import ScanOptions
from world2minecraft.capture.readers.apps.exr import ExrImage
from world2minecraft.capture.readers.apps.record3d import LzfseImage
from world2minecraft.capture.validation import validate_capture
from world2minecraft.core.errors import InputError, MissingExtraError

NAN = float("nan")


@pytest.fixture(scope="module")
def written(box_room, tmp_path_factory):
    """Each app's capture of eight frames, written once."""
    root = tmp_path_factory.mktemp("apps")
    shots = shots_of(box_room, 8, ROOM_TO_ARKIT)
    for app, write in WRITERS.items():
        write(root / app, shots)
    return root


@pytest.fixture
def room(written, tmp_path):
    def copied(app):
        shutil.copytree(written / app, tmp_path / "room")
        return tmp_path / "room"

    return copied


def refused(path, *words):
    with pytest.raises(InputError) as caught:
        validate_capture(path, ScanOptions())
    line = str(caught.value)
    assert "\n" not in line
    for word in words:
        assert word in line
    return line


def left_out(path, *words, frames=7):
    """All but one of the frames are used, and the other's reason is told."""
    judged = validate_capture(path, ScanOptions())
    assert len(judged.frames) == frames
    ((_, reason),) = judged.skipped
    assert "\n" not in reason
    for word in words:
        assert word in reason


def change_json(path, **values):
    stated = json.loads(path.read_text())
    stated.update(values)
    path.write_text(json.dumps({key: value for key, value in stated.items() if value is not ...}))


def first(folder, pattern):
    return sorted(folder.glob(pattern))[0]


def cut(path, share=0.5):
    path.write_bytes(path.read_bytes()[: int(path.stat().st_size * share)])


@pytest.mark.parametrize("app", WRITERS)
def test_a_zip_cut_short(written, tmp_path, app):
    archive = zipped(written / app, tmp_path / "capture.zip")
    cut(archive)
    refused(archive, "capture.zip")


@pytest.mark.parametrize("app", WRITERS)
def test_a_name_that_leaves_the_zip(written, tmp_path, app):
    archive = zipped(written / app, tmp_path / "capture.zip")
    with zipfile.ZipFile(archive, "a") as opened:
        opened.writestr("../../etc/passwd", "x")
    refused(archive, "unsafe name")


@pytest.mark.parametrize("app", WRITERS)
def test_one_depth_image_cut_short(room, app):
    folder = room(app)
    patterns = {"record3d": "rgbd/*.depth", "polycam": "keyframes/depth/*", "stray": "depth/*"}
    patterns |= {"arkitscenes": "lowres_depth/*", "scanner_app": "depth_*"}
    cut(first(folder, patterns[app]))
    left_out(folder, "copy the file again")


@pytest.mark.parametrize("app", WRITERS)
def test_depth_of_another_size(room, app):
    folder = room(app)
    patterns = {"polycam": "keyframes/depth/*", "stray": "depth/*"}
    patterns |= {"arkitscenes": "lowres_depth/*", "scanner_app": "depth_*"}
    if app == "record3d":
        path = first(folder, "rgbd/*.depth")
        path.write_bytes(stored_lzfse(bytes(4 * 40 * 30)))
        left_out(folder, "decompresses to 4,800 bytes")
        return
    Image.fromarray(np.full((90, 40), 900, np.uint16)).save(first(folder, patterns[app]))
    refused(folder, "40x90")


@pytest.mark.parametrize(("app", "module"), [("record3d", "lzfse"), ("stray", "av")])
def test_a_missing_library_is_named(room, monkeypatch, app, module):
    folder = room(app)
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(MissingExtraError, match=r"pip install 'world2minecraft\[capture\]'"):
        validate_capture(folder, ScanOptions())


# Record3D


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"K": ...}, ["metadata", '"K"', "9 numbers"]),
        ({"K": [1, 2]}, ['"K"', "9 numbers"]),
        ({"K": [NAN] * 9}, ["intrinsics"]),
        ({"w": ...}, ['"w"', "number"]),
        ({"w": 10**9}, ["intrinsics", "width"]),
        ({"dw": 10**6, "dh": 10**6}, ["dw", "8192"]),
        ({"dw": 80.5}, ["dw"]),
        ({"poses": "none"}, ["poses"]),
        ({"poses": [[0, 0, 0, 1]]}, ["poses", "7 numbers"]),
        ({"poses": [[NAN] * 7] * 8}, ["tracking was lost"]),
        ({"perFrameIntrinsicCoeffs": [[1, 2, 3]]}, ["perFrameIntrinsicCoeffs"]),
    ],
)
def test_record3d_states_nonsense(room, values, words):
    folder = room("record3d")
    change_json(folder / "metadata", **values)
    refused(folder, *words)


def test_record3d_loses_tracking_in_one_frame(room):
    folder = room("record3d")
    poses = json.loads((folder / "metadata").read_text())["poses"]
    change_json(folder / "metadata", poses=[*poses[:3], [NAN] * 7, *poses[4:]])
    left_out(folder, "tracking was lost")


def test_record3d_states_a_pose_too_few(room):
    folder = room("record3d")
    change_json(
        folder / "metadata", poses=json.loads((folder / "metadata").read_text())["poses"][:7]
    )
    left_out(folder, "no pose")


def test_record3d_without_metadata_or_with_broken_metadata(room):
    folder = room("record3d")
    (folder / "metadata").write_text("{")
    refused(folder, "is not JSON")
    (folder / "metadata").write_text("[]")
    refused(folder, "metadata", "object")
    (folder / "metadata").unlink()
    refused(folder, "unknown format")


def test_lzfse_that_promises_more_than_it_should(tmp_path):
    """A bomb is told by its blocks' headers, before anything is unpacked."""
    path = tmp_path / "0.depth"
    zeros = b"bvxn" + struct.pack("<II", 0xFFFFFFF0, 4) + b"\x06\0\0\0"
    hostile = {
        "bomb": zeros * 100 + b"bvx$",
        "half a header": b"bvx2\0\0",
        "a block past the end": b"bvx-" + struct.pack("<I", 10**9) + b"abc",
        "an unknown block": b"bvx9" + bytes(60),
        "no end": stored_lzfse(bytes(4 * 80 * 60))[:-4],
        "a block of no length": b"bvx2" + struct.pack("<I", 19200) + bytes(24),
        "empty": b"",
        "text": b"hello",
    }
    for data in hostile.values():
        path.write_bytes(data)
        image = LzfseImage(path, 80, 60, "float32")
        for read in (image.check_whole, image.raw):
            with pytest.raises(InputError) as caught:
                read()
            assert "\n" not in str(caught.value)


def test_lzfse_whose_bits_are_wrong(tmp_path):
    lzfse = pytest.importorskip("lzfse")
    values = np.linspace(1, 3, 4800).astype(np.float32).tobytes()
    packed = bytearray(lzfse.compress(values))
    rng = np.random.default_rng(2)
    image = LzfseImage(tmp_path / "0.depth", 80, 60, "float32")
    for _ in range(60):
        broken = packed.copy()
        broken[int(rng.integers(len(broken)))] ^= 1 << int(rng.integers(8))
        image.path.write_bytes(broken)
        try:
            assert image.raw().shape == (60, 80)
        except InputError as error:
            assert "\n" not in str(error)


def test_exr_that_is_damaged_or_too_large(tmp_path):
    OpenEXR = pytest.importorskip("OpenEXR")
    path = tmp_path / "0.exr"
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    depth = np.linspace(1, 3, 4800).astype(np.float32).reshape(60, 80)
    with OpenEXR.File(header, {"R": depth}) as file:
        file.write(str(path))
    whole = path.read_bytes()
    np.testing.assert_array_equal(ExrImage(path).raw(), depth)
    window = whole.index(b"dataWindow\0box2i\0") + len(b"dataWindow\0box2i\0") + 4
    vast = whole[:window] + struct.pack("<4i", 0, 0, 10**6, 10**6) + whole[window + 16 :]
    flat = whole[:window] + struct.pack("<4i", 0, 0, -5, 3) + whole[window + 16 :]
    for data in (vast, flat, whole[:200], whole[:-100], b"", b"hello", whole[:8]):
        path.write_bytes(data)
        for read in (ExrImage(path).check_whole, ExrImage(path).raw):
            with pytest.raises(InputError) as caught:
                read()
            assert "\n" not in str(caught.value)
    rng = np.random.default_rng(2)
    for _ in range(60):
        broken = bytearray(whole)
        broken[int(rng.integers(len(broken)))] ^= 1 << int(rng.integers(8))
        path.write_bytes(broken)
        try:
            ExrImage(path).raw()
        except InputError as error:
            assert "\n" not in str(error)


# Polycam


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"t_12": ...}, ["t_12"]),
        ({"fx": "wide"}, ['"fx"']),
        ({"fx": -3.0}, ["fx_px"]),
        ({"width": 10**7}, ["width"]),
        ({"t_00": NAN}, ["tracking was lost"]),
    ],
)
def test_one_camera_of_polycam_is_damaged(room, values, words):
    folder = room("polycam")
    change_json(first(folder, "keyframes/corrected_cameras/*"), **values)
    left_out(folder, *words)


def test_polycam_without_cameras_or_pictures(room):
    folder = room("polycam")
    shutil.rmtree(folder / "keyframes" / "corrected_images")
    refused(folder, "keyframes/images")
    shutil.rmtree(folder / "keyframes")
    refused(folder, "unknown format")


def test_polycams_lenses_of_another_shape(room):
    folder = room("polycam")
    for path in (folder / "keyframes" / "corrected_cameras").iterdir():
        change_json(path, width=120, height=160)
    refused(folder, "does not match its intrinsics")


# Stray Scanner


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", ["odometry.csv", "header row"]),
        ("timestamp, frame, x, y, z\n", ["column qx is missing"]),
        ("timestamp, frame, x, y, z, qx, qy, qz, qw\n", ["no pose"]),
        ("timestamp, frame, x, y, z, qx, qy, qz, qw\n1, 2, 3\n", ["line 2"]),
        ("timestamp, frame, x, y, z, qx, qy, qz, qw\n1,0,a,0,0,0,0,0,1\n", ["line 2"]),
        ("timestamp, frame, x, y, z, qx, qy, qz, qw\n1,9e9,0,0,0,0,0,0,1\n", ["line 2"]),
        ("timestamp, frame, x, y, z, qx, qy, qz, qw\n1,0,0,0,0,0,0,0,0\n", ["tracking was lost"]),
    ],
)
def test_strays_odometry_is_damaged(room, text, words):
    folder = room("stray")
    (folder / "odometry.csv").write_text(text)
    refused(folder, *words)


def test_stray_lacks_its_matrix_or_states_nonsense(room):
    folder = room("stray")
    (folder / "camera_matrix.csv").write_text("130,0,80\n0,130\n")
    refused(folder, "camera_matrix.csv", "9 numbers")
    (folder / "camera_matrix.csv").write_text("0,0,80\n0,0,60\n0,0,1\n")
    refused(folder, "camera_matrix.csv", "fx_px")
    (folder / "camera_matrix.csv").unlink()
    refused(folder, "does not contain camera_matrix.csv")


def test_strays_video_is_damaged(room):
    folder = room("stray")
    cut(folder / "rgb.mp4")
    refused(folder, "rgb.mp4", "not a complete video")
    (folder / "rgb.mp4").write_bytes(b"no video at all" * 100)
    refused(folder, "rgb.mp4", "not a complete video")
    (folder / "rgb.mp4").write_bytes(b"")
    refused(folder, "rgb.mp4", "not a complete video")


def test_strays_video_ends_early(written, room, box_room):
    from app_writers import write_video

    folder = room("stray")
    write_video(folder / "rgb.mp4", [box_room.render(box_room.poses(1)[0])[1]] * 7)
    left_out(folder, "the video contains 7")


def test_stray_loses_tracking_in_one_frame(room):
    folder = room("stray")
    lines = (folder / "odometry.csv").read_text().splitlines()
    words = lines[4].split(",")
    lines[4] = ",".join([*words[:2], *(["nan"] * 7)])
    (folder / "odometry.csv").write_text("\n".join(lines))
    left_out(folder, "tracking was lost")


# ARKitScenes


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", ["contains no poses"]),
        ("1 2 3\n", ["line 1", "7 numbers"]),
        ("a b c d e f g\n", ["line 1"]),
        ("nan 0 0 0 0 0 0\n", ["line 1"]),
        ("9999.0 0 0 0 0 0 0\n", ["contains no image at a time"]),
        ("305.377 nan 0 0 0 0 0\n", ["tracking was lost"]),
    ],
)
def test_the_trajectory_of_arkitscenes_is_damaged(room, text, words):
    folder = room("arkitscenes")
    (folder / "lowres_wide.traj").write_text(text)
    refused(folder, *words)


def test_one_lens_of_arkitscenes_is_damaged_or_missing(room):
    folder = room("arkitscenes")
    first(folder, "lowres_wide_intrinsics/*").write_text("160 120 130")
    left_out(folder, "pincam", "width, height")
    shutil.rmtree(folder / "lowres_wide_intrinsics")
    refused(folder, "intrinsics")


# 3D Scanner App


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"cameraPoseARFrame": ...}, ["cameraPoseARFrame", "16 numbers"]),
        ({"cameraPoseARFrame": [1, 2, 3]}, ["16 numbers"]),
        ({"cameraPoseARFrame": [NAN] * 16}, ["tracking was lost"]),
        ({"intrinsics": "none"}, ["intrinsics", "9 numbers"]),
        ({"intrinsics": [0] * 9}, ["intrinsics", "fx_px"]),
    ],
)
def test_one_frame_of_the_3d_scanner_app_is_damaged(room, values, words):
    folder = room("scanner_app")
    change_json(folder / "frame_00002.json", **values)
    left_out(folder, *words)


def test_the_3d_scanner_app_without_pictures(room):
    folder = room("scanner_app")
    for path in folder.glob("*.jpg"):
        path.unlink()
    refused(folder, "frame_00000.jpg", "All Data")


# All of them


NASTY = (None, True, "x", [], {}, [[]], [None], ["a"], [[1, 2], [3]], 0, -1, 10**400, 1e308, NAN)
STATED = {
    "record3d": "metadata",
    "polycam": "keyframes/corrected_cameras/*.json",
    "scanner_app": "frame_00000.json",
    "nerfstudio": "transforms.json",
}


@pytest.mark.parametrize("app", STATED)
def test_whatever_a_file_states_is_read_or_refused_in_one_line(room, written, tmp_path, app):
    """Each value of each key, replaced by each of many that no app writes."""
    if app == "nerfstudio":
        folder = tmp_path / "room"
        folder.mkdir()
        Image.new("RGB", (160, 120)).save(folder / "0.png")
        lens = {"fl_x": 100.0, "fl_y": 100.0, "cx": 80, "cy": 60, "w": 160, "h": 120, "k4": 0}
        frame = {"file_path": "0.png", "transform_matrix": np.eye(4).tolist(), "depth_path": "0"}
        more = {"applied_scale": 1.0, "integer_depth_scale": 1.0, "camera_angle_x": 1.0}
        stated = lens | more | {"mask_path": "0.png", "frames": [frame]}
        (folder / "transforms.json").write_text(json.dumps(stated))
    else:
        folder = room(app)
        for pattern in ("*.jpg", "corrected_cameras/*.json"):
            for more in sorted(folder.rglob(pattern))[2:]:
                more.unlink()
    path = first(folder, STATED[app])
    whole = json.loads(path.read_text())
    for key in whole:
        for value in NASTY:
            path.write_text(json.dumps(whole | {key: value}))
            try:
                validate_capture(folder, ScanOptions())
            except InputError as error:
                assert "\n" not in str(error)
                assert len(str(error)) < 1000
