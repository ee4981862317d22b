"""What holds together: shapes that touch where the thing that they show runs on.

Block by block the best shapes of a chair are a plate at the top of one block and a leg at the
bottom of it: a hovering seat. So a pair of shapes pays where the wanted runs through the face
between them and they do not touch.
"""

from functools import lru_cache

import numpy as np

from world2minecraft.construction.fitting.problem import WAYS, Problem
from world2minecraft.construction.fitting.shapes import ShapeSet
from world2minecraft.geometry.connected_components import label_components

BROKEN = 60.0  # Sub-cells given up for a joint: a plate half a block lower, not a whole block.
LEG_BROKEN = 160.0  # The same for a leg: a corner of a table may become a stair for it.
STACKED = 30.0  # Stairs over stairs: an upright wall of them looks like a washboard.
ROUNDS = 6


@lru_cache(maxsize=16)
def touching(shapes: ShapeSet) -> np.ndarray:
    """Return whether a shape touches another on one side of it, bool [6, S, S], ways as WAYS."""
    flat = shapes.faces.reshape(len(shapes), 3, 2, -1).astype(np.float32)
    rows = []
    for axis in range(3):
        high, low = flat[:, axis, 1], flat[:, axis, 0]
        rows += [high @ low.T > 0, low @ high.T > 0]
    return np.stack(rows)


def joined(
    grid: np.ndarray, rows: np.ndarray, scores: np.ndarray, problem: Problem, shapes: ShapeSet
) -> np.ndarray:
    """Return shapes, int [X, Y, Z], changed so that neighbours touch where the wanted runs on.

    Blocks of even and of odd places take turns; none that is empty is filled.

    Args:
        grid: int [X, Y, Z], the shapes to begin with.
        rows: int [M], the blocks of the problem that may change.
        scores: float32 [N, S], what each shape gains in each block; -inf where it may not stand.
        problem: what is wanted.
        shapes: the set.
    """
    contact = touching(shapes)[:, : shapes.free]
    posts, stairs = shapes.kinds == "post", shapes.kinds == "stairs"
    padded = np.pad(grid, 1)
    places = tuple((problem.cells + 1).T)
    rows = rows[padded[places][rows] > 0]
    odd = problem.cells[rows].sum(1) % 2
    moved = [True, True]
    for turn in range(2 * ROUNDS):
        mine = rows[odd == turn % 2]
        energy = scores[mine, : shapes.free].copy()
        for way, step in enumerate(WAYS):
            other = padded[tuple((problem.cells[mine] + 1 + step).T)]
            asked = problem.flows[way, mine] & (other > 0)
            cost = np.where(posts[other], LEG_BROKEN, BROKEN).astype(np.float32)
            energy -= cost[:, None] * (~contact[way][:, other].T & asked[:, None])
            if step[2]:
                energy -= np.float32(STACKED) * (stairs[other][:, None] & stairs[: shapes.free])
        best = energy.argmax(1)
        here = tuple(axis[mine] for axis in places)
        moved[turn % 2] = bool((padded[here] != best).any())
        padded[here] = best
        if not any(moved):
            break
    return padded[1:-1, 1:-1, 1:-1].copy()


def broken_share(grid: np.ndarray, problem: Problem, shapes: ShapeSet) -> float:
    """Return the share of the joints of the wanted at which shapes [X, Y, Z] do not touch."""
    contact, padded = touching(shapes), np.pad(grid, 1)
    held = broken = 0
    for way in (0, 2, 4):
        mine = problem.flows[way]
        here = problem.cells[mine] + 1
        own, other = padded[tuple(here.T)], padded[tuple((here + WAYS[way]).T)]
        held += len(own)
        broken += int((~contact[way][own, other]).sum())
    return broken / max(held, 1)


def parts_of_shapes(grid: np.ndarray, shapes: ShapeSet) -> np.ndarray:
    """Return the part, int32 [X, Y, Z], of each block: blocks that touch by faces are one part."""
    contact = touching(shapes)
    # A board of blocks and, between them, the joints: labelled at twice the size.
    board = np.zeros([2 * side - 1 for side in grid.shape], bool)
    board[::2, ::2, ::2] = grid > 0
    for axis in range(3):
        inner, outer, between = ([slice(None)] * 3 for _ in range(3))
        inner[axis], outer[axis] = slice(None, -1), slice(1, None)
        between = [slice(None, None, 2)] * 3
        between[axis] = slice(1, None, 2)
        meet = contact[2 * axis][grid[tuple(inner)], grid[tuple(outer)]]
        board[tuple(between)] = meet
    return label_components(board, corners=False)[0][::2, ::2, ::2]
