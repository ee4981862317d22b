"""The images of a set: encoded as JPEG, compared by perceptual hash, and written once."""

import hashlib
import io
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image

from world2minecraft.core.files import write_bytes
from world2minecraft.core.types import Camera
from world2minecraft.navigation.types import Stance
from world2minecraft.navigation.walk_stream import wrap_deg
from world2minecraft.rendering.views.cameras import camera_of

SIZE, FOV_DEG = (640, 360), 70.0  # The view in the game, 299 tokens of Qwen2.5-VL.
QUALITY = 90
COARSE_PX = (32, 18)  # Size at which textures vanish and only objects differ.
NEAR_M, NEAR_DEG = 0.5, 20.0  # Differences below which two stances show the same.
MIN_DETAIL = 20.0  # Chosen by inspection; images with less detail show little but a wall.
DUPLICATE_HASH_BITS = 4  # Bits, of 64, in which two images must differ to be distinct.
MIN_HASH_BITS = 6  # Bits, of 64, in which a distractor differs from the correct option.


def vln_camera(width_px: int = SIZE[0], height_px: int = SIZE[1]) -> Camera:
    """Return the camera of a set, with the game's vertical field of view of 70 degrees."""
    return camera_of(width_px, height_px, vertical_fov_deg=FOV_DEG)


@dataclass(frozen=True, eq=False)
class EncodedPicture:
    """A JPEG image in memory with the features for comparing it to others.

    Attributes:
        jpeg: The encoded image.
        sha256: The SHA-256 of the JPEG.
        mean: The mean grey value, 0 to 255.
        dhash: The 64-bit difference hash.
        detail: The standard deviation of the downscaled grey image.
        small: The grey image as uint8, downscaled to ``COARSE_PX``.
    """

    jpeg: bytes
    sha256: str
    mean: float
    dhash: int
    detail: float
    small: bytes


def encode_picture(colour: np.ndarray) -> EncodedPicture:
    """Encode an image, uint8 [H, W, 3], as JPEG, and compute its features."""
    image = Image.fromarray(colour)
    buffer = io.BytesIO()
    image.save(buffer, "JPEG", quality=QUALITY)
    data = buffer.getvalue()
    grey = image.convert("L")
    mean = float(np.asarray(grey, np.float64).mean())
    small = np.asarray(grey.resize(COARSE_PX, Image.Resampling.BOX))
    sum_ = hashlib.sha256(data).hexdigest()
    return EncodedPicture(data, sum_, mean, dhash(grey), float(small.std()), small.tobytes())


def dhash(image: Image.Image) -> int:
    """Return the 64-bit difference hash: a bit is set where brightness increases to the right.

    Example:
        >>> ramp = Image.fromarray(np.tile(np.arange(90, dtype=np.uint8), (80, 1)))
        >>> dhash(ramp) == 2**64 - 1
        True
    """
    small = np.asarray(image.convert("L").resize((9, 8), Image.Resampling.BOX), np.int16)
    bits = (small[:, 1:] > small[:, :-1]).ravel()
    return int("".join("1" if bit else "0" for bit in bits), 2)


def hash_distance(one: int, other: int) -> int:
    """Return the number of bits, of 64, in which two hashes differ."""
    return (one ^ other).bit_count()


RenderViews = Callable[[Sequence[Stance]], list[EncodedPicture]]


@dataclass(frozen=True)
class StoredPicture:
    """An image file of a set, with its stance and the features for comparing it to others."""

    image: str  # beside the records, POSIX
    stance: Stance
    sha256: str
    dhash: int
    detail: float
    small: bytes  # 32x18 of its grey


class PictureStore:
    """A renderer of images that writes them to a folder.

    ``take`` renders images in full size, and ``look`` renders small previews for comparison.
    """

    def __init__(self, folder: Path, take: RenderViews, look: RenderViews):
        self._folder, self.take, self.look = folder, take, look

    def write(self, name: str, stance: Stance, shot: EncodedPicture) -> StoredPicture:
        """Write a rendered image to the folder.

        Raises:
            OutputError: If the image cannot be written.
        """
        write_bytes(self._folder / name, shot.jpeg)
        return StoredPicture(name, stance, shot.sha256, shot.dhash, shot.detail, shot.small)


def show_different_views(one: Stance, other: Stance, metres_per_block: float) -> bool:
    """Return whether two stances differ enough in position or heading to show different views."""
    away_m = ((one.x - other.x) ** 2 + (one.y - other.y) ** 2 + (one.z - other.z) ** 2) ** 0.5
    turn_deg = abs(float(wrap_deg(one.yaw_deg - other.yaw_deg)))
    return away_m * metres_per_block >= NEAR_M or turn_deg >= NEAR_DEG


def are_distinguishable(
    one: StoredPicture | EncodedPicture, other: StoredPicture | EncodedPicture
) -> bool:
    """Return whether two images differ enough to serve as options of one question."""
    return hash_distance(one.dhash, other.dhash) >= MIN_HASH_BITS


def is_near_duplicate(
    one: StoredPicture | EncodedPicture, other: StoredPicture | EncodedPicture
) -> bool:
    """Return whether two images are nearly identical."""
    return hash_distance(one.dhash, other.dhash) < DUPLICATE_HASH_BITS


def picture_difference(
    one: StoredPicture | EncodedPicture, other: StoredPicture | EncodedPicture
) -> float:
    """Return the mean squared difference of two images, downscaled to suppress textures."""
    pair = [np.frombuffer(picture.small, np.uint8).astype(np.float32) for picture in (one, other)]
    return float(((pair[0] - pair[1]) ** 2).mean())


def has_detail(one: StoredPicture | EncodedPicture) -> bool:
    """Return whether an image shows more than a bare wall."""
    return one.detail >= MIN_DETAIL
