"""Automatic clean-up of a built room, in which each repair is an edit that can be undone.

===========  ===================================================================================
trim         remove pieces of furniture cut off by a wall or other furniture
see_through  restore the wall where an object in its plane leaves a gap to the outside
holes        close small holes in walls, floors and ceilings
floating     join, lower, suspend or remove floating blocks
steady       update or remove blocks that would fall, break or change in the game
===========  ===================================================================================

A room with one block per voxel is an exact copy of its cells and is not changed.
"""

from collections.abc import Callable, Sequence

import numpy as np

from world2minecraft.core.errors import UnknownNameError
from world2minecraft.core.types import BlockEdit, Blocks, BlockVolume
from world2minecraft.editing.cleanup.draft_blocks import remove_blocks
from world2minecraft.editing.cleanup.floating import repair_floating
from world2minecraft.editing.cleanup.holes import close_holes
from world2minecraft.editing.cleanup.intrusions import close_see_through, trim_severed_pieces
from world2minecraft.editing.volume_draft import Draft
from world2minecraft.minecraft.rules.connections import update_connections
from world2minecraft.minecraft.rules.stability import find_unstable

EXACT_BLOCKS_PER_METRE = 8.0  # Above it, cells are copied as they are.
ROUNDS = 4  # A repair may reveal a fault that another rule repairs.
STEADY_ROUNDS = 8  # A removal may leave other blocks unstable.


def stabilize(draft: Draft) -> None:
    """Update block connections as in the game, and remove unstable blocks, as recorded edits."""
    for _ in range(STEADY_ROUNDS):
        _connect(draft)
        found = find_unstable(draft.volume())
        if not found:
            return
        for position, state, reason in found:
            cell = np.array([position]) - draft.corner
            if draft.palette[draft.states[tuple(cell[0])]] == state:
                remove_blocks(draft, cell, "drop", f"{state.partition('[')[0]} {reason}")


def _connect(draft: Draft) -> None:
    states, palette = update_connections(draft.states, draft.palette)
    numbers = np.array([draft.id_of(state) for state in palette], np.uint16)
    new = numbers[states]
    cells = np.argwhere(new != draft.states)
    if len(cells):
        old = draft.contents(cells)
        after = Blocks(new[tuple(cells.T)], old.semantic, old.instance, old.block_entities)
        draft.change("connect", cells, after, reason="connections to neighbours updated")


RULES: dict[str, Callable[[Draft], None]] = {
    "trim": trim_severed_pieces,
    "see_through": close_see_through,
    "holes": close_holes,
    "floating": repair_floating,
    "steady": stabilize,
}


def repair_volume(
    volume: BlockVolume, rules: Sequence[str] = tuple(RULES)
) -> tuple[BlockVolume, tuple[BlockEdit, ...]]:
    """Return a repaired volume and the edits that repaired it.

    Args:
        volume: Built room. Without labels, only ``floating`` and ``steady`` find faults.
        rules: Rules to apply, in order.

    Returns:
        The repaired volume and the edits. If there is nothing to repair, the volume itself and no
        edits.

    Raises:
        UnknownNameError: If a rule is unknown.
    """
    for name in rules:
        if name not in RULES:
            raise UnknownNameError("clean-up rule", name, RULES)
    if volume.blocks_per_metre > EXACT_BLOCKS_PER_METRE:
        return volume, ()
    draft = Draft(volume)
    for _ in range(ROUNDS):
        before = len(draft.edits)
        for name, rule in RULES.items():
            if name in rules:
                rule(draft)
        if len(draft.edits) == before:
            break
    return (draft.volume(), tuple(draft.edits)) if draft.edits else (volume, ())
