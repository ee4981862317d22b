"""Intrinsics of data sets, whose pixel centres are whole numbers; ours lie at +0.5."""

from collections.abc import Sequence

import numpy as np

from world2minecraft.capture.images import ImagePlace, read_header
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.errors import CaptureError, InputError
from world2minecraft.core.types import Camera

PRIMESENSE = (525.0, 525.0, 319.5, 239.5)  # fx fy cx cy at 640x480: the default of OpenNI and ROS.
VGA = (640, 480)


def stated_camera(
    where: AnyPath,
    size: tuple[int, int],
    lens: Sequence[float] | np.ndarray,
    distortion: Sequence[float] | np.ndarray = (),
    centre: float = 0.5,
) -> Camera:
    """Return the camera of fx, fy, cx, cy as a data set states them.

    Args:
        where: the file that states them, for the message.
        size: width and height in pixels of the image that they speak of.
        lens: fx, fy, cx, cy in pixels.
        distortion: up to five of k1 k2 p1 p2 k3.
        centre: where the middle of the first pixel lies in our cameras, less where it lies in
            the data set's.

    Raises:
        CaptureError: they are no intrinsics.
    """
    fx, fy, cx, cy = (float(value) for value in lens)
    bent = tuple(float(value) for value in distortion)
    try:
        padded = (*bent, *(0.0,) * (5 - len(bent)))
        return Camera(*size, fx, fy, cx + centre, cy + centre, padded)
    except (ValueError, OverflowError) as error:
        raise CaptureError(where, f"intrinsics: {error}") from error


def matrix_camera(where: AnyPath, size: tuple[int, int], matrix: np.ndarray) -> Camera:
    """Return the camera of a 3x3 (or larger) intrinsic matrix. Raises as ``stated_camera``."""
    sound = np.isfinite(matrix[:3, :3]).all() and np.allclose(matrix[2, :3], [0, 0, 1])
    if not sound or abs(matrix[1, 0]) > 1e-6:
        stated = matrix[:3, :3].tolist()
        raise CaptureError(where, f"its intrinsics must read fx 0 cx, 0 fy cy, 0 0 1, not {stated}")
    lens = (matrix[0, 0], matrix[1, 1], matrix[0, 2], matrix[1, 2])
    return stated_camera(where, size, lens)


def first_image_size(images: Sequence[ImagePlace | None]) -> tuple[int, int] | None:
    """Return the size of the first image that can be read; the others are checked later."""
    for image in images:
        if image is not None:
            try:
                return read_header(image).size
            except InputError:
                continue
    return None


def intrinsics_size(
    lens: Sequence[float], sizes: Sequence[tuple[int, int] | None]
) -> tuple[int, int] | None:
    """Return the size whose middle the principal point (cx, cy) meets best, the first of equals.

    Exported images are often smaller than what the intrinsics next to them speak of.
    """
    known = [size for size in sizes if size is not None]
    cx, cy = lens

    def off(size: tuple[int, int]) -> float:
        return round(abs(cx / size[0] - 0.5) + abs(cy / size[1] - 0.5), 1)

    return min(known, key=off) if known else None
