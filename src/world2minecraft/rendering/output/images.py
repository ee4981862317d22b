"""Encoding of single images: colour, depth and ids.

- Colour: PNG, JPEG or WebP.
- Depth: 16-bit PNG in integer fractions of a metre (0 without a surface, the maximum for anything
  farther), EXR (float32 channel ``Z``, metres, 0 without a surface) or NPY (the same values).
- Ids: grey PNG with 8 or 16 bits, or RGBA whose four bytes, red lowest, are the number + 1.
"""

import io

import numpy as np
from PIL import Image

from world2minecraft.core.errors import UsageError
from world2minecraft.core.files import image_bytes
from world2minecraft.rendering.output.exr import exr_bytes

COLOUR_SUFFIXES = (".png", ".jpg", ".jpeg", ".webp")
DEPTH_SUFFIXES = (".png", ".exr", ".npy")
QUALITY = 92
PER_METRE = 1000  # Steps of 16-bit depth: millimetres, as in most RGB-D data sets.
FARTHEST = 65535
_PNG_LEVEL = 4  # Compression level; the default of 6 takes twice as long to save 3 %.
_LOSSLESS = 100  # The WebP quality from which it keeps every pixel.


def colour_bytes(colour: np.ndarray, suffix: str, quality: int = QUALITY) -> bytes:
    """Encode a colour image, uint8 [H, W, 3].

    Args:
        colour: sRGB colours.
        suffix: ``.png``, ``.jpg``, ``.jpeg`` or ``.webp``.
        quality: Quality of JPEG and WebP, 1 to 100. WebP is lossless at 100.

    Raises:
        UsageError: If the suffix is not supported.
    """
    if suffix == ".png":
        return image_bytes(Image.fromarray(colour), "PNG", compress_level=_PNG_LEVEL)
    if suffix in (".jpg", ".jpeg"):
        return image_bytes(Image.fromarray(colour), "JPEG", quality=quality, subsampling=0)
    if suffix == ".webp":
        lossless = quality >= _LOSSLESS
        return image_bytes(Image.fromarray(colour), "WEBP", quality=quality, lossless=lossless)
    raise UsageError(f"a colour image must end in {', '.join(COLOUR_SUFFIXES)}, got {suffix!r}")


def depth_bytes(depth_m: np.ndarray, suffix: str, per_metre: int = PER_METRE) -> bytes:
    """Encode a depth image, float32 [H, W] in metres with 0 for no surface.

    Args:
        depth_m: z-depth or range.
        suffix: ``.png``, ``.exr`` or ``.npy``.
        per_metre: Number that represents a metre in PNG.

    Raises:
        UsageError: If the suffix is not supported.
    """
    if suffix == ".png":
        return number_bytes(depth_numbers(depth_m, per_metre))
    if suffix == ".exr":
        return exr_bytes({"Z": depth_m}, notes={"comments": "metres; 0 where there is no surface"})
    if suffix == ".npy":
        stream = io.BytesIO()
        np.lib.format.write_array(stream, depth_m.astype(np.float32), allow_pickle=False)
        return stream.getvalue()
    raise UsageError(f"a depth image must end in {', '.join(DEPTH_SUFFIXES)}, got {suffix!r}")


def depth_numbers(depth_m: np.ndarray, per_metre: int = PER_METRE) -> np.ndarray:
    """Convert depth to integer fractions of a metre, uint16 [H, W]; 0 stands for no surface."""
    whole = np.minimum(np.rint(depth_m.astype(np.float64) * per_metre), FARTHEST)
    near = (depth_m > 0) & (whole < 1)  # 0 means that there is nothing.
    return np.where(near, 1, whole).astype(np.uint16)


def number_bytes(numbers: np.ndarray) -> bytes:
    """Encode ids, uint8 or uint16 [H, W], as a grey PNG."""
    return image_bytes(Image.fromarray(numbers), "PNG", compress_level=_PNG_LEVEL)


def index_bytes(index: np.ndarray) -> bytes:
    """Encode indices, int32 [H, W] with -1 for none, as an RGBA PNG.

    Read the file with ``numpy.asarray(image).view("<u4")[..., 0].astype(int) - 1``.
    """
    packed = (index.astype(np.int64) + 1).astype("<u4")
    rgba = packed.view(np.uint8).reshape(*index.shape, 4)
    return image_bytes(Image.fromarray(rgba, "RGBA"), "PNG", compress_level=_PNG_LEVEL)


def normal_bytes(normal: np.ndarray) -> bytes:
    """Encode unit normals, float32 [H, W, 3], as a PNG: 128 + 127 n, black without a surface."""
    packed = np.rint(128 + 127 * normal).astype(np.uint8)
    packed[~normal.any(axis=2)] = 0
    return image_bytes(Image.fromarray(packed), "PNG", compress_level=_PNG_LEVEL)
