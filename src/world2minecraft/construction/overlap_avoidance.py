"""Steps of one block by which an object avoids others that were placed before it.

Boxes that touch in metres may share a layer of blocks once each is snapped to the lattice. What
comes later then loses a side, or all of itself where it is small; a step of one block keeps it
whole.
"""

import numpy as np

STEP_COST = 0.25  # Share of its blocks that a thing gives up before it is moved.
LIFT_COST = 0.6  # The same before it is lifted: a book that sinks into a table still lies on it.
OPEN_COST = 0.5  # A block in space that was seen free counts half as much as a taken one.
SIDEWAYS = ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0))
UP = ((0, 0, 1),)


def best_place(blocks: np.ndarray, counts: np.ndarray, free: np.ndarray) -> np.ndarray | None:
    """Return the free block, int64 [3], that most of an object's cells lie in or by, or None.

    Args:
        blocks: int [N, 3], the blocks of its cells, each once.
        counts: int [N], how many cells lie in each.
        free: bool, the blocks of the whole lattice that nothing takes.
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
    """Return the step, int64 [3], after which least of a thing's blocks are taken.

    Args:
        filled: bool [X, Y, Z], the blocks of the thing.
        low: int [3], where it begins.
        free: bool, the blocks of the whole lattice that nothing takes.
        opened: bool of that shape, the blocks that were seen free.
        stands: whether it stands on a floor; what does not may be lifted onto what it lies on.
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
