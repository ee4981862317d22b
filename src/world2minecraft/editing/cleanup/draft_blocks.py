"""Blocks of a draft by kind, and their removal and moves, as the clean-up rules need them."""

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
    """Return bool [X, Y, Z]: blocks that one sees; not air, light or barriers."""
    return _by_state(draft, lambda state: len(visual_boxes(state)) > 0)


def free_cells(draft: Draft) -> np.ndarray:
    """Return bool [X, Y, Z]: air, and the light that stands in it."""
    return _by_state(draft, lambda state: state.partition("[")[0] in FREE)


def structure_blocks(draft: Draft) -> np.ndarray:
    """Return bool [X, Y, Z]: blocks of floor, walls, ceiling and windows that one sees."""
    return np.isin(draft.semantic, STRUCTURE_CLASSES) & visible_blocks(draft)


def object_blocks(draft: Draft) -> np.ndarray:
    """Return bool [X, Y, Z]: blocks of objects that one sees."""
    return np.isin(draft.semantic, OBJECT_CLASSES) & visible_blocks(draft)


def metres_to_blocks(draft: Draft, metres: float, least: int = 1) -> int:
    """Return a length in whole blocks, at least ``least``."""
    return max(least, round(metres * draft.start.blocks_per_metre))


def max_crumb_blocks(draft: Draft) -> float:
    """Return how many blocks a crumb has at most: without its object it is noise."""
    return max(1.0, CRUMB_M3 * draft.start.blocks_per_metre**3)


def remove_blocks(draft: Draft, cells: np.ndarray, kind: str, reason: str) -> BlockEdit:
    """Make cells [N, 3] air and record it; the object is that of most of them."""
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
    """Move what stands in cells [N, 3] by a step of whole blocks, int [3], and record it.

    What signs and chests hold goes with them. What is in the cells that they come to is gone.
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
