"""Collision boxes of block states."""

from functools import lru_cache

import numpy as np

from world2minecraft.minecraft.block_states import BlockState, parse_state
from world2minecraft.minecraft.block_table import BlockType, block_table

# Known blocks whose shapes blocks of mods and newer games with these name endings take.
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
        state: Text of the block state. Missing properties have their default values. A block that
            is not in the table uses the shape of a known block with the same name ending, if that
            block has all properties of the state (the stairs of a mod are stairs). Otherwise the
            shape is a full cube.

    Returns:
        The boxes as read-only float32 [N, 6] with x0, y0, z0, x1, y1, z1 in block units: x is east,
        y is up and z is south. Fences and walls are 1.5 high. Air, flowers and torches have no box.

    Raises:
        UsageError: If the text is not a valid block state.

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
    """Return whether the collision shape of a block state is exactly one full cube.

    Raises:
        UsageError: If the text is not a valid block state.
    """
    return np.array_equal(boxes_of(state), FULL_CUBE)


def _twin(state: BlockState) -> BlockType | None:
    """Return the known block whose shape an unknown block is assumed to have."""
    if not state.properties:
        return None
    known = {key for key, _ in state.properties}
    for end, name in TWINS.items():
        twin = block_table().blocks[f"minecraft:{name}"]
        if state.name.endswith(end) and known <= {key for key, _ in twin.properties}:
            return twin
    return None
