"""Free photographs that come with packages of the tests, sharp and spoilt in known ways."""

import importlib.util
from pathlib import Path

import cv2
import numpy as np
import pytest
from PIL import Image

PLACES = {"skimage": "data", "sklearn": "datasets/images"}
SKLEARN = ("china", "flower")


def photograph(name: str, blur_px: float = 0.0) -> np.ndarray:
    """uint8 [H, W, 3]; ``blur_px`` is the sigma of OpenCV's Gaussian."""
    package = "sklearn" if name in SKLEARN else "skimage"
    spec = importlib.util.find_spec(package)
    if spec is None:
        pytest.skip(f"{package}, whose {name} is asked for, is not installed")
    folder = Path(str(spec.origin)).parent / PLACES[package]
    place = next(folder.glob(f"{name}.*"))
    picture = np.array(Image.open(place).convert("RGB"))
    return cv2.GaussianBlur(picture, (0, 0), blur_px) if blur_px else picture
