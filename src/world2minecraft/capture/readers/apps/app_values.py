"""Parsing of the numbers, cameras and poses in files of phone apps.

ARKit's camera looks along -z with y up, in a world whose y is up; ``arkit_pose`` and
``arkit_pose_of_quaternion`` give the pose of the same camera with OpenCV axes. Numbers that are
not finite stay as they are in poses: tracking was lost there, and the frame is skipped later.
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


def parse_number(path: AnyPath, stated: Mapping[str, Any], key: str) -> float:
    """Return a stated finite number.

    Raises:
        CaptureError: it is missing, or is no such number.
    """
    value = to_float(stated.get(key))
    if not math.isfinite(value):
        raise CaptureError(path, f'"{key}" must be a number, not {str(stated.get(key))[:40]}')
    return value


def to_float(value: object) -> float:
    """Return a number of JSON; NaN for what is none, infinity for a whole number too long."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return math.nan
    try:
        return float(value)
    except OverflowError:
        return math.inf


def parse_numbers(path: AnyPath, key: str, values: object, count: int) -> np.ndarray:
    """Return float64 [count] of a list, or of lists in it; NaN and infinity may stand in it.

    Raises:
        CaptureError: it is no list of so many numbers.
    """
    found = as_floats(values).reshape(-1)
    if len(found) != count or not isinstance(values, list):
        raise CaptureError(path, f'"{key}" must be a list of {count} numbers')
    return found


def parse_camera(path: AnyPath, size: tuple[float, float], lens: Sequence[float]) -> Camera:
    """Return a camera of a size and fx, fy, cx, cy in pixels.

    Raises:
        CaptureError: that is no camera.
    """
    try:
        return Camera(*size, *lens)  # type: ignore[arg-type]
    except (TypeError, ValueError, OverflowError) as error:
        raise CaptureError(path, f"intrinsics: {error}") from error


def arkit_pose(matrix: np.ndarray) -> np.ndarray:
    """Return the pose with OpenCV axes, float64 [4, 4], of ARKit's 4x4 camera transform.

    What no pose can hold becomes NaN: tracking was lost.
    """
    stated = np.asarray(matrix, np.float64)
    return opengl_to_opencv_pose(np.where(np.abs(stated) < MAX_COORDINATE_M, stated, np.nan))


def arkit_pose_of_quaternion(quaternion: np.ndarray, place_m: np.ndarray) -> np.ndarray:
    """Return the pose with OpenCV axes of ARKit's quaternion x, y, z, w and place in metres."""
    return arkit_pose(pose_from_quaternion(place_m, quaternion))


def files_by_stem(folder: AnyPath, suffixes: Iterable[str]) -> dict[str, AnyPath]:
    """Return the files of a folder by their names without suffix, in the order of the names."""
    wanted = tuple(suffixes)
    if not folder.is_dir():
        return {}
    found = sorted(folder.iterdir(), key=lambda path: path.name)
    return {path.stem: path for path in found if path.suffix.lower() in wanted}


def read_text(path: AnyPath) -> str:
    """Read a text file of ASCII numbers. Raises what ``files.read_bytes`` raises."""
    return read_bytes(path, MAX_TEXT_BYTES).decode("utf-8", "replace")
