"""Majority smoothing: parts of a class that are too small take the class around them."""

import numpy as np

from world2minecraft.core.classes import CLASS_COUNT
from world2minecraft.geometry.connected_components import label_components

NEIGHBOURHOOD = np.argwhere(np.ones((3, 3, 3), bool))


def smooth_labels(labels: np.ndarray, small_cells: int) -> np.ndarray:
    """Return labels in which small parts take the class of most of their neighbours.

    Args:
        labels: Labels, uint8 [X, Y, Z], 0 to 11 or 255. Only occupied cells change, and only to
            classes 1 to 11; parts without occupied neighbours keep their class.
        small_cells: Number of cells below which a part is small.
    """
    result = labels.copy()
    padded = np.pad(labels, 1)
    for class_id in range(1, CLASS_COUNT):
        parts, count = label_components(labels == class_id)
        sizes = np.bincount(parts.reshape(-1), minlength=count + 1)
        small = np.flatnonzero(sizes < small_cells)
        cells = np.argwhere(np.isin(parts, small[small > 0]))
        if not len(cells):
            continue
        owner = parts[tuple(cells.T)]
        table = np.zeros((count + 1, CLASS_COUNT), np.int64)
        for step in NEIGHBOURHOOD:
            near = padded[tuple((cells + step).T)]
            other = (near > 0) & (near < CLASS_COUNT) & (near != class_id)
            np.add.at(table, (owner[other], near[other]), 1)
        winner = np.where(table.max(axis=1) > 0, table.argmax(axis=1), class_id)
        result[tuple(cells.T)] = winner[owner]
    return result
