"""The iPhone's part of ScanNet++, written as the data set's toolkit is described to read it."""

import json
import struct
import zlib
from dataclasses import replace

import numpy as np
import pytest
from lz4.block import compress
from tests.capture.readers.datasets.writing import save, zipped

from world2minecraft.capture import open_scan
from world2minecraft.capture.format_detection import find_capture
from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.types import Camera

DEPTH_CAMERA = Camera(256, 192, 208.0, 208.0, 128.0, 96.0)


@pytest.fixture(scope="module")
def phone_views(box_room, views):
    """Views whose depth has the size of the phone's; up is z."""
    made = []
    for view, pose in zip(views, box_room.poses(12), strict=True):
        depth, _ = box_room.render(pose, DEPTH_CAMERA)
        made.append(replace(view, camera_to_scan=pose, depth_m=depth, depth_camera=DEPTH_CAMERA))
    return made


def lz4_block(depth_m):
    millimetres = np.round(depth_m * 1000).astype("<u2")
    return compress(millimetres.tobytes(), store_size=False)


def deflated(depth_m):
    packer = zlib.compressobj(6, zlib.DEFLATED, -zlib.MAX_WBITS)
    return packer.compress(depth_m.astype("<f4").tobytes()) + packer.flush()


def entry(view, camera):
    matrix = camera.matrix
    matrix[:2, 2] -= 0.5
    pose = view.camera_to_scan.tolist()
    return {"timestamp": 1.0, "aligned_pose": pose, "intrinsic": matrix.tolist(), "imu": []}


def write_phone(folder, views, pack=lz4_block, video=False):
    folder.mkdir(parents=True, exist_ok=True)
    camera = views[0].colour_camera
    stated = {f"frame_{n:06d}": entry(view, camera) for n, view in enumerate(views)}
    (folder / "pose_intrinsic_imu.json").write_text(json.dumps(stated))
    blocks = [pack(view.depth_m) for view in views]
    packed = b"".join(struct.pack("<I", len(block)) + block for block in blocks)
    (folder / "depth.bin").write_bytes(packed)
    if video:
        write_video(folder / "rgb.mkv", views)
        return
    for number, view in enumerate(views):
        save(folder / "rgb" / f"frame_{number:06d}.png", view.colour)


def write_video(path, views):
    av = pytest.importorskip("av")
    with av.open(str(path), "w") as container:
        stream = container.add_stream("ffv1", rate=60)
        stream.width, stream.height, stream.pix_fmt = 160, 120, "bgr0"
        for view in views:
            container.mux(stream.encode(av.VideoFrame.from_ndarray(view.colour, format="rgb24")))
        container.mux(stream.encode(None))


@pytest.mark.parametrize("pack", [lz4_block, deflated])
def test_a_recording_gives_the_views_that_were_written(tmp_path, phone_views, box_room, pack):
    write_phone(tmp_path / "iphone", phone_views, pack)
    capture = find_capture(tmp_path)
    np.testing.assert_array_equal(capture.world_up, [0, 0, 1])
    scan = open_scan(tmp_path)
    assert scan.source == "scannetpp"
    for read, view in zip(scan.views, phone_views, strict=True):
        np.testing.assert_allclose(read.camera_to_scan, view.camera_to_scan, atol=1e-9)
        np.testing.assert_allclose(read.depth_m, view.depth_m, atol=6e-4)
        np.testing.assert_array_equal(read.colour, view.colour)
        assert read.depth_camera == DEPTH_CAMERA
    np.testing.assert_allclose(sorted(scan.room_size_m), sorted(box_room.size_m), atol=0.01)


def test_a_zip_of_it_is_the_same(tmp_path, phone_views):
    write_phone(tmp_path / "iphone", phone_views)
    capture = find_capture(zipped(tmp_path, tmp_path / "a.zip"))
    depth = capture.frames[4].depth_path.raw() / 1000
    np.testing.assert_allclose(depth, phone_views[4].depth_m, atol=6e-4)


def test_pictures_of_the_video(tmp_path, phone_views):
    write_phone(tmp_path, phone_views, video=True)
    frames = find_capture(tmp_path).frames
    off = np.abs(frames[5].colour_path.colour().astype(int) - phone_views[5].colour)
    assert off.max() <= 2


def test_files_go_before_the_packed_ones(tmp_path, phone_views):
    write_phone(tmp_path, phone_views)
    for number, view in enumerate(phone_views):
        save(tmp_path / "depth" / f"frame_{number:06d}.png", (view.depth_m * 1000).astype("<u2"))
    assert find_capture(tmp_path).frames[3].depth_path.name == "frame_000003.png"


def test_of_depth_cut_short_the_whole_frames_are_kept(tmp_path, phone_views):
    write_phone(tmp_path, phone_views)
    path = tmp_path / "depth.bin"
    path.write_bytes(path.read_bytes()[:-20])
    frames = find_capture(tmp_path).frames
    assert [frame.depth_path is None for frame in frames] == [False] * 11 + [True]


def test_a_depth_image_that_swells_or_is_noise(tmp_path, phone_views):
    bomb = deflated(np.zeros(20_000_000, np.float32))
    for block, words in (
        (bomb, "decompresses to 196,609 bytes"),
        (b"\xff" * 99, "cannot be decompressed"),
    ):
        write_phone(tmp_path, phone_views)
        (tmp_path / "depth.bin").write_bytes(struct.pack("<I", len(block)) + block)
        with pytest.raises(DamagedFileError, match=words):
            find_capture(tmp_path).frames[0].depth_path.raw()


@pytest.mark.parametrize(
    ("name", "data", "words"),
    [
        ("depth.bin", struct.pack("<I", 1 << 31) + bytes(99), "compressed as a whole; unpack it"),
        ("pose_intrinsic_imu.json", b"{}", 'must contain frames of the form "frame_000000"'),
        ("pose_intrinsic_imu.json", b"[1]", 'must contain frames of the form "frame_000000"'),
        ("pose_intrinsic_imu.json", b'{"a": {}}', "of the form frame_000000, got 'a'"),
        ("pose_intrinsic_imu.json", b'{"frame_000000": {}}', "must contain a 3x3 matrix"),
        ("pose_intrinsic_imu.json", b"{", "is not JSON"),
    ],
)
def test_damaged_recordings(tmp_path, phone_views, refused, name, data, words):
    write_phone(tmp_path, phone_views)
    (tmp_path / name).write_bytes(data)
    refused(tmp_path, words)


def test_a_recording_without_pictures(tmp_path, phone_views, refused):
    write_phone(tmp_path, phone_views)
    for path in (tmp_path / "rgb").iterdir():
        path.unlink()
    refused(tmp_path, "contains no readable colour images")
