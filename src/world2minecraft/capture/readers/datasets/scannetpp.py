"""Reader of ScanNet++ iPhone data: ``pose_intrinsic_imu.json``, a video and ``depth.bin``.

The JSON file has an entry per frame, such as ``frame_000012``, with ``aligned_pose`` (4x4,
camera-to-world, OpenCV axes, z up) or ``pose``, and ``intrinsic`` (3x3, at the size of the video).
Colour images are in ``rgb.mkv`` or ``rgb.mp4``, or are files in ``rgb/``. ``depth.bin`` contains
256x192 pixels per frame: the size in bytes as uint32, then millimetres compressed with LZ4 or float
metres compressed with deflate. Alternatively, ``depth/`` contains image files.
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
from world2minecraft.capture.readers.datasets.text_tables import files_with_suffix, numbered_files
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
    """A reader of the iPhone recordings of ScanNet++ scenes."""

    layout = "iphone/pose_intrinsic_imu.json with rgb.mkv and depth.bin (ScanNet++)"

    def recognise(self, folder: AnyPath) -> bool:
        """Return whether the folder or its ``iphone`` subfolder contains the file of poses."""
        return _iphone_folder(folder) is not None

    def read(self, folder: AnyPath) -> Capture:
        """Read the frames of a ScanNet++ iPhone recording.

        Raises:
            CaptureError: If poses, intrinsics or images are missing or not valid.
            DamagedFileError: If the depth file is damaged.
        """
        place = _iphone_folder(folder) or folder
        entries = _entries(place / POSES)
        pictures, depths = _pictures(place, entries), _depths(place)
        size = first_image_size([pictures[min(pictures)]] if pictures else [])
        if size is None:
            raise CaptureError(place, f"contains no readable colour images ({VIDEOS[0]} or rgb/)")
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
    """Return the JSON entry of each frame by number."""
    stated = read_json(path)
    entries = {}
    for key, entry in stated.items() if isinstance(stated, dict) else ():
        digits = key.removeprefix("frame_")
        if not digits.isdecimal() or len(digits) > 9 or not isinstance(entry, dict):
            raise CaptureError(
                path, f"must contain keys of the form frame_000000, got {key[:40]!r}"
            )
        entries[int(digits)] = entry
    if not entries:
        raise CaptureError(
            path, 'must contain frames of the form "frame_000000": {aligned_pose, intrinsic}'
        )
    return entries


def _files(folder: AnyPath) -> dict[int, ImagePlace]:
    """Return the images of a folder, such as ``frame_000012.jpg``, by number."""
    return dict(numbered_files(files_with_suffix(folder, SUFFIXES), "frame_"))


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
    """Return the position of each frame in a ``depth.bin``; incomplete frames are skipped."""
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
                    f"frame {len(found)} has {length:,} bytes: the file is damaged or "
                    "compressed as a whole; unpack it with prepare_iphone_data.py of the "
                    "data set",
                )
            position += _SIZE.size
            if length > size - position:
                break
            found.append(PackedDepth(path, position, length, f"{len(found):06d} depth"))
            position += length
    return found


@dataclass(frozen=True)
class PackedDepth(FileSlice):
    """A depth image in a ``depth.bin``."""

    def header(self) -> ImageHeader:
        """Return the size and mode shared by all depth images."""
        return ImageHeader(*DEPTH_SIZE, "uint16")

    def check_whole(self) -> None:
        """Do nothing, because incomplete frames have already been skipped."""

    def colour(self) -> np.ndarray:
        """Raise DamagedFileError, because a depth image has no colours."""
        raise DamagedFileError(self, "contains depth, not colours")

    def raw(self) -> np.ndarray:
        """Return the depth in millimetres as uint16 [192, 256].

        Raises:
            DamagedFileError: If the image cannot be decompressed.
        """
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
        """Decompress float metres, at most the size of a frame."""
        try:
            plain = zlib.decompressobj(-zlib.MAX_WBITS).decompress(data, 4 * PIXELS + 1)
        except zlib.error as error:
            raise DamagedFileError(
                self, f"cannot be decompressed ({error}); copy the file again"
            ) from error
        if len(plain) != 4 * PIXELS:
            raise DamagedFileError(
                self, f"decompresses to {len(plain):,} bytes, expected {4 * PIXELS:,}"
            )
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
        problem=problem if picture or depth else "has neither a colour nor a depth image",
    )


def _matrix(path: AnyPath, name: str, stated: Any, side: int) -> np.ndarray:
    matrix = as_floats(stated)
    if matrix.size != side * side:
        raise CaptureError(path, f"{name} must contain a {side}x{side} matrix")
    return matrix.reshape(side, side)
