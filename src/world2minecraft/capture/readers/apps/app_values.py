"""Parsing of numbers, cameras and poses in the files of phone apps.

ARKit cameras look along -z with y up, in a world with y up. ``arkit_pose`` and
``arkit_pose_of_quaternion`` return the pose of the same camera with OpenCV axes. Poses may contain
values that are not finite, which mark lost tracking; those frames are skipped later.
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from world2minecraft.capture.source_types import as_floats
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.coordinates import opengl_to_opencv_pose
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.files import read_bytes
from world2minecraft.core.types import Camera
from world2minecraft.geometry.rotations import pose_from_quaternion

ARKIT_UP = np.array([0.0, 1.0, 0.0])
MAX_COORDINATE_M = 1e9
MAX_TEXT_BYTES = 64 << 20  # An hour of odometry at 60 Hz takes about 30 MB.


def parse_number(
    path: AnyPath, stated: Mapping[str, Any], key: str, default: float | None = None
) -> float:
    """Return a finite number from a JSON object, or ``default`` if it is missing.

    Raises:
        CaptureError: If the value is not a finite number, or is missing without a default.
    """
    value = stated.get(key, default)
    number = to_float(value)
    if not math.isfinite(number):
        raise CaptureError(path, f'"{key}" must be a number, got {str(value)[:40]}')
    return number


def to_float(value: object) -> float:
    """Convert a JSON number to float.

    Returns:
        The number, NaN if the value is not a number, or infinity if an integer is too large.
    """
    if isinstance(value, bool) or not isinstance(value, int | float):
        return math.nan
    try:
        return float(value)
    except OverflowError:
        return math.inf


def parse_numbers(path: AnyPath, key: str, values: object, count: int) -> np.ndarray:
    """Convert a list or nested lists to float64 [count]. NaN and infinity are accepted.

    Args:
        path: File that contains the values, for error messages.
        key: Name of the field, for error messages.
        values: The list.
        count: Required number of values.

    Raises:
        CaptureError: If the value is not a list with that count of numbers.
    """
    found = as_floats(values).reshape(-1)
    if len(found) != count or not isinstance(values, list):
        raise CaptureError(path, f'"{key}" must be a list of {count} numbers')
    return found


def parse_camera(path: AnyPath, size: tuple[float, float], lens: Sequence[float]) -> Camera:
    """Return a camera with the given size and fx, fy, cx, cy in pixels.

    Raises:
        CaptureError: If the values are not valid intrinsics.
    """
    try:
        return Camera(*size, *lens)  # type: ignore[arg-type]
    except (TypeError, ValueError, OverflowError) as error:
        raise CaptureError(path, f"has invalid intrinsics: {error}") from error


def arkit_pose(matrix: np.ndarray) -> np.ndarray:
    """Convert ARKit's 4x4 camera transform to a pose with OpenCV axes, float64 [4, 4].

    Extremely large values, which mark lost tracking, become NaN.
    """
    stated = np.asarray(matrix, np.float64)
    return opengl_to_opencv_pose(np.where(np.abs(stated) < MAX_COORDINATE_M, stated, np.nan))


def arkit_pose_of_quaternion(quaternion: np.ndarray, place_m: np.ndarray) -> np.ndarray:
    """Convert ARKit's quaternion x, y, z, w and position in metres to a pose with OpenCV axes."""
    return arkit_pose(pose_from_quaternion(place_m, quaternion))


def files_by_stem(folder: AnyPath, suffixes: Iterable[str]) -> dict[str, AnyPath]:
    """Return the files of a folder with the given suffixes by file stem, sorted by name."""
    wanted = tuple(suffixes)
    if not folder.is_dir():
        return {}
    found = sorted(folder.iterdir(), key=lambda path: path.name)
    return {path.stem: path for path in found if path.suffix.lower() in wanted}


def read_text(path: AnyPath) -> str:
    """Read a small text file as a string.

    Raises:
        InputError: If the file is missing.
        LimitError: If the file is too large.
    """
    return read_bytes(path, MAX_TEXT_BYTES).decode("utf-8", "replace")
