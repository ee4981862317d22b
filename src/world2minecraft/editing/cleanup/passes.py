"""The automatic clean-up of a built room; each repair is an edit that can be undone.

===========  ===================================================================================
trim         pieces of furniture that a wall or other furniture cuts off
see_through  the wall comes back where an object in its plane lets one see out
holes        small holes in walls, floors and ceilings are closed
floating     what hangs in the air is joined, put down, hung up or taken away
steady       what would fall, pop off or change is set as the game would have it, or taken away
===========  ===================================================================================

A room of one block a voxel is an exact copy of its cells and is left as it is.
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
ROUNDS = 4  # A repair may uncover what another rule is for.
STEADY_ROUNDS = 8  # What stood on something that is taken away goes next.


def stabilize(draft: Draft) -> None:
    """Set connections as the game would, and take away what would not stay; each is an edit."""
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
        draft.change("connect", cells, after, reason="they join their neighbours otherwise")


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
    """Return a volume as a person would leave it, and the edits that made it so.

    Args:
        volume: a built room; without labels only ``floating`` and ``stabilize`` find anything.
        rules: which rules, in their order.

    Returns:
        The volume itself and no edits where nothing is to mend.

    Raises:
        UnknownNameError: there is no such rule.
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
