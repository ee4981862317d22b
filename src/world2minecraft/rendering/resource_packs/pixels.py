"""PNG bytes become pixels: the first frame of an animation, as a square of a power of two."""

import io
import struct
from collections.abc import Mapping
from typing import Any

import numpy as np
from PIL import Image

from world2minecraft.rendering.resource_packs.json_checks import listing, mapping, number
from world2minecraft.rendering.texture import MOST_PX

MOST_PIXELS = 1 << 25  # 32 frames of 1024 x 1024.
_HEAD = b"\x89PNG\r\n\x1a\n\x00\x00\x00\rIHDR"


def png_size(data: bytes) -> tuple[int, int]:
    """Return the width and height that a PNG says it has; ValueError where it is none."""
    if not data.startswith(_HEAD) or len(data) < 24:
        raise ValueError("is no PNG")
    width, height = struct.unpack(">II", data[16:24])
    return width, height


def decode_png(data: bytes) -> np.ndarray:
    """Return uint8 [H, W, 4] of a PNG, its size checked before it is unpacked.

    Raises:
        ValueError: it is no PNG, is damaged or too large.
    """
    width, height = png_size(data)
    if not 0 < width * height <= MOST_PIXELS:
        raise ValueError(f"has {width} x {height} pixels; at most {MOST_PIXELS:,} are read")
    try:
        with Image.open(io.BytesIO(data), formats=("PNG",)) as image:
            if image.mode.startswith("I"):  # 16 bits of grey.
                grey = Image.fromarray((np.asarray(image) >> 8).astype(np.uint8))
                return np.array(grey.convert("RGBA"))
            return np.array(image.convert("RGBA"))
    except Exception as error:  # Pillow raises dozens of kinds over damaged files.
        raise ValueError(f"is a damaged PNG ({error})") from error


def first_frame(pixels: np.ndarray, animation: Mapping[str, Any] | None) -> np.ndarray:
    """Return the frame that an animation begins with, the whole picture where there is none.

    Args:
        pixels: uint8 [H, W, 4].
        animation: the ``animation`` object of the ``.mcmeta`` file beside the picture.

    Raises:
        ValueError: the animation is not as the format says.
    """
    if animation is None:
        return pixels
    height, width = pixels.shape[:2]
    wide, tall = animation.get("width"), animation.get("height")
    if wide is None and tall is None:
        wide = tall = min(width, height)
    wide = int(number(width if wide is None else wide, "width of a frame", 1, width))
    tall = int(number(height if tall is None else tall, "height of a frame", 1, height))
    index = _first_index(animation.get("frames"))
    columns, rows = width // wide, height // tall
    if index >= columns * rows:
        raise ValueError(f"its first frame is {index}, but it has {columns * rows}")
    row, column = divmod(index, columns)
    return pixels[row * tall : (row + 1) * tall, column * wide : (column + 1) * wide]


def _first_index(frames: Any) -> int:
    if frames is None or frames == []:
        return 0
    first = listing(frames, "frames", 100_000)[0]
    if isinstance(first, dict):
        first = mapping(first, "a frame").get("index")
    return int(number(first, "index of a frame", 0, 100_000))


def side_for(pixels: np.ndarray, most_px: int) -> int:
    """Return the side of the square texture for a frame: a power of two that holds it."""
    longest = max(pixels.shape[:2])
    return min(1 << (longest - 1).bit_length(), most_px, MOST_PX)


def resampled(pixels: np.ndarray, side_px: int) -> np.ndarray:
    """Return uint8 [N, N, C]: each pixel the mean of the area that it covers.

    Colours of four channels count by their alpha, so that no dark rim creeps in from holes.
    """
    if pixels.shape[:2] == (side_px, side_px):
        return pixels
    down, across = (_area_weights(count, side_px) for count in pixels.shape[:2])
    values = pixels.astype(np.float64)
    if pixels.shape[2] != 4:
        return _bytes(np.einsum("ij,kl,jlc->ikc", down, across, values, optimize=True))
    alpha = np.where(values[..., 3:] == 0, 1e-6, values[..., 3:])
    values[..., :3] *= alpha
    values[..., 3:] = alpha
    mean = np.einsum("ij,kl,jlc->ikc", down, across, values, optimize=True)
    mean[..., :3] /= mean[..., 3:]
    return _bytes(mean)


def _bytes(values: np.ndarray) -> np.ndarray:
    return np.clip(values + 0.5, 0, 255).astype(np.uint8)


def _area_weights(count: int, side_px: int) -> np.ndarray:
    """Return float64 [side_px, count]: the share that each old pixel has of each new one."""
    edges = np.arange(side_px + 1) * (count / side_px)
    low, high = edges[:-1, None], edges[1:, None]
    old = np.arange(count)[None, :]
    return np.clip(np.minimum(high, old + 1) - np.maximum(low, old), 0, None) / (high - low)
