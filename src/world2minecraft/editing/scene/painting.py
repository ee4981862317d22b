"""What cells become when they are painted, erased or filled, and whose they are then.

A painted cell is sure and observed. Its colour stays where it was occupied; where it was not, it
takes the colour of the nearest cell of its class within half a metre, or none (black).

Cells of an object class belong to an object of that class: each connected part of the painted
cells to the one that it shares most faces with, the lowest id of a tie; to none where it touches
none. Cells of structure and erased cells belong to none. An object that loses its last cell goes,
with its furniture; one that loses or gains some keeps its box and its furniture as they are.
"""

from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
from scipy.spatial import KDTree

from world2minecraft.core.classes import OBJECT_CLASSES, UNKNOWN
from world2minecraft.core.types import OBSERVED, GridCells, Operation, SceneObject
from world2minecraft.editing.scene.draft import SceneDraft
from world2minecraft.editing.scene.parts import box_of, parts_of_cells, shifted

MAX_IDS = 1 << 16
FEW = 16
COLOUR_REACH_M = 0.5  # Paint and wood change from one end of a room to the other.


def planned_cells(
    draft: SceneDraft,
    verb: str,
    cells: np.ndarray,
    classes: np.ndarray | int,
    owners: np.ndarray | int | None = None,
    *,
    colours: np.ndarray | None = None,
    gone: Iterable[int] = (),
    objects: Iterable[SceneObject] = (),
    **told: Any,
) -> Operation:
    """Return the operation that gives cells their classes, and removes objects left without any.

    Args:
        draft: the scene.
        verb: the kind of the operation.
        cells: int [N, 3], each once.
        classes: ids 0 to 11, one for each cell or for all.
        owners: ids of objects, 0 for none, likewise; None finds them by the rule above.
        colours: uint8 [N, 3]; None finds them by the rule above.
        gone: objects that are removed beside those that lose their last cell.
        objects: those that are new, or take the place of the ones with their ids.
        told: ``counts_as`` and ``class_id`` of the operation; found from the cells by default.
    """
    labels = np.broadcast_to(np.asarray(classes, np.uint8), len(cells))
    if owners is None:
        owners = adjacent_owners(draft, cells, labels)
    instance = np.where(np.isin(labels, OBJECT_CLASSES), owners, 0).astype(np.uint16)
    after = GridCells(
        labels,
        np.ones(len(cells), np.float16),
        colours_of(draft, cells, labels) if colours is None else colours,
        np.full(len(cells), OBSERVED, np.uint8),
        instance,
    )
    told = {"counts_as": counted_as(draft, cells, labels), "class_id": one_class(labels)} | told
    gone = {*gone, *emptied(draft, cells, instance)}
    return draft.planned(verb, cells, after, gone=gone, objects=objects, **told)


def counted_as(draft: SceneDraft, cells: np.ndarray, labels: np.ndarray) -> str:
    """Return what the paper's table counts a change as: what most of its cells undergo."""
    was = draft.labels[tuple(cells.T)] % UNKNOWN > 0
    erased, kept = labels == 0, (labels > 0) & was
    if 2 * erased.sum() > len(cells):
        return "delete"
    return "relabel" if 2 * kept.sum() > len(cells) else "add"


def one_class(labels: np.ndarray) -> int | None:
    """Return the class of all cells, None where they differ."""
    return int(labels[0]) if len(labels) and (labels == labels[0]).all() else None


def emptied(draft: SceneDraft, cells: np.ndarray, instance: np.ndarray) -> list[int]:
    """Return the objects, by id, that have no cell left when cells int [N, 3] change hands."""
    held = draft.instance[tuple(cells.T)]
    lost = np.unique(held[(held > 0) & (held != instance)])
    if not len(lost):
        return []
    total = cells_held(draft, lost)
    total -= np.bincount(held, minlength=MAX_IDS)
    total += np.bincount(instance, minlength=MAX_IDS)
    return [int(one) for one in lost if total[one] == 0 and int(one) in draft.objects]


def cells_held(draft: SceneDraft, numbers: np.ndarray) -> np.ndarray:
    """Return how many cells some objects have, int64 [65536], by id; of others it may be 0."""
    if len(numbers) > FEW:
        return np.bincount(draft.instance.ravel(), minlength=MAX_IDS)
    total = np.zeros(MAX_IDS, np.int64)
    for number in numbers:  # Counting all takes eight times the memory of the grid.
        total[number] = np.count_nonzero(draft.instance == number)
    return total


def adjacent_owners(draft: SceneDraft, cells: np.ndarray, labels: np.ndarray) -> np.ndarray:
    """Return the object, uint16 [N], that each painted cell belongs to by the rule above."""
    owners = np.zeros(len(cells), np.uint16)
    for class_id in np.intersect1d(np.unique(labels), OBJECT_CLASSES):
        chosen = np.flatnonzero(labels == class_id)
        for members in parts_of_cells(cells[chosen]):
            owners[chosen[members]] = _touching(draft, cells[chosen[members]], int(class_id))
    return owners


def _touching(draft: SceneDraft, cells: np.ndarray, class_id: int) -> int:
    """Return the object of a class that shares most faces with cells int [N, 3], 0 for none."""
    found: list[np.ndarray] = []
    for beside in _beside(draft, cells):
        ids = draft.instance[tuple(beside.T)]
        found.append(ids[(ids > 0) & (draft.labels[tuple(beside.T)] == class_id)])
    faces = np.bincount(np.concatenate(found), minlength=1)
    faces[
        [number for number in np.flatnonzero(faces).tolist() if not _is(draft, number, class_id)]
    ] = 0
    return int(faces.argmax()) if faces.any() else 0


def _is(draft: SceneDraft, number: int, class_id: int) -> bool:
    return number in draft.objects and draft.objects[number].class_id == class_id


def _beside(draft: SceneDraft, cells: np.ndarray) -> Iterator[np.ndarray]:
    """Yield the neighbours int [M, 3] of cells over each of the six faces, inside the grid."""
    for axis in range(3):
        for step in (-1, 1):
            beside = shifted(cells, axis, step)
            yield beside[(beside[:, axis] >= 0) & (beside[:, axis] < draft.shape[axis])]


def colours_of(draft: SceneDraft, cells: np.ndarray, labels: np.ndarray) -> np.ndarray:
    """Return the colour, uint8 [N, 3], that painted cells have by the rule above."""
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
