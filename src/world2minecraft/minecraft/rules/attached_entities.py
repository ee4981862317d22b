"""Entities attached to a block: item frames, paintings and leash knots.

Their NBT contains the world position of the block, as ``TileX``, ``TileY``, ``TileZ``, or as
``block_pos`` since 1.21.5. If a file was moved after it was written, this position is wrong and the
game drops the entity. A position that is not next to the entity is therefore replaced by the
entity's own block position.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from world2minecraft.core.errors import MALFORMED

TILE = ("TileX", "TileY", "TileZ")
_REACH = 2.0  # Blocks from the middle of the largest painting, 4 x 4, to the block it names.


def attached_block(
    nbt: Mapping[str, Any], position: tuple[float, float, float]
) -> tuple[int, int, int]:
    """Return the position of the block that an entity hangs on, or of the block that it is in.

    Args:
        nbt: The entity's NBT, in world coordinates.
        position: The entity's position in the same coordinates.
    """
    own = tuple(int(value // 1) for value in position)
    stated = named_block(nbt)
    if stated is not None:
        near = [abs(s + 0.5 - p) <= _REACH + 0.5 for s, p in zip(stated, position, strict=True)]
        if all(near):
            return stated
    return own[0], own[1], own[2]


def move_attachment(
    nbt: Mapping[str, Any], position: tuple[float, float, float], shift: tuple[int, int, int]
) -> dict[str, Any]:
    """Move the attachment block in an entity's NBT, and correct it if it is not next to the entity.

    Args:
        nbt: The entity's NBT. It is copied unchanged if it contains no attachment block.
        position: The position of the entity after the move.
        shift: Offset in blocks along x, y, z from the coordinates of ``nbt`` to those of
            ``position``.
    """
    stated = named_block(nbt)
    if stated is None:
        return dict(nbt)
    x, y, z = (s + d for s, d in zip(stated, shift, strict=True))
    moved = name_attached_block(nbt, (x, y, z))
    return name_attached_block(moved, attached_block(moved, position))


def name_attached_block(nbt: Mapping[str, Any], block: tuple[int, int, int]) -> dict[str, Any]:
    """Return an entity's NBT with another attachment block, in the same form as before."""
    if "block_pos" in nbt:
        return {**nbt, "block_pos": np.array(block, np.int32)}
    return {**nbt, **dict(zip(TILE, block, strict=True))}


def named_block(nbt: Mapping[str, Any]) -> tuple[int, int, int] | None:
    """Return the attachment block in an entity's NBT, or None if it contains none."""
    try:
        held = nbt["block_pos"] if "block_pos" in nbt else [nbt[key] for key in TILE]
        x, y, z = (int(value) for value in held)
    except MALFORMED:
        return None
    return x, y, z
