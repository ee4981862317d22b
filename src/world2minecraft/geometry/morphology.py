"""Growing and shrinking masks, in plan or in space; corners join."""

from typing import cast

import numpy as np
from scipy import ndimage


def grown(mask: np.ndarray, steps: int = 1) -> np.ndarray:
    """Return a bool mask grown by ``steps`` cells in all directions, corners included."""
    structure = np.ones((3,) * mask.ndim, bool)
    return cast(np.ndarray, ndimage.binary_dilation(mask, structure, iterations=steps))


def shrunk(mask: np.ndarray, steps: int = 1) -> np.ndarray:
    """Return a bool mask without its outer ``steps`` cells; beyond the array lies nothing."""
    structure = np.ones((3,) * mask.ndim, bool)
    return cast(np.ndarray, ndimage.binary_erosion(mask, structure, iterations=steps))


def opened(mask: np.ndarray) -> np.ndarray:
    """Return a bool mask without what is thinner than three cells."""
    return grown(shrunk(mask))


def filled(mask: np.ndarray, steps: int = 2) -> np.ndarray:
    """Return a bool plan with its holes, and gaps of up to ``2 * steps`` cells, closed."""
    room = np.pad(mask, 2 * steps)
    inner = (slice(2 * steps, -2 * steps),) * mask.ndim
    closed = shrunk(grown(room, steps), steps)[inner] | mask
    return cast(np.ndarray, ndimage.binary_fill_holes(closed))


def plan_of(mask: np.ndarray) -> np.ndarray:
    """Return the bool [X, Y] columns in which a mask [X, Y, Z] has a cell."""
    return cast(np.ndarray, mask.any(axis=2))
