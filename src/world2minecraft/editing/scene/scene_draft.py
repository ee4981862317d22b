"""An edited scene, in which every change is an operation that can be undone."""

from collections.abc import Iterable
from typing import Any

import numpy as np

from world2minecraft.core.errors import ConflictError
from world2minecraft.core.types import GridCells, OccupancyGrid, Operation, SceneObject
from world2minecraft.editing.scene.object_conversion import same_object

ARRAYS = ("labels", "confidence", "colour", "source", "instance")


class SceneDraft:
    """The occupancy and the objects of a room, changed only by ``apply``.

    ``labels`` uint8, ``confidence`` float16, ``source`` uint8 and ``instance`` uint16 are [X, Y,
    Z], and ``colour`` is uint8 [X, Y, Z, 3]. Treat these arrays as read-only. ``objects`` maps ids
    to objects. ``counts`` int64 [256] is the number of cells with each label.
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
        """Return the current contents of cells, int [N, 3]."""
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
        """Return an operation on the current scene without applying it.

        Args:
            kind: Verb of the operation, such as ``paint``.
            cells: Cell indices, int [N, 3], without duplicates.
            after: New contents of the cells.
            gone: Ids of objects to remove.
            objects: New objects, or replacements of objects with the same ids.
            details: ``counts_as``, ``class_id``, ``actor`` and ``time_s`` of the operation.
        """
        new = tuple(objects)
        touched = sorted({*gone, *(one.id for one in new)} & self.objects.keys())
        before = tuple(self.objects[number] for number in touched)
        cells = cells.astype(np.int32)
        return Operation(kind, cells, self.contents(cells), after, before, new, **details)

    def apply(self, operation: Operation) -> None:
        """Apply an operation.

        Raises:
            ConflictError: If the operation does not match the scene. Nothing is changed then.
        """
        self.check(operation)
        self.put(operation)

    def put(self, operation: Operation) -> None:
        """Apply an operation that has been checked."""
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
        """Check that an operation can be applied.

        Raises:
            ConflictError: If the scene differs from the operation's previous contents.
        """
        if reason := self._find_conflict(operation):
            raise ConflictError(f"operation {operation.kind}", reason)

    def grid(self) -> OccupancyGrid:
        """Return a copy of the current occupancy."""
        arrays = {name: getattr(self, name).copy() for name in ARRAYS}
        return OccupancyGrid(**arrays, voxel_m=self.voxel_m, origin_m=self.origin_m)

    def cells_of(self, number: int) -> np.ndarray:
        """Return the cells int32 [N, 3] of the object with an id, in C order."""
        return np.argwhere(self.instance == number).astype(np.int32)

    def _find_conflict(self, operation: Operation) -> str:
        """Return why an operation cannot be applied, or an empty string."""
        cells = operation.cells
        inside = ((cells >= 0) & (cells < self.shape)).all(axis=1)
        if not inside.all():
            return f"cell {tuple(map(int, cells[~inside][0]))} is outside the grid"
        now = self.contents(cells)
        for name in ARRAYS:
            if not np.array_equal(getattr(now, name), getattr(operation.before, name)):
                return f"the {name} of its cells has changed since"
        for one in operation.objects_before:
            if one.id not in self.objects or not same_object(self.objects[one.id], one):
                return f"object {one.id} has changed since"
        new = {one.id for one in operation.objects_after}
        taken = new & self.objects.keys() - {one.id for one in operation.objects_before}
        return f"object {min(taken)} already exists" if taken else ""
