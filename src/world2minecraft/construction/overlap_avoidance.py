"""One-block shifts by which an object avoids objects that were placed earlier.

Boxes that touch in metres can share a layer of blocks after snapping to the lattice. The later
object would lose a side, or disappear if it is small. A shift by one block keeps it complete.
"""

import numpy as np

STEP_COST = 0.25  # Share of its blocks that an object loses before it is moved.
LIFT_COST = 0.6  # The same before it is lifted: a book that sinks into a table still lies on it.
OPEN_COST = 0.5  # A block in space that was seen free counts half as much as a taken one.
SIDEWAYS = ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0))
UP = ((0, 0, 1),)


def best_place(blocks: np.ndarray, counts: np.ndarray, free: np.ndarray) -> np.ndarray | None:
    """Return the free block, int64 [3], in or next to most of an object's cells, or None.

    Args:
        blocks: Distinct blocks of the object's cells, int [N, 3].
        counts: Number of cells in each block, int [N].
        free: Bool mask of the unoccupied blocks of the whole lattice.
    """
    near = np.concatenate([blocks + step for step in ((0, 0, 0), *UP, *SIDEWAYS)])
    places = np.unique(near, axis=0)
    inside = ((places >= 0) & (places < free.shape)).all(axis=1)
    places = places[inside]
    places = places[free[tuple(places.T)]]
    if not len(places):
        return None
    distances = np.abs(places[:, None] - blocks).sum(axis=2)
    served = (counts * np.maximum(2 - distances, 0)).sum(axis=1)
    return places[int(np.argmax(served))]


def best_step(
    filled: np.ndarray, low: np.ndarray, free: np.ndarray, opened: np.ndarray, stands: bool
) -> np.ndarray:
    """Return the shift, int64 [3], after which the fewest blocks of an object are occupied.

    Args:
        filled: Bool [X, Y, Z] mask of the object's blocks.
        low: First block of the object, int [3].
        free: Bool mask of the unoccupied blocks of the whole lattice.
        opened: Bool mask, of the same shape, of the blocks seen as free.
        stands: Whether the object stands on a floor; otherwise it may be lifted onto its support.
    """
    cells = np.argwhere(filled) + low
    steps = ((0, 0, 0), *(() if stands else UP), *SIDEWAYS)
    costs = []
    for step in steps:
        cost = LIFT_COST if step in UP else STEP_COST if any(step) else 0.0
        moved = cells + step
        inside = ((moved >= 0) & (moved < free.shape)).all(axis=1)
        at = tuple(np.clip(moved, 0, np.array(free.shape) - 1).T)
        taken = ~(free[at] & inside)
        lost = taken.mean() if len(cells) else 0.0
        if step not in UP:
            lost += OPEN_COST * (opened[at] & ~taken).mean() if len(cells) else 0.0
        costs.append(round(float(lost) + cost, 9))
    return np.array(steps[int(np.argmin(costs))], np.int64)
