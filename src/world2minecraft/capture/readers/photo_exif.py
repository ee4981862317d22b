"""EXIF metadata of photos: orientation, lens and time.

Only photos without poses are rotated upright, because the intrinsics of posed captures refer to the
pixels as stored.
"""

import math
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any

import numpy as np
from PIL import Image, ImageOps

from world2minecraft.capture.images import ImageHeader, NamedByFile, check_whole, open_image
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.types import Camera

DIAGONAL_MM = math.hypot(36.0, 24.0)  # Diagonal of 35 mm film, in millimetres.
ORIENTATION, MAKE, EXIF_IFD = 0x0112, 0x010F, 0x8769
FOCAL_MM, FOCAL_35MM, TAKEN = 0x920A, 0xA405, 0x9003
PLANE_RESOLUTION, PLANE_UNIT, PIXELS_ACROSS = 0xA20E, 0xA210, 0xA002
UNIT_MM = {2: 25.4, 3: 10.0, 4: 1.0}
SHARE_OF_DIAGONAL = (0.2, 15.0)  # Plausible range, from a fisheye to a long telephoto lens.


@dataclass(frozen=True)
class PhotoMetadata:
    """Metadata of a photo.

    Attributes:
        width_px: Width in pixels after upright rotation.
        height_px: Height in pixels after upright rotation.
        focal_px: Focal length in pixels, or None if unknown.
        time_s: Time of the photo as a Unix time stamp, or None if unknown.
        by_camera: Whether the EXIF data was written by a camera.
    """

    width_px: int
    height_px: int
    focal_px: float | None
    time_s: float | None
    by_camera: bool

    @property
    def camera(self) -> Camera | None:
        """An initial estimate of the intrinsics, or None if the focal length is unknown."""
        if self.focal_px is None:
            return None
        middle = (self.width_px / 2, self.height_px / 2)
        return Camera(self.width_px, self.height_px, self.focal_px, self.focal_px, *middle)


@dataclass(frozen=True)
class UprightPhoto(NamedByFile):
    """A photo file, rotated upright. It implements ``ImageSource``."""

    path: AnyPath

    def header(self) -> ImageHeader:
        """Return the size of the rotated photo and its mode."""
        with open_image(self.path) as image:
            return ImageHeader(*_upright_size(image), image.mode)

    def check_whole(self) -> None:
        """Check that the file is not truncated."""
        check_whole(self.path)

    def colour(self) -> np.ndarray:
        """Return the upright photo as sRGB, uint8 [H, W, 3]."""
        with open_image(self.path) as image:
            return np.array(ImageOps.exif_transpose(image).convert("RGB"), np.uint8)

    def raw(self) -> np.ndarray:
        """Raise DamagedFileError, because a photo contains colours."""
        raise DamagedFileError(self, "contains colours, not single values")


def read_photo_metadata(path: AnyPath) -> PhotoMetadata:
    """Read the metadata of a photo.

    Raises:
        InputError: If the photo cannot be read.
    """
    with open_image(path) as image:
        width, height = _upright_size(image)
        general, own = _exif_tags(image)
        focal = _focal_length_px(own, image.size)
    return PhotoMetadata(width, height, focal, _time_s(own), MAKE in general or FOCAL_MM in own)


def _exif_tags(image: Image.Image) -> tuple[dict[int, Any], dict[int, Any]]:
    """Return the general and the camera-specific EXIF tags; damaged tags are omitted."""
    try:
        exif = image.getexif()
        return dict(exif), dict(exif.get_ifd(EXIF_IFD))
    except Exception:  # Pillow's EXIF reader raises whatever a damaged tag leads it to.
        return {}, {}


def _upright_size(image: Image.Image) -> tuple[int, int]:
    turned = _exif_tags(image)[0].get(ORIENTATION) in (5, 6, 7, 8)
    return (image.height, image.width) if turned else image.size


def _focal_length_px(tags: dict[int, Any], size: tuple[int, int]) -> float | None:
    """Return the focal length in pixels, from the 35 mm equivalent or else from the pixel pitch."""
    diagonal_px = math.hypot(*size)
    film = _number(tags.get(FOCAL_35MM))
    focal = film / DIAGONAL_MM * diagonal_px
    if focal <= 0:
        unit_mm = UNIT_MM.get(int(_number(tags.get(PLANE_UNIT, 2))), 0.0)
        per_mm = _number(tags.get(PLANE_RESOLUTION)) / unit_mm if unit_mm else 0.0
        across = _number(tags.get(PIXELS_ACROSS)) or max(size)
        focal = _number(tags.get(FOCAL_MM)) * per_mm * max(size) / across
    low, high = (share * diagonal_px for share in SHARE_OF_DIAGONAL)
    return focal if low < focal < high else None


def _number(value: Any) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError, ZeroDivisionError, OverflowError):
        return 0.0
    return number if math.isfinite(number) and 0 < number < 1e9 else 0.0


def _time_s(tags: dict[int, Any]) -> float | None:
    try:
        taken = datetime.strptime(str(tags.get(TAKEN)).strip("\0 "), "%Y:%m:%d %H:%M:%S")
    except ValueError:
        return None
    return taken.replace(tzinfo=UTC).timestamp()
