"""A body's way along the ground, compiled: what stops it, what it steps up on, where it drops.

A way is cut into short pieces, each shorter than the body, so that nothing is passed through. Of
each piece only its end is looked at: the body fits there, or fits on top of what is in the way.
Places are feet in world blocks. ``moves.moved`` is the door to this file.
"""

from typing import NamedTuple

import numpy as np

from world2minecraft.core.jit import njit
from world2minecraft.minecraft.physics.body import TOUCH
from world2minecraft.minecraft.physics.columns import WET

PIECE = 0.4  # Of half a body's width: how long the pieces of a way are.
CHAIR, FURN = 5, 10  # The classes of furniture, from the first to the last: no ground to walk on.


class BodySize(NamedTuple):
    """Lengths of a body, in blocks."""

    half: float  # of its width
    height: float
    climb: float  # what it steps up without a jump
    drop: float  # the farthest that it steps down


@njit
def walked(solid, corner, x, y, z, dx, dz, size, sliding):
    """Return the feet after a way along the ground, and whether something stopped it.

    ``solid`` is a volume's ``Solid``, ``corner`` int64 [3] the world place of its first cell,
    ``size`` a ``BodySize``. One who does not slide either goes the whole way or stays.
    """
    pieces = max(1, int(np.ceil(np.sqrt(dx * dx + dz * dz) / (size.half * PIECE))))
    px, pz = dx / pieces, dz / pieces
    here_x, here_y, here_z, stopped = x, y, z, False
    for _ in range(pieces):
        free, level = _ground_at(solid, corner, here_x, here_y, here_z, px, pz, size)
        if free:
            here_x, here_y, here_z = here_x + px, level, here_z + pz
            continue
        stopped = True
        if not sliding:
            return x, y, z, True
        for turn in range(2):  # Along the longer side first, as the game does.
            along_x = (turn == 0) == (abs(px) >= abs(pz))
            qx, qz = (px, 0.0) if along_x else (0.0, pz)
            free, level = _ground_at(solid, corner, here_x, here_y, here_z, qx, qz, size)
            if free:
                here_x, here_y, here_z = here_x + qx, level, here_z + qz
    return here_x, here_y, here_z, stopped


@njit
def _ground_at(solid, corner, x, y, z, px, pz, size):
    """Return whether a body comes to the end of a piece of a way, and the height of its feet."""
    at_x, at_y, at_z = x + px - corner[0], y - corner[1], z + pz - corner[2]
    if px == 0.0 and pz == 0.0:
        return True, y
    top = _top_in(solid, at_x, at_y, at_z, size)
    level = at_y
    if top > at_y:
        if top - at_y > size.climb + TOUCH:
            return False, y
        level = top
        if _top_in(solid, at_x, level, at_z, size) > level:
            return False, y
        if _top_in(solid, x - corner[0], level, z - corner[2], size) > level:
            return False, y
    ground, kind = _under(solid, at_x, level, at_z, size)
    if level - ground > size.drop + TOUCH or kind == WET:
        return False, y
    if CHAIR <= kind <= FURN and abs(ground - at_y) > TOUCH:
        return False, y
    return True, ground + corner[1]


@njit
def _top_in(solid, x, y, z, size):
    """Return the highest top of what is in a body's box, -1e9 for nothing; grid coordinates."""
    nx, ny, nz = solid.kinds.shape
    low_x, high_x = x - size.half + TOUCH, x + size.half - TOUCH
    low_z, high_z = z - size.half + TOUCH, z + size.half - TOUCH
    low_y, high_y = y + TOUCH, y + size.height - TOUCH
    best = -1e9
    for i in range(max(0, int(np.floor(low_x))), min(nx - 1, int(np.floor(high_x))) + 1):
        # Fences reach half a block into the cell over them.
        for j in range(max(0, int(np.floor(low_y)) - 1), min(ny - 1, int(np.floor(high_y))) + 1):
            for k in range(max(0, int(np.floor(low_z))), min(nz - 1, int(np.floor(high_z))) + 1):
                kind = solid.kinds[i, j, k]
                if kind == 0:
                    continue
                for n in range(solid.start[kind], solid.start[kind + 1]):
                    b = solid.boxes[n]
                    if (
                        i + b[0] < high_x and i + b[3] > low_x
                        and j + b[1] < high_y and j + b[4] > low_y
                        and k + b[2] < high_z and k + b[5] > low_z
                    ):  # fmt: skip
                        best = max(best, j + b[4])
    return best


@njit
def _under(solid, x, y, z, size):
    """Return the highest top under a body's feet and its class; -1e9 and 0 for nothing."""
    nx, ny, nz = solid.kinds.shape
    low_x, high_x = x - size.half + TOUCH, x + size.half - TOUCH
    low_z, high_z = z - size.half + TOUCH, z + size.half - TOUCH
    best, found = -1e9, 0
    for j in range(min(ny - 1, int(np.floor(y + TOUCH))), -1, -1):
        if j + 1.5 < max(best, y - size.drop) - TOUCH:
            break
        for i in range(max(0, int(np.floor(low_x))), min(nx - 1, int(np.floor(high_x))) + 1):
            for k in range(max(0, int(np.floor(low_z))), min(nz - 1, int(np.floor(high_z))) + 1):
                kind = solid.kinds[i, j, k]
                if kind == 0:
                    continue
                for n in range(solid.start[kind], solid.start[kind + 1]):
                    b = solid.boxes[n]
                    beside = (
                        i + b[0] >= high_x or i + b[3] <= low_x
                        or k + b[2] >= high_z or k + b[5] <= low_z
                    )  # fmt: skip
                    top = j + b[4]
                    if beside or top > y + TOUCH or top < best - TOUCH:
                        continue
                    label = int(solid.classes[i, j, k])
                    label = 0 if label == 255 else label
                    found = label if top > best + TOUCH else max(found, label)
                    best = max(best, top)
    return best, found
