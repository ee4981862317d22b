"""Colour as the JPEGs that the loaders open."""

import io

import numpy as np
from PIL import Image

from world2minecraft.dataset.exporters.rules import JPEG_QUALITY
from world2minecraft.dataset.values import OccSample
from world2minecraft.errors import InputError


def jpeg_bytes(pixels: np.ndarray) -> bytes:
    """Return uint8 [H, W, 3] as a JPEG, its colours at full resolution."""
    stream = io.BytesIO()
    Image.fromarray(pixels).save(stream, "JPEG", quality=JPEG_QUALITY, subsampling=0)
    return stream.getvalue()


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
