"""The paint of chairs: one for a chair, and the same for chairs of one set.

A chair is small and half in the shade of a table, so the median of its cells is that of shadow;
its lighter half says what it is made of, and of a frame with cushions the part that has a hue.
Chairs whose colours lie near are a set.
"""

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import OccupancyGrid

SAME_SET = 0.08  # Oklab, lightness as light as in the choice of blocks: brown and grey are 0.1.
LIGHTER_SHARE = 0.5
CLEAR_CHROMA, CLEAR_SHARE = 0.03, 0.3  # Over sensor noise; grey cushions leave so much of a frame.


def chair_paints(
    grid: OccupancyGrid, colours: np.ndarray, usable: np.ndarray, lightness_weight: float
) -> dict[int, np.ndarray]:
    """Return the Oklab colour, float32 [3], of each chair by its instance.

    Args:
        grid: the room.
        colours: float32 [X, Y, Z, 3], Oklab.
        usable: bool [X, Y, Z], the cells whose colour was seen from outside.
        lightness_weight: how much lightness counts against hue and chroma.
    """
    chairs = np.equal(grid.labels, SemanticClass.CHAIR) & usable & (grid.instance > 0)
    weight = np.array([lightness_weight, 1, 1], np.float32)
    own = {
        int(number): lit_colour(colours[chairs & (grid.instance == number)])
        for number in np.unique(grid.instance[chairs])
    }
    sets: list[list[int]] = []
    for number, colour in own.items():
        near = (s for s in sets if _apart(colour, own[s[0]], weight) <= SAME_SET)
        found = next(near, None)
        if found is None:
            sets.append([number])
        else:
            found.append(number)
    shared = {}
    for group in sets:
        paint = np.median([own[number] for number in group], axis=0).astype(np.float32)
        shared |= dict.fromkeys(group, paint)
    return shared


def lit_colour(colours: np.ndarray) -> np.ndarray:
    """Return the median, float32 [3], of the lighter half of Oklab colours [N, 3].

    Only those with a clear hue count, where they are a fair part.
    """
    clear = np.hypot(colours[:, 1], colours[:, 2]) >= CLEAR_CHROMA
    counted = colours[clear] if clear.mean() >= CLEAR_SHARE else colours
    order = np.argsort(counted[:, 0], kind="stable")
    lighter = counted[order[int(len(order) * (1 - LIGHTER_SHARE)) :]]
    return np.median(lighter, axis=0).astype(np.float32)


def _apart(one: np.ndarray, other: np.ndarray, weight: np.ndarray) -> float:
    return float(np.linalg.norm((one - other) * weight))
