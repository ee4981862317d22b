"""Pictures of a set: as JPEG, told apart by hashes."""

import hashlib
import io
from dataclasses import dataclass

import numpy as np
from PIL import Image

from world2minecraft.core.types import Camera
from world2minecraft.rendering.views.cameras import camera_of

SIZE, FOV_DEG = (640, 360), 70.0  # The game's view; 299 tokens of Qwen2.5-VL.
QUALITY = 90
COARSE_PX = (32, 18)  # So small, textures are even and only things vary.


def vln_camera(width_px: int = SIZE[0], height_px: int = SIZE[1]) -> Camera:
    """Return the camera of a set: the game's vertical FOV of 70 degrees."""
    return camera_of(width_px, height_px, vertical_fov_deg=FOV_DEG)


@dataclass(frozen=True, eq=False)
class Shot:
    """A picture in memory with what tells it from others."""

    jpeg: bytes
    sha256: str
    mean: float  # of its grey, 0 to 255
    dhash: int  # 64 bits
    detail: float  # how much its grey varies over the picture, a standard deviation
    small: bytes  # its grey, uint8, ``COARSE_PX``


def shot_of(colour: np.ndarray) -> Shot:
    """Return a picture, uint8 [H, W, 3], as JPEG with its sum, mean and hash."""
    image = Image.fromarray(colour)
    buffer = io.BytesIO()
    image.save(buffer, "JPEG", quality=QUALITY)
    data = buffer.getvalue()
    grey = image.convert("L")
    mean = float(np.asarray(grey, np.float64).mean())
    small = np.asarray(grey.resize(COARSE_PX, Image.Resampling.BOX))
    sum_ = hashlib.sha256(data).hexdigest()
    return Shot(data, sum_, mean, dhash(grey), float(small.std()), small.tobytes())


def dhash(image: Image.Image) -> int:
    """Return the difference hash of a picture, 64 bits: where it grows brighter to the right.

    Example:
        >>> ramp = Image.fromarray(np.tile(np.arange(90, dtype=np.uint8), (80, 1)))
        >>> dhash(ramp) == 2**64 - 1
        True
    """
    small = np.asarray(image.convert("L").resize((9, 8), Image.Resampling.BOX), np.int16)
    bits = (small[:, 1:] > small[:, :-1]).ravel()
    return int("".join("1" if bit else "0" for bit in bits), 2)


def hash_distance(one: int, other: int) -> int:
    """Return by how many of 64 bits two hashes differ."""
    return (one ^ other).bit_count()
