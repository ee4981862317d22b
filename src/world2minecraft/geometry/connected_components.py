"""Connected-component labelling of masks."""

import numpy as np
from scipy import ndimage


def label_components(mask: np.ndarray, *, corners: bool = True) -> tuple[np.ndarray, int]:
    """Label the connected components of a bool mask with any number of dimensions.

    Args:
        mask: Bool array; True cells belong to components.
        corners: Whether cells that share only an edge or a corner are connected. By default they
            are.

    Returns:
        The labels as int32 array of the mask's shape, 0 outside the mask and 1 to n inside, and the
        number of components n.

    Example:
        >>> label_components(np.array([True, True, False, True]))[0].tolist()
        [1, 1, 0, 2]
    """
    labels = np.zeros(mask.shape, np.int32)
    structure = ndimage.generate_binary_structure(mask.ndim, mask.ndim if corners else 1)
    ndimage.label(mask, structure, output=labels)
    return labels, int(labels.max(initial=0))


def label_face_components(mask: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Label the face-connected components of a bool mask and count their cells.

    Returns:
        The labels as int32 array of the mask's shape, 0 outside the mask and 1 to n inside, and the
        number of cells of each label as int64 [n + 1], whose entry 0 is 0.
    """
    labels, _ = label_components(mask, corners=False)
    sizes = np.bincount(labels.ravel(), minlength=1)
    sizes[0] = 0
    return labels, sizes
