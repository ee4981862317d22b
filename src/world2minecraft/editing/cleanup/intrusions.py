"""Clean-up of furniture that intersects walls or other furniture.

A cell contains one block, so one of two intersecting objects loses the cell. The visible faults are
pieces of an object that are cut off by a wall or another object, and non-cubic blocks in the plane
of a wall that leave gaps to the outside.
"""

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.editing.cleanup.draft_blocks import (
    max_crumb_blocks,
    object_blocks,
    remove_blocks,
    structure_blocks,
)
from world2minecraft.editing.volume_draft import Draft
from world2minecraft.geometry.connected_components import label_components
from world2minecraft.minecraft.collision_shapes import is_full_cube

CUT_SHARE = 0.25  # A piece of at most this share of its object counts as cut off.
# Objects of one piece. Tables and cupboards may continue behind an object in front of them, and
# small objects may be piles of several.
WHOLE = (SemanticClass.CHAIR, SemanticClass.BED, SemanticClass.SOFA)


def trim_severed_pieces(draft: Draft) -> None:
    """Remove pieces of objects cut off by walls or other objects. Each repair is an edit."""
    things, structure = object_blocks(draft), structure_blocks(draft)
    for number in np.unique(draft.instance[things]).tolist():
        if not number:
            continue
        own = things & (draft.instance == number)
        pieces, count = label_components(own)
        if count < 2:
            continue
        sizes = np.bincount(pieces.ravel(), minlength=count + 1)
        sizes[0] = 0
        main = np.argwhere(pieces == int(sizes.argmax()))
        for piece in range(1, count + 1):
            cells = np.argwhere(pieces == piece)
            if piece == sizes.argmax() or len(cells) > CUT_SHARE * sizes.sum():
                continue
            between = _between(cells, main)
            at = tuple(between.T)
            is_one = draft.semantic[tuple(main[0])] in WHOLE and _is_stray(draft, cells)
            if len(between) and structure[at].any():
                _take_out(draft, cells, "piece behind or inside a wall")
            elif is_one and (things[at] & (draft.instance[at] != number)).any():
                _take_out(draft, cells, "piece cut off by another object")


def _is_stray(draft: Draft, cells: np.ndarray) -> bool:
    """Return whether a piece is a crumb that does not reach the floor."""
    under = np.maximum(cells - [0, 1, 0], 0)
    on_floor = (draft.semantic[tuple(under.T)] == SemanticClass.FLOOR).any()
    return len(cells) <= max_crumb_blocks(draft) and not on_floor


def _take_out(draft: Draft, cells: np.ndarray, reason: str) -> None:
    """Remove a piece, restoring the wall in its place."""
    walls = draft.semantic == SemanticClass.WALL
    in_wall = _in_plane(walls, 0) | _in_plane(walls, 2)
    for cell in cells[in_wall[tuple(cells.T)]]:
        _put_wall(draft, cell, walls, reason)
    rest = cells[~in_wall[tuple(cells.T)]]
    if len(rest):
        remove_blocks(draft, rest, "trim", reason)


def close_see_through(draft: Draft) -> None:
    """Restore the wall where an object in its plane leaves a gap. Each repair is an edit."""
    things, structure = object_blocks(draft), structure_blocks(draft)
    walls = draft.semantic == SemanticClass.WALL
    partial = things & ~_full(draft)
    for axis in (0, 2):
        in_plane = _both_sides(walls, 1) | _both_sides(walls, 2 - axis)
        out = _open_to_the_end(~(structure | things), axis)
        for cell in np.argwhere(partial & in_plane & out):
            number = int(draft.instance[tuple(cell)])
            own = things & (draft.instance == number)
            if number and own.sum() > 2 * (own & in_plane & out).sum():
                _put_wall(draft, cell, walls, "object in the wall with a gap to the outside")


def _between(cells: np.ndarray, main: np.ndarray) -> np.ndarray:
    """Return the cells on the straight line between the nearest cells of two pieces."""
    distance = np.abs(cells[:, None] - main[None]).sum(axis=2)
    first, second = np.unravel_index(int(distance.argmin()), distance.shape)
    start, end = cells[first], main[second]
    count = int(np.abs(end - start).max())
    steps = np.arange(1, count)[:, None] / max(count, 1)
    return np.rint(start + (end - start) * steps).astype(np.int64)


def _full(draft: Draft) -> np.ndarray:
    return np.array([is_full_cube(state) for state in draft.palette], bool)[draft.states]


def _both_sides(mask: np.ndarray, axis: int) -> np.ndarray:
    """Return the cells with masked cells on both sides along an axis."""
    padded = np.pad(mask, [(1, 1) if one == axis else (0, 0) for one in range(3)])
    size = mask.shape[axis]
    low = np.take(padded, range(size), axis)
    return low & np.take(padded, range(2, size + 2), axis)


def _in_plane(walls: np.ndarray, axis: int) -> np.ndarray:
    """Return the cells with wall on two of four sides in their plane, but not across it."""
    padded = np.pad(walls, 1)
    inner = tuple(slice(1, size + 1) for size in walls.shape)

    def neighbours(along: int) -> np.ndarray:
        sides = [np.roll(padded, step, along)[inner] for step in (-1, 1)]
        return sides[0].astype(np.uint8) + sides[1]

    return (neighbours(1) + neighbours(2 - axis) >= 2) & (neighbours(axis) == 0)


def _open_to_the_end(empty: np.ndarray, axis: int) -> np.ndarray:
    """Return the cells with a free line to the end of the volume along an axis."""
    from_low = np.logical_and.accumulate(empty, axis=axis)
    from_high = np.flip(np.logical_and.accumulate(np.flip(empty, axis), axis=axis), axis)
    edge = np.ones_like(np.take(empty, [0], axis))
    size = empty.shape[axis]
    before = np.concatenate([edge, np.take(from_low, range(size - 1), axis)], axis=axis)
    after = np.concatenate([np.take(from_high, range(1, size), axis), edge], axis=axis)
    return before | after


def _put_wall(draft: Draft, cell: np.ndarray, walls: np.ndarray, reason: str) -> None:
    """Set a cell to the most frequent wall block among its neighbours."""
    around = cell + np.concatenate([np.eye(3, dtype=int), -np.eye(3, dtype=int)])
    around = around[((around >= 0) & (around < walls.shape)).all(axis=1)]
    around = around[walls[tuple(around.T)]]
    state = draft.palette[np.bincount(draft.states[tuple(around.T)]).argmax()]
    draft.fill(
        "wall",
        cell[None],
        state,
        as_class=int(SemanticClass.WALL),
        reason=reason,
        class_id=int(draft.semantic[tuple(cell)]),
        instance=int(draft.instance[tuple(cell)]),
    )
