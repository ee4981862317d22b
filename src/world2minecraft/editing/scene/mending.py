"""Commands that mend what a scan left: floaters, holes, rough surfaces."""

from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from world2minecraft.core.classes import CLASS_NAMES, OBJECT_CLASSES
from world2minecraft.core.errors import UnknownNameError, UsageError
from world2minecraft.core.types import Operation
from world2minecraft.editing.scene.command import MAX_RUNS, Tools
from world2minecraft.editing.scene.draft import SceneDraft
from world2minecraft.editing.scene.floaters import MAX_CELLS, find_floaters
from world2minecraft.editing.scene.holes import HOLE_M2, gap_at, hole_cells, plane_gaps
from world2minecraft.editing.scene.painting import planned_cells
from world2minecraft.editing.scene.planes import Plane, find_planes
from world2minecraft.editing.scene.runs import cells_of_runs
from world2minecraft.editing.scene.smoothing import smoothed
from world2minecraft.editing.scene.voxels import Cell, CellCommand, Runs, check_cell


class RemoveFloaters(CellCommand):
    """Erase all pieces of at most ``max_cells`` that hold to nothing.

    A piece that has one of the cells ``keep``, flat numbers, stays.
    """

    op: Literal["remove_floaters"] = "remove_floaters"
    max_cells: Annotated[int, Field(ge=1)] = MAX_CELLS
    keep: Annotated[tuple[Annotated[int, Field(ge=0)], ...], Field(max_length=MAX_RUNS)] = ()

    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return the erased cells."""
        found = [one.cells for one in find_floaters(draft, self.max_cells)]
        numbers = [np.ravel_multi_index(tuple(cells.T), draft.shape) for cells in found]
        gone = [
            cells
            for cells, flat in zip(found, numbers, strict=True)
            if not np.isin(flat, self.keep).any() and self.free(draft, cells).all()
        ]
        if not gone:
            raise UsageError(
                f"no floaters of at most {self.max_cells} cells: all hold, or are kept"
            )
        return planned_cells(draft, "delete", np.concatenate(gone), 0)


class FillHoles(CellCommand):
    """Fill the holes of a plane, of an object's surface, or of all planes.

    ``plane`` is ``floor``, ``ceiling``, ``wall:1`` and so on as the query ``holes`` lists them,
    ``all`` of them, or ``object:7``: of an object, the empty cells that have its cells on both
    sides along two axes. With ``cell``, only the gap of the plane that it lies in is filled,
    be it a door; without, gaps that are no openings, the seen ones up to ``hole_m2``.
    """

    op: Literal["fill_holes"] = "fill_holes"
    plane: Annotated[str, Field(max_length=40)]
    cell: Cell | None = None
    hole_m2: Annotated[float, Field(ge=0)] = HOLE_M2

    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return the filled cells."""
        if self.plane.startswith("object:"):
            return self._object(draft)
        planes = find_planes(draft)
        if self.plane != "all":
            planes = [named_plane(planes, self.plane)]
        parts = [self._cells(draft, plane) for plane in planes]
        cells = np.concatenate([*parts, np.zeros((0, 3), np.int64)])
        classes = np.repeat([plane.class_id for plane in planes], [len(part) for part in parts])
        cells, first = np.unique(cells, axis=0, return_index=True)  # Two planes meet in a corner.
        if not len(cells):
            where = "any plane" if self.plane == "all" else self.plane
            raise UsageError(f"{where} has no hole to fill; name a cell of an opening to close it")
        return planned_cells(draft, "fill", cells, classes[first], 0, counts_as="add")

    def _cells(self, draft: SceneDraft, plane: Plane) -> np.ndarray:
        gaps = plane_gaps(draft, plane, hole_m2=self.hole_m2)
        if self.cell is None:
            return hole_cells(draft, gaps, gaps.holes)
        check_cell(draft, self.cell)
        place = tuple(np.delete(self.cell, plane.axis).tolist())
        mask = gap_at(gaps, place)
        if not mask.any():
            raise UsageError(f"cell {list(self.cell)} is in no gap of {plane.name}")
        return hole_cells(draft, gaps, mask)

    def _object(self, draft: SceneDraft) -> Operation:
        number = self.plane.partition(":")[2]
        if not number.isdecimal() or int(number) not in draft.objects:
            raise UsageError(f"no object {number}; the tree on the left lists all")
        one = draft.objects[int(number)]
        cells = pinholes(draft.labels, draft.instance == one.id)
        if not len(cells):
            raise UsageError(f"object {one.id} has no hole of one cell")
        return planned_cells(draft, "fill", cells, one.class_id, one.id, counts_as="add")


class Smooth(CellCommand):
    """Smooth furniture by a majority filter; structure never moves.

    Only cells of ``class_id`` are changed or made where it is given, and only those of ``runs``
    where they are.
    """

    op: Literal["smooth"] = "smooth"
    class_id: Annotated[int, Field(ge=min(OBJECT_CLASSES), le=max(OBJECT_CLASSES))] | None = None
    runs: Runs | None = None

    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return the cells that change."""
        result = smoothed(draft.labels)
        changes = result != draft.labels
        if self.class_id is not None:
            changes &= (draft.labels == self.class_id) | (result == self.class_id)
        if self.runs is not None:
            chosen = np.zeros(draft.shape, bool)
            chosen[tuple(cells_of_runs(self.runs, draft.shape).T)] = True
            changes &= chosen
        cells = np.argwhere(changes)
        cells = cells[self.free(draft, cells)]
        if not len(cells):
            what = CLASS_NAMES[self.class_id] if self.class_id else "furniture"
            raise UsageError(f"no cell changes: the {what} here is smooth already, or locked")
        return planned_cells(draft, "smooth", cells, result[tuple(cells.T)], counts_as="other")


def named_plane(planes: list[Plane], name: str) -> Plane:
    """Return the plane of a name; a 1 may be left out or added.

    Raises:
        UnknownNameError: the scene has no such plane.
    """
    by_name = {plane.name: plane for plane in planes}
    for spelled in (name, name.removesuffix(":1"), f"{name}:1"):
        if spelled in by_name:
            return by_name[spelled]
    raise UnknownNameError("plane", name, [*by_name, "all"])


def pinholes(labels: np.ndarray, mine: np.ndarray) -> np.ndarray:
    """Return the cells int [N, 3], empty or unseen, with cells of a mask on both sides of two axes.

    ``labels`` uint8 and ``mine`` bool are [X, Y, Z].
    """
    between = np.zeros(labels.shape, np.uint8)
    for axis in range(3):
        inner = [slice(None)] * 3
        inner[axis] = slice(1, -1)
        moved = np.moveaxis(mine, axis, 0)
        both = np.moveaxis(moved[:-2] & moved[2:], 0, axis)
        between[tuple(inner)] += both
    return np.argwhere((between >= 2) & (labels % 255 == 0))
