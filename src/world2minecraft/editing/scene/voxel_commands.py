"""Commands for cells selected by a person or by class: paint, erase, fill, paste, relabel.

A painted cell has full confidence and counts as observed. Occupied cells keep their colour. Other
cells take the colour of the nearest cell of their class within half a metre, or black.

Cells of an object class belong to an object of that class: each connected part of the painted cells
joins the object with which it shares most faces (the lowest id if tied), or no object if it touches
none. Structure cells and erased cells belong to no object. An object that loses its last cell is
removed with its furniture. An object that loses or gains cells keeps its box and furniture.
"""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field, model_validator
from scipy.spatial import KDTree

from world2minecraft.core.classes import OBJECT_CLASSES, UNKNOWN, display_name
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import OBSERVED, GridCells, Operation, SceneObject
from world2minecraft.editing.scene.cell_patch import box_cells, cells_of_runs
from world2minecraft.editing.scene.command import MAX_RUNS, Command, Tools
from world2minecraft.editing.scene.object_conversion import (
    box_of,
    connected_component,
    connected_parts,
    instance_of,
    shift_cells,
)
from world2minecraft.editing.scene.object_naming import with_class
from world2minecraft.editing.scene.scene_draft import SceneDraft

MAX_IDS = 1 << 16
FEW = 16
COLOUR_REACH_M = 0.5  # Paint and wood change from one end of a room to the other.
Run = tuple[Annotated[int, Field(ge=0)], Annotated[int, Field(ge=1)]]
Runs = Annotated[list[Run], Field(max_length=MAX_RUNS)]
ClassId = Annotated[int, Field(ge=0, le=11)]
EMPTY = 0
Cell = tuple[int, int, int]
OccupiedId = Annotated[int, Field(ge=1, le=11)]


def plan_cells(
    draft: SceneDraft,
    verb: str,
    cells: np.ndarray,
    classes: np.ndarray | int,
    owners: np.ndarray | int | None = None,
    *,
    colours: np.ndarray | None = None,
    gone: Iterable[int] = (),
    objects: Iterable[SceneObject] = (),
    **details: Any,
) -> Operation:
    """Return the operation that sets the classes of cells and removes objects without cells.

    Args:
        draft: Scene to edit.
        verb: Kind of the operation.
        cells: Cell indices, int [N, 3], without duplicates.
        classes: Class ids 0 to 11, one per cell or one for all cells.
        owners: Object ids (0 for none), one per cell or one for all cells. None applies the rule in
            the module docstring.
        colours: Colours, uint8 [N, 3]. None applies the rule in the module docstring.
        gone: Objects to remove in addition to those that lose their last cell.
        objects: New objects, or replacements of objects with the same ids.
        details: ``counts_as`` and ``class_id`` of the operation. Derived from the cells by default.
    """
    labels = np.broadcast_to(np.asarray(classes, np.uint8), len(cells))
    if owners is None:
        owners = adjacent_owners(draft, cells, labels)
    instance = np.where(np.isin(labels, OBJECT_CLASSES), owners, 0).astype(np.uint16)
    after = GridCells(
        labels,
        np.ones(len(cells), np.float16),
        infer_colours(draft, cells, labels) if colours is None else colours,
        np.full(len(cells), OBSERVED, np.uint8),
        instance,
    )
    details = {
        "counts_as": edit_category(draft, cells, labels),
        "class_id": single_class(labels),
    } | details
    gone = {*gone, *emptied_objects(draft, cells, instance)}
    return draft.plan_operation(verb, cells, after, gone=gone, objects=objects, **details)


def edit_category(draft: SceneDraft, cells: np.ndarray, labels: np.ndarray) -> str:
    """Return the category of a change in the paper's table, by what happens to most cells."""
    was = draft.labels[tuple(cells.T)] % UNKNOWN > 0
    erased, kept = labels == 0, (labels > 0) & was
    if 2 * erased.sum() > len(cells):
        return "delete"
    return "relabel" if 2 * kept.sum() > len(cells) else "add"


def single_class(labels: np.ndarray) -> int | None:
    """Return the class of all cells, or None if their classes differ."""
    return int(labels[0]) if len(labels) and (labels == labels[0]).all() else None


def emptied_objects(draft: SceneDraft, cells: np.ndarray, instance: np.ndarray) -> list[int]:
    """Return the ids of objects that lose all their cells if cells int [N, 3] change objects."""
    held = draft.instance[tuple(cells.T)]
    lost = np.unique(held[(held > 0) & (held != instance)])
    if not len(lost):
        return []
    total = count_object_cells(draft, lost)
    total -= np.bincount(held, minlength=MAX_IDS)
    total += np.bincount(instance, minlength=MAX_IDS)
    return [int(one) for one in lost if total[one] == 0 and int(one) in draft.objects]


def count_object_cells(draft: SceneDraft, numbers: np.ndarray) -> np.ndarray:
    """Return the cell counts of some objects as int64 [65536] by id. Other entries can be 0."""
    if len(numbers) > FEW:
        return np.bincount(draft.instance.ravel(), minlength=MAX_IDS)
    total = np.zeros(MAX_IDS, np.int64)
    for number in numbers:  # Counting all takes eight times the memory of the grid.
        total[number] = np.count_nonzero(draft.instance == number)
    return total


def adjacent_owners(draft: SceneDraft, cells: np.ndarray, labels: np.ndarray) -> np.ndarray:
    """Return the object id, uint16 [N], that each painted cell joins."""
    owners = np.zeros(len(cells), np.uint16)
    for class_id in np.intersect1d(np.unique(labels), OBJECT_CLASSES):
        chosen = np.flatnonzero(labels == class_id)
        for members in connected_parts(cells[chosen]):
            owners[chosen[members]] = _touching(draft, cells[chosen[members]], int(class_id))
    return owners


def _touching(draft: SceneDraft, cells: np.ndarray, class_id: int) -> int:
    """Return the object of a class that shares most faces with cells int [N, 3], or 0."""
    found: list[np.ndarray] = []
    for beside in _beside(draft, cells):
        ids = draft.instance[tuple(beside.T)]
        found.append(ids[(ids > 0) & (draft.labels[tuple(beside.T)] == class_id)])
    faces = np.bincount(np.concatenate(found), minlength=1)
    faces[
        [
            number
            for number in np.flatnonzero(faces).tolist()
            if not _has_class(draft, number, class_id)
        ]
    ] = 0
    return int(faces.argmax()) if faces.any() else 0


def _has_class(draft: SceneDraft, number: int, class_id: int) -> bool:
    return number in draft.objects and draft.objects[number].class_id == class_id


def _beside(draft: SceneDraft, cells: np.ndarray) -> Iterator[np.ndarray]:
    """Yield the neighbours int [M, 3] of cells across each of the six faces, inside the grid."""
    for axis in range(3):
        for step in (-1, 1):
            beside = shift_cells(cells, axis, step)
            yield beside[(beside[:, axis] >= 0) & (beside[:, axis] < draft.shape[axis])]


def infer_colours(draft: SceneDraft, cells: np.ndarray, labels: np.ndarray) -> np.ndarray:
    """Return the colours, uint8 [N, 3], of painted cells."""
    at = tuple(cells.T)
    was = draft.labels[at] % UNKNOWN > 0
    colours = np.where((was & (labels > 0))[:, None], draft.colour[at], 0).astype(np.uint8)
    for class_id in np.unique(labels[~was & (labels > 0)]):
        new = np.flatnonzero(~was & (labels == class_id))
        colours[new] = _nearest_colours(draft, cells[new], int(class_id))
    return colours


def _nearest_colours(draft: SceneDraft, cells: np.ndarray, class_id: int) -> np.ndarray:
    reach = max(round(COLOUR_REACH_M / draft.voxel_m), 1)
    low, box = box_of(cells, draft.shape, reach)
    known = (draft.labels[box] == class_id) & draft.colour[box].any(axis=-1)
    sources = np.argwhere(known) + low
    if not len(sources):
        return np.zeros((len(cells), 3), np.uint8)
    _, nearest = KDTree(sources).query(cells, distance_upper_bound=reach + 1e-6)
    found = np.asarray(nearest < len(sources))  # Where nothing is near, it is one past the last.
    at = tuple(sources[np.where(found, nearest, 0)].T)
    return np.where(found[:, None], draft.colour[at], 0).astype(np.uint8)


class CellCommand(Command):
    """Base class of commands for cells. Cells of ``locked`` classes are not changed."""

    locked: tuple[ClassId, ...] = ()

    def free(self, draft: SceneDraft, cells: np.ndarray) -> np.ndarray:
        """Return a mask of the cells int [N, 3] whose classes are not locked, bool [N]."""
        return ~np.isin(draft.labels[tuple(cells.T)], self.locked)


class SetCells(CellCommand):
    """Set the class of cells. Class 0 erases them.

    The cells are assigned to the object ``instance``, or to no object if it is 0. If it is not
    given, they join the object of their class that they touch.
    """

    op: Literal["set_cells"] = "set_cells"
    cells: Runs
    class_id: ClassId
    instance: Annotated[int, Field(ge=0, le=65535)] | None = None
    verb: Literal["paint", "erase", "relabel", "fill", "delete"] = "paint"

    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return the operation with the changed cells."""
        check_owner(draft, self.instance, self.class_id)
        cells = cells_of_runs(self.cells, draft.shape)
        changes = draft.labels[tuple(cells.T)] != self.class_id
        if self.instance is not None and self.class_id in OBJECT_CLASSES:
            changes |= draft.instance[tuple(cells.T)] != self.instance
        cells = cells[changes & self.free(draft, cells)]
        if not len(cells):
            raise UsageError("nothing to change: all cells already have this class or are locked")
        return plan_cells(draft, self.verb, cells, self.class_id, self.instance)


class FillBox(CellCommand):
    """Set the class of all cells in a box with inclusive corners. Class 0 erases them."""

    op: Literal["fill_box"] = "fill_box"
    low: Cell
    high: Cell
    class_id: ClassId

    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return the operation with the changed cells of the box."""
        cells = box_cells(self.low, self.high, draft.shape)
        cells = cells[(draft.labels[tuple(cells.T)] != self.class_id) & self.free(draft, cells)]
        if not len(cells):
            raise UsageError(
                "nothing to change: all cells in the box already have this class or are locked"
            )
        return plan_cells(draft, "fill" if self.class_id else "erase", cells, self.class_id)


class DeleteComponent(CellCommand):
    """Erase a cell and all cells of its class that are connected to it by faces."""

    op: Literal["delete_component"] = "delete_component"
    cell: Cell

    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return the operation with the erased cells."""
        check_cell(draft, self.cell)
        held = int(draft.labels[self.cell])
        if held in (EMPTY, UNKNOWN):
            raise UsageError(f"cell {list(self.cell)} is empty; choose an occupied cell")
        if held in self.locked:
            raise UsageError(f"{display_name(held)} is locked; unlock it in the class legend first")
        cells = connected_component(draft.labels, self.cell)
        return plan_cells(draft, "delete", cells, 0, class_id=held)


class Paste(CellCommand):
    """Copy cells to a position ``by`` cells away, mirrored first if ``mirror`` names an axis.

    The mirror plane is at the centre of the cells' bounding box. Only occupied cells are copied,
    with their colours. Copies outside the grid are dropped. Like a painted cell, a copied cell
    joins the object of its class that it touches. Use ``duplicate_object`` to create a second
    object.
    """

    op: Literal["paste"] = "paste"
    cells: Runs
    by: Cell
    mirror: Literal["x", "y", "z"] | None = None

    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return the operation with the pasted cells."""
        sources = cells_of_runs(self.cells, draft.shape)
        sources = sources[draft.labels[tuple(sources.T)] % 255 > 0]
        if not len(sources):
            raise UsageError("nothing to paste: all of these cells are empty")
        targets = self._target_cells(sources)
        inside = ((targets >= 0) & (targets < draft.shape)).all(axis=1)
        sources, targets = sources[inside], targets[inside]
        changes = draft.labels[tuple(sources.T)] != draft.labels[tuple(targets.T)]
        changes &= self.free(draft, targets)
        sources, targets = sources[changes], targets[changes]
        if not len(targets):
            raise UsageError(
                "nothing to change: the copy is outside the grid or identical to the existing cells"
            )
        labels = draft.labels[tuple(sources.T)]
        colours = draft.colour[tuple(sources.T)]
        return plan_cells(draft, "paste", targets, labels, colours=colours)

    def _target_cells(self, cells: np.ndarray) -> np.ndarray:
        moved = cells.astype(np.int64)
        if self.mirror is not None:
            axis = "xyz".index(self.mirror)
            moved[:, axis] = moved[:, axis].min() + moved[:, axis].max() - moved[:, axis]
        limit = np.iinfo(np.int32).max
        return moved + np.clip(np.array(self.by, object), -limit, limit).astype(np.int64)


def check_owner(draft: SceneDraft, number: int | None, class_id: int) -> None:
    """Check that cells of a class can belong to an object.

    Raises:
        UsageError: If the object does not exist or has another class.
    """
    if not number:
        return
    if number not in draft.objects:
        raise UsageError(f"object {number} not found; omit instance to join the adjacent object")
    held = draft.objects[number].class_id
    if held != class_id:
        names = f"{display_name(held)}, not {display_name(class_id)}"
        raise UsageError(f"object {number} has class {names}; relabel it first, or use its class")


def check_cell(draft: SceneDraft, cell: tuple[int, int, int]) -> None:
    """Check that a cell is inside the grid.

    Raises:
        UsageError: If the cell is outside the grid.
    """
    if not all(0 <= at < side for at, side in zip(cell, draft.shape, strict=True)):
        raise UsageError(f"cell {list(cell)} is outside the grid of {list(draft.shape)} cells")


class RelabelClass(CellCommand):
    """Change the class of all cells and objects of one class.

    Objects take the new class, and furniture of that class is matched. If the new class is
    structure, the objects are removed.
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
        """Return the operation with all cells of the class and its relabelled objects."""
        check_class(draft, self.from_id, self.locked)
        cells = np.argwhere(draft.labels == self.from_id)
        owners = draft.instance[tuple(cells.T)]
        if self.to_id not in OBJECT_CLASSES:
            gone = objects_without_cells(draft, self.from_id)
            return plan_cells(draft, "relabel", cells, self.to_id, owners, gone=gone)
        changed = self._objects(draft, tools)
        fields = {"counts_as": "relabel", "objects": changed}
        return plan_cells(draft, "relabel", cells, self.to_id, owners, **fields)

    def _objects(self, draft: SceneDraft, tools: Tools) -> list[SceneObject]:
        """Return the objects of the class after relabelling."""
        grid = draft.grid()
        grid = replace(grid, labels=np.where(grid.labels == self.from_id, self.to_id, grid.labels))
        found = []
        for one in draft.objects.values():
            if one.class_id == self.from_id:
                bare = replace(with_class(one, self.to_id), confidence=one.confidence)
                cells = draft.cells_of(one.id)
                furniture = tools.match(grid, instance_of(bare, cells)) if len(cells) else ()
                found.append(replace(bare, placements=furniture))
        return found


class DeleteClass(CellCommand):
    """Erase all cells and delete all objects of a class."""

    op: Literal["delete_class"] = "delete_class"
    class_id: OccupiedId

    def plan(self, draft: SceneDraft, tools: Tools) -> Operation:
        """Return the operation with all erased cells and deleted objects of the class."""
        check_class(draft, self.class_id, self.locked)
        cells = np.argwhere(draft.labels == self.class_id)
        gone = objects_without_cells(draft, self.class_id)
        details = {"counts_as": "delete", "class_id": self.class_id}
        return plan_cells(draft, "delete", cells, 0, gone=gone, **details)


def check_class(draft: SceneDraft, class_id: int, locked: tuple[int, ...]) -> None:
    """Check that a class can be changed.

    Raises:
        UsageError: If the class is locked, or if the scene has no cells or objects of it.
    """
    name = display_name(class_id)
    if class_id in locked:
        raise UsageError(f"{name} is locked; unlock it in the class legend first")
    if not draft.counts[class_id] and not objects_without_cells(draft, class_id):
        raise UsageError(f"the scene has no cells or objects of class {name}")


def objects_without_cells(draft: SceneDraft, class_id: int) -> list[int]:
    """Return the ids of the objects of a class that have no cells."""
    held = np.bincount(draft.instance.ravel(), minlength=65536)
    ordered = sorted(draft.objects.values(), key=lambda one: one.id)
    return [one.id for one in ordered if one.class_id == class_id and held[one.id] == 0]
