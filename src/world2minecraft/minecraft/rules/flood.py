"""Light that spreads from cell to cell, losing one a step: the flood behind every kind of light.

All arrays are flat views of a grid with one cell of margin on every side, so that a step never
leaves them. ``kinds`` names for each cell its row in ``words``, which says what light can pass:

- bits 0 to 23: which quarters of its faces are covered, four bits a face in the order -x +x -y +y
  -z +z. A quarter's bit is 2 * (upper half of the first other axis) + (upper half of the second).
  Light passes from cell to cell unless the two faces that touch cover all four quarters together.
- ``SHUT``, all of them: light never enters, but leaves freely, as it does from a glowing block.
- ``DIMS``: light that falls straight down is dimmed by it, as in water.
- ``SOLID``: it darkens corners, and has no light of its own to show. The margin is shut, not solid.
"""

import numpy as np

from world2minecraft.core.jit import njit

SHUT = 0xFFFFFF
DIMS = 1 << 24
SOLID = 1 << 25


def steps_of(shape: tuple[int, ...]) -> np.ndarray:
    """Return the six steps -x +x -y +y -z +z in a flat view of a grid, int64 [6]."""
    along = np.array([shape[1] * shape[2], shape[2], 1], np.int64)
    return np.stack([-along, along], axis=1).reshape(-1)


def with_margin(values: np.ndarray, margin: int) -> np.ndarray:
    """Return values [X, Y, Z] with one cell of ``margin`` on every side, [X + 2, Y + 2, Z + 2]."""
    padded = np.full(tuple(size + 2 for size in values.shape), margin, values.dtype)
    padded[1:-1, 1:-1, 1:-1] = values
    return padded


@njit
def spread(light, kinds, words, steps, seeds):
    """Spread light from the cells ``seeds`` (int64 [N]), which have theirs already, in place.

    Cells are raised level by level from the brightest, so that each is raised once.
    """
    first = np.zeros(258, np.int64)
    for seed in seeds:
        first[255 - light[seed] + 1] += 1
    first = np.cumsum(first)
    order, filled = np.empty(len(seeds), np.int64), first.copy()
    for seed in seeds:
        order[filled[255 - light[seed]]] = seed
        filled[255 - light[seed]] += 1
    queue, raised = np.empty(1024, np.int64), np.empty(1024, np.int64)
    count = 0
    for level in range(255, 1, -1):
        seeded = first[255 - level + 1] - first[255 - level]
        room = 6 * (seeded + count)
        if room > len(raised):
            raised = np.empty(2 * room, np.int64)
        found = 0
        for n in range(seeded):
            found = _spread_cell(
                light, kinds, words, steps, order[first[255 - level] + n], level, raised, found
            )
        for n in range(count):
            found = _spread_cell(light, kinds, words, steps, queue[n], level, raised, found)
        queue, raised, count = raised, queue, found


@njit
def _spread_cell(light, kinds, words, steps, cell, level, raised, found):
    """Raise the neighbours of a cell; append them to ``raised``, return how many it holds."""
    if light[cell] != level:  # A seed that was raised by a brighter one.
        return found
    word = words[kinds[cell]]
    if word & SHUT == SHUT:
        word = word ^ SHUT
    for side in range(6):
        near = cell + steps[side]
        if light[near] >= level - 1:
            continue
        if ((word >> (4 * side)) | (words[kinds[near]] >> (4 * (side ^ 1)))) & 15 != 15:
            light[near] = level - 1
            raised[found] = near
            found += 1
    return found
