"""Covering of blocks with few boxes of one state each, for ``fill`` commands."""

import numpy as np

from world2minecraft.core.jit import njit

MAX_FILL = 32_768  # The game's default limit of one fill command.


def cover_with_boxes(states: np.ndarray, limit: int = MAX_FILL) -> np.ndarray:
    """Cover all non-zero cells with non-overlapping boxes of one state each.

    The algorithm is greedy: in the order y, z, x, it grows a box from each uncovered cell along x,
    then z, then y.

    Args:
        states: Volume of states as uint16 [X, Y, Z] in block axes.
        limit: Maximum number of cells per box.

    Returns:
        The boxes as int32 [N, 7]: state, x0, y0, z0, x1, y1, z1, with inclusive upper bounds.
    """
    counted = _grow(states, limit, np.empty((0, 7), np.int32))
    boxes = np.empty((counted, 7), np.int32)
    _grow(states, limit, boxes)
    return boxes


@njit
def _grow(states, limit, boxes):  # pragma: no cover
    """Find the boxes, write as many as fit into ``boxes``, and return their number."""
    size_x, size_y, size_z = states.shape
    done = np.zeros(states.shape, np.bool_)
    count = 0
    for y in range(size_y):
        for z in range(size_z):
            for x in range(size_x):
                state = states[x, y, z]
                if state == 0 or done[x, y, z]:
                    continue
                x1 = x
                while x1 + 1 < size_x and x1 + 2 - x <= limit:
                    if states[x1 + 1, y, z] != state or done[x1 + 1, y, z]:
                        break
                    x1 += 1
                wide = x1 + 1 - x
                z1 = z
                while z1 + 1 < size_z and wide * (z1 + 2 - z) <= limit:
                    if not _is_free(states, done, state, x, x1, y, y, z1 + 1, z1 + 1):
                        break
                    z1 += 1
                area = wide * (z1 + 1 - z)
                y1 = y
                while y1 + 1 < size_y and area * (y1 + 2 - y) <= limit:
                    if not _is_free(states, done, state, x, x1, y1 + 1, y1 + 1, z, z1):
                        break
                    y1 += 1
                done[x : x1 + 1, y : y1 + 1, z : z1 + 1] = True
                if count < len(boxes):
                    boxes[count, 0] = state
                    boxes[count, 1], boxes[count, 2], boxes[count, 3] = x, y, z
                    boxes[count, 4], boxes[count, 5], boxes[count, 6] = x1, y1, z1
                count += 1
    return count


@njit
def _is_free(states, done, state, x0, x1, y0, y1, z0, z1):  # pragma: no cover
    for x in range(x0, x1 + 1):
        for y in range(y0, y1 + 1):
            for z in range(z0, z1 + 1):
                if states[x, y, z] != state or done[x, y, z]:
                    return False
    return True
