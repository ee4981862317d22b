"""Pictures for language models, made small enough: every pixel is tokens, time and money."""

from io import BytesIO

import numpy as np
from PIL import Image

from world2minecraft.core.errors import UsageError
from world2minecraft.external_models.chat_messages import Picture

MOST_PX = 1_048_576  # 1,338 tokens of Qwen2.5-VL, within what the budget counts for a picture.
LEAST_PX = 784  # One token's square of 28 x 28.
LARGEST_PX = 64_000_000  # Of a file; more is not opened.
JPEG_QUALITY = 90


def check_most_px(most_px: int) -> None:
    """Raise UsageError where a cap on pixels cannot be."""
    if most_px < LEAST_PX:
        raise UsageError(f"a picture for a model has {LEAST_PX} pixels or more, not {most_px}")


def at_most(colour: np.ndarray, most_px: int) -> np.ndarray:
    """Return a picture, uint8 [H, W, 3], of at most so many pixels, in its own shape.

    Example:
        >>> at_most(np.zeros((480, 640, 3), np.uint8), 76_800).shape
        (240, 320, 3)
    """
    height, width = colour.shape[:2]
    size = _size(width, height, most_px)
    if size == (width, height):
        return colour
    return np.asarray(Image.fromarray(colour).resize(size, Image.Resampling.LANCZOS))


def capped(picture: Picture, most_px: int) -> Picture:
    """Return a picture as it is, or a smaller JPEG of it where it has more pixels.

    Raises:
        ValueError: it cannot be opened, or is far too large to be.
    """
    try:
        with Image.open(BytesIO(picture.data)) as image:
            if image.width * image.height > LARGEST_PX:
                raise ValueError(f"has {image.width} x {image.height} pixels, too many to open")
            size = _size(image.width, image.height, most_px)
            if size == image.size:
                return picture
            small = image.convert("RGB").resize(size, Image.Resampling.LANCZOS)
    except (OSError, SyntaxError, Image.DecompressionBombError) as error:
        raise ValueError(f"is no picture that can be opened ({error})") from error
    stream = BytesIO()
    small.save(stream, "JPEG", quality=JPEG_QUALITY)
    return Picture(stream.getvalue(), "image/jpeg")


def _size(width: int, height: int, most_px: int) -> tuple[int, int]:
    """Return the size of a picture that may have so many pixels."""
    if width * height <= most_px:
        return width, height
    scale = (most_px / (width * height)) ** 0.5
    wide = max(1, int(width * scale))
    return wide, max(1, min(int(height * scale), most_px // wide))
