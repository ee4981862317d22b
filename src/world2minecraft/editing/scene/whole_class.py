"""Commands on all that is of one class: given another, or erased."""

from dataclasses import replace
from typing import Annotated, Literal

import numpy as np
from pydantic import Field, model_validator

from world2minecraft.core.classes import CLASS_NAMES, OBJECT_CLASSES
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import Operation, SceneObject
from world2minecraft.editing.scene.command import Tools
from world2minecraft.editing.scene.draft import SceneDraft
from world2minecraft.editing.scene.objects_of import instance_of
from world2minecraft.editing.scene.painting import planned_cells
from world2minecraft.editing.scene.voxels import CellCommand

OccupiedId = Annotated[int, Field(ge=1, le=11)]


class RelabelClass(CellCommand):
    """Give all cells and all objects of one class another.

    Objects take the class of their cells, and furniture of that class is found for them; where
    the new class is structure they are none any more.
    """

    op: Literal["relabel_class"] = "relabel_class"
    from_id: OccupiedId
    to_id: OccupiedId

    @model_validator(mode="after")
    def _differ(self) -> "RelabelClass":
        if self.from_id == self.to_id:
            raise ValueError("from_id and to_id must differ")
        return self

    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return all cells of the class, and its objects with their new class."""
        check_class(draft, self.from_id, self.locked)
        cells = np.argwhere(draft.labels == self.from_id)
        owners = draft.instance[tuple(cells.T)]
        if self.to_id not in OBJECT_CLASSES:
            gone = without_cells(draft, self.from_id)
            return planned_cells(draft, "relabel", cells, self.to_id, owners, gone=gone)
        changed = self._objects(draft, tools)
        fields = {"counts_as": "relabel", "objects": changed}
        return planned_cells(draft, "relabel", cells, self.to_id, owners, **fields)

    def _objects(self, draft: SceneDraft, tools: Tools) -> list[SceneObject]:
        """The objects of the class as they are afterwards."""
        grid = draft.grid()
        grid = replace(grid, labels=np.where(grid.labels == self.from_id, self.to_id, grid.labels))
        found = []
        for one in draft.objects.values():
            if one.class_id == self.from_id:
                bare = replace(one, class_id=self.to_id, placements=())
                cells = draft.cells_of(one.id)
                furniture = tools.match(grid, instance_of(bare, cells)) if len(cells) else ()
                found.append(replace(bare, placements=furniture))
        return found


class DeleteClass(CellCommand):
    """Erase all cells and all objects of a class."""

    op: Literal["delete_class"] = "delete_class"
    class_id: OccupiedId

    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return all cells of the class."""
        check_class(draft, self.class_id, self.locked)
        cells = np.argwhere(draft.labels == self.class_id)
        gone = without_cells(draft, self.class_id)
        told = {"counts_as": "delete", "class_id": self.class_id}
        return planned_cells(draft, "delete", cells, 0, gone=gone, **told)


def check_class(draft: SceneDraft, class_id: int, locked: tuple[int, ...]) -> None:
    """Look whether a class may be changed.

    Raises:
        UsageError: it is locked, or the scene has nothing of it.
    """
    name = CLASS_NAMES[class_id]
    if class_id in locked:
        raise UsageError(f"{name} is locked: unlock it in the legend first")
    if not draft.counts[class_id] and not without_cells(draft, class_id):
        raise UsageError(f"the scene has no {name}")


def without_cells(draft: SceneDraft, class_id: int) -> list[int]:
    """Return the objects, by id, of a class that have no cells: centres alone."""
    held = np.bincount(draft.instance.ravel(), minlength=65536)
    ordered = sorted(draft.objects.values(), key=lambda one: one.id)
    return [one.id for one in ordered if one.class_id == class_id and held[one.id] == 0]
