"""Binary morphology of 2D and 3D masks; cells outside the array count as empty.

Radii are in cells. ``dilate``, ``erode``, ``binary_opening`` and ``binary_closing`` use a full box
as structuring element, so diagonal neighbours are connected. ``dilate_faces`` and ``erode_faces``
use only the cells that share a face.
"""

from typing import cast

import numpy as np
from scipy import ndimage


def dilate(mask: np.ndarray, radius: int | tuple[int, ...] = 1) -> np.ndarray:
    """Dilate a bool mask by ``radius`` cells, or by one radius per axis."""
    if isinstance(radius, tuple):
        box = np.ones([2 * cells + 1 for cells in radius], bool)
        return np.asarray(ndimage.binary_dilation(mask, box), bool)
    structure = np.ones((3,) * mask.ndim, bool)
    return cast(np.ndarray, ndimage.binary_dilation(mask, structure, iterations=radius))


def dilate_faces(mask: np.ndarray) -> np.ndarray:
    """Return a bool mask extended by the face neighbours of its cells."""
    return np.asarray(ndimage.binary_dilation(mask), bool)


def dilate_within(
    mask: np.ndarray, allowed: np.ndarray, structure: np.ndarray, iterations: int
) -> np.ndarray:
    """Dilate a bool mask repeatedly by a 3x3x3 structuring element, restricted to allowed cells."""
    result = ndimage.binary_dilation(mask, structure, iterations=iterations, mask=allowed)
    return np.asarray(result, bool)


def erode(mask: np.ndarray, radius: int = 1) -> np.ndarray:
    """Erode a bool mask by ``radius`` cells."""
    structure = np.ones((3,) * mask.ndim, bool)
    return cast(np.ndarray, ndimage.binary_erosion(mask, structure, iterations=radius))


def erode_faces(mask: np.ndarray) -> np.ndarray:
    """Return the cells of a bool mask whose face neighbours all belong to the mask."""
    return np.asarray(ndimage.binary_erosion(mask), bool)


def binary_opening(mask: np.ndarray) -> np.ndarray:
    """Return a bool mask without the parts that are thinner than three cells."""
    return dilate(erode(mask))


def binary_closing(mask: np.ndarray, radius: tuple[int, ...]) -> np.ndarray:
    """Close gaps of a bool mask of up to twice the radius along each axis."""
    padded = np.pad(mask, [(cells, cells) for cells in radius]).astype(np.uint8)
    size = [2 * cells + 1 for cells in radius]
    filled = ndimage.minimum_filter(ndimage.maximum_filter(padded, size), size)
    inner = tuple(slice(cells, cells + n) for cells, n in zip(radius, mask.shape, strict=True))
    return np.asarray(filled, bool)[inner]


def fill_holes(mask: np.ndarray) -> np.ndarray:
    """Fill the holes that a bool mask encloses."""
    return np.asarray(ndimage.binary_fill_holes(mask), bool)


def fill_gaps_and_holes(mask: np.ndarray, radius: int = 2) -> np.ndarray:
    """Fill the holes of a 2D bool mask and its gaps of up to ``2 * radius`` cells."""
    padded = np.pad(mask, 2 * radius)
    inner = (slice(2 * radius, -2 * radius),) * mask.ndim
    closed = erode(dilate(padded, radius), radius)[inner] | mask
    return cast(np.ndarray, ndimage.binary_fill_holes(closed))


def project_to_plan(mask: np.ndarray) -> np.ndarray:
    """Return the bool [X, Y] columns in which a mask [X, Y, Z] has at least one cell."""
    return cast(np.ndarray, mask.any(axis=2))


def nearest_set_cells(mask: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Find the nearest set cell of a mask for every cell.

    Args:
        mask: Bool array with n dimensions and at least one set cell.

    Returns:
        The indices of the nearest set cell as int32 [n, ...], and the distances to it in cells as
        float64 [...].
    """
    distances = np.zeros(mask.shape)
    nearest = np.zeros((mask.ndim, *mask.shape), np.int32)
    ndimage.distance_transform_edt(
        ~mask, return_distances=True, return_indices=True, distances=distances, indices=nearest
    )
    return nearest, distances
