"""Entities attached to a block: frames, paintings and leash knots state which by its position.

They say it in world coordinates, as ``TileX``, ``TileY``, ``TileZ``, or from 1.21.5 on as
``block_pos``. Where a file was moved after it was written, the block is no longer there, and the
game drops the entity: so a position that is not beside the entity becomes the entity's own.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from world2minecraft.minecraft.unlabelled_volume import MISSHAPEN

TILE = ("TileX", "TileY", "TileZ")
_REACH = 2.0  # Blocks from the middle of the largest painting, 4 x 4, to the block it names.


def attached_block(
    nbt: Mapping[str, Any], position: tuple[float, float, float]
) -> tuple[int, int, int]:
    """Return the block that an entity hangs on, or the one that it stands in.

    Args:
        nbt: the entity's tags, as they are in world coordinates.
        position: where the entity is, in the same coordinates.
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
    """Return ``nbt`` with its block moved by ``shift`` and, if need be, brought to the entity.

    Args:
        nbt: the entity's tags; those that name no block come back as they are.
        position: where the entity is after the move.
        shift: blocks along x, y, z from the coordinates of ``nbt`` to those of ``position``.
    """
    stated = named_block(nbt)
    if stated is None:
        return dict(nbt)
    x, y, z = (s + d for s, d in zip(stated, shift, strict=True))
    moved = name_attached_block(nbt, (x, y, z))
    return name_attached_block(moved, attached_block(moved, position))


def name_attached_block(nbt: Mapping[str, Any], block: tuple[int, int, int]) -> dict[str, Any]:
    """Return an entity's tags with another block to hang on, in the form that they have."""
    if "block_pos" in nbt:
        return {**nbt, "block_pos": np.array(block, np.int32)}
    return {**nbt, **dict(zip(TILE, block, strict=True))}


def named_block(nbt: Mapping[str, Any]) -> tuple[int, int, int] | None:
    """Return the block that an entity's tags say it hangs on; None where they name none."""
    try:
        held = nbt["block_pos"] if "block_pos" in nbt else [nbt[key] for key in TILE]
        x, y, z = (int(value) for value in held)
    except MISSHAPEN:
        return None
    return x, y, z
