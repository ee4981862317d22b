"""Colour as the JPEGs that the loaders open."""

import numpy as np

from world2minecraft.core.errors import InputError
from world2minecraft.minecraftocc.exporters.rules import JPEG_QUALITY
from world2minecraft.minecraftocc.values import OccSample
from world2minecraft.rendering.output.images import colour_bytes


def jpeg_bytes(pixels: np.ndarray) -> bytes:
    """Return uint8 [H, W, 3] as a JPEG, its colours at full resolution."""
    return colour_bytes(pixels, ".jpg", JPEG_QUALITY)


def colour_of(sample: OccSample) -> np.ndarray:
    """Return a sample's colour image. Raises InputError where it has none."""
    if sample.colour is None:
        raise InputError(
            sample.key, "it has no colour image, which this format needs; npz does without"
        )
    return sample.colour


def split_of(sample: OccSample) -> str:
    """Return train or test; a sample of neither goes to train."""
    return "test" if sample.split in ("test", "val") else "train"
