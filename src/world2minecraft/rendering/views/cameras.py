"""A camera from a picture's size and one of: vertical FOV, horizontal FOV, intrinsics."""

from collections.abc import Sequence

import numpy as np

from world2minecraft.core.coordinates import focal_px_of_fov, fov_deg_of_focal_px
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import Camera

GAME_FOV_DEG = 70.0  # The game's usual field of view; the game's is vertical.
WIDEST_DEG = 170.0  # Wider, and a flat picture shows little but its edges.


def camera_of(
    width_px: int,
    height_px: int,
    *,
    vertical_fov_deg: float | None = None,
    horizontal_fov_deg: float | None = None,
    intrinsics: np.ndarray | Sequence[float] | None = None,
) -> Camera:
    """Return a camera of square pixels that looks through its middle, or one of given intrinsics.

    Args:
        width_px: the picture's width.
        height_px: its height.
        vertical_fov_deg: from the upper to the lower edge, as the game's option says.
        horizontal_fov_deg: from the left to the right edge.
        intrinsics: fx, fy, cx, cy in pixels, or the 3x3 matrix K; pixel centres lie at +0.5.

    Raises:
        UsageError: not exactly one of the three is given, or a number is out of range.

    Example:
        >>> round(camera_of(640, 480, vertical_fov_deg=90).fx_px, 6)
        240.0
    """
    given = [vertical_fov_deg, horizontal_fov_deg, intrinsics]
    if sum(one is not None for one in given) != 1:
        raise UsageError(
            "a camera needs one of vertical_fov_deg, horizontal_fov_deg and intrinsics, "
            f"and {sum(one is not None for one in given)} are given"
        )
    try:
        if intrinsics is not None:
            fx_px, fy_px, cx_px, cy_px = _four(intrinsics)
            return Camera(width_px, height_px, fx_px, fy_px, cx_px, cy_px)
        across = horizontal_fov_deg is not None
        fov_deg = horizontal_fov_deg if horizontal_fov_deg is not None else vertical_fov_deg
        focal_px = _focal_px(width_px if across else height_px, float(fov_deg or 0.0))
        return Camera(width_px, height_px, focal_px, focal_px, width_px / 2, height_px / 2)
    except ValueError as error:
        raise UsageError(f"no such camera: {error}") from error


def vertical_fov_deg_of(camera: Camera) -> float:
    """Return the angle between a camera's upper and lower edge, were its middle in the middle."""
    return fov_deg_of_focal_px(camera.height_px, camera.fy_px)


def _focal_px(side_px: int, fov_deg: float) -> float:
    if not 0 < fov_deg <= WIDEST_DEG:
        raise UsageError(
            f"a field of view must be above 0 and up to {WIDEST_DEG:g} degrees, not {fov_deg:g}"
        )
    return float(focal_px_of_fov(side_px, fov_deg))


def _four(intrinsics: np.ndarray | Sequence[float]) -> list[float]:
    """Return fx, fy, cx, cy of either form."""
    values = np.asarray(intrinsics, np.float64)
    if values.shape == (4,):
        return values.tolist()
    if values.shape != (3, 3):
        raise ValueError(f"intrinsics must be fx, fy, cx, cy or 3x3, not {list(values.shape)}")
    flat = (values[0, 1], values[1, 0], values[2, 0], values[2, 1], values[2, 2] - 1)
    if np.abs(flat).max() > 1e-9:
        raise ValueError("K must be [[fx, 0, cx], [0, fy, cy], [0, 0, 1]]")
    return [values[0, 0], values[1, 1], values[0, 2], values[1, 2]]
