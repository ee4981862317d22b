"""A majority filter that never moves structure.

Each cell looks at the 26 around it. A cell of furniture takes the class of most furniture cells
there, itself counted, where that is more than half of them. A cell that was seen to be empty is
filled with that class where 17 of its neighbours are furniture: a pit in a surface. A bump goes: a
cell that holds to one face alone, of a cell that holds to four others; ends of legs and rims stay.
Walls, floors, ceilings, windows and unseen cells stay as they are.
"""

import numpy as np
from scipy import ndimage

from world2minecraft.core.classes import OBJECT_CLASSES

FLAT_FACES = 4  # So many other faces has a cell within a sheet.
PIT = 17  # Of 26: one below a flat surface. An inner edge, as of seat and back, has 15 and stays.


def smoothed(labels: np.ndarray) -> np.ndarray:
    """Return labels uint8 [X, Y, Z] after one pass of the filter."""
    furniture = np.isin(labels, OBJECT_CLASSES)
    counts = np.stack([_around(labels == one) for one in OBJECT_CLASSES])
    total = counts.sum(axis=0)
    most = counts.max(axis=0)
    commonest = np.array(OBJECT_CLASSES, np.uint8)[counts.argmax(axis=0)]
    result = labels.copy()
    changes = furniture & (2 * most > total)
    result[changes] = commonest[changes]
    filled = (labels == 0) & (total >= PIT)
    result[filled] = commonest[filled]
    result[furniture & _bumps((labels > 0) & (labels < 255))] = 0
    return result


def _around(mask: np.ndarray) -> np.ndarray:
    """How many of the 27 cells around each are of the mask, uint8 [X, Y, Z]."""
    count = mask.astype(np.uint8)
    for axis in range(3):
        count = ndimage.convolve1d(count, np.ones(3, np.uint8), axis=axis, mode="constant")
    return np.asarray(count)


def _bumps(occupied: np.ndarray) -> np.ndarray:
    """Which cells hold to one face alone, of a cell within a sheet; bool [X, Y, Z]."""
    padded = np.pad(occupied, 1)
    faces = np.zeros(padded.shape, np.uint8)
    for axis in range(3):
        for step in (-1, 1):
            faces += np.roll(padded, step, axis)
    sheet = padded & (faces > FLAT_FACES)
    beside = np.zeros(padded.shape, bool)
    for axis in range(3):
        for step in (-1, 1):
            beside |= np.roll(sheet, step, axis)
    inner = (slice(1, -1),) * 3
    return (padded & (faces == 1) & beside)[inner]
