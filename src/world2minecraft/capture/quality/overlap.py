"""How much two pictures share, told from how one has to be shifted over the other.

This is a look, not a match: at the kitchen's and a generated room's neighbours it is within about
a tenth of what their depth says, as a median over many pairs; a single pair may be far off.
"""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from PIL import Image, ImageFilter

from world2minecraft.capture.quality.pictures import Picture

WIDTH_PX = 64
LEAST_SHARE = 0.2  # Smaller overlaps agree by chance.
AGREES = 0.4  # Pictures of different places reach this correlation one time in three.
SOFT = 8.0  # Grey levels: noise of bare walls is not blown up to texture.


def neighbour_shares(pictures: Sequence[Picture]) -> np.ndarray:
    """Return the share of each picture that the next one shows too, float64 [len - 1].

    NaN where the two are no neighbours in the capture; 0 where no shift agrees.
    """
    small = [_flattened(picture.thumb) for picture in pictures]
    shares = np.full(max(0, len(pictures) - 1), np.nan)
    for place, (one, other) in enumerate(pairwise(pictures)):
        if other.index - one.index == 1:
            shares[place] = shared_share(small[place], small[place + 1])
    return shares


def shared_share(one: np.ndarray, other: np.ndarray) -> float:
    """Return the share of the area that two flattened pictures show both, by the best shift."""
    if one.shape != other.shape:  # One is upright, the other lies: a look cannot tell.
        return float("nan")
    padded = (2 * one.shape[0], 2 * one.shape[1])
    full = np.ones_like(one)
    first = [np.fft.rfft2(values, padded) for values in (full, one, one * one)]
    second = [np.conj(np.fft.rfft2(values, padded)) for values in (full, other, other * other)]

    def summed(a: int, b: int) -> np.ndarray:
        return np.fft.irfft2(first[a] * second[b], padded)

    count = np.maximum(summed(0, 0), 1.0)
    sum_one, sum_other = summed(1, 0), summed(0, 1)
    covariance = summed(1, 1) - sum_one * sum_other / count
    variance = (summed(2, 0) - sum_one**2 / count) * (summed(0, 2) - sum_other**2 / count)
    likeness = covariance / np.sqrt(np.maximum(variance, (1e-3 * one.size) ** 2))
    area = count / one.size
    likeness[area < LEAST_SHARE] = -1.0
    best = int(np.argmax(likeness * area**0.25))  # Of two that agree alike, the larger overlap.
    return round(float(area.flat[best]), 2) if likeness.flat[best] >= AGREES else 0.0


def _flattened(thumb: np.ndarray) -> np.ndarray:
    """Return a picture 64 px wide without its slow changes of light, float64 [h, 64]."""
    height = max(8, round(WIDTH_PX * thumb.shape[0] / thumb.shape[1]))
    grey = Image.fromarray(thumb).convert("L").resize((WIDTH_PX, height), Image.Resampling.BOX)
    detail = np.asarray(grey, np.float64)
    detail = detail - np.asarray(grey.filter(ImageFilter.BoxBlur(8)), np.float64)
    return detail / (np.abs(detail).mean() + SOFT)
