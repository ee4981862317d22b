"""RealSense recordings: a ROS 1 bag with colour and depth pictures, no poses.

The topics are those of the camera's own recorder (``/device_0/sensor_1/Color_0/image/data``) or of
its ROS driver where depth was aligned (``/camera/aligned_depth_to_color/image_raw``). Beside each
stream stand its intrinsics, how it stands to the others and how much a unit of depth is.
"""

import re
from dataclasses import dataclass
from typing import Any

import numpy as np

from world2minecraft.capture.frames import Capture, FrameFiles
from world2minecraft.capture.readers.datasets.bag_reading import BagImage, Stream, opened_bag
from world2minecraft.capture.readers.datasets.intrinsics import stated_camera
from world2minecraft.capture.readers.datasets.time_sync import pair_times
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.coordinates import invert_rigid
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.types import Camera
from world2minecraft.geometry.quaternions import pose_of

WITHIN_S = 0.025  # Streams of 30 Hz that are not locked lie up to 17 ms apart.
DEFAULT_UNIT_M = 0.001
MAX_GROUPS = 8  # Of streams whose places to each other are known; cameras have one or two.
MAGIC = b"#ROSBAG V"
_RECORDED = re.compile(r"(/device_\d+/sensor_\d+)/(Color|Depth)_\d+/image/data")
_UNITS = re.compile(r"/device_\d+/sensor_\d+/option/Depth[ _]Units/value")
_DRIVER = (
    ("/color/image_raw", "/aligned_depth_to_color/image_raw"),
    ("/rgb/image_raw", "/depth_registered/image_raw"),
)
_PINHOLES = ("", "none", "plumb_bob", "brown_conrady", "rational_polynomial")


@dataclass(frozen=True)
class _Pair:
    """The two streams that are read, and where their intrinsics stand."""

    colour: Stream
    depth: Stream
    colour_info: str
    depth_info: str
    recorded: bool


class RealSenseSource:
    """Reads a ``.bag``, or a folder that holds one."""

    layout = "a RealSense recording (.bag)"

    def recognise(self, folder: AnyPath) -> bool:
        """Return whether it is a bag or a folder with just one."""
        return _bag_file(folder) is not None

    def read(self, folder: AnyPath) -> Capture:
        """List the pairs of pictures. Raises CaptureError as ``Source.read`` says."""
        path = _bag_file(folder)
        if path is None:
            raise CaptureError(folder, "holds no .bag")
        bag = opened_bag(path)
        pair = _streams(path, bag.streams())
        matches = pair_times(
            np.array(pair.colour.times_ns) / 1e9, np.array(pair.depth.times_ns) / 1e9, WITHIN_S
        )
        if not matches:
            raise CaptureError(path, f"no colour and depth picture lie within {WITHIN_S} s")
        colour_camera = _camera(path, bag.first(pair.colour_info))
        depth_camera = _camera(path, bag.first(pair.depth_info))
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
    return found[0] if len(found) == 1 and _begins_as_bag(found[0]) else None


def _begins_as_bag(path: AnyPath) -> bool:
    try:
        with path.open("rb") as stream:
            return stream.read(len(MAGIC)) == MAGIC
    except OSError:
        return False


def _streams(path: AnyPath, streams: dict[str, Stream]) -> _Pair:
    """Return the colour and depth streams of the recorder, or of the driver."""
    recorded = {
        match[2]: topic for topic in sorted(streams) if (match := _RECORDED.fullmatch(topic))
    }
    if len(recorded) == 2:
        colour, depth = recorded["Color"], recorded["Depth"]
        infos = [
            topic.removesuffix("/image/data") + "/info/camera_info" for topic in (colour, depth)
        ]
        return _Pair(streams[colour], streams[depth], infos[0], infos[1], True)
    for colour_end, depth_end in _DRIVER:
        for topic in sorted(streams):
            prefix = topic.removesuffix(colour_end)
            if prefix != topic and prefix + depth_end in streams:
                depth = prefix + depth_end
                infos = [name.removesuffix("image_raw") + "camera_info" for name in (topic, depth)]
                return _Pair(streams[topic], streams[depth], infos[0], infos[1], False)
    raise CaptureError(
        path,
        "holds no colour and depth streams; record both (with the ROS driver: "
        "aligned_depth_to_color)",
    )


def _camera(path: AnyPath, info: Any) -> Camera:
    """Return the camera of a ``sensor_msgs/CameraInfo``."""
    if info is None:
        raise CaptureError(path, "states no intrinsics (camera_info) of a stream: record them too")
    matrix = np.asarray(info.K, np.float64).reshape(-1)
    model = str(info.distortion_model).lower().replace(" ", "_")
    lens = np.asarray(info.D, np.float64).reshape(-1)
    if len(matrix) != 9 or not np.isfinite(lens).all():
        raise CaptureError(path, "its intrinsics must be nine numbers and a lens")
    if np.any(lens) and (model not in _PINHOLES or np.any(lens[5:])):
        # The recorder's inverse model undoes what ours does; its terms are near zero in fact.
        if "inverse" not in model or np.abs(lens[:5]).max() > 0.2:
            raise CaptureError(path, f"has a lens of the model {model[:30]!r}, which is not read")
        lens = np.zeros(5)
    size = (int(info.width), int(info.height))
    return stated_camera(path, size, matrix[[0, 4, 2, 5]], lens[:5])


def _depth_to_colour(path: AnyPath, bag: Any, pair: _Pair) -> np.ndarray:
    """Return how the depth lens stands to the colour lens.

    The recorder writes for each stream the transform from one reference stream to it.
    """
    if not pair.recorded:
        return np.eye(4)
    to_stream = []
    prefixes = [stream.topic.removesuffix("/image/data") for stream in (pair.colour, pair.depth)]
    known = set(bag.topics())
    groups = [n for n in range(MAX_GROUPS) if all(f"{p}/tf/{n}" in known for p in prefixes)]
    if not groups:
        raise CaptureError(path, "does not say how its lenses stand to each other: record tf/0")
    for prefix in prefixes:
        message = bag.first(f"{prefix}/tf/{groups[0]}")
        t, q = message.translation, message.rotation
        to_stream.append(pose_of(np.array([t.x, t.y, t.z]), np.array([q.x, q.y, q.z, q.w])))
    if not all(np.isfinite(transform).all() for transform in to_stream):
        raise CaptureError(path, "says that its lenses stand nowhere (tf is not finite)")
    return to_stream[0] @ invert_rigid(to_stream[1])


def _unit(path: AnyPath, bag: Any) -> tuple[float, tuple[str, ...]]:
    """Return metres per unit of depth."""
    for topic in bag.topics():
        if _UNITS.fullmatch(topic):
            unit_m = float(np.float32(bag.first(topic).data))
            if not 1e-6 < unit_m < 0.1:
                raise CaptureError(
                    path, f"states a depth unit of {unit_m} m; 1e-06 to 0.1 are read"
                )
            return float(f"{unit_m:.6g}"), ()
    return DEFAULT_UNIT_M, ("the bag states no depth unit: millimetres are taken",)
