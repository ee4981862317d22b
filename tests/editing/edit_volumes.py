"""Volumes and edits that the tests of this folder share."""

import numpy as np

from world2minecraft.core.types import AIR, BlockEdit, BlockEntity, Blocks, BlockVolume, Entity
from world2minecraft.editing.volume_draft import Draft

PALETTE = (
    AIR,
    "minecraft:glass",
    "minecraft:oak_sign[rotation=0,waterlogged=false]",
    "minecraft:stone",
)


def small_volume(seed: int = 0, shape: tuple[int, int, int] = (4, 3, 5)) -> BlockVolume:
    """Blocks at random with two signs and an entity, away from the world's middle."""
    rng = np.random.default_rng(seed)
    states = rng.choice([0, 1, 3], shape).astype(np.uint16)
    states[0, 0, 0], states[1, 0, 0], states[0, 1, 0], states[0, 2, 0] = 2, 2, 1, 3
    corner = (-2, 62, 7)
    return BlockVolume(
        states,
        PALETTE,
        rng.integers(0, 12, shape).astype(np.uint8),
        rng.integers(0, 3, shape).astype(np.uint16),
        corner,
        np.eye(4),
        tuple(
            BlockEntity((corner[0] + x, corner[1], corner[2]), "minecraft:sign", {"Text1": str(x)})
            for x in (0, 1)
        ),
        (Entity((-1.5, 63.25, 8.5), "minecraft:block_display", {"width": 1.0}, 5, 2),),
    )


def random_edit(draft: Draft, rng: np.random.Generator) -> BlockEdit:
    """Some cells get other blocks; now and then the entity goes or comes."""
    count = int(rng.integers(1, 6))
    flat = rng.choice(draft.states.size, count, replace=False)
    cells = np.stack(np.unravel_index(flat, draft.states.shape), axis=1).astype(np.int32)
    gone = draft.entities if rng.random() < 0.3 else ()
    come = (Entity(tuple(rng.random(3) * 9), "minecraft:item_display"),) * (rng.random() < 0.3)
    new = draft.id_of(f"minecraft:{rng.choice(['stone', 'dirt', 'bricks'])}")
    after = Blocks(
        np.full(count, new, np.uint16),
        rng.integers(0, 12, count).astype(np.uint8),
        rng.integers(0, 9, count).astype(np.uint16),
        (),
        come,
    )
    return draft.change("paint", cells, after, reason="a test", entities=gone)


def random_edits(volume: BlockVolume, count: int, seed: int) -> list[BlockEdit]:
    """Edits, each of what the ones before it left."""
    draft, rng = Draft(volume), np.random.default_rng(seed)
    return [random_edit(draft, rng) for _ in range(count)]


def seen(volume: BlockVolume) -> dict:
    """What two volumes must agree on, in plain values."""
    cells = {}
    texts = np.array(volume.palette, object)[volume.states]
    for at in np.ndindex(*volume.states.shape):
        place = tuple(int(a + c) for a, c in zip(at, volume.corner, strict=True))
        cells[place] = (texts[at], int(volume.semantic[at]), int(volume.instance[at]))
    data = {e.block_pos: (e.id, str(e.nbt)) for e in volume.block_entities}
    entities = sorted((e.position, e.id, str(e.nbt), e.class_id) for e in volume.entities)
    return {"cells": cells, "data": data, "entities": entities}
