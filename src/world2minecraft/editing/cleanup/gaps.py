"""Clean-up of gaps of less than a block between an object and its support.

Objects start in the cell above a table top, which can end below that cell if it is a lower slab or
a trapdoor on the table legs. The lowest blocks of an object can also fill only the upper part of
their cells.
"""

import numpy as np

from world2minecraft.core.types import Blocks
from world2minecraft.editing.cleanup.draft_blocks import move_blocks
from world2minecraft.editing.volume_draft import Draft
from world2minecraft.minecraft.block_states import known_blocks
from world2minecraft.minecraft.visual_shapes import visual_boxes

DOWN = np.array([0, -1, 0])
PLATE = 0.26  # Maximum height of a plate, such as a trapdoor or carpet, in blocks.
SUNK_SHARE = 0.25  # An object replaces at most this share of the blocks of another one.


def close_gap(draft: Draft, cells: np.ndarray, carriers: np.ndarray) -> bool:
    """Close a gap of less than a block below a part. Each repair is an edit.

    Args:
        draft: Blocks to repair.
        cells: Cells of the floating part, int [N, 3].
        carriers: Mask of supported blocks, bool [X, Y, Z].

    Returns:
        True if the gap was closed.
    """
    bottom = cells[cells[:, 1] == cells[:, 1].min()]
    under = bottom + DOWN
    held = np.asarray((under >= 0).all(axis=1))
    held[held] = carriers[tuple(under[held].T)]
    if not held.any():
        return False
    bottom, under = bottom[held], under[held]
    names = [draft.palette[number] for number in draft.states[tuple(bottom.T)]]
    if all(_lowest(name) > 0 for name in names):
        return _reach_down(draft, cells, bottom, names)
    return _sink(draft, cells) or _raise(draft, under)


def full_block_of(state: str) -> str:
    """Return the full block of the same material as a slab or a trapdoor.

    Other states are returned unchanged.

    Example:
        >>> full_block_of("minecraft:oak_trapdoor[facing=east,half=top,open=false]")
        'minecraft:oak_planks'
    """
    name, _, rest = state.partition("[")
    if "type=bottom" in rest or "type=top" in rest:
        return state.replace("type=bottom", "type=double").replace("type=top", "type=double")
    stem = name.removesuffix("_trapdoor")
    for full in (f"{stem}_planks", f"{stem}_block"):
        if stem != name and full in known_blocks():
            return full
    return state


def _lowest(state: str) -> float:
    boxes = visual_boxes(state)
    return float(boxes[:, 1].min()) if len(boxes) else 0.0


def _reach_down(draft: Draft, cells: np.ndarray, bottom: np.ndarray, names: list[str]) -> bool:
    """Move the upper halves of a flat object down, or make its lowest blocks full otherwise."""
    if np.ptp(cells[:, 1]) == 0:
        new = [
            n.replace("type=top", "type=bottom").replace("half=top", "half=bottom") for n in names
        ]
    else:
        new = [full_block_of(name) for name in names]
    if new == names:
        return False
    return _restate(draft, bottom, new, "gap of less than a block above its support")


def _sink(draft: Draft, cells: np.ndarray) -> bool:
    """Lower a part by one block, replacing the plates below."""
    there = cells + DOWN
    own = {tuple(cell) for cell in cells.tolist()}
    new = np.array([cell for cell in there.tolist() if tuple(cell) not in own])
    states = [draft.palette[number] for number in draft.states[tuple(new.T)]]
    if not all(_is_plate(state) for state in states):
        return False
    for number in np.unique(draft.instance[tuple(new.T)]).tolist():
        taken = (draft.instance[tuple(new.T)] == number).sum()
        if number and taken > SUNK_SHARE * (draft.instance == number).sum():
            return False
    move_blocks(draft, cells, DOWN, "gap of less than a block above the plate below")
    return True


def _is_plate(state: str) -> bool:
    boxes = visual_boxes(state)
    return not len(boxes) or float(boxes[:, 4].max()) <= PLATE


def _raise(draft: Draft, under: np.ndarray) -> bool:
    """Replace the lower slabs below a part by full blocks."""
    names = [draft.palette[number] for number in draft.states[tuple(under.T)]]
    low = ["type=bottom" in name for name in names]
    if not any(low):
        return False
    chosen = [full_block_of(name) for name, is_low in zip(names, low, strict=True) if is_low]
    return _restate(draft, under[low], chosen, "gap of half a block below the object on it")


def _restate(draft: Draft, cells: np.ndarray, states: list[str], reason: str) -> bool:
    numbers = np.array([draft.id_of(state) for state in states], np.uint16)
    old = draft.contents(cells)
    after = Blocks(numbers, old.semantic, old.instance, old.block_entities)
    class_id, instance = int(old.semantic[0]), int(old.instance[0])
    draft.change("settle", cells, after, reason=reason, class_id=class_id, instance=instance)
    return True
