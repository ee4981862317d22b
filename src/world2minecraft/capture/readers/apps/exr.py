"""Reader of depth in OpenEXR files, as exported by Record3D and the 3D Scanner App.

Supported are single-part scan-line files, uncompressed or with ZIP compression, with float or half
channels. The first channel is the depth in metres. The implementation follows the public format
description at openexr.com.

The OpenEXR library is not used for untrusted files, because it prints to stderr for each damaged
file and decompresses a whole file to check that it is complete.
"""

import struct
import zlib
from dataclasses import dataclass

import numpy as np

from world2minecraft.capture.images import MAX_PIXELS, ImageHeader, NamedByFile
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.errors import DamagedFileError, LimitError
from world2minecraft.core.files import read_bytes

MAGIC = b"\x76\x2f\x31\x01"
MAX_HEADER_BYTES = 1 << 20
MAX_FILE_BYTES = 1 << 29
_LINES = {0: 1, 2: 1, 3: 16}  # Scan lines in a chunk by compression: none, ZIPS, ZIP.
_TYPES = {1: np.dtype("<f2"), 2: np.dtype("<f4"), 0: np.dtype("<u4")}


@dataclass(frozen=True)
class _Layout:
    width_px: int
    height_px: int
    first_row: int
    lines: int
    packed: bool
    channels: tuple[np.dtype, ...]
    data_start: int

    @property
    def row_bytes(self) -> int:
        return self.width_px * sum(kind.itemsize for kind in self.channels)

    @property
    def chunks(self) -> int:
        return -(-self.height_px // self.lines)


@dataclass(frozen=True)
class ExrImage(NamedByFile):
    """A float32 depth image in an OpenEXR file. It implements ``ImageSource``."""

    path: AnyPath

    def header(self) -> ImageHeader:
        """Return the size and mode of the image."""
        with self.path.open("rb") as stream:
            layout = _read_layout(self.path, stream.read(MAX_HEADER_BYTES))
        return ImageHeader(layout.width_px, layout.height_px, "float32")

    def check_whole(self) -> None:
        """Check that the file contains every chunk of scan lines."""
        data = read_bytes(self.path, MAX_FILE_BYTES)
        list(_read_chunks(self.path, data, _read_layout(self.path, data)))

    def colour(self) -> np.ndarray:
        """Raise DamagedFileError, because a depth image has no colours."""
        raise DamagedFileError(self.path, "contains depth, not colours")

    def raw(self) -> np.ndarray:
        """Return the first channel as float32 [H, W]."""
        data = read_bytes(self.path, MAX_FILE_BYTES)
        layout = _read_layout(self.path, data)
        depth = np.zeros((layout.height_px, layout.width_px), np.float32)
        for row, chunk in _read_chunks(self.path, data, layout):
            lines = min(layout.lines, layout.height_px - row)
            pixels = _unpack(self.path, chunk, lines * layout.row_bytes, layout.packed)
            first = layout.width_px * layout.channels[0].itemsize
            values = pixels.reshape(lines, -1)[:, :first].copy().view(layout.channels[0])
            depth[row : row + lines] = values
        return depth


def _read_layout(path: AnyPath, data: bytes) -> _Layout:
    """Read the header and check the image size before memory is allocated."""
    if data[:4] != MAGIC:
        raise DamagedFileError(path, "is not an OpenEXR file; copy the file again")
    try:
        (version,) = struct.unpack_from("<I", data, 4)
        if version & 0xFF != 2 or version & 0x1A00:
            raise DamagedFileError(
                path,
                "is a tiled, deep or multi-part OpenEXR file, which is not supported; "
                "save it as scan lines",
            )
        held, place = _read_attributes(data)
        x0, y0, x1, y1 = struct.unpack("<4i", held[b"dataWindow"])
        compression = held[b"compression"][0]
        channels = _read_channels(held[b"channels"])
    except (struct.error, KeyError, IndexError, ValueError) as error:
        raise DamagedFileError(
            path, "has an incomplete OpenEXR header; copy the file again"
        ) from error
    if compression not in _LINES or not channels:
        raise DamagedFileError(
            path, "has an unsupported OpenEXR compression; save the file with ZIP compression"
        )
    width, height = x1 - x0 + 1, y1 - y0 + 1
    if width <= 0 or height <= 0:
        raise DamagedFileError(path, "has an image size of 0 pixels; export the file again")
    if width * height * len(channels) > MAX_PIXELS:
        raise LimitError(
            path,
            f"has a size of {width}x{height} pixels, which is too large; export a smaller image",
        )
    return _Layout(width, height, y0, _LINES[compression], compression > 0, channels, place)


def _read_attributes(data: bytes) -> tuple[dict[bytes, bytes], int]:
    """Return the attributes of the header by name, and the end of the header."""
    held: dict[bytes, bytes] = {}
    place = 8
    while data[place] != 0:
        end = data.index(b"\0", place, place + 256)
        kind_end = data.index(b"\0", end + 1, end + 257)
        (size,) = struct.unpack_from("<I", data, kind_end + 1)
        start = kind_end + 5
        if start + size >= len(data):
            raise ValueError("an attribute extends beyond the end of the file")
        held[data[place:end]] = data[start : start + size]
        place = start + size
    return held, place + 1


def _read_channels(listed: bytes) -> tuple[np.dtype, ...]:
    """Return the types of the channels, in the order of storage."""
    kinds = []
    place = 0
    while listed[place] != 0:
        end = listed.index(b"\0", place)
        kind, _, across, down = struct.unpack_from("<iiii", listed, end + 1)
        if (across, down) != (1, 1) or kind not in _TYPES:
            raise ValueError("a channel is subsampled or has an unknown type")
        kinds.append(_TYPES[kind])
        place = end + 17
    return tuple(kinds)


def _read_chunks(path: AnyPath, data: bytes, layout: _Layout) -> list[tuple[int, bytes]]:
    """Return the first row and the bytes of each chunk of scan lines.

    Raises:
        DamagedFileError: If a chunk is outside the file or the image.
    """
    found = []
    try:
        offsets = struct.unpack_from(f"<{layout.chunks}Q", data, layout.data_start)
        for offset in offsets:
            row, size = struct.unpack_from("<ii", data, offset)
            row -= layout.first_row
            inside = 0 <= row < layout.height_px and row % layout.lines == 0
            if not inside or size < 0 or offset + 8 + size > len(data):
                raise DamagedFileError(
                    path, "is truncated or damaged (OpenEXR); copy the file again"
                )
            found.append((row, data[offset + 8 : offset + 8 + size]))
    except (struct.error, OverflowError) as error:
        raise DamagedFileError(path, "is truncated (OpenEXR); copy the file again") from error
    return found


def _unpack(path: AnyPath, chunk: bytes, size: int, packed: bool) -> np.ndarray:
    """Decompress a chunk to uint8 [size]; incompressible chunks are stored uncompressed."""
    if not packed or len(chunk) == size:
        if len(chunk) != size:
            raise DamagedFileError(
                path, "has scan lines of an unexpected length; copy the file again"
            )
        return np.frombuffer(chunk, np.uint8)
    try:
        raw = zlib.decompressobj().decompress(chunk, size + 1)
    except zlib.error as error:
        raise DamagedFileError(
            path, f"cannot be decompressed ({error}); copy the file again"
        ) from error
    if len(raw) != size:
        raise DamagedFileError(path, "has scan lines of an unexpected length; copy the file again")
    # Bytes are kept as differences, first those at even places, then those at odd ones.
    steps = np.frombuffer(raw, np.uint8).astype(np.int64)
    steps[1:] -= 128
    values = np.cumsum(steps).astype(np.uint8)
    result = np.empty(size, np.uint8)
    half = (size + 1) // 2
    result[0::2], result[1::2] = values[:half], values[half:]
    return result
