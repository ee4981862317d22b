"""Reader of Record3D's ``.r3d`` files and its EXR + JPG export, packed or unpacked.

``metadata`` (or ``metadata.json``) contains the image size ``w``, ``h``, the depth size ``dw``,
``dh``, the intrinsic matrix ``K`` (column-major), in newer versions ``perFrameIntrinsicCoeffs``
(fx, fy, cx, cy), and ``poses`` (qx qy qz qw x y z, camera-to-world, OpenGL axes). ``rgbd/N.jpg``,
``N.depth`` (LZFSE, float32 metres) and ``N.conf`` (LZFSE, 0 to 2) form one frame. The front camera
is not tracked, so all its poses are identical.

An LZFSE file states no image size. It is a chain of blocks, each with its decompressed size. The
total is compared with the expected size before decompression.
"""

import math
import struct
from dataclasses import dataclass
from typing import Any

import numpy as np

from world2minecraft.capture.images import MAX_PIXELS, ImageHeader, ImagePlace, NamedByFile
from world2minecraft.capture.readers.apps.app_values import (
    ARKIT_UP,
    arkit_pose_of_quaternion,
    files_by_stem,
    parse_camera,
    parse_number,
    parse_numbers,
)
from world2minecraft.capture.readers.apps.exr import ExrImage
from world2minecraft.capture.source_types import Capture, FrameFiles
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.errors import (
    CaptureError,
    DamagedFileError,
    InputError,
    LimitError,
    MissingExtraError,
)
from world2minecraft.core.files import read_bytes, read_json
from world2minecraft.core.types import Camera
from world2minecraft.geometry.rotations import pose_from_quaternion

MAX_FILE_BYTES = 4 * MAX_PIXELS
_END = b"bvx$"
_STORED = b"bvx-"
_LZVN = b"bvxn"
_CODED = b"bvx2"
_CODED_V1 = b"bvx1"
_V1_HEADER_BYTES = 772
_MODES = {"float32": np.float32, "L": np.uint8}
_PICTURES = (".jpg", ".jpeg", ".png")
_MIN_POSE_CHANGE = 1e-6  # Poses that differ by less were never tracked.
MIN_UP_IN_IMAGE = 0.5  # Cameras that look steeply up or down say little of their roll.
MAX_ROLL_DEG = 15.0  # Limit for most frames; hand-held phones roll by about 5 degrees.


@dataclass(frozen=True)
class LzfseImage(NamedByFile):
    """An LZFSE-compressed image. It implements ``ImageSource``.

    Attributes:
        path: The file.
        width_px: Width in pixels.
        height_px: Height in pixels.
        mode: ``float32`` for depth in metres, or ``L`` for confidence.
    """

    path: AnyPath
    width_px: int
    height_px: int
    mode: str

    @property
    def expected_bytes(self) -> int:
        """The size in bytes of the decompressed image."""
        return self.width_px * self.height_px * np.dtype(_MODES[self.mode]).itemsize

    def header(self) -> ImageHeader:
        """Return the size and mode stated by the capture."""
        return ImageHeader(self.width_px, self.height_px, self.mode)

    def check_whole(self) -> None:
        """Check that all blocks are present and decompress to the expected size."""
        self._checked()

    def colour(self) -> np.ndarray:
        """Raise DamagedFileError, because the image has no colours."""
        raise DamagedFileError(self.path, "contains single values, not colours")

    def raw(self) -> np.ndarray:
        """Return the depth in metres as float32 [H, W], or the confidence as uint8 [H, W]."""
        data = self._checked()
        if data[:3] == b"bvx":
            data = decompress_lzfse(self.path, data)
        if len(data) != self.expected_bytes:
            reason = (
                f"decompresses to {len(data):,} bytes, expected {self.expected_bytes:,}; "
                "copy the file again"
            )
            raise DamagedFileError(self.path, reason)
        values = np.frombuffer(data, _MODES[self.mode])
        return values.reshape(self.height_px, self.width_px).copy()

    def _checked(self) -> bytes:
        data = read_bytes(self.path, MAX_FILE_BYTES)
        size = lzfse_unpacked_size(self.path, data)
        if size != self.expected_bytes:
            kind = LimitError if size > MAX_FILE_BYTES else DamagedFileError
            raise kind(
                self.path,
                f"decompresses to {size:,} bytes, expected {self.expected_bytes:,} for "
                f"{self.width_px}x{self.height_px} of {self.mode}; copy the file again",
            )
        return data


def lzfse_unpacked_size(path: AnyPath, data: bytes) -> int:
    """Return the decompressed size stated by an LZFSE file, or the length of an uncompressed file.

    Raises:
        DamagedFileError: If the file is empty or truncated, or contains an unknown block type.
    """
    if data[:3] != b"bvx":
        if not data:
            raise DamagedFileError(path, "is empty; copy the file again")
        return len(data)
    place = total = 0
    while data[place : place + 4] != _END:
        try:
            raw, size = _block(data, place)
        except struct.error as error:
            raise DamagedFileError(
                path, "is truncated (LZFSE without an end marker); copy the file again"
            ) from error
        if size <= 0 or place + size > len(data):
            raise DamagedFileError(path, "is truncated or damaged (LZFSE); copy the file again")
        total, place = total + raw, place + size
    return total


def _block(data: bytes, place: int) -> tuple[int, int]:
    """Return the decompressed and the compressed size of a block; 0 for an unknown block type."""
    kind, raw = struct.unpack_from("<4sI", data, place)
    if kind == _STORED:
        return raw, 8 + raw
    if kind == _LZVN:
        return raw, 12 + struct.unpack_from("<I", data, place + 8)[0]
    if kind == _CODED:
        first, second, third = struct.unpack_from("<QQQ", data, place + 8)
        payload = (first >> 20 & 0xFFFFF) + (second >> 40 & 0xFFFFF)
        return raw, (third & 0xFFFFFFFF) + payload
    if kind == _CODED_V1:
        payload, *_ = struct.unpack_from("<I", data, place + 8)
        return raw, _V1_HEADER_BYTES + payload
    return 0, 0


def decompress_lzfse(path: AnyPath, data: bytes) -> bytes:
    """Decompress LZFSE data whose size has been checked.

    Raises:
        DamagedFileError: If a block is damaged.
        MissingExtraError: If the ``lzfse`` library is not installed.
    """
    try:
        import lzfse  # noqa: PLC0415
    except ImportError as error:
        raise MissingExtraError("reading Record3D's depth", "capture") from error
    try:
        return lzfse.decompress(data)
    except lzfse.error as error:
        raise DamagedFileError(
            path, "cannot be decompressed (LZFSE); copy the file again"
        ) from error


class Record3DSource:
    """A reader of Record3D exports."""

    layout = "metadata with rgbd/0.jpg, .depth, .conf (Record3D, a .r3d file)"

    def recognise(self, folder: AnyPath) -> bool:
        """Return whether the folder contains Record3D metadata and frames."""
        if not folder.is_dir():
            return False
        packed = (folder / "metadata").is_file() and (folder / "rgbd").is_dir()
        exported = (folder / "metadata.json").is_file() and (folder / "rgb").is_dir()
        return packed or (exported and any((folder / "depth").glob("*.exr")))

    def read(self, folder: AnyPath) -> Capture:
        """Read the frames of a Record3D export.

        Raises:
            CaptureError: If the metadata or the frames are missing or not valid.
        """
        packed = (folder / "rgbd").is_dir()
        path = folder / ("metadata" if (folder / "metadata").is_file() else "metadata.json")
        stated = read_json(path)
        if not isinstance(stated, dict):
            raise CaptureError(path, "must be a JSON object with K, w, h and poses")
        named = files_by_stem(folder / ("rgbd" if packed else "rgb"), _PICTURES)
        pictures = {int(stem): path for stem, path in named.items() if _is_index(stem)}
        if not pictures:
            raise CaptureError(folder, "contains no frames (rgbd/0.jpg); export the data again")
        lenses, poses = _lenses(path, stated), _poses(path, stated)
        size = _depth_size(folder, path, stated) if packed else None
        notes: tuple[str, ...] = ()
        if poses is not None and len(poses) > 1 and np.ptp(poses, axis=0).max() < _MIN_POSE_CHANGE:
            poses = None
            notes = (
                "the capture has no poses: it was recorded with the front camera, which Record3D "
                "does not track",
            )
        frames = tuple(
            _frame(folder, index, picture, lenses, poses, size)
            for index, picture in sorted(pictures.items())
        )
        return Capture(
            folder,
            "record3d",
            frames,
            depth_unit="m",
            notes=notes,
            full_trust=2.0,
            world_up=_world_up(poses),
        )


def _is_index(stem: str) -> bool:
    return stem.isascii() and stem.isdigit() and len(stem) < 9


def _lenses(path: AnyPath, stated: dict[str, Any]) -> list[Camera | None]:
    """Return the cameras of the frames, or a single camera if all frames share it.

    A frame without valid intrinsics has None.
    """
    size = (parse_number(path, stated, "w"), parse_number(path, stated, "h"))
    each = stated.get("perFrameIntrinsicCoeffs")
    if isinstance(each, list) and each:
        lenses = [parse_numbers(path, "perFrameIntrinsicCoeffs", one, 4) for one in each]
        known = [bool(np.isfinite(lens).all() and lens.min() > 0) for lens in lenses]
        return [
            parse_camera(path, size, lens.tolist()) if is_known else None
            for lens, is_known in zip(lenses, known, strict=True)
        ]
    matrix = parse_numbers(path, "K", stated.get("K"), 9).reshape(3, 3)
    if matrix[0, 2] == 0 and matrix[1, 2] == 0:  # Column by column, as the app writes it.
        matrix = matrix.T
    return [parse_camera(path, size, [matrix[0, 0], matrix[1, 1], matrix[0, 2], matrix[1, 2]])]


def _poses(path: AnyPath, stated: dict[str, Any]) -> np.ndarray | None:
    """Return the poses as float64 [N, 7], or None if the metadata contains none."""
    values = stated.get("poses")
    if values is None:
        return None
    if not isinstance(values, list) or not values:
        raise CaptureError(path, '"poses" must be a list of qx, qy, qz, qw, x, y, z')
    return np.stack([parse_numbers(path, "poses", value, 7) for value in values])


def _world_up(poses: np.ndarray | None) -> np.ndarray | None:
    """Return the up direction, which is known in ARKit's world but not relative to the first frame.

    Some versions store poses relative to the first frame, whose rotation is then the identity; a
    trimmed video may start later. In a tilted world, cameras that look in all directions show roll.
    """
    if poses is None or not np.isfinite(poses[0]).all() or abs(poses[0, 3]) > 1 - 1e-6:
        return None
    finite = poses[np.isfinite(poses).all(axis=1)]
    cameras = np.stack([pose_from_quaternion(pose[4:], pose[:4]) for pose in finite])
    up = np.swapaxes(cameras[:, :3, :3], 1, 2) @ ARKIT_UP
    level = up[np.hypot(up[:, 0], up[:, 1]) > MIN_UP_IN_IMAGE]
    roll_deg = np.degrees(np.arctan2(level[:, 0], level[:, 1]))
    off_deg = np.abs((roll_deg + 45) % 90 - 45)
    return ARKIT_UP if len(level) and np.quantile(off_deg, 0.8) < MAX_ROLL_DEG else None


def _depth_size(folder: AnyPath, path: AnyPath, stated: dict[str, Any]) -> tuple[int, int] | None:
    """Return the width and height of the depth images, or None if there are none.

    Old versions do not state the size. It is then derived from the length of the first complete
    depth image and the aspect ratio of the colour images.
    """
    if "dw" in stated and "dh" in stated:
        sides = (parse_number(path, stated, "dw"), parse_number(path, stated, "dh"))
        if not all(side == int(side) and 0 < side <= 8192 for side in sides):
            raise CaptureError(path, f'"dw" and "dh" must be integers from 1 to 8192, got {sides}')
        return int(sides[0]), int(sides[1])
    shape = parse_number(path, stated, "w") / max(parse_number(path, stated, "h"), 1e-9)
    for depth in files_by_stem(folder / "rgbd", (".depth",)).values():
        try:
            pixels = lzfse_unpacked_size(depth, read_bytes(depth, MAX_FILE_BYTES)) / 4
        except InputError:
            continue
        high = round(math.sqrt(pixels / max(shape, 1e-9)))
        wide = round(pixels / max(high, 1))
        if wide * high == pixels and 0 < max(wide, high) <= 8192:
            return wide, high
        raise CaptureError(path, 'does not contain the depth size; add "dw" and "dh" in pixels')
    return None


def _frame(
    folder: AnyPath,
    index: int,
    picture: AnyPath,
    lenses: list[Camera | None],
    poses: np.ndarray | None,
    size: tuple[int, int] | None,
) -> FrameFiles:
    depth, trust = _depth(folder, picture.stem, size)
    lens = lenses[index] if index < len(lenses) else (lenses[0] if len(lenses) == 1 else None)
    pose, problem = None, ""
    if poses is not None and index < len(poses):
        pose = arkit_pose_of_quaternion(poses[index, :4], poses[index, 4:])
    elif poses is not None:
        problem = "has no pose in the metadata"
    if lens is None:
        problem = "has no intrinsics in the metadata"
    return FrameFiles(
        f"{index:06d}",
        pose,
        picture,
        lens,
        depth,
        lens if depth else None,
        problem=problem,
        trust_path=trust if depth else None,
    )


def _depth(
    folder: AnyPath, stem: str, size: tuple[int, int] | None
) -> tuple[ImagePlace | None, ImagePlace | None]:
    """Return the depth and confidence images of a colour image, or None for missing files."""
    if not (folder / "rgbd").is_dir():
        exported = folder / "depth" / f"{stem}.exr"
        return (ExrImage(exported) if exported.is_file() else None), None
    depth, trust = folder / "rgbd" / f"{stem}.depth", folder / "rgbd" / f"{stem}.conf"
    if size is None or not depth.is_file():
        return None, None
    return (
        LzfseImage(depth, *size, "float32"),
        LzfseImage(trust, *size, "L") if trust.is_file() else None,
    )
