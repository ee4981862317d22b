"""The collision boxes of block states, from the public table."""

from functools import lru_cache

import numpy as np

from world2minecraft.minecraft.block_states import BlockState, parse_state
from world2minecraft.minecraft.block_table import BlockType, block_table

# Blocks whose shapes those of mods and newer games with such names are taken to have.
TWINS = {
    "_trapdoor": "oak_trapdoor",
    "_door": "oak_door",
    "_stairs": "oak_stairs",
    "_slab": "oak_slab",
    "_fence": "oak_fence",
    "_fence_gate": "oak_fence_gate",
    "_wall": "cobblestone_wall",
    "_pane": "glass_pane",
    "_bars": "iron_bars",
    "_carpet": "white_carpet",
    "_pressure_plate": "oak_pressure_plate",
    "_button": "oak_button",
    "_sign": "oak_sign",
    "_torch": "torch",
    "_lantern": "lantern",
    "_chain": "chain",
}

FULL_CUBE = np.array([[0, 0, 0, 1, 1, 1]], np.float32)
FULL_CUBE.flags.writeable = False


@lru_cache(maxsize=1 << 16)
def boxes_of(state: str) -> np.ndarray:
    """Return the collision boxes of a block state.

    Args:
        state: its text; missing properties count as the defaults. A block that the table does
            not know has the shape of one whose name ends alike and that has all the properties
            which are stated (a mod's stairs are stairs); else it is a full cube.

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
    block = table.blocks.get(parsed.name) or _twin(parsed)
    if block is None:
        return FULL_CUBE
    return table.shapes[block.shape_at(block.index_of(dict(parsed.properties)))]


def is_full_cube(state: str) -> bool:
    """Whether the state fills its whole block and no more. Raises what ``boxes_of`` raises."""
    return np.array_equal(boxes_of(state), FULL_CUBE)


def _twin(state: BlockState) -> BlockType | None:
    """Return the known block that an unknown one is taken to be like."""
    if not state.properties:
        return None
    known = {key for key, _ in state.properties}
    for end, name in TWINS.items():
        twin = block_table().blocks[f"minecraft:{name}"]
        if state.name.endswith(end) and known <= {key for key, _ in twin.properties}:
            return twin
    return None
