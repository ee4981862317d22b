"""Relocation of a volume in the world, including block data, entities and its frame."""

from dataclasses import replace
from typing import Any

import numpy as np

from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import BlockVolume, Entity
from world2minecraft.minecraft.rules.attached_entities import move_attachment
from world2minecraft.minecraft.turn_and_mirror import turn_volume


def place_volume(
    volume: BlockVolume, at: tuple[int, int, int], turns: int, ground_y: int | None
) -> BlockVolume:
    """Return a volume without surrounding air, rotated and moved to a position.

    Args:
        volume: Blocks to move.
        at: New position of the smallest x, the ground layer and the smallest z.
        turns: Number of quarter turns, counter-clockwise from above, applied before the move.
        ground_y: Layer of the volume on which a player stands, which is moved to the y of ``at``.
            None uses the lowest layer.

    Raises:
        UsageError: If the volume is empty.
    """
    whole = trim_air(turn_volume(volume, turns))
    low = whole.corner[1] if ground_y is None else ground_y
    x, _, z = whole.corner
    return translate_volume(whole, np.array(at) - (x, low, z))


def trim_air(volume: BlockVolume) -> BlockVolume:
    """Return a volume without the layers of air around its blocks.

    Raises:
        UsageError: If the volume contains only air.
    """
    if not volume.states.any():
        raise UsageError("the volume contains no blocks to build")
    filled = np.argwhere(volume.states)
    low, high = filled.min(axis=0), filled.max(axis=0) + 1
    part = tuple(slice(start, end) for start, end in zip(low, high, strict=True))
    x, y, z = (low + volume.corner).tolist()
    return replace(
        volume,
        states=np.ascontiguousarray(volume.states[part]),
        semantic=np.ascontiguousarray(volume.semantic[part]),
        instance=np.ascontiguousarray(volume.instance[part]),
        corner=(x, y, z),
    )


def translate_volume(volume: BlockVolume, step: np.ndarray) -> BlockVolume:
    """Return a volume moved by whole blocks, int [3]. Room coordinates of blocks are unchanged."""
    back = np.eye(4)
    back[:3, 3] = -step
    x, y, z = (np.array(volume.corner) + step).tolist()
    dx, dy, dz = (int(value) for value in step)
    return replace(
        volume,
        corner=(x, y, z),
        block_to_room=volume.block_to_room @ back,
        block_entities=tuple(
            replace(e, block_pos=(e.block_pos[0] + dx, e.block_pos[1] + dy, e.block_pos[2] + dz))
            for e in volume.block_entities
        ),
        entities=tuple(
            replace(
                e,
                position=(e.position[0] + dx, e.position[1] + dy, e.position[2] + dz),
                nbt=_moved_nbt(e, (dx, dy, dz)),
            )
            for e in volume.entities
        ),
    )


def _moved_nbt(entity: Entity, step: tuple[int, int, int]) -> dict[str, Any]:
    """Return the NBT with moved position tags and a new UUID."""
    x, y, z = (place + by for place, by in zip(entity.position, step, strict=True))
    moved = move_attachment(entity.nbt, (x, y, z), step)
    return {key: value for key, value in moved.items() if key not in ("UUID", "Pos")}
