"""Placement of furniture: a new piece at a point, or an object snapped to a floor or a wall."""

from collections.abc import Sequence
from typing import Literal, NamedTuple

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.coordinates import metres_to_cells
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import Operation, SceneObject
from world2minecraft.editing.scene.command import Command, Tools
from world2minecraft.editing.scene.object_boxes import describe_object, object_by_id, plan_extent_m
from world2minecraft.editing.scene.object_transforms import Id, plan_shift
from world2minecraft.editing.scene.scene_draft import SceneDraft
from world2minecraft.furniture import Template, estimate_facing, read_surroundings, size_in_cells

WALLS = (SemanticClass.WALL, SemanticClass.WINDOW)
WALL_SHARE = 0.5  # Minimum share of a side's face with a wall behind it.


class StandingBox(NamedTuple):
    """The box of furniture: minimum cell, side lengths in cells along its axes, and rotation."""

    corner: np.ndarray  # int64 [3]
    counts: tuple[int, int, int]
    quarter_turns: int


def standing_box(
    draft: SceneDraft, chosen: Template, at_m: Sequence[float], quarter_turns: int | None
) -> StandingBox:
    """Return the box of a template of typical size placed at a position.

    Args:
        draft: Scene to place the furniture in.
        chosen: Template of the furniture.
        at_m: Position x, y, z in metres, inside the grid.
        quarter_turns: Rotation in quarter turns. None faces away from walls or towards tables.

    Raises:
        UsageError: If the position is outside the grid.
    """
    cell = metres_to_cells(np.array(at_m), draft.origin_m, draft.voxel_m)
    if (cell < 0).any() or (cell >= draft.shape).any():
        low, high = draft.origin_m, draft.origin_m + np.array(draft.shape) * draft.voxel_m
        spans = [f"{n} {a:.2f} to {b:.2f}" for n, a, b in zip("xyz", low, high, strict=True)]
        raise UsageError(f"at_m is outside the grid, which spans {', '.join(spans)} m")
    counts = size_in_cells(chosen.typical_m, draft.voxel_m)
    bottom = _bottom(draft, chosen, cell, counts[2])
    if quarter_turns is None:
        quarter_turns = _facing(draft, chosen, _corner(draft, at_m, counts, 0, bottom), counts)
    turns = quarter_turns % 4
    return StandingBox(_corner(draft, at_m, counts, turns, bottom), counts, turns)


def _bottom(draft: SceneDraft, chosen: Template, cell: np.ndarray, height: int) -> int:
    """Return the lowest layer of the furniture."""
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
    """Return the first layer above the floor surface at z = 0."""
    return int(np.floor(-draft.origin_m[2] / draft.voxel_m + 0.5))


def _corner(
    draft: SceneDraft, at_m: Sequence[float], counts: tuple[int, int, int], turns: int, bottom: int
) -> np.ndarray:
    """Return the minimum cell of a rotated box whose centre is nearest to a position."""
    sides = np.array(counts)[[1, 0]] if turns % 2 else np.array(counts)[[0, 1]]
    low = (np.array(at_m[:2]) - draft.origin_m[:2]) / draft.voxel_m - sides / 2
    return np.array([*np.floor(low + 0.5 + 1e-6).astype(np.int64), bottom])


def _facing(
    draft: SceneDraft, chosen: Template, corner: np.ndarray, counts: tuple[int, int, int]
) -> int:
    """Return the direction in which a solid box of the same size would face."""
    cells = (np.argwhere(np.ones(counts, bool)) + corner).astype(np.int32)
    return estimate_facing(cells, chosen.class_id, read_surroundings(draft.labels)).quarter_turns


class SnapObject(Command):
    """Move an object vertically onto the surface below it, or sideways to the nearest wall.

    The object moves by whole cells until its box touches the surface. A wall is used if it covers
    at least half of the object's side.
    """

    op: Literal["snap_object"] = "snap_object"
    id: Id
    to: Literal["floor", "wall"]

    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return the operation with the object and its cells at the new position."""
        one = object_by_id(draft, self.id)
        low, high = box_in_cells(draft, one)
        way = _to_floor if self.to == "floor" else _to_wall
        shift = way(draft, one, low, high)
        if not shift.any():
            where = "on the floor" if self.to == "floor" else "at the wall"
            raise UsageError(f"{describe_object(one)} is already {where}")
        return plan_shift(draft, one, shift, "snap_object")


def box_in_cells(draft: SceneDraft, one: SceneObject) -> tuple[np.ndarray, np.ndarray]:
    """Return the minimum cell and the exclusive maximum cell of an object, int64 [3] each.

    They are computed from the object's cells, or from its axis-aligned bounding box if it has none.
    """
    cells = draft.cells_of(one.id).astype(np.int64)
    if len(cells):
        return cells.min(axis=0), cells.max(axis=0) + 1
    sides = plan_extent_m(one)
    ends = (one.center_m + np.stack([-sides, sides]) / 2 - draft.origin_m) / draft.voxel_m
    low, high = np.floor(ends + 0.5).astype(np.int64)
    low = np.clip(low, 0, np.array(draft.shape) - 1)
    return low, np.clip(high, low + 1, draft.shape)


def _to_floor(draft: SceneDraft, one: SceneObject, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Return the shift onto the highest surface below an object."""
    under = np.s_[low[0] : high[0], low[1] : high[1], : low[2]]
    solid = (draft.labels[under] % 255 > 0) & (draft.instance[under] != one.id)
    layers = np.flatnonzero(solid.any(axis=(0, 1)))
    top = int(layers[-1]) + 1 if len(layers) else floor_layer(draft)
    return np.array([0, 0, top - low[2]])


def _to_wall(draft: SceneDraft, one: SceneObject, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Return the shift to the nearest wall along x or y.

    Raises:
        UsageError: If there is no wall next to the object.
    """
    window = [slice(a, b) for a, b in zip(low, high, strict=True)]
    ways = []
    for axis in (0, 1):
        window[axis] = slice(None)
        walls = np.isin(draft.labels[tuple(window)], WALLS)
        window[axis] = slice(low[axis], high[axis])
        share = walls.any(axis=2).mean(axis=1 - axis) >= WALL_SHARE
        middle = (low[axis] + high[axis]) // 2
        after, before = np.flatnonzero(share[middle:]), np.flatnonzero(share[:middle])
        if len(after):
            ways.append((axis, int(middle + after[0] - high[axis])))
        if len(before):
            ways.append((axis, int(before[-1]) + 1 - int(low[axis])))
    if not ways:
        raise UsageError(f"no wall found next to {describe_object(one)}; move it instead")
    axis, step = min(ways, key=lambda way: abs(way[1]))
    return step * np.eye(3, dtype=np.int64)[axis]
