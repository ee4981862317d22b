"""What hides the view in a volume, and which cells have something above: one truth a cell.

Where a person may stand, and the ways between, is told by ``minecraft.physics.graph``.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from world2minecraft.core.types import BlockVolume
from world2minecraft.minecraft.collision_shapes import boxes_of
from world2minecraft.minecraft.physics.doors import is_door
from world2minecraft.minecraft.visual import visual_boxes_of

ROOF = 0.2  # Blocks: what is lower, such as a carpet, is no roof.
SIGHT_SHARE = 0.3  # Of a cell's side: what is narrower hides little.


@dataclass(frozen=True, eq=False)
class Hiding:
    """Cells that one does not see through, and those with something above.

    Both are [X, Y, Z] in block axes from ``corner``. Doors and gates hide nothing.
    """

    hides: np.ndarray  # bool [X, Y, Z]
    roofed: np.ndarray  # bool [X, Y, Z]
    corner: tuple[int, int, int]
    blocks_per_metre: float


def hiding_of(volume: BlockVolume) -> Hiding:
    """Return what hides the view in a volume."""
    measures = np.array([_measures(state) for state in volume.palette], np.float32)
    top, width = measures[volume.states, 0], measures[volume.states, 1]
    roofs = (top > ROOF)[:, ::-1]
    return Hiding(
        hides=width > SIGHT_SHARE,
        roofed=np.logical_or.accumulate(roofs, axis=1)[:, ::-1],
        corner=volume.corner,
        blocks_per_metre=volume.blocks_per_metre,
    )


@lru_cache(maxsize=1 << 14)
def _measures(state: str) -> tuple[float, float]:
    """Return how high a state fills its cell for a body, and the width that hides the view."""
    if is_door(state):
        return 0.0, 0.0
    boxes, seen = boxes_of(state), visual_boxes_of(state)
    top = float(boxes[:, 4].max()) if len(boxes) else 0.0
    if not len(seen):
        return top, 0.0
    size = seen[:, 3:].max(axis=0) - seen[:, :3].min(axis=0)
    return top, float(np.sort(size)[1])
