"""Connected cells of objects, and conversion between scene objects and stage results."""

from collections.abc import Iterable, Sequence

import numpy as np

from world2minecraft.core.types import ObjectInstance, Placement, SceneObject
from world2minecraft.geometry.connected_components import label_components

Box = tuple[slice, slice, slice]


def box_of(cells: np.ndarray, shape: tuple[int, ...], margin: int = 0) -> tuple[np.ndarray, Box]:
    """Return the minimum corner int [3] and the slices of a box around cells int [N, 3].

    The box is enlarged by ``margin`` cells and clipped to the grid.
    """
    low = np.maximum(cells.min(axis=0) - margin, 0)
    high = np.minimum(cells.max(axis=0) + margin + 1, shape)
    x, y, z = (slice(int(a), int(b)) for a, b in zip(low, high, strict=True))
    return low, (x, y, z)


def connected_parts(cells: np.ndarray) -> list[np.ndarray]:
    """Return the parts of cells int [N, 3] connected by faces, as row indices int [M] each.

    The parts are ordered by their first cells.
    """
    if not len(cells):
        return []
    low, high = cells.min(axis=0), cells.max(axis=0)
    mask = np.zeros(tuple(high - low + 1), bool)
    at = tuple((cells - low).T)
    mask[at] = True
    numbers = label_components(mask, corners=False)[0][at]
    order = np.argsort(numbers, kind="stable")
    breaks = np.flatnonzero(np.diff(numbers[order])) + 1
    return np.split(order, breaks)


def connected_component(labels: np.ndarray, seed: tuple[int, int, int]) -> np.ndarray:
    """Return the cells int32 [N, 3], in C order, connected by faces with equal labels to a cell.

    ``labels`` is uint8 [X, Y, Z]. The web page implements the same rule.
    """
    numbers = label_components(labels == labels[seed], corners=False)[0]
    return np.argwhere(numbers == numbers[seed]).astype(np.int32)


def shift_cells(cells: np.ndarray, axis: int, step: int) -> np.ndarray:
    """Return cells int [N, 3] moved along one axis, possibly outside the grid."""
    moved = cells.copy()
    moved[:, axis] += step
    return moved


def objects_of(
    instances: Sequence[ObjectInstance], placements: Sequence[Placement] = ()
) -> tuple[SceneObject, ...]:
    """Return scene objects from instances and their placements."""
    placed: dict[int, list[Placement]] = {}
    for one in placements:
        placed.setdefault(one.object_id, []).append(one)
    return tuple(object_of(one, placed.get(one.id, ())) for one in instances)


def object_of(instance: ObjectInstance, placements: Iterable[Placement] = ()) -> SceneObject:
    """Return a scene object from an instance and its placements."""
    fields = (instance.center_m, instance.size_m, instance.yaw_deg, instance.confidence)
    named = (instance.name, instance.name_confidence)
    return SceneObject(instance.id, instance.class_id, *fields, tuple(placements), *named)


def instance_of(one: SceneObject, cells: np.ndarray) -> ObjectInstance:
    """Return an object as an ``ObjectInstance`` with its cells int32 [N, 3]."""
    box = (one.center_m, one.size_m, one.yaw_deg)
    named = (one.name, one.name_confidence)
    return ObjectInstance(one.id, one.class_id, *box, cells, one.confidence, *named)


def instances_of(
    objects: Iterable[SceneObject], instance: np.ndarray
) -> tuple[ObjectInstance, ...]:
    """Return objects as ``ObjectInstance`` values ordered by id.

    ``instance`` contains the object id of each cell, uint16 [X, Y, Z].
    """
    at = np.argwhere(instance > 0).astype(np.int32)
    owners = instance[tuple(at.T)]
    ordered = sorted(objects, key=lambda one: one.id)
    return tuple(instance_of(one, at[owners == one.id]) for one in ordered)


def placements_of(objects: Iterable[SceneObject]) -> tuple[Placement, ...]:
    """Return the placements of all objects, ordered by object id."""
    return tuple(p for one in sorted(objects, key=lambda one: one.id) for p in one.placements)


def same_object(one: SceneObject, other: SceneObject) -> bool:
    """Return whether two objects have equal class, box, name, confidence and placements."""
    return object_key(one) == object_key(other)


def object_key(one: SceneObject) -> tuple:
    """Return all properties of an object as comparable and hashable values."""
    box = (*map(float, one.center_m), *map(float, one.size_m), float(one.yaw_deg))
    placed = tuple(
        (
            p.template,
            *map(float, p.center_m),
            *map(float, p.size_m),
            p.quarter_turns,
            p.iou,
            tuple(p.parameters.items()),
            tuple((a.template, a.quarter_turns, a.iou) for a in p.alternatives),
        )
        for p in one.placements
    )
    named = (one.name, one.name_confidence)
    return (one.id, one.class_id, box, one.confidence, placed, named)
