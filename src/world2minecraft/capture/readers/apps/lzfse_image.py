"""Images of single values packed with LZFSE, as Record3D keeps depth and confidence.

Such a file states no width or height, only a chain of blocks that say how many bytes they unpack
to. The chain is walked and held against the expected size before anything is unpacked.
"""

import struct
from dataclasses import dataclass

import numpy as np

from world2minecraft.capture.image_names import NamedByFile
from world2minecraft.capture.images import MAX_PIXELS, ImageHeader
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.errors import DamagedFileError, LimitError, MissingExtraError
from world2minecraft.core.files import read_bytes

MAX_FILE_BYTES = 4 * MAX_PIXELS
_END = b"bvx$"
_STORED = b"bvx-"
_LZVN = b"bvxn"
_CODED = b"bvx2"
_CODED_V1 = b"bvx1"
_V1_HEADER_BYTES = 772
_MODES = {"float32": np.float32, "L": np.uint8}


@dataclass(frozen=True)
class LzfseImage(NamedByFile):
    """An ``ImageSource``: ``mode`` is ``float32`` for depth in metres, ``L`` for confidence."""

    path: AnyPath
    width_px: int
    height_px: int
    mode: str

    @property
    def expected_bytes(self) -> int:
        """How many bytes the image unpacks to."""
        return self.width_px * self.height_px * np.dtype(_MODES[self.mode]).itemsize

    def header(self) -> ImageHeader:
        """Return the size that the capture states."""
        return ImageHeader(self.width_px, self.height_px, self.mode)

    def check_whole(self) -> None:
        """Check that the blocks are all there and unpack to this size."""
        self._checked()

    def colour(self) -> np.ndarray:
        """Raise: there is no colour in it."""
        raise DamagedFileError(self.path, "holds single values, not colours")

    def raw(self) -> np.ndarray:
        """Return [H, W] float32 metres, or uint8 confidence."""
        data = self._checked()
        if data[:3] == b"bvx":
            data = unpacked(self.path, data)
        if len(data) != self.expected_bytes:
            reason = f"unpacks to {len(data):,} bytes, not {self.expected_bytes:,}; copy it again"
            raise DamagedFileError(self.path, reason)
        values = np.frombuffer(data, _MODES[self.mode])
        return values.reshape(self.height_px, self.width_px).copy()

    def _checked(self) -> bytes:
        data = read_bytes(self.path, MAX_FILE_BYTES)
        size = unpacked_bytes(self.path, data)
        if size != self.expected_bytes:
            kind = LimitError if size > MAX_FILE_BYTES else DamagedFileError
            raise kind(
                self.path,
                f"unpacks to {size:,} bytes where {self.width_px}x{self.height_px} of "
                f"{self.mode} are {self.expected_bytes:,}; copy it again",
            )
        return data


def unpacked_bytes(path: AnyPath, data: bytes) -> int:
    """Return how many bytes a file says it unpacks to; one that is not packed, its length.

    Raises:
        DamagedFileError: it is empty, its chain of blocks breaks off, or holds an unknown kind.
    """
    if data[:3] != b"bvx":
        if not data:
            raise DamagedFileError(path, "is empty; copy it again")
        return len(data)
    place = total = 0
    while data[place : place + 4] != _END:
        try:
            raw, size = _block(data, place)
        except struct.error as error:
            raise DamagedFileError(
                path, "is cut short (LZFSE without its end); copy it again"
            ) from error
        if size <= 0 or place + size > len(data):
            raise DamagedFileError(path, "is cut short or damaged (LZFSE); copy it again")
        total, place = total + raw, place + size
    return total


def _block(data: bytes, place: int) -> tuple[int, int]:
    """Return the bytes that a block unpacks to, and its own length; 0 for an unknown kind."""
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


def unpacked(path: AnyPath, data: bytes) -> bytes:
    """Unpack LZFSE whose size was checked.

    Raises:
        DamagedFileError: the blocks are damaged. MissingExtraError: ``lzfse`` is not installed.
    """
    try:
        import lzfse  # noqa: PLC0415
    except ImportError as error:
        raise MissingExtraError("reading Record3D's depth", "capture") from error
    try:
        return lzfse.decompress(data)
    except lzfse.error as error:
        raise DamagedFileError(path, "cannot be unpacked (LZFSE); copy it again") from error
