"""What holds together: shapes that touch where the thing that they show runs on.

Block by block the best shapes of a chair are a plate at the top of one block and a leg at the
bottom of it: a hovering seat. So a pair of shapes pays where the wanted runs through the face
between them and they do not touch, and what is joined to nothing in the end is left out.
"""

from functools import lru_cache

import numpy as np

from world2minecraft.fit.masks import SUB
from world2minecraft.fit.shapes import ShapeSet
from world2minecraft.geometry.parts import connected_parts

LEAST_FLOW = 0.5  # Sub-cells of a face (of 64) from which the wanted runs through it.
BROKEN = 60.0  # Sub-cells given up for a joint: a plate half a block lower, not a whole block.
ROUNDS = 6
WAYS = np.array([(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)])


@lru_cache(maxsize=8)
def touching(shapes: ShapeSet) -> np.ndarray:
    """Return whether a shape touches another on one side of it, bool [6, S, S], ways as WAYS."""
    flat = shapes.faces.reshape(len(shapes), 3, 2, -1).astype(np.float32)
    rows = []
    for axis in range(3):
        high, low = flat[:, axis, 1], flat[:, axis, 0]
        rows += [high @ low.T > 0, low @ high.T > 0]
    return np.stack(rows)


def flows(wanted: np.ndarray) -> np.ndarray:
    """Return through which faces the wanted runs, bool [6, X, Y, Z], of blocks [X, Y, Z, 512]."""
    cells = wanted.reshape(*wanted.shape[:3], SUB, SUB, SUB)
    result = np.zeros((6, *wanted.shape[:3]), bool)
    for axis in range(3):
        high = np.take(cells, SUB - 1, 3 + axis)
        low = np.take(cells, 0, 3 + axis)
        inner = [slice(None)] * 3
        inner[axis] = slice(None, -1)
        outer = [slice(None)] * 3
        outer[axis] = slice(1, None)
        runs = np.minimum(high[tuple(inner)], low[tuple(outer)]).sum((3, 4)) > LEAST_FLOW
        result[(2 * axis, *inner)] = runs
        result[(2 * axis + 1, *outer)] = runs
    return result


def joined(
    grid: np.ndarray,
    cells: np.ndarray,
    scores: np.ndarray,
    flow: np.ndarray,
    shapes: ShapeSet,
    broken: float = BROKEN,
) -> np.ndarray:
    """Return shapes, int [X, Y, Z], changed so that neighbours touch where the wanted runs on.

    Blocks of even and of odd places take turns; none that is empty is filled.

    Args:
        grid: int [X, Y, Z], the shapes to begin with.
        cells: int [N, 3], the blocks that may change.
        scores: float32 [N, S], what each shape gains there; -inf where it may not stand.
        flow: bool [6, X, Y, Z], as of ``flows``.
        shapes: the set.
        broken: what a joint that does not touch costs, in sub-cells.
    """
    contact = touching(shapes)
    padded = np.pad(grid, 1)
    inner = padded[1:-1, 1:-1, 1:-1]
    live = grid[tuple(cells.T)] > 0
    cells, scores = cells[live], scores[live]
    odd = cells.sum(1) % 2
    for turn in range(2 * ROUNDS):
        mine = np.flatnonzero(odd == turn % 2)
        energy = scores[mine].copy()
        for way, step in enumerate(WAYS):
            at = tuple(cells[mine].T)
            other = padded[tuple((cells[mine] + 1 + step).T)]
            apart = ~contact[way][:, other].T & (other > 0)[:, None] & flow[way][at][:, None]
            energy -= np.float32(broken) * apart
        best = energy.argmax(1)
        if turn > 1 and (inner[tuple(cells[mine].T)] == best).all():
            break
        inner[tuple(cells[mine].T)] = best
    return inner.copy()


def parts_of_shapes(grid: np.ndarray, shapes: ShapeSet) -> np.ndarray:
    """Return the part, int32 [X, Y, Z], of each block: blocks that touch by faces are one part."""
    contact = touching(shapes)
    # A board of blocks and, between them, the joints: labelled at twice the size.
    board = np.zeros([2 * side - 1 for side in grid.shape], bool)
    board[::2, ::2, ::2] = grid > 0
    for axis in range(3):
        inner = [slice(None)] * 3
        inner[axis] = slice(None, -1)
        outer = [slice(None)] * 3
        outer[axis] = slice(1, None)
        between = [slice(None, None, 2)] * 3
        between[axis] = slice(1, None, 2)
        board[tuple(between)] = contact[2 * axis][grid[tuple(inner)], grid[tuple(outer)]]
    return connected_parts(board, corners=False)[0][::2, ::2, ::2]
