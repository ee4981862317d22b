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


HALF_OF_26 = [
    (dx, dy, dz)
    for dx in (-1, 0, 1)
    for dy in (-1, 0, 1)
    for dz in (-1, 0, 1)
    if (dx, dy, dz) > (0, 0, 0)
]


def touching_pairs(owners: np.ndarray, labels: np.ndarray | None = None) -> list[tuple[int, int]]:
    """Return the pairs of numbered parts that touch at a face, an edge or a corner, sorted.

    Args:
        owners: Number of the part of each cell, int [X, Y, Z], 0 for none.
        labels: Only cells with the same label count, uint8 [X, Y, Z].
    """
    pairs: set[tuple[int, int]] = set()
    for shift in HALF_OF_26:
        near = tuple(
            slice(max(0, -s), n - max(0, s)) for s, n in zip(shift, owners.shape, strict=True)
        )
        far = tuple(
            slice(max(0, s), n - max(0, -s)) for s, n in zip(shift, owners.shape, strict=True)
        )
        meets = (owners[near] != owners[far]) & (owners[near] > 0) & (owners[far] > 0)
        if labels is not None:
            meets &= labels[near] == labels[far]
        both = np.stack([owners[near][meets], owners[far][meets]], axis=1)
        pairs |= {(int(a), int(b)) for a, b in np.unique(np.sort(both, axis=1), axis=0)}
    return sorted(pairs)
