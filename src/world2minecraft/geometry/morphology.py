"""Binary morphology of masks in plan or in space; everything outside the array counts as empty.

Radii are in cells. ``dilate``, ``erode``, ``binary_opening`` and ``binary_closing`` use a full box
as structuring element, so that corners join; ``dilate_faces`` and ``erode_faces`` look at the
cells that share a face.
"""

from typing import cast

import numpy as np
from scipy import ndimage


def dilate(mask: np.ndarray, radius: int | tuple[int, ...] = 1) -> np.ndarray:
    """Return a bool mask dilated by ``radius`` cells, or by a radius for each axis."""
    if isinstance(radius, tuple):
        box = np.ones([2 * cells + 1 for cells in radius], bool)
        return np.asarray(ndimage.binary_dilation(mask, box), bool)
    structure = np.ones((3,) * mask.ndim, bool)
    return cast(np.ndarray, ndimage.binary_dilation(mask, structure, iterations=radius))


def dilate_faces(mask: np.ndarray) -> np.ndarray:
    """Return a bool mask with the face neighbours of its cells."""
    return np.asarray(ndimage.binary_dilation(mask), bool)


def dilate_within(
    mask: np.ndarray, allowed: np.ndarray, structure: np.ndarray, iterations: int
) -> np.ndarray:
    """Return a mask dilated repeatedly by a 3x3x3 structuring element, onto allowed cells only."""
    result = ndimage.binary_dilation(mask, structure, iterations=iterations, mask=allowed)
    return np.asarray(result, bool)


def erode(mask: np.ndarray, radius: int = 1) -> np.ndarray:
    """Return a bool mask without its outer ``radius`` cells."""
    structure = np.ones((3,) * mask.ndim, bool)
    return cast(np.ndarray, ndimage.binary_erosion(mask, structure, iterations=radius))


def erode_faces(mask: np.ndarray) -> np.ndarray:
    """Return the cells of a bool mask whose face neighbours all belong to it."""
    return np.asarray(ndimage.binary_erosion(mask), bool)


def binary_opening(mask: np.ndarray) -> np.ndarray:
    """Return a bool mask without what is thinner than three cells."""
    return dilate(erode(mask))


def binary_closing(mask: np.ndarray, radius: tuple[int, ...]) -> np.ndarray:
    """Return a bool mask with gaps of up to twice a radius closed along each axis."""
    padded = np.pad(mask, [(cells, cells) for cells in radius]).astype(np.uint8)
    size = [2 * cells + 1 for cells in radius]
    filled = ndimage.minimum_filter(ndimage.maximum_filter(padded, size), size)
    inner = tuple(slice(cells, cells + n) for cells, n in zip(radius, mask.shape, strict=True))
    return np.asarray(filled, bool)[inner]


def fill_holes(mask: np.ndarray) -> np.ndarray:
    """Return a bool mask with the holes that it encloses filled."""
    return np.asarray(ndimage.binary_fill_holes(mask), bool)


def fill_gaps_and_holes(mask: np.ndarray, radius: int = 2) -> np.ndarray:
    """Return a bool plan with its holes, and gaps of up to ``2 * radius`` cells, filled."""
    padded = np.pad(mask, 2 * radius)
    inner = (slice(2 * radius, -2 * radius),) * mask.ndim
    closed = erode(dilate(padded, radius), radius)[inner] | mask
    return cast(np.ndarray, ndimage.binary_fill_holes(closed))


def project_to_plan(mask: np.ndarray) -> np.ndarray:
    """Return the bool [X, Y] columns in which a mask [X, Y, Z] has a cell."""
    return cast(np.ndarray, mask.any(axis=2))


def nearest_set_cells(mask: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the nearest set cell of a mask for every cell, and the distance to it.

    Args:
        mask: bool of n dimensions, at least one cell set.

    Returns:
        int32 [n, ...], indices; float64 [...], distances in cells.
    """
    distances = np.zeros(mask.shape)
    nearest = np.zeros((mask.ndim, *mask.shape), np.int32)
    ndimage.distance_transform_edt(
        ~mask, return_distances=True, return_indices=True, distances=distances, indices=nearest
    )
    return nearest, distances
