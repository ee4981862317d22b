"""A scene while it is edited: every change is an operation that can be undone."""

from collections.abc import Iterable
from typing import Any

import numpy as np

from world2minecraft.core.errors import ConflictError
from world2minecraft.core.types import GridCells, OccupancyGrid, Operation, SceneObject
from world2minecraft.editing.scene.object_conversion import same_object

ARRAYS = ("labels", "confidence", "colour", "source", "instance")


class SceneDraft:
    """The occupancy and the objects of a room, changed only by ``apply``.

    ``labels`` uint8, ``confidence`` float16, ``source`` uint8 and ``instance`` uint16 are
    [X, Y, Z], ``colour`` is uint8 [X, Y, Z, 3]; treat them as read-only. ``objects`` are by id,
    ``counts`` int64 [256] tells how many cells have each label.
    """

    def __init__(self, grid: OccupancyGrid, objects: Iterable[SceneObject] = ()):
        self.labels, self.confidence, self.colour, self.source, self.instance = (
            getattr(grid, name).copy() for name in ARRAYS
        )
        self.voxel_m, self.origin_m = grid.voxel_m, grid.origin_m
        self.objects = {one.id: one for one in objects}
        self.counts = np.bincount(self.labels.ravel(), minlength=256)

    @property
    def shape(self) -> tuple[int, int, int]:
        """The number of cells along x, y and z."""
        return self.labels.shape  # type: ignore[return-value]

    def contents(self, cells: np.ndarray) -> GridCells:
        """Return what some cells, int [N, 3], hold now."""
        at = tuple(cells.T)
        return GridCells(*(getattr(self, name)[at] for name in ARRAYS))

    def plan_operation(
        self,
        kind: str,
        cells: np.ndarray,
        after: GridCells,
        *,
        gone: Iterable[int] = (),
        objects: Iterable[SceneObject] = (),
        **details: Any,
    ) -> Operation:
        """Return an operation on the scene as it is now; nothing is done yet.

        Args:
            kind: a verb.
            cells: int [N, 3], each once.
            after: what they become.
            gone: ids of objects that are removed.
            objects: those that are new, or take the place of the ones with their ids.
            details: ``counts_as``, ``class_id``, ``actor`` and ``time_s`` of the operation.
        """
        new = tuple(objects)
        touched = sorted({*gone, *(one.id for one in new)} & self.objects.keys())
        before = tuple(self.objects[number] for number in touched)
        cells = cells.astype(np.int32)
        return Operation(kind, cells, self.contents(cells), after, before, new, **details)

    def apply(self, operation: Operation) -> None:
        """Do an operation. Raises what ``check`` raises; then nothing is changed."""
        self.check(operation)
        self.put(operation)

    def put(self, operation: Operation) -> None:
        """Do an operation that was checked."""
        at = tuple(operation.cells.T)
        for name in ARRAYS:
            getattr(self, name)[at] = getattr(operation.after, name)
        self.counts -= np.bincount(operation.before.labels, minlength=256)
        self.counts += np.bincount(operation.after.labels, minlength=256)
        for one in operation.objects_before:
            del self.objects[one.id]
        for one in operation.objects_after:
            self.objects[one.id] = one

    def check(self, operation: Operation) -> None:
        """Look whether an operation can be done.

        Raises:
            ConflictError: the scene does not hold what it says was there.
        """
        if reason := self._find_conflict(operation):
            raise ConflictError(f"operation {operation.kind}", reason)

    def grid(self) -> OccupancyGrid:
        """Return the occupancy as it is now, a copy."""
        arrays = {name: getattr(self, name).copy() for name in ARRAYS}
        return OccupancyGrid(**arrays, voxel_m=self.voxel_m, origin_m=self.origin_m)

    def cells_of(self, number: int) -> np.ndarray:
        """Return the cells int32 [N, 3] of an object, in C order."""
        return np.argwhere(self.instance == number).astype(np.int32)

    def _find_conflict(self, operation: Operation) -> str:
        """Why an operation cannot be done here; empty where it can."""
        cells = operation.cells
        inside = ((cells >= 0) & (cells < self.shape)).all(axis=1)
        if not inside.all():
            return f"cell {tuple(map(int, cells[~inside][0]))} lies outside the grid"
        now = self.contents(cells)
        for name in ARRAYS:
            if not np.array_equal(getattr(now, name), getattr(operation.before, name)):
                return f"the {name} of its cells changed since"
        for one in operation.objects_before:
            if one.id not in self.objects or not same_object(self.objects[one.id], one):
                return f"object {one.id} changed since"
        new = {one.id for one in operation.objects_after}
        taken = new & self.objects.keys() - {one.id for one in operation.objects_before}
        return f"object {min(taken)} is there already" if taken else ""
