"""Checks of grids, transforms and other values, used by the value types and by file readers.

Each function returns the checked value, with arrays as read-only views, or raises ``ValueError``
with the name of the field, the expected value and the given value.
"""

from typing import Any

import numpy as np

Shape = tuple[int | None, ...]
VOXEL_RANGE_M = (0.001, 10.0)  # Rooms use 0.02 to 0.5 m; a block is 10 m at 0.1 blocks per metre.
MAX_COORDINATE_M = 2.1e7  # No map projection of the Earth goes beyond 20,038 km.
MAX_EXTENT_M = 10_000.0
RIGID_TOLERANCE = 1e-4


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
    try:
        numbers = np.array(value, np.float64)
    except OverflowError:
        raise ValueError(f"{name} must be finite, got an integer of over 300 digits") from None
    result = array(name, numbers, np.float64, shape)
    if not np.isfinite(result).all():
        raise ValueError(f"{name} must be finite, got {result.tolist()}")
    return result


def coordinates(
    name: str, value: Any, shape: Shape, limit_m: float = MAX_COORDINATE_M
) -> np.ndarray:
    """Return positions in metres as a read-only float64 array.

    Georeferenced positions are valid: the limit is the size of the Earth's map projections.
    """
    result = floats(name, value, shape)
    if result.size and (far := float(np.abs(result).max())) > limit_m:
        raise ValueError(
            f"{name} is up to {far:.3g} m, the limit is {limit_m:.3g} m; check the unit"
        )
    return result


def lengths(name: str, value: Any, shape: Shape) -> np.ndarray:
    """Return lengths in metres as a read-only float64 array, none beyond that of a world."""
    return coordinates(name, value, shape, MAX_EXTENT_M)


def transform(name: str, value: Any, tolerance: float = RIGID_TOLERANCE) -> np.ndarray:
    """Return a rigid right-handed 4x4 transform of metres, orthonormal within ``tolerance``."""
    result = floats(name, value, (4, 4))
    if fault := rigid_fault(result, tolerance):
        raise ValueError(f"{name} must be a rotation and a translation, but {fault}")
    return result


def similarity(name: str, value: Any) -> np.ndarray:
    """Return a 4x4 transform from blocks or cells to metres: a rigid one with a uniform scale."""
    result = floats(name, value, (4, 4))
    scale = float(np.linalg.norm(result[:3, 0]))
    low, high = VOXEL_RANGE_M
    if not low <= scale <= high:
        raise ValueError(
            f"{name} must scale by {low:g} to {high:g} m, got {scale:g}; check the unit"
        )
    rigid = result.copy()
    rigid[:3, :3] /= scale
    if fault := rigid_fault(rigid, RIGID_TOLERANCE):
        raise ValueError(f"{name} must be a rotation, a scale and a translation, but {fault}")
    return result


def rigid_fault(matrix: np.ndarray, tolerance: float) -> str:
    """Return why a 4x4 matrix is not a rigid transform of metres, and what to do; else "".

    Example:
        >>> rigid_fault(np.diag([1.0, 1.0, -1.0, 1.0]), 1e-4)
        'is mirrored (determinant -1.000); check for an axis flipped on export'
    """
    if not np.isfinite(matrix).all():
        return "contains NaN or infinity"
    if not np.allclose(matrix[3], [0, 0, 0, 1], rtol=0, atol=1e-6):
        return f"ends with the row {matrix[3].tolist()}, not 0 0 0 1; transpose the matrix"
    rotation = matrix[:3, :3]
    if (largest := float(np.abs(rotation).max())) > 1e6:
        return f"has a rotation with entries up to {largest:.3g}; export it again"
    if np.abs(rotation @ rotation.T - np.eye(3)).max() > tolerance:
        sizes = np.linalg.svd(rotation, compute_uv=False)
        if np.ptp(sizes) < 0.01 * sizes[0] and np.ptp(sizes) < abs(sizes.mean() - 1):
            return f"is scaled by {sizes.mean():.4g}; divide the rotation by the scale"
        return "has a rotation that is not orthonormal; export it again"
    if (turn := float(np.linalg.det(rotation))) < 0:
        return f"is mirrored (determinant {turn:.3f}); check for an axis flipped on export"
    if (far := float(np.abs(matrix[:3, 3]).max())) > MAX_COORDINATE_M:
        return f"moves by {far:.3g} m, the limit is {MAX_COORDINATE_M:.3g} m; check the unit"
    return ""


def positive(name: str, value: float) -> float:
    """Return a finite number above zero."""
    number = float(value)
    if not (np.isfinite(number) and number > 0):
        raise ValueError(f"{name} must be above 0, got {value}")
    return number


def voxel_size(value: float) -> float:
    """Return the edge length of a cell in metres if it is plausible."""
    number = positive("voxel_m", value)
    low, high = VOXEL_RANGE_M
    if not low <= number <= high:
        advice = "give it in metres, not millimetres" if number > high else "check the unit"
        raise ValueError(f"voxel_m must be {low:g} to {high:g} m, got {number:g}; {advice}")
    return number


def extent(shape: tuple[int, ...], voxel_m: float) -> None:
    """Raise ``ValueError`` for a grid that is larger than any room, house or world."""
    longest = max(shape) * voxel_m
    if longest > MAX_EXTENT_M:
        raise ValueError(
            f"the grid is {longest:,.0f} m long, the limit is {MAX_EXTENT_M:,.0f} m; check voxel_m"
        )


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
    result = coordinates("origin_m", value, (3,))
    cells = result / voxel_m
    # Far from the frame's origin, a coordinate itself is rounded to a share of a nanometre.
    if (np.abs(cells - np.round(cells)) > 1e-6 + 4 * np.spacing(np.abs(cells))).any():
        raise ValueError(f"origin_m must be a multiple of {voxel_m} m, got {result.tolist()}")
    return result


def object_name(value: str) -> str:
    """Return an object's name if it is at most 200 printable characters; it may be empty."""
    if not isinstance(value, str) or len(value) > 200 or not value.isprintable():
        raise ValueError("name must be at most 200 printable characters")
    return value
