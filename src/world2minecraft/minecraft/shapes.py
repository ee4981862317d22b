"""The collision boxes of block states, from the public table."""

from functools import lru_cache

import numpy as np

from world2minecraft.minecraft.blocks import block_table
from world2minecraft.minecraft.states import parse_state

FULL_CUBE = np.array([[0, 0, 0, 1, 1, 1]], np.float32)
FULL_CUBE.flags.writeable = False


@lru_cache(maxsize=1 << 16)
def boxes_of(state: str) -> np.ndarray:
    """Return the collision boxes of a block state.

    Args:
        state: its text; missing properties count as the defaults. A block that the table does
            not know counts as a full cube.

    Returns:
        Read-only float32 [N, 6]: x0 y0 z0 x1 y1 z1 in block units, x east, y up, z south. Fences
        and walls reach up to 1.5; air, flowers and torches have no box.

    Raises:
        UsageError: the text is no block state.

    Example:
        >>> boxes_of("minecraft:oak_slab[type=top]").tolist()
        [[0.0, 0.5, 0.0, 1.0, 1.0, 1.0]]
    """
    parsed = parse_state(state)
    table = block_table()
    block = table.blocks.get(parsed.name)
    if block is None:
        return FULL_CUBE
    return table.shapes[block.shape_at(block.index_of(dict(parsed.properties)))]


def is_full_cube(state: str) -> bool:
    """Whether the state fills its whole block and no more. Raises what ``boxes_of`` raises."""
    return np.array_equal(boxes_of(state), FULL_CUBE)
