"""The pictures beside labels: colour and depth, where they are there."""

from pathlib import Path

import numpy as np
from PIL import Image

from world2minecraft.capture.depth_images import check_depth_kind
from world2minecraft.capture.images import read_colour, read_header, read_raw
from world2minecraft.minecraftocc.formats.depth_codes import Code, metres_of


def colour_at(path: Path) -> np.ndarray | None:
    """Read uint8 [H, W, 3], or return None where there is no file."""
    return read_colour(path) if path.is_file() else None


def depth_at(path: Path, code: Code) -> np.ndarray | None:
    """Read float32 [H, W] metres, or return None where there is no file.

    Raises:
        CaptureError: the image cannot hold depth.
    """
    if not path.is_file():
        return None
    check_depth_kind(path, read_header(path))
    return metres_of(read_raw(path), code)


def resized_colour(pixels: np.ndarray, width_px: int, height_px: int) -> np.ndarray:
    """Return a picture at another size, as the loaders resize theirs."""
    if pixels.shape[:2] == (height_px, width_px):
        return pixels
    image = Image.fromarray(pixels).resize((width_px, height_px), Image.Resampling.BILINEAR)
    return np.asarray(image)
