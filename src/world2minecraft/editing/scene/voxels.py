"""Commands on cells that a person names: painted, erased, given another class, copied."""

from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from world2minecraft.core.classes import CLASS_NAMES, OBJECT_CLASSES, UNKNOWN
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import Operation
from world2minecraft.editing.scene.command import MAX_RUNS, Command, Tools
from world2minecraft.editing.scene.draft import SceneDraft
from world2minecraft.editing.scene.painting import planned_cells
from world2minecraft.editing.scene.parts import component_of
from world2minecraft.editing.scene.runs import box_cells, cells_of_runs

Run = tuple[Annotated[int, Field(ge=0)], Annotated[int, Field(ge=1)]]
Runs = Annotated[list[Run], Field(max_length=MAX_RUNS)]
ClassId = Annotated[int, Field(ge=0, le=11)]
EMPTY = 0
Cell = tuple[int, int, int]


class CellCommand(Command):
    """What commands on cells share: cells of ``locked`` classes stay as they are."""

    locked: tuple[ClassId, ...] = ()

    def free(self, draft: SceneDraft, cells: np.ndarray) -> np.ndarray:
        """Return bool [N]: which cells int [N, 3] are of no locked class."""
        return ~np.isin(draft.labels[tuple(cells.T)], self.locked)


class SetCells(CellCommand):
    """Give cells one class; 0 erases them.

    Whose they are then: of ``instance``, of none where that is 0, and where it is not given, of
    the object of the class that they touch.
    """

    op: Literal["set_cells"] = "set_cells"
    cells: Runs
    class_id: ClassId
    instance: Annotated[int, Field(ge=0, le=65535)] | None = None
    verb: Literal["paint", "erase", "relabel", "fill", "delete"] = "paint"

    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return the cells that change."""
        check_owner(draft, self.instance, self.class_id)
        cells = cells_of_runs(self.cells, draft.shape)
        changes = draft.labels[tuple(cells.T)] != self.class_id
        if self.instance is not None and self.class_id in OBJECT_CLASSES:
            changes |= draft.instance[tuple(cells.T)] != self.instance
        cells = cells[changes & self.free(draft, cells)]
        if not len(cells):
            raise UsageError("no cell changes: all have this class already or are locked")
        return planned_cells(draft, self.verb, cells, self.class_id, self.instance)


class FillBox(CellCommand):
    """Give all cells of a box one class; 0 erases them. Both corners are in the box."""

    op: Literal["fill_box"] = "fill_box"
    low: Cell
    high: Cell
    class_id: ClassId

    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return the cells of the box that change."""
        cells = box_cells(self.low, self.high, draft.shape)
        cells = cells[(draft.labels[tuple(cells.T)] != self.class_id) & self.free(draft, cells)]
        if not len(cells):
            raise UsageError("no cell changes: all of the box has this class already or is locked")
        return planned_cells(draft, "fill" if self.class_id else "erase", cells, self.class_id)


class DeleteComponent(CellCommand):
    """Erase a cell and all of its class that hold to it by faces."""

    op: Literal["delete_component"] = "delete_component"
    cell: Cell

    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return the erased cells."""
        check_cell(draft, self.cell)
        held = int(draft.labels[self.cell])
        if held in (EMPTY, UNKNOWN):
            raise UsageError(f"cell {list(self.cell)} is empty: name one that is occupied")
        if held in self.locked:
            raise UsageError(f"{CLASS_NAMES[held]} is locked: unlock it in the legend first")
        cells = component_of(draft.labels, self.cell)
        return planned_cells(draft, "delete", cells, 0, class_id=held)


class Paste(CellCommand):
    """Copy what cells hold to ``by`` cells farther, mirrored first where ``mirror`` names an axis.

    The mirror stands in the middle of the cells' box. Only occupied cells are copied, with their
    colour; what lands outside the grid is dropped. A copied cell belongs to the
    object of its class that it touches, as a painted one: whoever wants a second object asks for
    ``duplicate_object``.
    """

    op: Literal["paste"] = "paste"
    cells: Runs
    by: Cell
    mirror: Literal["x", "y", "z"] | None = None

    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return the cells that are pasted over."""
        sources = cells_of_runs(self.cells, draft.shape)
        sources = sources[draft.labels[tuple(sources.T)] % 255 > 0]
        if not len(sources):
            raise UsageError("nothing to paste: none of these cells is occupied")
        targets = self._moved(sources)
        inside = ((targets >= 0) & (targets < draft.shape)).all(axis=1)
        sources, targets = sources[inside], targets[inside]
        changes = draft.labels[tuple(sources.T)] != draft.labels[tuple(targets.T)]
        changes &= self.free(draft, targets)
        sources, targets = sources[changes], targets[changes]
        if not len(targets):
            raise UsageError("no cell changes: the copy lies outside, or on cells like its own")
        labels = draft.labels[tuple(sources.T)]
        colours = draft.colour[tuple(sources.T)]
        return planned_cells(draft, "paste", targets, labels, colours=colours)

    def _moved(self, cells: np.ndarray) -> np.ndarray:
        moved = cells.astype(np.int64)
        if self.mirror is not None:
            axis = "xyz".index(self.mirror)
            moved[:, axis] = moved[:, axis].min() + moved[:, axis].max() - moved[:, axis]
        limit = np.iinfo(np.int32).max
        return moved + np.clip(np.array(self.by, object), -limit, limit).astype(np.int64)


def check_owner(draft: SceneDraft, number: int | None, class_id: int) -> None:
    """Look whether cells of a class may belong to an object.

    Raises:
        UsageError: there is no such object, or it is of another class.
    """
    if not number:
        return
    if number not in draft.objects:
        raise UsageError(f"no object {number}; leave instance out and cells join what they touch")
    held = draft.objects[number].class_id
    if held != class_id:
        names = f"{CLASS_NAMES[held]}, not {CLASS_NAMES[class_id]}"
        raise UsageError(f"object {number} is a {names}: relabel it first, or give its class")


def check_cell(draft: SceneDraft, cell: tuple[int, int, int]) -> None:
    """Look whether a cell is in the grid.

    Raises:
        UsageError: it is not.
    """
    if not all(0 <= at < side for at, side in zip(cell, draft.shape, strict=True)):
        raise UsageError(f"cell {list(cell)} lies outside the grid of {list(draft.shape)} cells")
