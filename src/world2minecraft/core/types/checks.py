"""Checks used by the constructors of the value types.

Each function returns the checked value, with arrays as read-only views, or raises ``ValueError``
with the name of the field, the expected value and the given value.
"""

from typing import Any

import numpy as np

Shape = tuple[int | None, ...]


def array(name: str, value: Any, dtype: Any, shape: Shape) -> np.ndarray:
    """Return ``value`` as a read-only C-ordered array with a given dtype and shape.

    None in ``shape`` accepts any size. The dtype must match exactly, so that no stage hides a lossy
    conversion.
    """
    result = np.asarray(value)
    expected = np.dtype(dtype)
    if result.dtype != expected:
        raise ValueError(f"{name} must be {expected}, got {result.dtype}")
    if result.ndim != len(shape) or any(
        want is not None and want != have for want, have in zip(shape, result.shape, strict=True)
    ):
        wanted = "x".join("any" if size is None else str(size) for size in shape)
        raise ValueError(f"{name} must have shape {wanted}, got {result.shape}")
    view = np.ascontiguousarray(result).view()
    view.flags.writeable = False
    return view


def floats(name: str, value: Any, shape: Shape) -> np.ndarray:
    """Return ``value`` as a finite read-only float64 array."""
    result = array(name, np.array(value, np.float64), np.float64, shape)
    if not np.isfinite(result).all():
        raise ValueError(f"{name} must be finite, got {result.tolist()}")
    return result


def transform(name: str, value: Any) -> np.ndarray:
    """Return a rigid right-handed 4x4 transform: orthonormal within 1e-4, last row 0 0 0 1."""
    result = floats(name, value, (4, 4))
    rotation = result[:3, :3]
    if np.abs(rotation @ rotation.T - np.eye(3)).max() > 1e-4 or np.linalg.det(rotation) < 0:
        raise ValueError(f"{name} must be a rotation and a translation, got {result.tolist()}")
    if not np.array_equal(result[3], [0, 0, 0, 1]):
        raise ValueError(f"{name} must end with the row 0 0 0 1, got {result[3].tolist()}")
    return result


def positive(name: str, value: float) -> float:
    """Return a finite number above zero."""
    number = float(value)
    if not (np.isfinite(number) and number > 0):
        raise ValueError(f"{name} must be above 0, got {value}")
    return number


def fraction(name: str, value: float) -> float:
    """Return a number from 0 to 1."""
    number = float(value)
    if not 0 <= number <= 1:
        raise ValueError(f"{name} must be between 0 and 1, got {value}")
    return number


def identifier(name: str, value: str) -> str:
    """Return a short printable name without path parts."""
    if not value or len(value) > 200 or not value.isprintable() or "/" in value or "\\" in value:
        raise ValueError(f"{name} must be a short printable name without slashes, got {value!r}")
    return value


def labels(name: str, value: Any, shape: Shape) -> np.ndarray:
    """Return a uint8 array whose values are 0 to 11 or 255."""
    result = array(name, value, np.uint8, shape)
    # Most volumes have no label at all: then one look is enough, and takes no memory.
    if result.size and result.max() > 11 and np.any((result > 11) & (result != 255)):
        bad = int(result[(result > 11) & (result != 255)][0])
        raise ValueError(f"{name} must contain class ids 0 to 11 or 255, got {bad}")
    return result


def origin(value: Any, voxel_m: float) -> np.ndarray:
    """Return the minimum corner of a grid, which must be a multiple of the voxel size.

    An offset of half a cell reduced the IoU by a quarter in an experiment, so it is not allowed.
    """
    result = floats("origin_m", value, (3,))
    cells = result / voxel_m
    if np.abs(cells - np.round(cells)).max() > 1e-6:
        raise ValueError(f"origin_m must be a multiple of {voxel_m} m, got {result.tolist()}")
    return result


def object_name(value: str) -> str:
    """Return an object's name if it is at most 200 printable characters; it may be empty."""
    if not isinstance(value, str) or len(value) > 200 or not value.isprintable():
        raise ValueError("name must be at most 200 printable characters")
    return value
