"""RealSense recordings, written by rosbags' own writer under the recorder's topics."""

import struct
from dataclasses import replace

import numpy as np
import pytest
from tests.capture.readers.datasets.writing import quaternion, zipped

from world2minecraft.capture import open_scan
from world2minecraft.capture.format_detection import find_capture
from world2minecraft.capture.options import ScanOptions
from world2minecraft.capture.readers.datasets.realsense import open_bag
from world2minecraft.capture.validation import validate_capture
from world2minecraft.capture.view_stream import read_view
from world2minecraft.core.errors import CaptureError

rosbag1 = pytest.importorskip("rosbags.rosbag1")
COLOUR, DEPTH = "/device_0/sensor_1/Color_0", "/device_0/sensor_0/Depth_0"
UNITS = "/device_0/sensor_0/option/Depth Units/value"
START_NS = 1_600_000_000_000_000_000


def store():
    from rosbags.typesys import Stores, get_typestore

    return get_typestore(Stores.ROS1_NOETIC)


class BagWriter:
    """Writes messages of a few kinds to a bag."""

    def __init__(self, path, compression=None):
        self.types, self.known = store(), {}
        self.writer = rosbag1.Writer(path)
        if compression:
            self.writer.set_compression(compression)

    def __enter__(self):
        self.writer.open()
        return self

    def __exit__(self, *_):
        self.writer.close()

    def write(self, topic, kind, time_ns, *values):
        if topic not in self.known:
            self.known[topic] = self.writer.add_connection(topic, kind, typestore=self.types)
        message = self.types.types[kind](*values)
        self.writer.write(self.known[topic], time_ns, self.types.serialize_ros1(message, kind))

    def header(self, time_ns):
        stamp = self.types.types["builtin_interfaces/msg/Time"](*divmod(time_ns, 10**9))
        return self.types.types["std_msgs/msg/Header"](0, stamp, "")

    def image(self, topic, time_ns, encoding, pixels, size=None):
        height, width = size or pixels.shape[:2]
        data = np.frombuffer(pixels.tobytes(), np.uint8)
        step = pixels.strides[0]
        values = (self.header(time_ns), height, width, encoding, 0, step, data)
        self.write(topic, "sensor_msgs/msg/Image", time_ns, *values)

    def info(self, topic, camera, model="Brown Conrady", lens=(0.0,) * 5):
        matrix = camera.matrix
        matrix[:2, 2] -= 0.5
        region = self.types.types["sensor_msgs/msg/RegionOfInterest"](0, 0, 0, 0, False)
        values = (self.header(0), camera.height_px, camera.width_px, model, np.array(lens))
        values += (matrix.reshape(-1), np.zeros(9), np.zeros(12), 0, 0, region)
        self.write(topic, "sensor_msgs/msg/CameraInfo", START_NS, *values)

    def transform(self, topic, matrix):
        vector = self.types.types["geometry_msgs/msg/Vector3"](*matrix[:3, 3])
        turn = self.types.types["geometry_msgs/msg/Quaternion"](*quaternion(matrix[:3, :3]))
        self.write(topic, "geometry_msgs/msg/Transform", START_NS, vector, turn)


SIDE = np.eye(4)
SIDE[0, 3] = 0.0147


def write_bag(path, views, *, compression=None, unit=0.001, encoding="rgb8", late_ns=9_000_000,
              infos=True, transforms=True, size=None, **info):  # fmt: skip
    with BagWriter(path, compression) as bag:
        if infos:
            bag.info(f"{COLOUR}/info/camera_info", views[0].colour_camera, **info)
            bag.info(f"{DEPTH}/info/camera_info", views[0].depth_camera)
        if transforms:
            bag.transform(f"{COLOUR}/tf/0", SIDE)
            bag.transform(f"{DEPTH}/tf/0", np.eye(4))
        if unit:
            bag.write(UNITS, "std_msgs/msg/Float32", START_NS, unit)
        for index, view in enumerate(views):
            time_ns = START_NS + index * 33_333_333
            colour = view.colour[..., ::-1] if encoding == "bgr8" else view.colour
            bag.image(f"{COLOUR}/image/data", time_ns, encoding, np.ascontiguousarray(colour), size)
            stored = np.round(view.depth_m / (unit or 0.001)).astype("<u2")
            bag.image(f"{DEPTH}/image/data", time_ns + late_ns, "mono16", stored)
    return path


def check(path, views):
    judged = validate_capture(path, ScanOptions())
    assert (judged.capture.source, judged.posed, judged.has_depth) == ("realsense", False, True)
    assert len(judged.frames) == len(views)
    for frame, view in zip(judged.frames, views, strict=True):
        posed = replace(frame, camera_to_world=np.eye(4))
        read = read_view(posed, judged.encoding)
        np.testing.assert_array_equal(read.colour, view.colour)
        np.testing.assert_allclose(read.depth_m, view.depth_m, atol=6e-4)
        assert read.colour_camera == view.colour_camera
        np.testing.assert_allclose(read.depth_to_colour, SIDE, atol=1e-9)
    return judged


@pytest.mark.parametrize("compression", [None, "LZ4", "BZ2"])
def test_a_recording_gives_the_pictures_that_were_written(tmp_path, views, compression):
    kind = compression and rosbag1.Writer.CompressionFormat[compression]
    judged = check(write_bag(tmp_path / "room.bag", views, compression=kind), views)
    assert judged.frames[3].time_s == pytest.approx(START_NS / 1e9 + 0.1, abs=1e-6)
    with pytest.raises(CaptureError, match="contains no poses"):
        open_scan(tmp_path / "room.bag")


def test_a_folder_and_a_zip_of_it_are_the_same(tmp_path, views):
    (tmp_path / "x").mkdir()
    write_bag(tmp_path / "x" / "room.bag", views[:4], encoding="bgr8")
    check(tmp_path / "x", views[:4])
    check(zipped(tmp_path / "x", tmp_path / "a.zip"), views[:4])


def test_units_stated_and_not(tmp_path, views):
    assert find_capture(write_bag(tmp_path / "a.bag", views[:2], unit=0.00025)).depth_unit == (
        "0.00025"
    )
    capture = find_capture(write_bag(tmp_path / "b.bag", views[:2], unit=None))
    assert capture.notes == ("the bag states no depth unit; using millimetres",)


def test_a_large_bag_within_a_zip_is_not_held_in_memory(tmp_path, views, refused, monkeypatch):
    (tmp_path / "x").mkdir()
    write_bag(tmp_path / "x" / "room.bag", views[:2])
    monkeypatch.setattr(
        "world2minecraft.capture.readers.datasets.embedded_images.MAX_MEMBER_BYTES", 10_000
    )
    refused(
        zipped(tmp_path / "x", tmp_path / "a.zip"), "from a zip archive; unpack the archive first"
    )


def test_streams_that_are_not_locked_pair_by_time(tmp_path, views):
    with BagWriter(tmp_path / "a.bag") as bag:
        for name, camera in ((COLOUR, views[0].colour_camera), (DEPTH, views[0].depth_camera)):
            bag.info(f"{name}/info/camera_info", camera)
            bag.transform(f"{name}/tf/0", np.eye(4))
        for index, view in enumerate(views):
            time_ns = START_NS + index * 33_333_333
            bag.image(f"{COLOUR}/image/data", time_ns, "rgb8", view.colour)
            if index % 2 == 0:
                stored = np.round(view.depth_m * 1000).astype("<u2")
                bag.image(f"{DEPTH}/image/data", time_ns + 5_000_000, "mono16", stored)
    frames = find_capture(tmp_path / "a.bag").frames
    assert len(frames) == 6
    np.testing.assert_array_equal(frames[2].colour_path.colour(), views[4].colour)


def test_what_the_ros_driver_records_with_aligned_depth(tmp_path, views):
    with BagWriter(tmp_path / "a.bag") as bag:
        for name in ("color", "aligned_depth_to_color"):
            bag.info(f"/camera/{name}/camera_info", views[0].colour_camera, "plumb_bob")
        for index, view in enumerate(views[:3]):
            time_ns = START_NS + index * 33_333_333
            bag.image("/camera/color/image_raw", time_ns, "rgb8", view.colour)
            stored = np.round(view.depth_m * 1000).astype("<u2")
            bag.image("/camera/aligned_depth_to_color/image_raw", time_ns, "16UC1", stored)
    capture = find_capture(tmp_path / "a.bag")
    np.testing.assert_array_equal(capture.frames[0].depth_to_colour, np.eye(4))
    np.testing.assert_allclose(
        capture.frames[1].depth_path.raw() / 1000, views[1].depth_m, atol=6e-4
    )


def test_yuyv_pictures_become_rgb(tmp_path, views):
    """Grey pixels have no hue; a red one has, by the broadcast formula."""
    camera = views[0].colour_camera
    pixels = np.full((camera.height_px, camera.width_px, 2), 128, np.uint8)
    pixels[..., 0] = 90
    pixels[:, 1::2, 1] = 228
    with BagWriter(tmp_path / "a.bag") as bag:
        for name in (COLOUR, DEPTH):
            bag.info(f"{name}/info/camera_info", camera)
            bag.transform(f"{name}/tf/0", np.eye(4))
        bag.image(f"{COLOUR}/image/data", START_NS, "YUYV", pixels)
        stored = np.round(views[0].depth_m * 1000).astype("<u2")
        bag.image(f"{DEPTH}/image/data", START_NS, "mono16", stored)
    colour = find_capture(tmp_path / "a.bag").frames[0].colour_path.colour()
    assert colour.shape == (120, 160, 3)
    assert colour[5, 6].tolist() == [230, 19, 90]


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"late_ns": 10**12}, "contains no colour and depth images within 0.025 s"),
        ({"infos": False}, "contains no intrinsics (camera_info)"),
        ({"transforms": False}, "does not contain the transform between its cameras"),
        ({"unit": 5.0}, "has a depth unit of 5.0 m"),
        (
            {"encoding": "bayer_rggb8"},
            "has the unsupported encoding 'bayer_rggb8'; supported: rgb8",
        ),
        ({"size": (120, 100_000)}, "too few for 100000x120"),
        (
            {"model": "Kannala Brandt4", "lens": (0.3, 0, 0, 0, 0)},
            "unsupported model 'kannala_brandt4'",
        ),
    ],
)
def test_recordings_that_lack_or_lie(tmp_path, views, refused, options, words):
    write_bag(tmp_path / "a.bag", views[:3], **options)
    refused(tmp_path / "a.bag", words)


def test_a_bag_without_both_streams(tmp_path, views, refused):
    with BagWriter(tmp_path / "a.bag") as bag:
        bag.image(f"{COLOUR}/image/data", START_NS, "rgb8", views[0].colour)
    refused(tmp_path / "a.bag", "does not contain colour and depth streams; record both")


@pytest.mark.parametrize("keep", [14, 60, 0.3, 0.9])
def test_bags_cut_short(tmp_path, views, refused, keep):
    path = write_bag(tmp_path / "a.bag", views[:3])
    data = path.read_bytes()
    path.write_bytes(data[: int(keep * len(data)) if keep < 1 else keep])
    refused(path, "is not a complete ROS bag (")


def test_a_bag_of_noise_after_its_first_line(tmp_path, refused):
    noise = np.random.default_rng(3).integers(0, 256, 5000).astype(np.uint8).tobytes()
    (tmp_path / "a.bag").write_bytes(b"#ROSBAG V2.0\n" + noise)
    refused(tmp_path / "a.bag", "is not a complete ROS bag (")


def test_a_chunk_that_swells_is_not_unpacked_whole(tmp_path, views, monkeypatch):
    kind = rosbag1.Writer.CompressionFormat.BZ2
    path = write_bag(tmp_path / "a.bag", views[:3], compression=kind)
    monkeypatch.setattr(
        "world2minecraft.capture.readers.datasets.realsense.MAX_CHUNK_BYTES", 60_000
    )
    bag = open_bag.__globals__["Bag"](path)
    positions = list(bag._reader.chunks)
    stored = path.read_bytes()
    for position in positions:
        chunk = bag._reader.chunks[position]
        data = stored[chunk.datapos : chunk.datapos + chunk.datasize]
        assert len(chunk.decompressor(data)) <= 60_000


def test_a_file_that_is_only_named_a_bag(tmp_path, refused):
    (tmp_path / "a.bag").write_bytes(struct.pack("<Q", 5))
    refused(tmp_path / "a.bag", "is a file (.bag) of an unknown format")
