"""How much of each sub-cell of a block a block state fills, in room axes.

A block has ``SUB`` sub-cells along each axis. What is seen of it counts, not what one bumps into.
The boxes of a state are in block axes (y up); masks
are ``[x, y, z]`` with z up, like every array of a room.
"""

from functools import lru_cache

import numpy as np

from world2minecraft.core.coordinates import block_axes_to_grid
from world2minecraft.minecraft.visual_shapes import visual_boxes_of

SUB = 8  # Finer masks gained 0.003 to 0.013 of IoU for three times the time (reference/fit.md).
PROBES = 32  # Along each axis: every box of the game's that matters lies on 32nds.


@lru_cache(maxsize=1 << 14)
def solid_of(state: str) -> np.ndarray:
    """Return which of ``PROBES``^3 cells of its block a state fills, bool, room axes, read-only.

    Raises:
        UsageError: the text is no block state.
    """
    solid = np.zeros((PROBES,) * 3, bool)
    for box in np.clip(visual_boxes_of(state), 0, 1):
        low = np.ceil(box[:3] * PROBES - 0.5).astype(int)
        high = np.ceil(box[3:] * PROBES - 0.5).astype(int)
        solid[tuple(map(slice, low, high))] = True
    solid = block_axes_to_grid(solid)
    solid.flags.writeable = False
    return solid


@lru_cache(maxsize=1 << 14)
def mask_of(state: str) -> np.ndarray:
    """Return the filled share of each sub-cell of a state, float32 [8, 8, 8], read-only.

    Example:
        >>> float(mask_of("minecraft:oak_slab[type=bottom]").mean())
        0.5
        >>> float(mask_of("minecraft:oak_slab[type=bottom]")[:, :, 0].mean())
        1.0
    """
    step = PROBES // SUB
    mask = solid_of(state).reshape(SUB, step, SUB, step, SUB, step).mean((1, 3, 5))
    mask = mask.astype(np.float32)
    mask.flags.writeable = False
    return mask


@lru_cache(maxsize=1 << 14)
def faces_of(state: str) -> np.ndarray:
    """Return which parts of a block's faces a state touches, bool [3, 2, 8, 8], read-only.

    The first axis is the face's own (x, y, z), the second its low or high side; the others are
    the two remaining axes in order.
    """
    solid, step = solid_of(state), PROBES // SUB
    faces = np.zeros((3, 2, SUB, SUB), bool)
    for axis in range(3):
        for side in (0, 1):
            plane = np.take(solid, -side, axis)
            faces[axis, side] = plane.reshape(SUB, step, SUB, step).any((1, 3))
    faces.flags.writeable = False
    return faces
