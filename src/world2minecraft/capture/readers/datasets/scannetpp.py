"""Reader of ScanNet++'s iPhone data: ``pose_intrinsic_imu.json``, video, ``depth.bin``.

The JSON has an entry a frame, ``frame_000012``: ``aligned_pose`` (4x4, camera to world, OpenCV
axes, z up) or ``pose``, and ``intrinsic`` (3x3, of the video's size). Pictures are those of
``rgb.mkv`` or ``rgb.mp4``, or files in ``rgb/``. ``depth.bin`` has 256x192 pixels a frame: uint32
its size in bytes, then millimetres as LZ4 or float metres as deflate; ``depth/`` may hold files.
"""

import struct
import zlib
from dataclasses import dataclass
from typing import Any

import numpy as np

from world2minecraft.capture.images import SUFFIXES, ImageHeader, ImagePlace
from world2minecraft.capture.readers.apps.video_frames import VideoFrame
from world2minecraft.capture.readers.datasets.embedded_images import FileSlice, open_seekable
from world2minecraft.capture.readers.datasets.intrinsics import first_image_size, matrix_camera
from world2minecraft.capture.source_types import Capture, FrameFiles, as_floats
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.errors import CaptureError, DamagedFileError
from world2minecraft.core.files import read_json

POSES = "pose_intrinsic_imu.json"
VIDEOS = ("rgb.mkv", "rgb.mp4")
DEPTH_SIZE = (256, 192)
PIXELS = DEPTH_SIZE[0] * DEPTH_SIZE[1]
MAX_FRAME_BYTES = 5 * PIXELS  # Float metres that cannot be packed, and a little more.
MAX_FRAMES = 300_000
WORLD_UP = np.array([0.0, 0.0, 1.0])
_SIZE = struct.Struct("<I")


class ScanNetPpSource:
    """Reads the iPhone's recording of a ScanNet++ scene."""

    layout = "iphone/pose_intrinsic_imu.json with rgb.mkv and depth.bin (ScanNet++)"

    def recognise(self, folder: AnyPath) -> bool:
        """Return whether the poses lie there, or in ``iphone``."""
        return _iphone_folder(folder) is not None

    def read(self, folder: AnyPath) -> Capture:
        """List the frames. Raises CaptureError as ``Source.read`` does."""
        place = _iphone_folder(folder) or folder
        entries = _entries(place / POSES)
        pictures, depths = _pictures(place, entries), _depths(place)
        size = first_image_size([pictures[min(pictures)]] if pictures else [])
        if size is None:
            raise CaptureError(place, f"has no picture that can be read ({VIDEOS[0]} or rgb/)")
        frames = tuple(
            _frame(place / POSES, number, entry, size, pictures.get(number), depths.get(number))
            for number, entry in sorted(entries.items())
        )
        aligned = all("aligned_pose" in entry for entry in entries.values())
        up = WORLD_UP if aligned else None
        return Capture(folder, "scannetpp", frames, depth_unit="mm", world_up=up)


def _iphone_folder(folder: AnyPath) -> AnyPath | None:
    return next((at for at in (folder, folder / "iphone") if (at / POSES).is_file()), None)


def _entries(path: AnyPath) -> dict[int, dict[str, Any]]:
    """Return what is stated of each frame, by its number."""
    stated = read_json(path)
    entries = {}
    for key, entry in stated.items() if isinstance(stated, dict) else ():
        digits = key.removeprefix("frame_")
        if not digits.isdecimal() or len(digits) > 9 or not isinstance(entry, dict):
            raise CaptureError(path, f"must hold frame_000000 and so on, not {key[:40]!r}")
        entries[int(digits)] = entry
    if not entries:
        raise CaptureError(path, 'must hold "frame_000000": {aligned_pose, intrinsic} and so on')
    return entries


def _files(folder: AnyPath) -> dict[int, ImagePlace]:
    """Return the images ``frame_000012.jpg`` of a folder by number."""
    found: dict[int, ImagePlace] = {}
    for path in sorted(folder.glob("frame_*"), key=str) if folder.is_dir() else ():
        digits = path.stem.removeprefix("frame_")
        if digits.isdecimal() and len(digits) <= 9 and path.suffix.lower() in SUFFIXES:
            found[int(digits)] = path
    return found


def _pictures(place: AnyPath, entries: dict[int, dict[str, Any]]) -> dict[int, ImagePlace]:
    files = _files(place / "rgb")
    video = next((place / name for name in VIDEOS if (place / name).is_file()), None)
    if files or video is None:
        return files
    return {number: VideoFrame(video, number) for number in entries}


def _depths(place: AnyPath) -> dict[int, ImagePlace]:
    files = _files(place / "depth")
    path = place / "depth.bin"
    if files or not path.is_file():
        return files
    return dict(enumerate(_packed_depth_images(path)))


def _packed_depth_images(path: AnyPath) -> list[ImagePlace]:
    """Return where each frame of a ``depth.bin`` lies; the whole ones of a file cut short."""
    found: list[ImagePlace] = []
    size = int(path.stat().st_size)
    position = 0
    with open_seekable(path) as stream:
        while size - position >= _SIZE.size and len(found) < MAX_FRAMES:
            stream.seek(position)
            (length,) = _SIZE.unpack(stream.read(_SIZE.size))
            if not 0 < length <= MAX_FRAME_BYTES:
                raise DamagedFileError(
                    path,
                    f"frame {len(found)} has {length:,} bytes: it is damaged, or packed as a "
                    "whole; unpack it with the data set's prepare_iphone_data.py",
                )
            position += _SIZE.size
            if length > size - position:
                break
            found.append(PackedDepth(path, position, length, f"{len(found):06d} depth"))
            position += length
    return found


@dataclass(frozen=True)
class PackedDepth(FileSlice):
    """One depth image of a ``depth.bin``."""

    def header(self) -> ImageHeader:
        """Return the size that all of them have."""
        return ImageHeader(*DEPTH_SIZE, "uint16")

    def check_whole(self) -> None:
        """Check nothing: the list of frames holds whole ones alone."""

    def colour(self) -> np.ndarray:
        """Refuse: depth is no colour."""
        raise DamagedFileError(self, "holds depth, no colours")

    def raw(self) -> np.ndarray:
        """Return uint16 [192, 256] millimetres. Raises DamagedFileError."""
        from lz4.block import LZ4BlockError, decompress  # noqa: PLC0415

        data = self.part(0, self.size)
        try:
            plain = decompress(data, uncompressed_size=2 * PIXELS)
        except (LZ4BlockError, ValueError):
            return self._inflated(data)
        if len(plain) != 2 * PIXELS:
            return self._inflated(data)
        return np.frombuffer(plain, "<u2").reshape(DEPTH_SIZE[::-1]).astype(np.uint16)

    def _inflated(self, data: bytes) -> np.ndarray:
        """Unpack float metres, never more than a frame has."""
        try:
            plain = zlib.decompressobj(-zlib.MAX_WBITS).decompress(data, 4 * PIXELS + 1)
        except zlib.error as error:
            raise DamagedFileError(self, f"cannot be unpacked ({error}); copy it again") from error
        if len(plain) != 4 * PIXELS:
            raise DamagedFileError(self, f"unpacks to {len(plain):,} bytes, not {4 * PIXELS:,}")
        metres = np.frombuffer(plain, "<f4").reshape(DEPTH_SIZE[::-1]).astype(np.float64)
        millimetres = np.round(np.nan_to_num(metres, nan=0, posinf=0, neginf=0) * 1000)
        return np.clip(millimetres, 0, 65535).astype(np.uint16)


def _frame(
    path: AnyPath,
    number: int,
    entry: dict[str, Any],
    size: tuple[int, int],
    picture: ImagePlace | None,
    depth: ImagePlace | None,
) -> FrameFiles:
    name = f"frame_{number:06d}"
    camera = matrix_camera(path, size, _matrix(path, name, entry.get("intrinsic"), 3))
    stated = entry.get("aligned_pose", entry.get("pose"))
    pose = None if stated is None else _matrix(path, name, stated, 4)
    problem = "" if pose is not None else "has no aligned_pose"
    return FrameFiles(
        name,
        pose,
        picture,
        camera if picture else None,
        depth,
        camera if depth else None,
        problem=problem if picture or depth else "has neither picture nor depth",
    )


def _matrix(path: AnyPath, name: str, stated: Any, side: int) -> np.ndarray:
    matrix = as_floats(stated)
    if matrix.size != side * side:
        raise CaptureError(path, f"{name} must state a matrix of {side} rows of {side}")
    return matrix.reshape(side, side)
