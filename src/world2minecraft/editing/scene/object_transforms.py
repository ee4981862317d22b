"""Commands for whole objects: delete, move, rotate and duplicate.

Cells move with their object by whole cells, onto free cells inside the grid.
"""

from collections.abc import Sequence
from dataclasses import replace
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
from world2minecraft.editing.scene.object_conversion import instance_of
from world2minecraft.editing.scene.scene_draft import ARRAYS, SceneDraft

Id = Annotated[int, Field(ge=1, le=65535)]
Ids = Annotated[tuple[Id, ...], Field(min_length=1, max_length=65535)]
Metre = Annotated[float, Field(ge=-10_000, le=10_000)]
Point = tuple[Metre, Metre, Metre]
QuarterTurns = Annotated[int, Field(ge=-3, le=3)]


def plan_shift(draft: SceneDraft, one: SceneObject, shift: np.ndarray, kind: str) -> Operation:
    """Return the operation that moves an object by whole cells, int [3].

    Raises:
        UsageError: If the object would leave the grid.
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
    """Copy the contents of an object's cells to other cells, [N, 3] each, if these are free."""
    patch.empty(cells)
    free = is_free(draft, there) | (draft.instance[tuple(there.T)] == one.id)
    patch.put(there[free], select_cells(draft.contents(cells), free))


def cells_to(draft: SceneDraft, one: SceneObject, to_m: Sequence[float]) -> np.ndarray:
    """Return the shift in cells, int64 [3], that moves an object's centre nearest to a point."""
    return np.floor((np.array(to_m) - one.center_m) / draft.voxel_m + 0.5).astype(np.int64)


def check_within(draft: SceneDraft, one: SceneObject, cells: np.ndarray, shift: np.ndarray) -> None:
    """Raise ``UsageError`` if an object shifted by cells, int [3], would leave the grid."""
    held = cells if len(cells) else middle_cell(draft, one)[None]
    if within_grid(draft, held + shift).all():
        return
    low, high = held.min(axis=0), held.max(axis=0)
    to = one.center_m + draft.voxel_m * np.stack([-low, np.array(draft.shape) - 1 - high])
    spans = [
        f"{name} {first:.2f} to {last:.2f}" for name, first, last in zip("xyz", *to, strict=True)
    ]
    raise UsageError(
        f"{describe_object(one)} would leave the grid; its centre must be in {', '.join(spans)} m"
    )


def within_grid(draft: SceneDraft, cells: np.ndarray) -> np.ndarray:
    """Return whether each of the cells int [N, 3] is inside the grid, bool [N]."""
    return np.asarray(((cells >= 0) & (cells < draft.shape)).all(axis=1))


def is_free(draft: SceneDraft, cells: np.ndarray) -> np.ndarray:
    """Return which of the cells int [N, 3] are empty or unobserved and in the grid, bool [N]."""
    inside = within_grid(draft, cells)
    at = np.where(inside[:, None], cells, 0)
    return inside & (draft.labels[tuple(at.T)] % 255 == 0)


def select_cells(held: GridCells, mask: np.ndarray) -> GridCells:
    """Return the cell contents selected by a mask, bool [N]."""
    return GridCells(*(getattr(held, name)[mask] for name in ARRAYS))


def with_owner(held: GridCells, number: int) -> GridCells:
    """Return cell contents with another object id."""
    fields = {name: getattr(held, name) for name in ARRAYS}
    return GridCells(**fields | {"instance": np.full(len(held.labels), number, np.uint16)})


def middle_cell(draft: SceneDraft, one: SceneObject) -> np.ndarray:
    """Return the cell, int64 [3], that contains an object's centre."""
    return metres_to_cells(one.center_m, draft.origin_m, draft.voxel_m)


class DeleteObjects(Command):
    """Delete objects and empty their cells, keeping the floor and walls behind them."""

    op: Literal["delete_objects"] = "delete_objects"
    ids: Ids

    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return the operation with the emptied cells and the deleted objects."""
        gone = objects_by_ids(draft, self.ids)
        patch = Patch(draft)
        for one in gone:
            patch.empty(draft.cells_of(one.id))
        details = {"gone": [one.id for one in gone], "class_id": common_class(gone)}
        return patch.plan_operation("delete_objects", counts_as="delete", **details)


class MoveObject(Command):
    """Move an object with its cells and furniture by whole cells to a new centre.

    The previous cells become empty. Cells that would overlap structure or other objects are
    dropped, so nothing is overwritten.
    """

    op: Literal["move_object"] = "move_object"
    id: Id
    to_m: Point

    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return the operation with the object and its cells at the new position."""
        one = object_by_id(draft, self.id)
        shift = cells_to(draft, one, self.to_m)
        if not shift.any():
            raise UsageError(
                f"{describe_object(one)} is already at to_m, which is less than a cell away"
            )
        return plan_shift(draft, one, shift, "move_object")


class TurnObjects(Command):
    """Rotate objects by quarter turns about their centres, counter-clockwise from above.

    Their furniture and yaw are rotated. The cells of objects built from their own cells are also
    rotated, and cells that would overlap structure or other objects are dropped. The cells of
    objects with a furniture template are kept, because they record what was observed; the IoU of
    the template with them is computed again.
    """

    op: Literal["turn_objects"] = "turn_objects"
    ids: Ids
    quarter_turns: QuarterTurns

    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return the operation with the rotated objects."""
        ones = objects_by_ids(draft, self.ids)
        if self.quarter_turns % 4 == 0:
            raise UsageError("quarter_turns must be 1 to 3, or negative for clockwise")
        patch = Patch(draft)
        for one in ones:
            if is_of_cells(one):
                cells = draft.cells_of(one.id)
                put_cells(draft, patch, one, cells, self._rotated_cells(draft, one, cells))
        objects = [self._turned(draft, tools, one) for one in ones]
        details = {"counts_as": "orient", "class_id": common_class(ones)}
        return patch.plan_operation("turn_objects", objects=objects, **details)

    def _turned(self, draft: SceneDraft, tools: Tools, one: SceneObject) -> SceneObject:
        turned = rotate_object(one, self.quarter_turns)
        if is_of_cells(one):
            return turned
        found = instance_of(turned, draft.cells_of(one.id))
        return replace(turned, placements=tools.score(draft.grid(), found, turned.placements))

    def _rotated_cells(self, draft: SceneDraft, one: SceneObject, cells: np.ndarray) -> np.ndarray:
        result = rotate_cells(cells, one.center_m, self.quarter_turns, draft)
        if not within_grid(draft, result).all():
            raise UsageError(
                f"{describe_object(one)} would leave the grid; move it inward before rotating it"
            )
        return result


class DuplicateObject(Command):
    """Duplicate an object, centred at ``to_m``, or next to the original where most space is free.

    Cells that would overlap structure or other objects are dropped.
    """

    op: Literal["duplicate_object"] = "duplicate_object"
    id: Id
    to_m: Point | None = None

    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return the operation with the new object and its cells."""
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
                f"no free cells for a copy of {describe_object(one)}; choose another to_m"
            )
        patch.put((cells + shift)[free], select_cells(held, free))
        details = {"counts_as": "add", "class_id": one.class_id}
        return patch.plan_operation("duplicate_object", objects=[copy], **details)

    def _beside(self, draft: SceneDraft, one: SceneObject, cells: np.ndarray) -> np.ndarray:
        """Return the shift in cells to ``to_m``, or to the side with most free space."""
        if self.to_m is not None:
            return cells_to(draft, one, self.to_m)
        sides = np.ceil(plan_extent_m(one) / draft.voxel_m + 1e-6).astype(int)
        ways = [sign * sides * np.eye(3, dtype=int)[axis] for axis in (1, 0) for sign in (1, -1)]
        return max(ways, key=lambda way: _room(draft, one, cells, way))


def _room(draft: SceneDraft, one: SceneObject, cells: np.ndarray, way: np.ndarray) -> int:
    """Return the number of cells that fit at an offset, or -1 beyond the grid."""
    there = cells + way if len(cells) else middle_cell(draft, one)[None] + way
    return int(is_free(draft, there).sum()) if within_grid(draft, there).all() else -1
