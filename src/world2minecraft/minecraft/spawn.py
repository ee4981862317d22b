"""Where a player may stand in a volume of blocks, for worlds that come without a spawn."""

import numpy as np

from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraft.collision_shapes import boxes_of

PLAYER_LAYERS = 2  # A player is 1.8 blocks high.


def top_of_middle(volume: BlockVolume) -> tuple[float, float, float]:
    """Return where feet can stand nearest to the middle of the volume, in world blocks.

    A place is a block whose boxes leave the player's two layers above it free. Places under a
    roof are taken before others, then the nearest to the middle, then the lowest. Where nothing
    can be stood on, the place is the middle above the volume.
    """
    size_x, size_y, size_z = volume.states.shape
    tops = np.array([_top(state) for state in volume.palette])
    heights = np.pad(tops[volume.states], ((0, 0), (0, PLAYER_LAYERS), (0, 0)))
    is_free = heights == 0
    stands = (heights[:, :size_y] > 0) & is_free[:, 1 : size_y + 1] & is_free[:, 2:]
    middle = np.array([size_x / 2 - 0.5, size_z / 2 - 0.5])
    x, y, z = volume.corner
    if not stands.any():
        return (x + size_x / 2, float(y + size_y), z + size_z / 2)
    cells = np.argwhere(stands)
    distance = np.square(cells[:, [0, 2]] - middle).sum(axis=1)
    roof = np.where(volume.states.any(axis=1), size_y - 1 - _first(volume.states[:, ::-1]), -1)
    is_outside = cells[:, 1] >= roof[cells[:, 0], cells[:, 2]]
    best = cells[np.lexsort((cells[:, 1], distance, is_outside))[0]]
    floor = float(y + best[1] + heights[tuple(best)])
    return (float(x + best[0] + 0.5), floor, float(z + best[2] + 0.5))


def _first(states: np.ndarray) -> np.ndarray:
    """The first layer of each column that is not air."""
    return (states > 0).argmax(axis=1)


def _top(state: str) -> float:
    boxes = boxes_of(state)
    return float(boxes[:, 4].max()) if len(boxes) else 0.0
