"""Test whether bodies fit at arbitrary positions."""

import numpy as np

from world2minecraft.core.jit import njit
from world2minecraft.minecraft.physics.player_body import TOUCH
from world2minecraft.minecraft.physics.walk_graph import CollisionGrid


def bodies_fit(
    solid: CollisionGrid,
    corner: tuple[int, int, int],
    feet: np.ndarray,
    half: float,
    heights: tuple[float, float],
) -> np.ndarray:
    """Return whether the box of a body is free of collisions at each position, as bool [N].

    Args:
        solid: The collision boxes of a volume, from ``collision_grid``.
        corner: The world position of cell (0, 0, 0).
        feet: Positions of the feet in world block coordinates, float64 [N, 3].
        half: Half the width of the body's box, in blocks.
        heights: Heights of the box's bottom and top above the feet, in blocks.
    """
    middles = np.asarray(feet, np.float64) - np.array(corner)
    reach = np.array([half, 0.0, half])
    low, high = middles - reach, middles + reach
    low[:, 1] += heights[0]
    high[:, 1] += heights[1]
    return _free(solid, low + TOUCH, high - TOUCH)


@njit
def _free(solid, low, high):
    result = np.ones(len(low), np.bool_)
    for n in range(len(low)):
        result[n] = not _hits(solid, low[n], high[n])
    return result


@njit
def _hits(solid, low, high):
    nx, ny, nz = solid.kinds.shape
    for i in range(max(0, int(np.floor(low[0]))), min(nx - 1, int(np.floor(high[0]))) + 1):
        # Fences reach half a block into the cell over them.
        for j in range(max(0, int(np.floor(low[1])) - 1), min(ny - 1, int(np.floor(high[1]))) + 1):
            for k in range(max(0, int(np.floor(low[2]))), min(nz - 1, int(np.floor(high[2]))) + 1):
                kind = solid.kinds[i, j, k]
                for n in range(solid.start[kind], solid.start[kind + 1]):
                    b = solid.boxes[n]
                    if (
                        i + b[0] < high[0] and i + b[3] > low[0]
                        and j + b[1] < high[1] and j + b[4] > low[1]
                        and k + b[2] < high[2] and k + b[5] > low[2]
                    ):  # fmt: skip
                        return True
    return False
