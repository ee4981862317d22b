"""Depth as the occupancy data sets' PNGs hold it.

NYU's PNGs hold millimetres whose 16 bits are turned left by three. ISO turns them back; Symphonies
divides by 8000 instead, which is the same up to 8.191 m: beyond, the turn wraps around. So whole
millimetres up to 8.191 m are written, times eight, and both read them alike; what is farther is
written as a hole. OccScanNet's PNGs hold millimetres.
"""

from typing import Literal

import numpy as np

from world2minecraft.capture.depth_images import DepthEncoding
from world2minecraft.rendering.output.images import number_bytes

NYU_FAR_MM = 8191
MM_FAR = 65534  # 65535 is a hole to some cameras' readers.
LOW_BITS_SHARE = 0.01

Code = Literal["nyu", "mm"]


def depth_png(depth_m: np.ndarray, code: Code) -> bytes:
    """Return the PNG of float32 [H, W] metres; holes, and what is too far, are 0."""
    millimetres = np.round(np.nan_to_num(depth_m, posinf=0) * 1000).astype(np.int64)
    far = NYU_FAR_MM if code == "nyu" else MM_FAR
    millimetres[(millimetres < 0) | (millimetres > far)] = 0
    values = millimetres * 8 if code == "nyu" else millimetres
    return number_bytes(values.astype(np.uint16))


def metres_of(raw: np.ndarray, code: Code) -> np.ndarray:
    """Return float32 [H, W] metres of stored values, 0 where there is none.

    NYU's are told apart by their low three bits: turned millimetres have 0 or 1 there (depth under
    16.4 m), true units of 1/8000 m have any.

    Example:
        >>> metres_of(np.array([[8000, 0, 16385]], np.uint16), "nyu").tolist()
        [[1.0, 0.0, 10.239999771118164]]
    """
    if code == "mm":
        return DepthEncoding("mm").to_metres(raw)
    seen = raw[raw > 0]
    any_bits = seen.size and np.mean((seen & 7) > 1) > LOW_BITS_SHARE
    return DepthEncoding(str(1 / 8000) if any_bits else "rotated").to_metres(raw)
