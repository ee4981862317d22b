"""Where new furniture comes to stand: on what is under a place, or hang at it."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from world2minecraft.core.coordinates import metres_to_cells
from world2minecraft.core.errors import UsageError
from world2minecraft.editing.scene.draft import SceneDraft
from world2minecraft.furniture import Template, facing, size_in_cells, surroundings


class StandingBox(NamedTuple):
    """The box of furniture in cells: its first cell, its sides along its own axes, its turn."""

    corner: np.ndarray  # int64 [3]
    counts: tuple[int, int, int]
    quarter_turns: int


def standing_box(
    draft: SceneDraft, chosen: Template, at_m: Sequence[float], quarter_turns: int | None
) -> StandingBox:
    """Return the box of a template of its usual size that is put at a place.

    Args:
        draft: the scene.
        chosen: what is put.
        at_m: x, y, z in metres, within the grid.
        quarter_turns: which way it looks; None for away from walls and to tables.

    Raises:
        UsageError: the place lies outside the grid.
    """
    cell = metres_to_cells(np.array(at_m), draft.origin_m, draft.voxel_m)
    if (cell < 0).any() or (cell >= draft.shape).any():
        low, high = draft.origin_m, draft.origin_m + np.array(draft.shape) * draft.voxel_m
        spans = [f"{n} {a:.2f} to {b:.2f}" for n, a, b in zip("xyz", low, high, strict=True)]
        raise UsageError(f"at_m lies outside the grid, which spans {', '.join(spans)} m")
    counts = size_in_cells(chosen.typical_m, draft.voxel_m)
    bottom = _bottom(draft, chosen, cell, counts[2])
    if quarter_turns is None:
        quarter_turns = _turn(draft, chosen, _corner(draft, at_m, counts, 0, bottom), counts)
    turns = quarter_turns % 4
    return StandingBox(_corner(draft, at_m, counts, turns, bottom), counts, turns)


def _bottom(draft: SceneDraft, chosen: Template, cell: np.ndarray, height: int) -> int:
    """Return the layer where it begins."""
    column = draft.labels[cell[0], cell[1]] % 255 > 0
    if chosen.mount == "wall":
        return int(cell[2]) - height // 2
    if chosen.mount == "ceiling":
        over = np.flatnonzero(column[cell[2] :])
        return int(cell[2] + over[0] if len(over) else draft.shape[2]) - height
    free = np.flatnonzero(~column[cell[2] :])
    start = int(cell[2] + free[0]) if len(free) else draft.shape[2]
    under = np.flatnonzero(column[:start])
    return int(under[-1]) + 1 if len(under) else floor_layer(draft)


def floor_layer(draft: SceneDraft) -> int:
    """Return the first layer over the floor's top face, z = 0."""
    return int(np.floor(-draft.origin_m[2] / draft.voxel_m + 0.5))


def _corner(
    draft: SceneDraft, at_m: Sequence[float], counts: tuple[int, int, int], turns: int, bottom: int
) -> np.ndarray:
    """Return the first cell of a turned box whose middle is nearest to a place."""
    sides = np.array(counts)[[1, 0]] if turns % 2 else np.array(counts)[[0, 1]]
    low = (np.array(at_m[:2]) - draft.origin_m[:2]) / draft.voxel_m - sides / 2
    return np.array([*np.floor(low + 0.5 + 1e-6).astype(np.int64), bottom])


def _turn(
    draft: SceneDraft, chosen: Template, corner: np.ndarray, counts: tuple[int, int, int]
) -> int:
    """Return which way a full box of its size would look."""
    cells = (np.argwhere(np.ones(counts, bool)) + corner).astype(np.int32)
    return facing(cells, chosen.class_id, surroundings(draft.labels)).quarter_turns
