"""Commands on whole objects: delete, move, turn, duplicate."""

from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import Operation, SceneObject
from world2minecraft.editing.scene.carrying import (
    cells_to,
    check_within,
    is_free,
    middle_cell,
    owned,
    planned_shift,
    put_cells,
    some,
    within_grid,
)
from world2minecraft.editing.scene.command import Command, Tools
from world2minecraft.editing.scene.draft import SceneDraft
from world2minecraft.editing.scene.object_boxes import (
    common_class,
    copied,
    free_number,
    is_of_cells,
    object_named,
    objects_named,
    plan_extent_m,
    said,
    shifted,
    turned,
    turned_cells,
)
from world2minecraft.editing.scene.patch import Patch

Id = Annotated[int, Field(ge=1, le=65535)]
Ids = Annotated[tuple[Id, ...], Field(min_length=1, max_length=65535)]
Metre = Annotated[float, Field(ge=-10_000, le=10_000)]
Point = tuple[Metre, Metre, Metre]
QuarterTurns = Annotated[int, Field(ge=-3, le=3)]


class DeleteObjects(Command):
    """Remove objects: their cells are empty then; floor and walls behind them stay."""

    op: Literal["delete_objects"] = "delete_objects"
    ids: Ids

    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return the cells that become empty and the objects that go."""
        gone = objects_named(draft, self.ids)
        patch = Patch(draft)
        for one in gone:
            patch.empty(draft.cells_of(one.id))
        told = {"gone": [one.id for one in gone], "class_id": common_class(gone)}
        return patch.planned("delete_objects", counts_as="delete", **told)


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
        one = object_named(draft, self.id)
        shift = cells_to(draft, one, self.to_m)
        if not shift.any():
            raise UsageError(f"{said(one)} is there already: to_m is less than a cell away")
        return planned_shift(draft, one, shift, "move_object")


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
        ones = objects_named(draft, self.ids)
        if self.quarter_turns % 4 == 0:
            raise UsageError("quarter_turns must be 1 to 3, or less than 0 for clockwise")
        patch = Patch(draft)
        for one in ones:
            if is_of_cells(one):
                cells = draft.cells_of(one.id)
                put_cells(draft, patch, one, cells, self._turned(draft, one, cells))
        objects = [turned(one, self.quarter_turns) for one in ones]
        told = {"counts_as": "orient", "class_id": common_class(ones)}
        return patch.planned("turn_objects", objects=objects, **told)

    def _turned(self, draft: SceneDraft, one: SceneObject, cells: np.ndarray) -> np.ndarray:
        result = turned_cells(cells, one.center_m, self.quarter_turns, draft)
        if not within_grid(draft, result).all():
            raise UsageError(
                f"{said(one)} would leave the grid; move it inward before it is turned"
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
        one = object_named(draft, self.id)
        cells = draft.cells_of(one.id)
        shift = self._beside(draft, one, cells)
        check_within(draft, one, cells, shift)
        copy = copied(shifted(one, shift * draft.voxel_m), free_number(draft))
        patch = Patch(draft)
        held = owned(draft.held(cells), copy.id)
        free = is_free(draft, cells + shift)
        if len(cells) and not free.any():
            raise UsageError(f"no cell is free for another {said(one)} there; give to_m elsewhere")
        patch.put((cells + shift)[free], some(held, free))
        told = {"counts_as": "add", "class_id": one.class_id}
        return patch.planned("duplicate_object", objects=[copy], **told)

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
