"""Colour to grey as OpenCV does it, to the last bit, so that figures can be compared."""

import numpy as np

from world2minecraft.core.types import checks

BITS = 15
WEIGHTS = (9798, 19235, 3735)  # Red, green, blue of ITU-R BT.601, of 2**15: OpenCV's integers.


def to_grey(picture: np.ndarray) -> np.ndarray:
    """Return the luma of a picture, uint8 [H, W]; a grey one is returned as it is.

    It equals ``cv2.cvtColor(picture, cv2.COLOR_RGB2GRAY)``.

    Args:
        picture: uint8 [H, W] or [H, W, 3], sRGB.

    Raises:
        ValueError: the shape or type is another, or there is no pixel.

    Example:
        >>> to_grey(np.array([[[255, 0, 0], [0, 255, 0], [0, 0, 255]]], np.uint8)).tolist()
        [[76, 150, 29]]
    """
    picture = np.asarray(picture)
    if not picture.size:
        raise ValueError(f"picture must have a pixel, not shape {picture.shape}")
    if picture.ndim == 2:
        return checks.array("picture", picture, np.uint8, (None, None))
    checks.array("picture", picture, np.uint8, (None, None, 3))
    sums = sum(picture[..., n].astype(np.int32) * weight for n, weight in enumerate(WEIGHTS))
    return np.asarray((sums + (1 << (BITS - 1))) >> BITS).astype(np.uint8)
