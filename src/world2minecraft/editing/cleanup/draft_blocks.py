"""Masks of blocks by kind, and removal and moves of blocks, for the clean-up rules."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from world2minecraft.core.classes import OBJECT_CLASSES, STRUCTURE_CLASSES
from world2minecraft.core.types import AIR, BlockEdit, BlockEntity, Blocks
from world2minecraft.editing.volume_draft import Draft
from world2minecraft.minecraft.visual_shapes import visual_boxes

CRUMB_M3 = 0.03  # Two blocks at 4 blocks a metre.
FREE = (AIR, "minecraft:cave_air", "minecraft:void_air", "minecraft:light")


def visible_blocks(draft: Draft) -> np.ndarray:
    """Return a mask of visible blocks, bool [X, Y, Z]: all except air, light and barriers."""
    return _by_state(draft, lambda state: len(visual_boxes(state)) > 0)


def free_cells(draft: Draft) -> np.ndarray:
    """Return a mask of air and light blocks, bool [X, Y, Z]."""
    return _by_state(draft, lambda state: state.partition("[")[0] in FREE)


def structure_blocks(draft: Draft) -> np.ndarray:
    """Return a mask of visible floor, wall, ceiling and window blocks, bool [X, Y, Z]."""
    return np.isin(draft.semantic, STRUCTURE_CLASSES) & visible_blocks(draft)


def object_blocks(draft: Draft) -> np.ndarray:
    """Return a mask of visible blocks of objects, bool [X, Y, Z]."""
    return np.isin(draft.semantic, OBJECT_CLASSES) & visible_blocks(draft)


def metres_to_blocks(draft: Draft, metres: float) -> int:
    """Convert a length in metres to whole blocks, at least 1."""
    return max(1, round(metres * draft.start.blocks_per_metre))


def max_crumb_blocks(draft: Draft) -> float:
    """Return the maximum number of blocks in a crumb, a small piece that is considered noise."""
    return max(1.0, CRUMB_M3 * draft.start.blocks_per_metre**3)


def remove_blocks(draft: Draft, cells: np.ndarray, kind: str, reason: str) -> BlockEdit:
    """Replace cells [N, 3] by air and record the edit for the object with most of the cells."""
    numbers = draft.instance[tuple(cells.T)]
    classes = draft.semantic[tuple(cells.T)]
    return draft.fill(
        kind,
        cells,
        AIR,
        reason=reason,
        class_id=int(np.bincount(classes).argmax()),
        instance=int(np.bincount(numbers).argmax()),
    )


def move_blocks(draft: Draft, cells: np.ndarray, step: np.ndarray, reason: str) -> BlockEdit:
    """Move the blocks in cells [N, 3] by whole blocks, int [3], and record the edit.

    The contents of signs and chests move with them. Blocks at the new position are replaced.
    """
    old = draft.contents(cells)
    there = cells + step
    every = np.unique(np.concatenate([cells, there]), axis=0)
    place_of = {tuple(cell): number for number, cell in enumerate(every.tolist())}
    target = np.array([place_of[tuple(cell)] for cell in there.tolist()])

    def scatter(values: np.ndarray) -> np.ndarray:
        new = np.zeros(len(every), values.dtype)
        new[target] = values
        return new

    after = (scatter(values) for values in (old.states, old.semantic, old.instance))
    states, semantic, instance = after
    data = tuple(_translate(entity, step) for entity in old.block_entities)
    return draft.change(
        "move",
        every,
        Blocks(states, semantic, instance, data),
        reason=reason,
        class_id=int(np.bincount(old.semantic).argmax()),
        instance=int(np.bincount(old.instance).argmax()),
    )


def _translate(entity: BlockEntity, step: np.ndarray) -> BlockEntity:
    x, y, z = (np.array(entity.block_pos) + step).tolist()
    return replace(entity, block_pos=(x, y, z))


def _by_state(draft: Draft, holds: Callable[[str], bool]) -> np.ndarray:
    return np.array([holds(state) for state in draft.palette], bool)[draft.states]
