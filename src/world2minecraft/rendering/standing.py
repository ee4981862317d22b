"""Entities of a volume that is cut open: what goes with the blocks, and where the rest moves."""

from dataclasses import replace

import numpy as np

from world2minecraft.core.types import BlockVolume, Entity
from world2minecraft.minecraft.displays import display_cubes, owner_of

MOST_CUT = 0.5  # An object goes when more than this share of its blocks does.


def kept_entities(volume: BlockVolume, drop: np.ndarray) -> tuple[Entity, ...]:
    """Return the entities that stay when some blocks of their volume are left out.

    An object's entities go with its blocks; what has no blocks goes where its middle is cut.

    Args:
        volume: the whole volume.
        drop: bool [X, Y, Z], the blocks that go.
    """
    if not volume.entities:
        return ()
    counts = np.bincount(volume.instance.ravel(), minlength=1)
    lost = np.bincount(volume.instance[drop], minlength=len(counts))
    kept = []
    for entity in volume.entities:
        number = owner_of(entity)[1]
        if 0 < number < len(counts) and counts[number]:
            gone = lost[number] > MOST_CUT * counts[number]
        else:
            gone = drop[tuple(_cell_of(entity, volume))]
        if not gone:
            kept.append(entity)
    return tuple(kept)


def entities_within(volume: BlockVolume, low: int, high: int) -> tuple[Entity, ...]:
    """Return the entities whose middle lies in the layers [low, high) of a volume.

    The uppermost layers hold what lies above them, the lowest what lies below.
    """
    top = volume.states.shape[1]
    return tuple(
        entity
        for entity in volume.entities
        if low <= min(max(int(_cell_of(entity, volume)[1]), 0), top - 1) < high
    )


def moved_entities(volume: BlockVolume, shift: np.ndarray) -> tuple[Entity, ...]:
    """Return a volume's entities moved by a shift, float64 [3], in blocks."""
    return tuple(
        replace(one, position=tuple((np.array(one.position) + shift).tolist()))
        for one in volume.entities
    )


def _cell_of(entity: Entity, volume: BlockVolume) -> np.ndarray:
    """Return the cell, int64 [3], that holds an entity's middle, or the nearest of the volume."""
    drawn = display_cubes((entity,))
    middle = np.array(entity.position)
    if drawn:
        middle = (drawn[0].cube_to_world @ [0.5, 0.5, 0.5, 1.0])[:3]
    cell = np.floor(middle - volume.corner).astype(np.int64)
    return np.clip(cell, 0, np.array(volume.states.shape) - 1)
