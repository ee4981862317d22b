"""Intrinsics of data sets, converted to pixel centres at +0.5."""

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
    """Return the camera for the fx, fy, cx and cy stated by a data set.

    Args:
        where: File that states the intrinsics, for error messages.
        size: Width and height in pixels of the image that the intrinsics refer to.
        lens: fx, fy, cx and cy in pixels.
        distortion: Up to five distortion coefficients k1, k2, p1, p2, k3.
        centre: Offset added to cx and cy; 0.5 if the data set has its pixel centres at integers.

    Raises:
        CaptureError: If the values are not valid intrinsics.
    """
    fx, fy, cx, cy = (float(value) for value in lens)
    bent = tuple(float(value) for value in distortion)
    try:
        padded = (*bent, *(0.0,) * (5 - len(bent)))
        return Camera(*size, fx, fy, cx + centre, cy + centre, padded)
    except (ValueError, OverflowError) as error:
        raise CaptureError(where, f"has invalid intrinsics: {error}") from error


def matrix_camera(where: AnyPath, size: tuple[int, int], matrix: np.ndarray) -> Camera:
    """Return the camera of a 3x3 or larger intrinsic matrix.

    Raises:
        CaptureError: If the matrix is not a valid intrinsic matrix.
    """
    sound = np.isfinite(matrix[:3, :3]).all() and np.allclose(matrix[2, :3], [0, 0, 1])
    if not sound or abs(matrix[1, 0]) > 1e-6:
        stated = matrix[:3, :3].tolist()
        raise CaptureError(
            where, f"intrinsics must have the form fx 0 cx, 0 fy cy, 0 0 1, got {stated}"
        )
    lens = (matrix[0, 0], matrix[1, 1], matrix[0, 2], matrix[1, 2])
    return stated_camera(where, size, lens)


def first_image_size(images: Sequence[ImagePlace | None]) -> tuple[int, int] | None:
    """Return the size of the first readable image, or None. The other images are checked later."""
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
    """Return the candidate size whose centre is closest to the principal point (cx, cy).

    Exported images are often smaller than the images that the intrinsics refer to. Ties are decided
    by the order of the candidates.
    """
    known = [size for size in sizes if size is not None]
    cx, cy = lens

    def off(size: tuple[int, int]) -> float:
        return round(abs(cx / size[0] - 0.5) + abs(cy / size[1] - 0.5), 1)

    return min(known, key=off) if known else None
