"""Relabel specks: a few cells of another class within the surface of one object."""

import numpy as np
from scipy import ndimage

from world2minecraft.core.classes import OBJECT_CLASSES
from world2minecraft.geometry.connected_components import label_components

MAX_SPECK_CELLS = 6  # At 0.08 m less than a sheet of paper, and less than any object has.
MIN_SURROUNDING_SHARE = 0.8  # Of the occupied cells around a speck, those of the class around it.
MIN_ENCLOSING_AXES = 2  # A surface goes on along two axes; past what stands on it, along none.
NEIGHBOURHOOD = np.ones((3, 3, 3), np.bool_)


def relabel_specks(labels: np.ndarray) -> np.ndarray:
    """Return labels, uint8 [X, Y, Z], in which specks take the class of the surrounding object.

    A speck is a connected part of an object class with at most ``MAX_SPECK_CELLS`` cells. It is
    relabelled if nearly all touching cells belong to another object class that is on both sides of
    each of its cells along the same two axes. Objects that protrude, such as items on a table, are
    kept.
    """
    result = labels.copy()
    for class_id in OBJECT_CLASSES:
        mask = labels == class_id
        if not mask.any():
            continue
        parts, _ = label_components(mask)
        sizes = np.bincount(parts[mask])
        boxes = ndimage.find_objects(parts)
        for number in np.flatnonzero((sizes > 0) & (sizes <= MAX_SPECK_CELLS)):
            box = tuple(slice(max(side.start - 1, 0), side.stop + 1) for side in boxes[number - 1])
            own = parts[box] == number
            surrounding = _surrounding_class(own, labels[box])
            if surrounding:
                result[box][own] = surrounding
    return result


def _surrounding_class(own: np.ndarray, labels: np.ndarray) -> int:
    """Return the class that surrounds a speck, bool [A, B, C], or 0."""
    adjacent = labels[ndimage.binary_dilation(own, NEIGHBOURHOOD) & ~own]
    occupied = adjacent[(adjacent > 0) & (adjacent <= OBJECT_CLASSES[-1])]
    counts = np.bincount(occupied, minlength=1)
    surrounding = int(counts.argmax())
    if surrounding not in OBJECT_CLASSES:
        return 0
    if counts[surrounding] < MIN_SURROUNDING_SHARE * len(occupied):
        return 0
    is_enclosed = _count_enclosing_axes(own, labels == surrounding) >= MIN_ENCLOSING_AXES
    return surrounding if is_enclosed else 0


def _count_enclosing_axes(own: np.ndarray, surrounding: np.ndarray) -> int:
    """Count the axes along which the surrounding class is on both sides of each cell's row."""
    own, surrounding = np.pad(own, 1), np.pad(surrounding, 1)
    return sum(
        _all_rows_end(own, surrounding, axis, 1) and _all_rows_end(own, surrounding, axis, -1)
        for axis in range(3)
    )


def _all_rows_end(own: np.ndarray, surrounding: np.ndarray, axis: int, step: int) -> bool:
    """Return whether all rows of the speck end at the surrounding class in one direction."""
    return bool(surrounding[np.roll(own, step, axis) & ~own].all())
