"""Where a person may stand in a volume: one place a cell, with headroom and elbow room.

Sizes follow the volume's scale: at 4 blocks a metre a person is 7.2 blocks high. Doors and gates
count as open. What is furniture by its label, and beds, are nothing to stand on.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from world2minecraft.classes import SemanticClass
from world2minecraft.minecraft.shapes import boxes_of
from world2minecraft.minecraft.visual import visual_boxes_of
from world2minecraft.types import BlockVolume

BODY_WIDTH, BODY_HEIGHT = 0.6, 1.8  # Metres; the game's player at one block a metre.
STEP_M = 0.3  # One climbs so much; at one block a metre a whole block, by stairs or a jump.
CARPET = 0.2  # Blocks: lower than this, one walks over it.
SLAB = 0.6  # Blocks: up to this height one stands in the block's own cell.
SIGHT_SHARE = 0.3  # Of a cell's side: what is narrower hides little.
_FURNITURE = [int(one) for one in SemanticClass if SemanticClass.CHAIR <= one < SemanticClass.OBJS]
_PASSED = ("_door", "_fence_gate")
_LIQUID = ("minecraft:water", "minecraft:lava")


@dataclass(frozen=True, eq=False)
class Floor:
    """All places to stand, and what hides the view.

    ``stands`` tells the cells that hold feet, ``feet_y`` how high in world blocks they are there.
    ``hides`` tells the cells that one does not see through. ``roofed`` tells the cells with
    something above. All are [X, Y, Z] in block axes from ``corner``.
    """

    stands: np.ndarray  # bool [X, Y, Z]
    feet_y: np.ndarray  # float32 [X, Y, Z]
    hides: np.ndarray  # bool [X, Y, Z]
    roofed: np.ndarray  # bool [X, Y, Z]
    corner: tuple[int, int, int]
    blocks_per_metre: float

    @property
    def step_blocks(self) -> int:
        """How many cells one climbs at once."""
        return max(1, int(STEP_M * self.blocks_per_metre))


@lru_cache(maxsize=1 << 14)
def _body(state: str) -> tuple[float, float]:
    """Return how high a state fills its cell for a body, and the width that hides the view."""
    name = state.partition("[")[0]
    if name in _LIQUID:
        return 2.0, 0.0  # Neither a way nor a ground.
    boxes, seen = boxes_of(state), visual_boxes_of(state)
    top = 0.0 if name.endswith(_PASSED) or not len(boxes) else float(boxes[:, 4].max())
    if name.endswith("_bed"):
        top = 2.0
    if not len(seen) or name.endswith(_PASSED):
        return top, 0.0
    size = seen[:, 3:].max(axis=0) - seen[:, :3].min(axis=0)
    return top, float(np.sort(size)[1])


def floor_of(volume: BlockVolume) -> Floor:
    """Return the places where a person may stand in a volume."""
    measures = np.array([_body(state) for state in volume.palette], np.float32)
    top, width = measures[volume.states, 0], measures[volume.states, 1]
    blocked = top > CARPET
    scale = volume.blocks_per_metre
    step = max(1, int(STEP_M * scale))
    high = int(np.ceil(BODY_HEIGHT * scale - 1e-6))
    ground = (top > 0.9) & (top <= 1.0) & ~np.isin(volume.semantic, _FURNITURE)
    below = np.zeros_like(ground)
    below[:, 1:] = ground[:, :-1]
    on_block = below & ~blocked
    on_slab = (top > CARPET) & (top <= SLAB) & ~np.isin(volume.semantic, _FURNITURE)
    near = _grown(blocked, int(np.ceil(BODY_WIDTH / 2 * scale - 0.5 - 1e-6)))
    stands = on_block & _free(blocked, 0, high) & _free(near, step, high)
    stands |= on_slab & _free(blocked, 1, high + 1) & _free(near, step, high + 1)
    hides = width > SIGHT_SHARE
    stands &= ~_shifted(hides, int(1.62 * scale))  # Nothing stands in the eye.
    y = volume.corner[1] + np.arange(top.shape[1], dtype=np.float32)[None, :, None]
    return Floor(
        stands=stands,
        feet_y=y + np.where(top <= SLAB, top, 0.0).astype(np.float32),
        hides=hides,
        roofed=_above(blocked),
        corner=volume.corner,
        blocks_per_metre=scale,
    )


def _free(blocked: np.ndarray, first: int, past: int) -> np.ndarray:
    """Tell the cells over which the cells ``first`` to ``past`` are free; above all is free."""
    counts = np.zeros((blocked.shape[0], blocked.shape[1] + 1, blocked.shape[2]), np.int32)
    np.cumsum(blocked, axis=1, out=counts[:, 1:])
    rows = np.arange(blocked.shape[1])
    low, high = (np.minimum(rows + n, blocked.shape[1]) for n in (first, past))
    return counts[:, high] == counts[:, low]


def _shifted(values: np.ndarray, up: int) -> np.ndarray:
    """Return for each cell the value of the cell ``up`` cells above, False over the volume."""
    result = np.zeros_like(values)
    if up < values.shape[1]:
        result[:, : values.shape[1] - up] = values[:, up:]
    return result


def _above(blocked: np.ndarray) -> np.ndarray:
    """Tell the cells with a blocked one somewhere above."""
    return np.logical_or.accumulate(blocked[:, ::-1], axis=1)[:, ::-1]


def _grown(blocked: np.ndarray, cells: int) -> np.ndarray:
    """Return the cells within so many cells of a blocked one, along x and z."""
    grown = blocked.copy()
    for axis in (0, 2):
        source = grown.copy()
        for step in range(1, cells + 1):
            low, high = [slice(None)] * 3, [slice(None)] * 3
            low[axis], high[axis] = slice(step, None), slice(None, -step)
            if step < blocked.shape[axis]:
                grown[tuple(low)] |= source[tuple(high)]
                grown[tuple(high)] |= source[tuple(low)]
    return grown
