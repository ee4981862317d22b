"""Pictures as networks want them, by what a model's own preprocessor file states.

The image processors of the transformers library need torchvision, of which not every version goes
with every torch; the few steps that they take are here.
"""

from typing import Any

import numpy as np
from PIL import Image

LARGEST_SIDE_PX = 4096


def prepared(colour: np.ndarray, ready: dict[str, Any]) -> np.ndarray:
    """Return a picture as a network wants it.

    Args:
        colour: uint8 [H, W, 3].
        ready: the entries of a preprocessor_config.json.

    Returns:
        float32 [1, 3, h, w].
    """
    picture = Image.fromarray(colour)
    if ready.get("do_resize", True):
        picture = picture.resize(
            wanted_size(picture.size, ready), Image.Resampling(ready.get("resample", 3))
        )
    values = np.asarray(picture, np.float32)
    if ready.get("do_rescale", True):
        values = values * np.float32(ready.get("rescale_factor", 1 / 255))
    if ready.get("do_normalize", "image_mean" in ready):
        mean, spread = (np.array(ready[key], np.float32) for key in ("image_mean", "image_std"))
        values = (values - mean) / spread
    return np.ascontiguousarray(values.transpose(2, 0, 1)[None])


def wanted_size(size_px: tuple[int, int], ready: dict[str, Any]) -> tuple[int, int]:
    """Return the width and height that a network wants of a picture of a width and height.

    >>> wanted_size((640, 480), {"size": 518, "keep_aspect_ratio": True, "ensure_multiple_of": 14})
    (686, 518)
    """
    step = ready.get("ensure_multiple_of") or ready.get("size_divisor") or 1
    size = ready.get("size") or {"width": size_px[0], "height": size_px[1]}
    if not isinstance(size, dict):
        square = "max_size" not in ready  # Older files of segmenters mean the shorter side.
        size = {"width": size, "height": size} if square else {"shortest_edge": size}
    longest = size.get("longest_edge") or ready.get("max_size") or LARGEST_SIDE_PX
    if "shortest_edge" in size:
        scales = [min(size["shortest_edge"] / min(size_px), longest / max(size_px))] * 2
    else:
        scales = [size["width"] / size_px[0], size["height"] / size_px[1]]
        if ready.get("keep_aspect_ratio"):
            scales = [min(scales, key=lambda scale: abs(1 - scale))] * 2
    wide, high = (
        max(step, round(side * scale / step) * step)
        for side, scale in zip(size_px, scales, strict=True)
    )
    return min(wide, LARGEST_SIDE_PX // step * step), min(high, LARGEST_SIDE_PX // step * step)
