"""The paper's D and C: how full the neighbourhood of each cell is, and the cells that stand out."""

import numpy as np
from scipy import ndimage

from world2minecraft.core.classes import OBJECT_CLASSES


def object_cells(labels: np.ndarray) -> np.ndarray:
    """Return the paper's binary grid, bool [X, Y, Z]: cells of an object class, 5 to 11."""
    return (labels >= OBJECT_CLASSES[0]) & (labels <= OBJECT_CLASSES[-1])


def density_map(binary: np.ndarray, density_kernel: int) -> np.ndarray:
    """Return D = K * binary, float32 [X, Y, Z], as the share (0 to 1) of the kernel that is full.

    The uniform kernel is normalised to sum 1; beyond the grid all is empty. Counts are whole
    numbers until the last step, so that the map is the same on every machine.
    """
    counts = binary.astype(np.int32)
    ones = np.ones(density_kernel, np.int32)
    for axis in range(3):
        counts = ndimage.convolve1d(counts, ones, axis=axis, mode="constant", cval=0)
    return (counts / density_kernel**3).astype(np.float32)


def candidate_cells(
    binary: np.ndarray, density: np.ndarray, density_threshold: float
) -> np.ndarray:
    """Return C, int32 [M, 3] in the order x, y, z: object cells whose density reaches tau.

    Densities are multiples of 1 / k^3; half of one millionth keeps tau = 6/27 from missing 6/27.
    """
    return np.argwhere(binary & (density >= density_threshold - 5e-7)).astype(np.int32)
