"""Connected components of masks: the only module that labels them."""

import numpy as np
from scipy import ndimage


def label_components(mask: np.ndarray, *, corners: bool = True) -> tuple[np.ndarray, int]:
    """Label the connected components of a bool mask of any dimension.

    Args:
        mask: the cells.
        corners: whether cells that share only an edge or a corner are connected too.

    Returns:
        int32 array of the mask's shape, 0 outside and 1 to n inside, and n.

    Example:
        >>> label_components(np.array([True, True, False, True]))[0].tolist()
        [1, 1, 0, 2]
    """
    labels = np.zeros(mask.shape, np.int32)
    structure = ndimage.generate_binary_structure(mask.ndim, mask.ndim if corners else 1)
    ndimage.label(mask, structure, output=labels)
    return labels, int(labels.max(initial=0))


def label_face_components(mask: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Label the face-connected components of a bool mask, and count the cells of each.

    Returns:
        int32 of the mask's shape, 0 where it is empty, else 1 to n; int64 [n + 1] cells of each
        label, entry 0 is 0.
    """
    labels, _ = label_components(mask, corners=False)
    sizes = np.bincount(labels.ravel(), minlength=1)
    sizes[0] = 0
    return labels, sizes
