"""Commands on cells: painted, erased, given another class."""

from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from world2minecraft.edit.scene.command import MAX_RUNS, Command, Tools
from world2minecraft.edit.scene.draft import SceneDraft
from world2minecraft.edit.scene.runs import cells_of_runs
from world2minecraft.errors import UsageError
from world2minecraft.types import OBSERVED, GridCells, Operation

Run = tuple[Annotated[int, Field(ge=0)], Annotated[int, Field(ge=1)]]
ClassId = Annotated[int, Field(ge=0, le=11)]


class SetCells(Command):
    """Give cells one class; 0 erases them. Cells of locked classes stay as they are.

    Erased cells belong to no object, all others to ``instance``; 0 is none.
    """

    op: Literal["set_cells"] = "set_cells"
    cells: Annotated[list[Run], Field(max_length=MAX_RUNS)]
    class_id: ClassId
    instance: Annotated[int, Field(ge=0, le=65535)] = 0
    verb: Literal["paint", "erase", "relabel", "fill", "delete"] = "paint"
    locked: tuple[ClassId, ...] = ()

    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return the cells that change."""
        cells = cells_of_runs(self.cells, draft.shape)
        held = draft.labels[tuple(cells.T)]
        cells = cells[(held != self.class_id) & ~np.isin(held, self.locked)]
        if not len(cells):
            raise UsageError("no cell changes: all have this class already or are locked")
        return planned_cells(draft, self.verb, cells, self.class_id, self.instance)


def planned_cells(
    draft: SceneDraft, verb: str, cells: np.ndarray, class_id: int, instance: int = 0
) -> Operation:
    """Return the operation that gives cells int [N, 3] one class, sure and observed."""
    count = len(cells)
    occupied = (draft.labels[tuple(cells.T)] % 255) > 0
    after = GridCells(
        np.full(count, class_id, np.uint8),
        np.ones(count, np.float16),
        draft.colour[tuple(cells.T)],
        np.full(count, OBSERVED, np.uint8),
        np.full(count, instance if class_id else 0, np.uint16),
    )
    counted = "relabel" if occupied.mean() > 0.5 else "add"
    counted = "delete" if class_id == 0 else counted
    return draft.planned(verb, cells, after, counts_as=counted, class_id=class_id)
