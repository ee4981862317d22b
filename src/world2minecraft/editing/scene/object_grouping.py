"""Commands that change which cells form an object: split, merge, relabel and recluster."""

from dataclasses import replace
from typing import Annotated, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, model_validator

from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import OccupancyGrid, Operation, SceneObject
from world2minecraft.editing.scene.cell_patch import Patch
from world2minecraft.editing.scene.command import Command, Tools
from world2minecraft.editing.scene.furniture_commands import ObjectClass
from world2minecraft.editing.scene.object_boxes import (
    describe_object,
    free_object_id,
    object_by_id,
    objects_by_ids,
)
from world2minecraft.editing.scene.object_conversion import instance_of, object_of
from world2minecraft.editing.scene.object_naming import with_class, with_name_of
from world2minecraft.editing.scene.object_transforms import Id, Ids, Metre
from world2minecraft.editing.scene.scene_draft import SceneDraft

ROUNDS = 50  # Maximum iterations for two to eight clusters; most need ten.


class CutPlane(BaseModel):
    """A plane perpendicular to an axis of the room, such as x = 1.4 m."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    axis: Literal["x", "y", "z"]
    at_m: Metre


class RelabelObjects(Command):
    """Change the class of objects and their cells, and match furniture of that class."""

    op: Literal["relabel_objects"] = "relabel_objects"
    ids: Ids
    class_id: ObjectClass

    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return the operation with the relabelled cells and objects."""
        ones = [o for o in objects_by_ids(draft, self.ids) if o.class_id != self.class_id]
        if not ones:
            raise UsageError("nothing to change: all objects already have this class")
        patch, grid, objects = Patch(draft), draft.grid(), []
        for one in ones:
            cells = draft.cells_of(one.id)
            patch.relabel(cells, self.class_id)
            named = with_class(one, self.class_id)
            placed = tools.match(grid, instance_of(named, cells))
            objects.append(replace(named, placements=placed))
        details = {"counts_as": "relabel", "class_id": self.class_id}
        return patch.plan_operation("relabel_objects", objects=objects, **details)


class SplitObject(Command):
    """Split an object into several parts by the positions of its cells, or in two by a plane.

    The largest part keeps the id. The others become new objects of the same class and name. All
    parts are measured and matched with furniture again.
    """

    op: Literal["split_object"] = "split_object"
    id: Id
    parts: Annotated[int, Field(ge=2, le=8)] | None = None
    plane: CutPlane | None = None

    @model_validator(mode="after")
    def _one_way(self) -> "SplitObject":
        if (self.parts is None) == (self.plane is None):
            raise ValueError("specify either parts or plane")
        return self

    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return the operation with the cells of each part and the objects."""
        one = object_by_id(draft, self.id)
        cells = draft.cells_of(one.id)
        sides = self._sides(draft, cells)
        groups = _largest_first(cells, sides)
        if len(groups) < 2 and self.plane is None:
            raise UsageError(f"{describe_object(one)} has too few cells to split")
        if len(groups) < 2:
            raise UsageError(
                f"{describe_object(one)} is on one side of the plane; move the plane into its cells"
            )
        numbers = [one.id]
        while len(numbers) < len(groups):
            numbers.append(free_object_id(draft, numbers))
        patch, grid = Patch(draft), draft.grid()
        for number, group in zip(numbers[1:], groups[1:], strict=True):
            patch.give(group, number)
        pairs = zip(numbers, groups, strict=True)
        objects = [
            measure_object(grid, tools, replace(one, id=n, placements=()), group)
            for n, group in pairs
        ]
        return patch.plan_operation("split_object", objects=objects, class_id=one.class_id)

    def _sides(self, draft: SceneDraft, cells: np.ndarray) -> np.ndarray:
        """Return the part, int64 [N], of each cell."""
        if self.plane is None:
            return cluster_cells(cells, self.parts or 2)
        axis = "xyz".index(self.plane.axis)
        middles_m = draft.origin_m[axis] + (cells[:, axis] + 0.5) * draft.voxel_m
        return (middles_m >= self.plane.at_m).astype(np.int64)


class SplitObjects(Command):
    """Split each of several objects into a number of parts by the positions of its cells.

    Each object is split as by ``split_object``. Objects with fewer cells than parts are not
    changed.
    """

    op: Literal["split_objects"] = "split_objects"
    ids: Ids
    parts: Annotated[int, Field(ge=2, le=8)] = 2

    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return the operation with the cells of each part and the objects."""
        patch, grid, objects, taken = Patch(draft), draft.grid(), [], []
        for one in objects_by_ids(draft, self.ids):
            cells = draft.cells_of(one.id)
            if len(cells) < self.parts:
                continue
            for number, group in _numbered_parts(draft, one.id, cells, self.parts, taken):
                if number != one.id:
                    patch.give(group, number)
                part = replace(one, id=number, placements=())
                objects.append(measure_object(grid, tools, part, group))
        if not objects:
            raise UsageError(f"none of these objects has at least {self.parts} cells to split")
        classes = {one.class_id for one in objects}
        details = {"class_id": classes.pop()} if len(classes) == 1 else {}
        return patch.plan_operation("split_objects", objects=objects, **details)


class MergeObjects(Command):
    """Merge objects into one with the id, class and name of the first object listed."""

    op: Literal["merge_objects"] = "merge_objects"
    ids: Annotated[tuple[Id, ...], Field(min_length=2, max_length=65535)]

    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return the operation with the cells and the merged object."""
        first, *others = objects_by_ids(draft, self.ids)
        if not others:
            raise UsageError("merging requires at least two different objects")
        patch, groups = Patch(draft), [draft.cells_of(first.id)]
        for one in others:
            cells = draft.cells_of(one.id)
            groups.append(cells)
            patch.give(cells, first.id, first.class_id if one.class_id != first.class_id else None)
        cells = np.concatenate(groups)
        if not len(cells):
            raise UsageError("none of these objects has cells; delete all but one instead")
        cells = cells[np.lexsort(cells.T[::-1])]
        merged = measure_object(draft.grid(), tools, first, cells)
        gone = [one.id for one in others]
        return patch.plan_operation(
            "merge_objects", objects=[merged], gone=gone, class_id=first.class_id
        )


class Recluster(Command):
    """Detect the objects of one or all classes again with other clustering parameters.

    An object that consists mostly of the cells of an old object keeps its id.
    """

    op: Literal["recluster"] = "recluster"
    class_id: ObjectClass | None = None
    density_kernel: Annotated[int, Field(ge=1, le=31)]
    density_threshold: Annotated[float, Field(ge=0, le=1)]
    cluster_radius: Annotated[float, Field(gt=0, le=100)]

    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return the operation with the cells of each object and the objects."""
        grid = draft.grid()
        instance, found = tools.find(grid, self.model_dump(exclude={"op", "class_id"}))
        old = [o for o in draft.objects.values() if self.class_id in (None, o.class_id)]
        free = np.isin(draft.instance, [0, *(one.id for one in old)])
        patch = Patch(draft)
        patch.give(np.argwhere(free & (draft.instance > 0)), 0)
        chosen = [one for one in found if self.class_id in (None, one.class_id)]
        groups = [np.argwhere((instance == one.id) & free).astype(np.int32) for one in chosen]
        numbers = _matched_ids(draft, {one.id for one in old}, groups)
        objects: list[SceneObject] = []
        for number, one, cells in zip(numbers, chosen, groups, strict=True):
            if len(cells):
                patch.give(cells, number)
                named = with_name_of(
                    draft.objects.get(number), replace(one, id=number, cells=cells)
                )
                objects.append(object_of(named, tools.match(grid, named)))
        gone = {one.id for one in old} - {one.id for one in objects}
        details = {"gone": gone, "class_id": self.class_id}
        return patch.plan_operation("recluster", objects=objects, **details)


def measure_object(
    grid: OccupancyGrid, tools: Tools, one: SceneObject, cells: np.ndarray
) -> SceneObject:
    """Return an object with other cells, int32 [N, 3], measured and matched with furniture.

    It keeps its id, class and name.
    """
    found = with_name_of(one, tools.measure(grid, one.id, one.class_id, cells))
    return object_of(found, tools.match(grid, found))


def cluster_cells(cells: np.ndarray, count: int) -> np.ndarray:
    """Return the cluster, int64 [N], of each cell of int [N, 3] by deterministic k-means.

    The initial centres are evenly spaced along the direction of largest variance.
    """
    points = cells.astype(np.float64)
    if len(points) < 2:
        return np.zeros(len(points), np.int64)
    spread = points - points.mean(axis=0)
    _, _, axes = np.linalg.svd(spread, full_matrices=False)
    along = axes[0] * np.where(axes[0][np.argmax(np.abs(axes[0]))] < 0, -1.0, 1.0)
    order = np.argsort(np.round(spread @ along, 9), kind="stable")
    centers = points[order[((np.arange(count) + 0.5) / count * len(points)).astype(int)]]
    found = np.full(len(points), -1)
    for _ in range(ROUNDS):
        distance = ((points[:, None] - centers[None]) ** 2).sum(axis=2)
        nearest = np.argmin(np.round(distance, 9), axis=1)
        if np.array_equal(nearest, found):
            break
        found = nearest
        for n in range(count):
            if (found == n).any():
                centers[n] = points[found == n].mean(axis=0)
    return found


def _largest_first(cells: np.ndarray, sides: np.ndarray) -> list[np.ndarray]:
    """Return the groups of cells int [N, 3] by their part, int64 [N]."""
    return sorted((cells[sides == n] for n in np.unique(sides)), key=len, reverse=True)


def _numbered_parts(
    draft: SceneDraft, first: int, cells: np.ndarray, parts: int, taken: list[int]
) -> list[tuple[int, np.ndarray]]:
    """Return the parts of an object with ids, largest first: its own id and free ids.

    ``taken`` are ids used by other new objects. The new ids are appended to it.
    """
    found = [(first, group) for group in _largest_first(cells, cluster_cells(cells, parts))]
    for at in range(1, len(found)):
        taken.append(free_object_id(draft, taken))
        found[at] = (taken[-1], found[at][1])
    return found


def _matched_ids(draft: SceneDraft, old: set[int], groups: list[np.ndarray]) -> list[int]:
    """Return the id of each group of cells: that of the most similar old object, or a new id."""
    numbers: list[int] = []
    taken: set[int] = set()
    for cells in groups:
        ids, counts = np.unique(draft.instance[tuple(cells.T)], return_counts=True)
        ranked = ids[np.argsort(-counts, kind="stable")].tolist()
        number = next((n for n in ranked if n in old and n not in taken), 0)
        taken.add(number or free_object_id(draft, taken))
        numbers.append(number or max(taken))
    return numbers
