"""Commands on whole objects: delete, move, turn and duplicate.

Cells move with their object: whole cells, onto free ones, within the grid.
"""

from collections.abc import Sequence
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from world2minecraft.core.coordinates import metres_to_cells
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import GridCells, Operation, SceneObject
from world2minecraft.editing.scene.cell_patch import Patch
from world2minecraft.editing.scene.command import Command, Tools
from world2minecraft.editing.scene.object_boxes import (
    common_class,
    copy_object,
    describe_object,
    free_object_id,
    is_of_cells,
    object_by_id,
    objects_by_ids,
    plan_extent_m,
    rotate_cells,
    rotate_object,
    translate_object,
)
from world2minecraft.editing.scene.scene_draft import ARRAYS, SceneDraft

Id = Annotated[int, Field(ge=1, le=65535)]
Ids = Annotated[tuple[Id, ...], Field(min_length=1, max_length=65535)]
Metre = Annotated[float, Field(ge=-10_000, le=10_000)]
Point = tuple[Metre, Metre, Metre]
QuarterTurns = Annotated[int, Field(ge=-3, le=3)]


def plan_shift(draft: SceneDraft, one: SceneObject, shift: np.ndarray, kind: str) -> Operation:
    """Return the operation that moves an object by whole cells, int [3].

    Raises:
        UsageError: it would leave the grid.
    """
    cells = draft.cells_of(one.id)
    check_within(draft, one, cells, shift)
    patch = Patch(draft)
    put_cells(draft, patch, one, cells, cells + shift)
    moved = translate_object(one, shift * draft.voxel_m)
    return patch.plan_operation(kind, objects=[moved], counts_as="move", class_id=one.class_id)


def put_cells(
    draft: SceneDraft, patch: Patch, one: SceneObject, cells: np.ndarray, there: np.ndarray
) -> None:
    """Carry what an object's cells hold to other cells, [N, 3] each, as far as they are free."""
    patch.empty(cells)
    free = is_free(draft, there) | (draft.instance[tuple(there.T)] == one.id)
    patch.put(there[free], select_cells(draft.contents(cells), free))


def cells_to(draft: SceneDraft, one: SceneObject, to_m: Sequence[float]) -> np.ndarray:
    """Return the whole cells, int64 [3], that bring an object's centre nearest to a point."""
    return np.floor((np.array(to_m) - one.center_m) / draft.voxel_m + 0.5).astype(np.int64)


def check_within(draft: SceneDraft, one: SceneObject, cells: np.ndarray, shift: np.ndarray) -> None:
    """Raise ``UsageError`` where an object that is shifted by cells, int [3], leaves the grid."""
    held = cells if len(cells) else middle_cell(draft, one)[None]
    if within_grid(draft, held + shift).all():
        return
    low, high = held.min(axis=0), held.max(axis=0)
    to = one.center_m + draft.voxel_m * np.stack([-low, np.array(draft.shape) - 1 - high])
    spans = [
        f"{name} {first:.2f} to {last:.2f}" for name, first, last in zip("xyz", *to, strict=True)
    ]
    raise UsageError(
        f"{describe_object(one)} would leave the grid; its centre may be {', '.join(spans)} m"
    )


def within_grid(draft: SceneDraft, cells: np.ndarray) -> np.ndarray:
    """Return whether each of cells int [N, 3] lies in the grid, bool [N]."""
    return np.asarray(((cells >= 0) & (cells < draft.shape)).all(axis=1))


def is_free(draft: SceneDraft, cells: np.ndarray) -> np.ndarray:
    """Return whether each of cells int [N, 3] lies in the grid and is empty or unseen, bool [N]."""
    inside = within_grid(draft, cells)
    at = np.where(inside[:, None], cells, 0)
    return inside & (draft.labels[tuple(at.T)] % 255 == 0)


def select_cells(held: GridCells, mask: np.ndarray) -> GridCells:
    """Return what the cells hold that a bool mask [N] names."""
    return GridCells(*(getattr(held, name)[mask] for name in ARRAYS))


def with_owner(held: GridCells, number: int) -> GridCells:
    """Return what cells hold, as those of another object."""
    fields = {name: getattr(held, name) for name in ARRAYS}
    return GridCells(**fields | {"instance": np.full(len(held.labels), number, np.uint16)})


def middle_cell(draft: SceneDraft, one: SceneObject) -> np.ndarray:
    """Return the cell, int64 [3], that holds an object's centre."""
    return metres_to_cells(one.center_m, draft.origin_m, draft.voxel_m)


class DeleteObjects(Command):
    """Remove objects: their cells are empty then; floor and walls behind them stay."""

    op: Literal["delete_objects"] = "delete_objects"
    ids: Ids

    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return the cells that become empty and the objects that go."""
        gone = objects_by_ids(draft, self.ids)
        patch = Patch(draft)
        for one in gone:
            patch.empty(draft.cells_of(one.id))
        details = {"gone": [one.id for one in gone], "class_id": common_class(gone)}
        return patch.plan_operation("delete_objects", counts_as="delete", **details)


class MoveObject(Command):
    """Move an object, with its cells and its furniture, by whole cells to a new centre.

    The cells left behind are empty. Cells that come to lie in structure or in other objects are
    lost: nothing that is there is overwritten.
    """

    op: Literal["move_object"] = "move_object"
    id: Id
    to_m: Point

    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return the cells and the object where they go."""
        one = object_by_id(draft, self.id)
        shift = cells_to(draft, one, self.to_m)
        if not shift.any():
            raise UsageError(
                f"{describe_object(one)} is there already: to_m is less than a cell away"
            )
        return plan_shift(draft, one, shift, "move_object")


class TurnObjects(Command):
    """Turn objects by quarters about their centres, counter-clockwise from above.

    Their furniture and their yaw turn. The cells of what is built from its own cells turn too,
    and lose what comes to lie in structure or in other objects; the cells of an object that a
    template stands for stay: they are what was seen there.
    """

    op: Literal["turn_objects"] = "turn_objects"
    ids: Ids
    quarter_turns: QuarterTurns

    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return the objects as they are turned."""
        ones = objects_by_ids(draft, self.ids)
        if self.quarter_turns % 4 == 0:
            raise UsageError("quarter_turns must be 1 to 3, or less than 0 for clockwise")
        patch = Patch(draft)
        for one in ones:
            if is_of_cells(one):
                cells = draft.cells_of(one.id)
                put_cells(draft, patch, one, cells, self._rotated_cells(draft, one, cells))
        objects = [rotate_object(one, self.quarter_turns) for one in ones]
        details = {"counts_as": "orient", "class_id": common_class(ones)}
        return patch.plan_operation("turn_objects", objects=objects, **details)

    def _rotated_cells(self, draft: SceneDraft, one: SceneObject, cells: np.ndarray) -> np.ndarray:
        result = rotate_cells(cells, one.center_m, self.quarter_turns, draft)
        if not within_grid(draft, result).all():
            raise UsageError(
                f"{describe_object(one)} would leave the grid; move it inward before it is turned"
            )
        return result


class DuplicateObject(Command):
    """Put the same object again, centred at ``to_m``, or else beside itself where most is free.

    Cells that would lie in structure or in other objects are left out, as when it is moved.
    """

    op: Literal["duplicate_object"] = "duplicate_object"
    id: Id
    to_m: Point | None = None

    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return the new object and its cells."""
        one = object_by_id(draft, self.id)
        cells = draft.cells_of(one.id)
        shift = self._beside(draft, one, cells)
        check_within(draft, one, cells, shift)
        copy = copy_object(translate_object(one, shift * draft.voxel_m), free_object_id(draft))
        patch = Patch(draft)
        held = with_owner(draft.contents(cells), copy.id)
        free = is_free(draft, cells + shift)
        if len(cells) and not free.any():
            raise UsageError(
                f"no cell is free for another {describe_object(one)} there; give to_m elsewhere"
            )
        patch.put((cells + shift)[free], select_cells(held, free))
        details = {"counts_as": "add", "class_id": one.class_id}
        return patch.plan_operation("duplicate_object", objects=[copy], **details)

    def _beside(self, draft: SceneDraft, one: SceneObject, cells: np.ndarray) -> np.ndarray:
        """Return the shift in cells: to ``to_m``, or to the side that has most room."""
        if self.to_m is not None:
            return cells_to(draft, one, self.to_m)
        sides = np.ceil(plan_extent_m(one) / draft.voxel_m + 1e-6).astype(int)
        ways = [sign * sides * np.eye(3, dtype=int)[axis] for axis in (1, 0) for sign in (1, -1)]
        return max(ways, key=lambda way: _room(draft, one, cells, way))


def _room(draft: SceneDraft, one: SceneObject, cells: np.ndarray, way: np.ndarray) -> int:
    """Return how many cells would find room; -1 where the grid ends."""
    there = cells + way if len(cells) else middle_cell(draft, one)[None] + way
    return int(is_free(draft, there).sum()) if within_grid(draft, there).all() else -1
