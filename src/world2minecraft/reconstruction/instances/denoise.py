"""Specks: a few cells of another class within one object's surface are that object's."""

import numpy as np
from scipy import ndimage

from world2minecraft.core.classes import OBJECT_CLASSES
from world2minecraft.geometry.connected_components import label_components

SPECK_CELLS = 6  # At 0.08 m less than a sheet of paper, and less than any object has.
NEARLY_ALL = 0.8  # The share of the occupied cells around it that are of the class around it.
AXES_WITHIN = 2  # A surface goes on along two axes; past what stands on it, along none.
AROUND = np.ones((3, 3, 3), np.bool_)


def relabel_specks(labels: np.ndarray) -> np.ndarray:
    """Return labels, uint8 [X, Y, Z], in which specks have the class of what they lie in.

    A speck is a connected part of an object class of ``SPECK_CELLS`` at most. It lies in another
    object class where nearly all that touches it is of that class, and this lies on both sides of
    each of its cells along the same two axes. What stands on a table or before a cupboard sticks
    out of it.
    """
    result = labels.copy()
    for class_id in OBJECT_CLASSES:
        mask = labels == class_id
        if not mask.any():
            continue
        parts, _ = label_components(mask)
        sizes = np.bincount(parts[mask])
        boxes = ndimage.find_objects(parts)
        for number in np.flatnonzero((sizes > 0) & (sizes <= SPECK_CELLS)):
            box = tuple(slice(max(side.start - 1, 0), side.stop + 1) for side in boxes[number - 1])
            own = parts[box] == number
            host = _host(own, labels[box])
            if host:
                result[box][own] = host
    return result


def _host(own: np.ndarray, labels: np.ndarray) -> int:
    """Return the class in which a speck, bool [A, B, C], lies; 0 for none."""
    beside = labels[ndimage.binary_dilation(own, AROUND) & ~own]
    occupied = beside[(beside > 0) & (beside <= OBJECT_CLASSES[-1])]
    counts = np.bincount(occupied, minlength=1)
    host = int(counts.argmax())
    if host not in OBJECT_CLASSES or counts[host] < NEARLY_ALL * len(occupied):
        return 0
    return host if _axes_within(own, labels == host) >= AXES_WITHIN else 0


def _axes_within(own: np.ndarray, host: np.ndarray) -> int:
    """Count the axes along which each cell's row through the speck ends at the host both ways."""
    own, host = np.pad(own, 1), np.pad(host, 1)
    return sum(_ends(own, host, axis, 1) and _ends(own, host, axis, -1) for axis in range(3))


def _ends(own: np.ndarray, host: np.ndarray, axis: int, step: int) -> bool:
    """Tell whether all rows of the speck end at the host in one direction."""
    return bool(host[np.roll(own, step, axis) & ~own].all())
