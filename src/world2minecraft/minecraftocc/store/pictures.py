"""Colour and depth of a sample as files, and back.

Depth is a grey PNG of 16 bits in whole millimetres, 0 for nothing, 65535 for all that is farther.
It is packed here and not by Pillow, which tries five filters on every row: a quarter of the time.
"""

import io
import struct
import zlib
from pathlib import Path

import numpy as np
from PIL import Image

from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.types import Camera
from world2minecraft.rendering.output.images import PER_METRE, colour_bytes, depth_numbers

IMAGE_FORMATS = ("jpg", "png", "webp")
QUALITY = 95  # Of JPEG and WebP: the eye sees no loss, and edges of blocks stay sharp.
_UP = 2  # The filter of every row: the difference to the row above, for planes small and regular.
_GREY = 0


def picture_bytes(colour: np.ndarray, kind: str, quality: int = QUALITY) -> bytes:
    """Return colour, uint8 [H, W, 3], as a file of a kind of ``IMAGE_FORMATS``."""
    return colour_bytes(colour, f".{kind}", quality)


def depth_png(depth_m: np.ndarray) -> bytes:
    """Return depth, float32 [H, W] in metres, as a PNG of 16 bits at deflate level 1."""
    numbers = depth_numbers(depth_m, PER_METRE)
    height, width = numbers.shape
    rows = np.zeros((height, 1 + 2 * width), np.uint8)
    rows[:, 0] = _UP
    raw = numbers.astype(">u2").view(np.uint8)
    rows[0, 1:] = raw[0]
    np.subtract(raw[1:], raw[:-1], out=rows[1:, 1:])
    header = struct.pack(">IIBBBBB", width, height, 16, _GREY, 0, 0, 0)
    parts = ((b"IHDR", header), (b"IDAT", zlib.compress(rows.tobytes(), 1)), (b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(_chunk(kind, data) for kind, data in parts)


def colour_of(data: bytes, camera: Camera, source: str | Path) -> np.ndarray:
    """Return the colours, uint8 [H, W, 3], of a file that is as large as its camera says.

    Raises:
        DamagedFileError: it is no such picture.
    """
    return np.array(_opened(data, camera, source, ("JPEG", "PNG", "WEBP")).convert("RGB"))


def depth_of(data: bytes, camera: Camera, source: str | Path) -> np.ndarray:
    """Return the depth, float32 [H, W] in metres, of a PNG of ``depth_png``. Raises as above."""
    numbers = np.asarray(_opened(data, camera, source, ("PNG",)))
    if numbers.ndim != 2:
        raise DamagedFileError(source, "its depth is no grey picture")
    return numbers.astype(np.float32) / np.float32(PER_METRE)


def _opened(
    data: bytes, camera: Camera, source: str | Path, formats: tuple[str, ...]
) -> Image.Image:
    """Decode a picture, its size compared before any memory is taken."""
    size = (camera.width_px, camera.height_px)
    try:
        image = Image.open(io.BytesIO(data), formats=formats)
        if image.size != size:
            told = "x".join(map(str, image.size))
            raise DamagedFileError(source, f"a picture is {told}, not {size[0]}x{size[1]}")
        image.load()
    except (OSError, ValueError, SyntaxError, struct.error, Image.DecompressionBombError) as error:
        raise DamagedFileError(source, f"a picture cannot be read ({error})") from error
    return image


def _chunk(kind: bytes, data: bytes) -> bytes:
    checksum = zlib.crc32(data, zlib.crc32(kind))
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", checksum)
