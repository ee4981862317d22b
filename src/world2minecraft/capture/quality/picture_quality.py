"""Quality of sampled images: sharpness, brightness, texture and overlap of neighbouring images.

Overlap is computed from the best shift between two thumbnails by normalised cross-correlation. On
the kitchen capture and on a generated room, the median over many pairs is within about 0.1 of the
overlap computed from depth; single pairs may be far off.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from PIL import Image, ImageFilter

from world2minecraft.capture.images import ImagePlace, read_header, read_small
from world2minecraft.capture.source_types import FrameFiles
from world2minecraft.capture.validation import evenly_spaced
from world2minecraft.core.errors import InputError

WORK_PX = 640  # Blur that hurts at the 1024 px of posing shows at this size too.
THUMB_PX = 360
MAX_PICTURES = 120
BUDGET_MPX = 200.0  # About 5 s of decoding.
DRAFT_COST = 0.15  # A JPEG at a quarter of its size, against one decoded whole.
STRONG_SHARE = 0.1  # Blur is measured at the strongest edges alone: bare walls have none.
PATCH_PX = 16
BARE_CONTRAST = 3.0  # Grey levels of 255: the noise of a good sensor.
OVERLAP_WIDTH_PX = 64
MIN_OVERLAP = 0.2  # Smaller overlaps agree by chance.
MIN_CORRELATION = 0.4  # Pictures of different places reach this correlation one time in three.
NOISE_LEVEL = 8.0  # Grey levels: noise of bare walls is not blown up to texture.


@dataclass(frozen=True, eq=False)
class Picture:
    """A sampled image and its quality.

    Attributes:
        name: Name of the frame.
        index: Index of the frame among the usable frames.
        thumb: Thumbnail, uint8 [h, w, 3].
        sharpness: 0 for complete blur, about 0.4 for a good video frame, over 1 for a still photo.
        brightness: Median grey value, 0 to 255.
        bare: Share of image patches without texture.
    """

    name: str
    index: int
    thumb: np.ndarray
    sharpness: float
    brightness: float
    bare: float


def sample_pictures(
    frames: Sequence[FrameFiles], max_pictures: int = MAX_PICTURES
) -> list[Picture]:
    """Decode evenly spaced colour images of the frames; damaged images are skipped.

    Args:
        frames: Usable frames of a capture.
        max_pictures: Maximum number of images; large images reduce it.
    """
    shown = [(index, frame) for index, frame in enumerate(frames) if frame.colour_path]
    pictures = []
    for index, frame in evenly_spaced(
        shown, _affordable([frame for _, frame in shown], max_pictures)
    ):
        try:
            colour = read_small(frame.colour_path, WORK_PX) if frame.colour_path else None
        except InputError:
            continue
        if colour is not None:
            pictures.append(measure_picture(frame.name, index, colour))
    return pictures


def _affordable(frames: Sequence[FrameFiles], max_pictures: int) -> int:
    """Return how many images to decode, at least 12."""
    if not frames or frames[0].colour_path is None:
        return max_pictures
    width, height = read_header(frames[0].colour_path).size
    each = width * height / 1e6 * (DRAFT_COST if _is_jpeg(frames[0].colour_path) else 1.0)
    return int(np.clip(BUDGET_MPX / each, min(12, max_pictures), max_pictures))


def _is_jpeg(place: ImagePlace) -> bool:
    return place.name.lower().endswith((".jpg", ".jpeg"))


def measure_picture(name: str, index: int, colour: np.ndarray) -> Picture:
    """Compute the thumbnail and the quality of an image, uint8 [H, W, 3] of about ``WORK_PX``."""
    grey = np.asarray(Image.fromarray(colour).convert("L"), np.float32)
    image = Image.fromarray(colour)
    image.thumbnail((THUMB_PX, THUMB_PX), Image.Resampling.BOX)
    return Picture(
        name,
        index,
        np.array(image, np.uint8),
        round(sharpness(grey), 4),
        round(float(np.median(grey)), 1),
        round(textureless_share(grey), 4),
    )


def sharpness(grey: np.ndarray) -> float:
    """Measure how much the strongest edges weaken when the image is slightly blurred.

    Args:
        grey: Grey image, float32 [H, W].

    Returns:
        The mean step at strong edges divided by that of the blurred image, minus 1. The result is
        the smaller value of the two image directions, because camera shake blurs along one
        direction only. The measure depends little on the content of the image (after Crete et al.
        2007).
    """
    lost = [share for share in (_blur_loss(grey), _blur_loss(grey.T)) if share is not None]
    return max(0.0, min(lost, default=0.0))


def _blur_loss(grey: np.ndarray) -> float | None:
    """Return the loss at the strongest steps by a mean of three along rows; None without steps."""
    if grey.shape[1] < 8:
        return None
    step = np.abs(np.diff(grey, axis=1))[:, 1:-1]
    blurred = (grey[:, :-2] + grey[:, 1:-1] + grey[:, 2:]) / 3
    soft = np.abs(np.diff(blurred, axis=1))
    usual, largest = np.quantile(step, [1 - STRONG_SHARE, 0.999])
    limit = max(float(usual), 0.25 * float(largest))  # Drawn pictures have few steps, all sharp.
    if limit <= 0:
        return None
    strong = step >= limit
    return float(step[strong].mean()) / max(float(soft[strong].mean()), 1e-3) - 1


def textureless_share(grey: np.ndarray) -> float:
    """Return the share of image patches with too little contrast for features.

    Args:
        grey: Grey image, float32 [H, W].
    """
    rows, columns = grey.shape[0] // PATCH_PX, grey.shape[1] // PATCH_PX
    if not rows or not columns:
        return 0.0
    patches = grey[: rows * PATCH_PX, : columns * PATCH_PX]
    patches = patches.reshape(rows, PATCH_PX, columns, PATCH_PX)
    return float((patches.std(axis=(1, 3)) < BARE_CONTRAST).mean())


def neighbour_overlaps(pictures: Sequence[Picture]) -> np.ndarray:
    """Return the share of each image that the next image shows too, float64 [len - 1].

    The value is NaN if the two are not neighbours in the capture, and 0 if no shift matches.
    """
    small = [_high_pass(picture.thumb) for picture in pictures]
    shares = np.full(max(0, len(pictures) - 1), np.nan)
    for place, (one, other) in enumerate(pairwise(pictures)):
        if other.index - one.index == 1:
            shares[place] = overlap_share(small[place], small[place + 1])
    return shares


def overlap_share(one: np.ndarray, other: np.ndarray) -> float:
    """Return the share of the area that two high-pass filtered images have in common.

    The result is NaN if the images have different shapes.
    """
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
    likeness[area < MIN_OVERLAP] = -1.0
    best = int(np.argmax(likeness * area**0.25))  # Of two that agree alike, the larger overlap.
    return round(float(area.flat[best]), 2) if likeness.flat[best] >= MIN_CORRELATION else 0.0


def _high_pass(thumb: np.ndarray) -> np.ndarray:
    """Return an image of width 64 px without slow changes of brightness, float64 [h, 64]."""
    height = max(8, round(OVERLAP_WIDTH_PX * thumb.shape[0] / thumb.shape[1]))
    grey = (
        Image.fromarray(thumb).convert("L").resize((OVERLAP_WIDTH_PX, height), Image.Resampling.BOX)
    )
    detail = np.asarray(grey, np.float64)
    detail = detail - np.asarray(grey.filter(ImageFilter.BoxBlur(8)), np.float64)
    return detail / (np.abs(detail).mean() + NOISE_LEVEL)
