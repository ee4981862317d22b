"""Growing, closing and naming masks, all outside counted as empty."""

import numpy as np
from scipy import ndimage

from world2minecraft.geometry.connected_components import connected_parts


def grown(mask: np.ndarray, reach: tuple[int, ...]) -> np.ndarray:
    """Return a bool mask grown by ``reach`` cells each way along each axis, corners included."""
    box = np.ones([2 * step + 1 for step in reach], bool)
    return np.asarray(ndimage.binary_dilation(mask, box), bool)


def beside(mask: np.ndarray) -> np.ndarray:
    """Return a bool mask with the face neighbours of its cells."""
    return np.asarray(ndimage.binary_dilation(mask), bool)


def shrunk(mask: np.ndarray) -> np.ndarray:
    """Return the cells of a bool mask whose face neighbours all belong to it."""
    return np.asarray(ndimage.binary_erosion(mask), bool)


def grown_within(
    mask: np.ndarray, allowed: np.ndarray, steps: np.ndarray, times: int
) -> np.ndarray:
    """Return a mask grown ``times`` by a 3x3x3 pattern of steps, only onto allowed cells."""
    result = ndimage.binary_dilation(mask, steps, iterations=times, mask=allowed)
    return np.asarray(result, bool)


def closed(mask: np.ndarray, reach: tuple[int, ...]) -> np.ndarray:
    """Return a bool mask with its gaps of up to twice ``reach`` closed along each axis."""
    padded = np.pad(mask, [(step, step) for step in reach]).astype(np.uint8)
    size = [2 * step + 1 for step in reach]
    filled = ndimage.minimum_filter(ndimage.maximum_filter(padded, size), size)
    inner = tuple(slice(step, step + side) for step, side in zip(reach, mask.shape, strict=True))
    return np.asarray(filled, bool)[inner]


def without_holes(mask: np.ndarray) -> np.ndarray:
    """Return a bool mask with what it encloses."""
    return np.asarray(ndimage.binary_fill_holes(mask), bool)


def parts_of(mask: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the number of each cell's face-connected part, from 1, and the cells of each.

    Returns:
        int32 of the mask's shape, 0 where it is empty; int64 [parts + 1], entry 0 is 0.
    """
    numbers, _ = connected_parts(mask, corners=False)
    sizes = np.bincount(numbers.ravel(), minlength=1)
    sizes[0] = 0
    return numbers, sizes


def nearest_of(mask: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the nearest cell of a mask for every cell, and how far it is.

    Args:
        mask: bool of n dimensions, at least one cell set.

    Returns:
        int32 [n, ...], indices; float64 [...], distances in cells.
    """
    away = np.zeros(mask.shape)
    nearest = np.zeros((mask.ndim, *mask.shape), np.int32)
    ndimage.distance_transform_edt(
        ~mask, return_distances=True, return_indices=True, distances=away, indices=nearest
    )
    return nearest, away
