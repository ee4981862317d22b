"""Connected parts of a mask: the one place that numbers them."""

import numpy as np
from scipy import ndimage


def connected_parts(mask: np.ndarray, *, corners: bool = True) -> tuple[np.ndarray, int]:
    """Number the connected parts of a bool mask of any dimension.

    Args:
        mask: the cells.
        corners: whether cells that share but an edge or a corner are joined too.

    Returns:
        int32 array of the mask's shape, 0 outside and 1 to n inside, and n.

    Example:
        >>> connected_parts(np.array([True, True, False, True]))[0].tolist()
        [1, 1, 0, 2]
    """
    parts = np.zeros(mask.shape, np.int32)
    structure = ndimage.generate_binary_structure(mask.ndim, mask.ndim if corners else 1)
    ndimage.label(mask, structure, output=parts)
    return parts, int(parts.max(initial=0))
