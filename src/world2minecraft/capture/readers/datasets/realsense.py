"""Reader of RealSense recordings: ROS 1 bags with colour and depth images, without poses.

Topics are those of the camera's own recorder (``/device_0/sensor_1/Color_0/image/data``) or, if
depth was aligned to colour, of its ROS driver (``/camera/aligned_depth_to_color/image_raw``). Each
stream comes with its intrinsics, its transform to other streams and the depth unit.

Bags are untrusted input. Messages are read individually by the bag's index, and one chunk at a
time is decompressed, with a size limit. All exceptions of the bag library are converted to
exceptions of this project.
"""

import bz2
import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, cast

import numpy as np

from world2minecraft.capture.images import MAX_PIXELS, ImageHeader, NamedByFrame
from world2minecraft.capture.readers.datasets.embedded_images import check_archive_member_size
from world2minecraft.capture.readers.datasets.intrinsics import stated_camera
from world2minecraft.capture.readers.datasets.time_sync import pair_times
from world2minecraft.capture.source_types import Capture, FrameFiles
from world2minecraft.core.archives import AnyPath, file_stamp
from world2minecraft.core.coordinates import invert_rigid
from world2minecraft.core.errors import (
    CaptureError,
    DamagedFileError,
    InputError,
    LimitError,
    MissingExtraError,
    reason_of,
)
from world2minecraft.core.types import Camera
from world2minecraft.geometry.rotations import pose_from_quaternion

MAX_CHUNK_BYTES = 256 << 20  # Recorders close a chunk at 0.75 MB or after one large picture.
IMAGE = "sensor_msgs/msg/Image"
CAMERA_INFO, TRANSFORM = "sensor_msgs/msg/CameraInfo", "geometry_msgs/msg/Transform"
FLOAT = "std_msgs/msg/Float32"
# How each encoding is kept: dtype, channels, and the order that makes it RGB.
ENCODINGS: dict[str, tuple[str, int, tuple[int, ...]]] = {
    "rgb8": ("u1", 3, (0, 1, 2)),
    "bgr8": ("u1", 3, (2, 1, 0)),
    "rgba8": ("u1", 4, (0, 1, 2)),
    "bgra8": ("u1", 4, (2, 1, 0)),
    "mono16": ("u2", 1, ()),
    "16uc1": ("u2", 1, ()),
    "32fc1": ("f4", 1, ()),
    "yuyv": ("u1", 2, ()),
}
WITHIN_S = 0.025  # Streams of 30 Hz that are not locked lie up to 17 ms apart.
DEFAULT_UNIT_M = 0.001
MAX_GROUPS = 8  # Maximum number of groups of calibrated streams; cameras have 1 or 2.
MAGIC = b"#ROSBAG V"
_RECORDED = re.compile(r"(/device_\d+/sensor_\d+)/(Color|Depth)_\d+/image/data")
_UNITS = re.compile(r"/device_\d+/sensor_\d+/option/Depth[ _]Units/value")
_DRIVER = (
    ("/color/image_raw", "/aligned_depth_to_color/image_raw"),
    ("/rgb/image_raw", "/depth_registered/image_raw"),
)
_PINHOLES = ("", "none", "plumb_bob", "brown_conrady", "rational_polynomial")


@dataclass(frozen=True)
class ImageStream:
    """An image topic of a bag.

    Attributes:
        topic: Name of the topic.
        times_ns: Time of each message in nanoseconds, sorted.
    """

    topic: str
    times_ns: tuple[int, ...]


class Bag:
    """An open ROS 1 bag."""

    def __init__(self, path: AnyPath):
        """Open a bag and read its index.

        Raises:
            DamagedFileError: If the file is not a complete bag.
            LimitError: If a chunk is too large.
            MissingExtraError: If the rosbags library is not installed.
        """
        try:
            from rosbags.rosbag1 import Reader  # noqa: PLC0415
            from rosbags.typesys import Stores, get_typestore  # noqa: PLC0415
        except ImportError as error:
            raise MissingExtraError("reading bags", "capture") from error
        self.path = path
        self._latest: tuple[str, int, Any] | None = None
        self._types = get_typestore(Stores.ROS1_NOETIC)
        check_archive_member_size(path)
        with _reading_errors(path):
            self._reader: Any = Reader(cast(Any, path))  # A zip's member opens like a file.
            self._reader.open()
            self._bound_chunks()

    def _bound_chunks(self) -> None:
        for position, chunk in self._reader.chunks.items():
            if chunk.datasize > MAX_CHUNK_BYTES:
                raise LimitError(
                    self.path,
                    f"contains a chunk of {chunk.datasize:,} bytes, the limit is "
                    f"{MAX_CHUNK_BYTES:,}",
                )
            unpack = _bounded_decompressor(chunk.decompressor)
            self._reader.chunks[position] = chunk._replace(decompressor=unpack)

    def topics(self) -> tuple[str, ...]:
        """Return the sorted names of all topics."""
        return tuple(sorted({connection.topic for connection in self._reader.connections}))

    def streams(self) -> dict[str, ImageStream]:
        """Return the image topics by name."""
        found: dict[str, list[int]] = {}
        for connection in self._reader.connections:
            if connection.msgtype == IMAGE:
                entries = self._reader.indexes[connection.id]
                found.setdefault(connection.topic, []).extend(entry.time for entry in entries)
        return {topic: ImageStream(topic, tuple(sorted(times))) for topic, times in found.items()}

    def first(self, topic: str, kind: str) -> Any:
        """Return the first message of a topic that is of a kind, or None."""
        return next(self._messages(topic, kind, None), None)

    def image(self, topic: str, time_ns: int) -> Any:
        """Return the image message of a topic at a given time.

        Raises:
            DamagedFileError: If the message is missing or cannot be decoded.
        """
        if self._latest is None or self._latest[:2] != (topic, time_ns):
            found = next(self._messages(topic, IMAGE, time_ns), None)
            if found is None:
                raise DamagedFileError(
                    self.path, f"lacks an image of topic {topic}; copy the file again"
                )
            self._latest = (topic, time_ns, found)  # The header is read before the pixels.
        return self._latest[2]

    def _messages(self, topic: str, kind: str, time_ns: int | None) -> Iterator[Any]:
        with _reading_errors(self.path):
            chosen = [one for one in self._reader.connections if one.topic == topic]
            stop = None if time_ns is None else time_ns + 1
            if chosen:
                for connection, _, raw in self._reader.messages(chosen, time_ns, stop):
                    if connection.msgtype == kind:  # The index of a damaged bag names any message.
                        yield self._types.deserialize_ros1(raw, kind)


@contextmanager
def _reading_errors(path: AnyPath) -> Iterator[None]:
    """Convert any exception of the bag library to a one-line DamagedFileError."""
    try:
        yield
    except InputError:
        raise
    except Exception as error:
        reason = reason_of(error)
        raise DamagedFileError(
            path, f"is not a complete ROS bag ({reason}); copy the file again"
        ) from error


def _bounded_decompressor(unpack: Any) -> Any:
    """Return an equivalent decompressor that stops at ``MAX_CHUNK_BYTES``."""
    name = f"{getattr(unpack, '__module__', '')}.{getattr(unpack, '__name__', '')}"
    if "bz2" in name:
        return lambda data: bz2.BZ2Decompressor().decompress(data, MAX_CHUNK_BYTES)
    if "lz4" in name:
        return _unpack_lz4
    return unpack


def _unpack_lz4(data: bytes) -> bytes:
    from lz4.frame import LZ4FrameDecompressor  # noqa: PLC0415

    return LZ4FrameDecompressor().decompress(data, MAX_CHUNK_BYTES)


def open_bag(path: AnyPath) -> Bag:
    """Return an open bag, cached per process.

    Raises:
        InputError: If the file is missing.
        DamagedFileError: If the file is not a complete bag.
        LimitError: If a chunk is too large.
        MissingExtraError: If the rosbags library is not installed.
    """
    return _open_cached(path, file_stamp(path), os.getpid())


@lru_cache(maxsize=2)
def _open_cached(path: AnyPath, stamp: tuple[int, int], process: int) -> Bag:
    return Bag(path)


@lru_cache(maxsize=8)
def _times(path: AnyPath, topic: str, stamp: Bag) -> tuple[int, ...]:
    return stamp.streams()[topic].times_ns


@dataclass(frozen=True)
class BagImage(NamedByFrame):
    """An image of a bag.

    Attributes:
        path: The bag.
        topic: Name of the image topic.
        index: Position of the image in the topic, by time.
        frame: Name of the image, for messages.
    """

    path: AnyPath
    topic: str
    index: int
    frame: str

    def header(self) -> ImageHeader:
        """Return the size and mode of the image, which requires reading the message."""
        message = self._message()
        kind, _, order = self._encoding(message)
        mode = "RGB" if order or kind == "u1" else "float32" if kind == "f4" else "uint16"
        return ImageHeader(int(message.width), int(message.height), mode)

    def check_whole(self) -> None:
        """Check that the number of pixels matches the image size."""
        self._rows()

    def colour(self) -> np.ndarray:
        """Return the image as sRGB, uint8 [H, W, 3]."""
        rows, message = self._rows()
        kind, channels, order = self._encoding(message)
        if kind != "u1":
            raise DamagedFileError(
                self, f"is encoded as {message.encoding}, which is not a colour format"
            )
        pixels = rows.reshape(rows.shape[0], -1, channels)
        if not order:
            if pixels.shape[1] % 2:
                raise DamagedFileError(self, "is a YUYV image, whose width must be even")
            return _yuyv_to_rgb(pixels)
        return np.ascontiguousarray(pixels[..., list(order)])

    def raw(self) -> np.ndarray:
        """Return the stored pixel values as an array [H, W]."""
        rows, message = self._rows()
        kind, _, _ = self._encoding(message)
        if kind == "u1":
            raise DamagedFileError(
                self, f"is encoded as {message.encoding}, which is not a depth format"
            )
        order = ">" if message.is_bigendian else "<"
        values = rows.view(np.dtype(order + kind))
        return values.astype(values.dtype.newbyteorder("="))

    def _message(self) -> Any:
        bag = open_bag(self.path)
        return bag.image(self.topic, _times(self.path, self.topic, bag)[self.index])

    def _encoding(self, message: Any) -> tuple[str, int, tuple[int, ...]]:
        name = str(message.encoding).lower()
        if name not in ENCODINGS:
            raise DamagedFileError(
                self,
                f"has the unsupported encoding {name[:20]!r}; supported: {', '.join(ENCODINGS)}",
            )
        return ENCODINGS[name]

    def _rows(self) -> tuple[np.ndarray, Any]:
        """Return the pixel bytes as uint8 [H, bytes per row without padding], and the message."""
        message = self._message()
        kind, channels, _ = self._encoding(message)
        width, height, step = int(message.width), int(message.height), int(message.step)
        used = width * channels * np.dtype(kind).itemsize
        data = np.frombuffer(memoryview(message.data), np.uint8)
        if not 0 < width * height <= MAX_PIXELS or step < used or len(data) < step * height:
            raise DamagedFileError(
                self, f"contains {len(data):,} bytes, too few for {width}x{height} pixels"
            )
        rows = data[: step * height].reshape(height, step)[:, :used]
        return np.ascontiguousarray(rows), message


def _yuyv_to_rgb(pixels: np.ndarray) -> np.ndarray:
    """Convert YUYV pixels, with brightness per pixel and hue per pair of pixels, to RGB."""
    bright = pixels[..., 0].astype(np.float32)
    blue = np.repeat(pixels[:, 0::2, 1], 2, axis=1).astype(np.float32) - 128
    red = np.repeat(pixels[:, 1::2, 1], 2, axis=1).astype(np.float32) - 128
    rgb = [bright + 1.402 * red, bright - 0.344136 * blue - 0.714136 * red, bright + 1.772 * blue]
    return np.clip(np.round(np.stack(rgb, axis=-1)), 0, 255).astype(np.uint8)


@dataclass(frozen=True)
class _StreamPair:
    """The colour and depth streams to read, with the topics of their intrinsics."""

    colour: ImageStream
    depth: ImageStream
    colour_info: str
    depth_info: str
    recorded: bool


class RealSenseSource:
    """A reader of ROS bags recorded by RealSense cameras, and of folders that contain a bag."""

    layout = "a RealSense recording (.bag)"

    def recognise(self, folder: AnyPath) -> bool:
        """Return whether the path is a bag or a folder that contains exactly one bag."""
        return _bag_file(folder) is not None

    def read(self, folder: AnyPath) -> Capture:
        """Read the pairs of colour and depth images, matched by time.

        Raises:
            CaptureError: If the bag lacks streams or calibration.
            DamagedFileError: If the bag is damaged.
        """
        path = _bag_file(folder)
        if path is None:
            raise CaptureError(folder, "does not contain a .bag file")
        bag = open_bag(path)
        pair = _choose_streams(path, bag.streams())
        matches = pair_times(
            np.array(pair.colour.times_ns) / 1e9, np.array(pair.depth.times_ns) / 1e9, WITHIN_S
        )
        if not matches:
            raise CaptureError(
                path, f"contains no colour and depth images within {WITHIN_S} s of each other"
            )
        colour_camera = _camera(path, bag.first(pair.colour_info, CAMERA_INFO))
        depth_camera = _camera(path, bag.first(pair.depth_info, CAMERA_INFO))
        depth_to_colour = _depth_to_colour(path, bag, pair)
        unit_m, notes = _unit(path, bag)
        frames = tuple(
            FrameFiles(
                f"{number:06d}",
                None,
                BagImage(path, pair.colour.topic, index, f"{number:06d} colour"),
                colour_camera,
                BagImage(path, pair.depth.topic, other, f"{number:06d} depth"),
                depth_camera,
                depth_to_colour,
                time_s=pair.colour.times_ns[index] / 1e9,
            )
            for number, (index, other) in enumerate(matches)
        )
        return Capture(folder, "realsense", frames, depth_unit=repr(unit_m), notes=notes)


def _bag_file(place: AnyPath) -> AnyPath | None:
    found = [place] if place.suffix.lower() == ".bag" and place.is_file() else []
    if not found and place.is_dir():
        found = [path for path in place.glob("*.bag") if path.is_file()]
    return found[0] if len(found) == 1 and _has_bag_magic(found[0]) else None


def _has_bag_magic(path: AnyPath) -> bool:
    try:
        with path.open("rb") as stream:
            return stream.read(len(MAGIC)) == MAGIC
    except OSError:
        return False


def _choose_streams(path: AnyPath, streams: dict[str, ImageStream]) -> _StreamPair:
    """Return the colour and depth streams of the camera's recorder or of its ROS driver."""
    recorded = {
        match[2]: topic for topic in sorted(streams) if (match := _RECORDED.fullmatch(topic))
    }
    if len(recorded) == 2:
        colour, depth = recorded["Color"], recorded["Depth"]
        infos = [
            topic.removesuffix("/image/data") + "/info/camera_info" for topic in (colour, depth)
        ]
        return _StreamPair(streams[colour], streams[depth], infos[0], infos[1], True)
    for colour_end, depth_end in _DRIVER:
        for topic in sorted(streams):
            prefix = topic.removesuffix(colour_end)
            if prefix != topic and prefix + depth_end in streams:
                depth = prefix + depth_end
                infos = [name.removesuffix("image_raw") + "camera_info" for name in (topic, depth)]
                return _StreamPair(streams[topic], streams[depth], infos[0], infos[1], False)
    raise CaptureError(
        path,
        "does not contain colour and depth streams; record both (ROS driver: "
        "aligned_depth_to_color)",
    )


def _camera(path: AnyPath, info: Any) -> Camera:
    """Return the camera of a ``sensor_msgs/CameraInfo`` message."""
    if info is None:
        raise CaptureError(
            path, "contains no intrinsics (camera_info) for a stream; record that topic too"
        )
    matrix = np.asarray(info.K, np.float64).reshape(-1)
    model = str(info.distortion_model).lower().replace(" ", "_")
    lens = np.asarray(info.D, np.float64).reshape(-1)
    if len(matrix) != 9 or not np.isfinite(lens).all():
        raise CaptureError(
            path, "has invalid intrinsics: expected nine numbers and finite distortion coefficients"
        )
    if np.any(lens) and (model not in _PINHOLES or np.any(lens[5:])):
        # The recorder's inverse model undoes what ours does; its terms are near zero in fact.
        if "inverse" not in model or np.abs(lens[:5]).max() > 0.2:
            raise CaptureError(path, f"contains a lens of the unsupported model {model[:30]!r}")
        lens = np.zeros(5)
    size = (int(info.width), int(info.height))
    return stated_camera(path, size, matrix[[0, 4, 2, 5]], lens[:5])


def _depth_to_colour(path: AnyPath, bag: Any, pair: _StreamPair) -> np.ndarray:
    """Return the transform from the depth camera to the colour camera.

    The recorder writes for each stream the transform from a reference stream to it.
    """
    if not pair.recorded:
        return np.eye(4)
    to_stream = []
    prefixes = [stream.topic.removesuffix("/image/data") for stream in (pair.colour, pair.depth)]
    known = set(bag.topics())
    groups = [n for n in range(MAX_GROUPS) if all(f"{p}/tf/{n}" in known for p in prefixes)]
    messages = [bag.first(f"{prefix}/tf/{n}", TRANSFORM) for n in groups[:1] for prefix in prefixes]
    if not messages or None in messages:
        raise CaptureError(
            path, "does not contain the transform between its cameras; record the topic tf/0"
        )
    for message in messages:
        t, q = message.translation, message.rotation
        to_stream.append(
            pose_from_quaternion(np.array([t.x, t.y, t.z]), np.array([q.x, q.y, q.z, q.w]))
        )
    if not all(np.isfinite(transform).all() for transform in to_stream):
        raise CaptureError(path, "contains a transform between its cameras that is not finite")
    return to_stream[0] @ invert_rigid(to_stream[1])


def _unit(path: AnyPath, bag: Any) -> tuple[float, tuple[str, ...]]:
    """Return metres per depth unit, and notes."""
    for topic in bag.topics():
        stated = bag.first(topic, FLOAT) if _UNITS.fullmatch(topic) else None
        if stated is not None:
            unit_m = float(np.float32(stated.data))
            if not 1e-6 < unit_m < 0.1:
                raise CaptureError(path, f"has a depth unit of {unit_m} m; expected 1e-06 to 0.1 m")
            return float(f"{unit_m:.6g}"), ()
    return DEFAULT_UNIT_M, ("the bag states no depth unit; using millimetres",)
