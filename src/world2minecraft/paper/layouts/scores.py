"""Scores of layouts for objects outside rooms, collisions and missing categories.

An object is **out of bounds** if more than 1 % of its footprint is more than 10 cm outside the
floor, or its top is more than 10 cm above the ceiling. Two objects **collide** if they share more
than 1 % of the smaller one's volume and would have to be moved by more than 2 cm to separate them.
Objects that rest on others, and objects thinner than 5 cm such as rugs, do not collide. The boxes
are scored before conversion to cells, because cells of two objects can never overlap.

Two scores follow other publications for comparison: ``reaching`` is the rule of LayoutGPT's script
(a corner of the rotated box more than 10 cm outside the room's bounding box), and ``overlapping``
counts pairs with any common volume.

Solid collisions use furniture designs instead of boxes, so a chair pushed under a table does not
collide. An object of a layout has the solid parts of its design (``furniture_lookup``), rotated as
in the layout. An object without a design is completely solid. Layouts of other methods are thus
subject to the same 4 cm tolerance as our own furniture.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from typing import Any

import numpy as np

from world2minecraft.core.classes import OBJECT_CLASSES, SemanticClass
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import OWN_CELLS, Layout, LayoutObject
from world2minecraft.furniture import template
from world2minecraft.furniture.footprints import outside_share, shared_height_m, shared_volume_m3
from world2minecraft.furniture.layout_checks import (
    OVERLAP_M,
    inside_polygon,
    overlap_depth_m,
    overlapping_boxes,
    plan_corners_m,
)
from world2minecraft.navigation.scores import rate
from world2minecraft.paper.layouts.compared_scene import ComparedScene
from world2minecraft.paper.layouts.furniture_lookup import design_of

ANY_M3 = 1e-9  # Less is rounding: boxes that touch.


def solid_collisions(scene: ComparedScene) -> int:
    """Return the number of object pairs whose solid parts overlap, as recorded for a run."""
    if scene.collided is not None:
        return scene.collided
    boxes = [item for item in scene.objects if isinstance(item, LayoutObject)]
    parts: dict[int, list[LayoutObject]] = {}
    met = 0
    for m, n in overlapping_boxes(boxes):
        for index in (m, n):
            if index not in parts:
                parts[index] = solid_parts(boxes[index])
        met += _meet(_near(parts[m], boxes[n]), _near(parts[n], boxes[m]))
    return met


def solid_parts(item: LayoutObject) -> list[LayoutObject]:
    """Return the solid boxes of an object, or its own box if it has no design."""
    name = design_of(item).template
    if name == OWN_CELLS:
        return [item]
    angle = np.radians(item.yaw_deg)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    foot = item.center_m - [0, 0, item.size_m[2] / 2]
    parts = []
    for part in template(name).parts(item.size_m, {}):
        low, high = np.asarray(part.box_m, np.float64).reshape(2, 3)
        if (high > low).all():
            middle = (low + high) / 2
            center = foot + np.array([*(turn @ middle[:2]), middle[2]])
            parts.append(replace(item, center_m=center, size_m=high - low))
    return parts or [item]


def _near(parts: list[LayoutObject], box: LayoutObject) -> list[LayoutObject]:
    return [part for part in parts if overlap_depth_m(part, box) > OVERLAP_M]


def _meet(one: list[LayoutObject], other: list[LayoutObject]) -> bool:
    return any(overlap_depth_m(a, b) > OVERLAP_M for a in one for b in other)


@dataclass(frozen=True)
class Margins:
    """The tolerances of the scores, which the module's docstring explains.

    Attributes:
        outside_m: The distance outside the floor that is tolerated, in metres.
        outside_share: The share of the footprint outside that is tolerated.
        above_m: The height above the ceiling that is tolerated, in metres.
        shared: The share of the smaller volume that may be shared.
        depth_m: The overlap depth that is tolerated, in metres.
        thin_m: The height below which objects do not collide, in metres.
        resting_m: The shared height below which one object rests on another, in metres.
    """

    outside_m: float = 0.1
    outside_share: float = 0.01
    above_m: float = 0.1
    shared: float = 0.01
    depth_m: float = 0.02
    thin_m: float = 0.05
    resting_m: float = 0.05

    def __post_init__(self):
        if not all(np.isfinite(value) and value >= 0 for value in vars(self).values()):
            raise UsageError(f"tolerances must be 0 or more, got {vars(self)}")


USUAL = Margins()


@dataclass(frozen=True)
class SceneScores:
    """The scores of one scene as object indices and sorted pairs of indices.

    Attributes:
        name: The name of the scene.
        objects: The number of objects.
        unplaced: The number of objects that the method did not place.
        outside: The objects out of bounds.
        reaching: The objects out of bounds by LayoutGPT's rule.
        colliding: The pairs that collide.
        overlapping: The pairs with any common volume.
        categories: The classes of the objects.
        structure: The classes of the building structure.
        collided: The number of pairs whose solid parts overlap.
    """

    name: str
    objects: int
    unplaced: int
    outside: tuple[int, ...]
    reaching: tuple[int, ...]
    colliding: tuple[tuple[int, int], ...]
    overlapping: tuple[tuple[int, int], ...]
    categories: frozenset[int]
    structure: frozenset[int]
    collided: int


def score_scene(scene: ComparedScene, margins: Margins = USUAL) -> SceneScores:
    """Compute the scores of a scene."""
    pairs = [
        (m, n)
        for (m, a), (n, b) in combinations(enumerate(scene.objects), 2)
        if not _one_thing(a, b) and overlap_depth_m(a, b) > 0 and shared_volume_m3(a, b) > ANY_M3
    ]
    colliding = [(m, n) for m, n in pairs if _collide(scene.objects[m], scene.objects[n], margins)]
    return SceneScores(
        name=scene.name,
        objects=len(scene.objects),
        unplaced=len(scene.unplaced),
        outside=_in_no_room(scene, lambda item, room: _is_outside(item, room, scene, margins)),
        reaching=_in_no_room(scene, lambda item, room: _reaches_out(item, room, margins)),
        colliding=tuple(colliding),
        overlapping=tuple(pairs),
        categories=frozenset(int(item.class_id) for item in scene.objects) & set(OBJECT_CLASSES),
        structure=structure_of(scene.rooms),
        collided=solid_collisions(scene),
    )


def structure_of(rooms: Sequence[Layout]) -> frozenset[int]:
    """Return the structural classes of rooms, with windows only if there is one."""
    windows = any(one.kind == "window" for room in rooms for one in room.openings)
    shell = {SemanticClass.FLOOR, SemanticClass.WALL, SemanticClass.CEILING}
    return frozenset(int(one) for one in shell | ({SemanticClass.WINDOW} if windows else set()))


def integrity(built: frozenset[int], true: frozenset[int]) -> tuple[float, float]:
    """Return the recall and the precision of categories.

    Example:
        >>> integrity(frozenset({5, 8, 9}), frozenset({5, 6, 8, 10}))
        (0.5, 0.6666666666666666)
    """
    both = len(built & true)
    return both / len(true) if true else 1.0, both / len(built) if built else 1.0


def summary_of(
    scores: Sequence[SceneScores], true: Sequence[SceneScores | None] = ()
) -> dict[str, Any]:
    """Summarise the scores of scenes as JSON data.

    Args:
        scores: The scores of the scenes.
        true: The scores of each scene's ground truth, or None if unknown. Empty if none is known.

    Returns:
        Rates from 0 to 1 and counts per scene. Rates are over all objects, and shares of scenes
        have ``scenes`` in their names. ``interval`` is the 95 percent Wilson interval.

    Raises:
        UsageError: If there are no scenes.
    """
    if not scores:
        raise UsageError("no scenes to score")
    objects = sum(one.objects for one in scores)
    outside = sum(len(one.outside) for one in scores)
    counts = {
        "collisions": [len(one.colliding) for one in scores],
        "overlaps": [len(one.overlapping) for one in scores],
        "solid_collisions": [one.collided for one in scores],
    }
    return {
        "scenes": len(scores),
        "objects": objects,
        "unplaced": sum(one.unplaced for one in scores),
        "out_of_bounds": _share(outside, objects),
        "out_of_bounds_interval": _interval(outside, objects),
        "scenes_out_of_bounds": _share(sum(bool(one.outside) for one in scores), len(scores)),
        "reaching_out": _share(sum(len(one.reaching) for one in scores), objects),
        "scenes_reaching_out": _share(sum(bool(one.reaching) for one in scores), len(scores)),
        **{name: round(float(np.mean(each)), 4) for name, each in counts.items()},
        "scenes_with_collisions": _share(sum(map(bool, counts["collisions"])), len(scores)),
        **_integrity_of(scores, true),
    }


def _integrity_of(
    scores: Sequence[SceneScores], true: Sequence[SceneScores | None]
) -> dict[str, float | None]:
    """Return the mean integrity over scenes with a known ground truth, or None."""
    known = [(one, of) for one, of in zip(scores, true, strict=bool(true)) if of is not None]
    plain = [integrity(one.categories, of.categories) for one, of in known]
    shell = [
        integrity(one.categories | one.structure, of.categories | of.structure) for one, of in known
    ]

    def mean(pairs: list[tuple[float, float]], which: int) -> float | None:
        return round(float(np.mean([pair[which] for pair in pairs])), 4) if pairs else None

    return {
        "semantic_integrity": mean(plain, 0),
        "semantic_precision": mean(plain, 1),
        "semantic_integrity_with_structure": mean(shell, 0),
    }


def _in_no_room(scene: ComparedScene, is_outside: Any) -> tuple[int, ...]:
    """Return the indices of the objects that are outside every room."""
    return tuple(
        index
        for index, item in enumerate(scene.objects)
        if all(is_outside(item, room) for room in scene.rooms)
    )


def _is_outside(item: Any, room: Layout, scene: ComparedScene, margins: Margins) -> bool:
    top_m = float(item.center_m[2] + item.size_m[2] / 2) - room.floor_z_m
    if scene.is_height_stated and top_m > room.wall_height_m + margins.above_m:
        return True
    corners, polygon = plan_corners_m(item), room.floor_polygon_m
    if _is_convex(polygon) and inside_polygon(corners, polygon, margins.outside_m).all():
        return False  # All between them is within, too.
    return outside_share(item, polygon, margins.outside_m) > margins.outside_share


def _reaches_out(item: Any, room: Layout, margins: Margins) -> bool:
    corners, polygon = plan_corners_m(item), room.floor_polygon_m
    low, high = polygon.min(axis=0) - margins.outside_m, polygon.max(axis=0) + margins.outside_m
    return bool((corners < low).any() or (corners > high).any())


def _is_convex(polygon: np.ndarray) -> bool:
    side = np.roll(polygon, -1, axis=0) - polygon
    after = np.roll(side, -1, axis=0)
    turns = side[:, 0] * after[:, 1] - side[:, 1] * after[:, 0]
    return bool((turns >= 0).all() or (turns <= 0).all())


def _one_thing(a: Any, b: Any) -> bool:
    """Return whether two placements belong to one object, such as the two parts of an L shape."""
    owner = getattr(a, "object_id", None)
    return owner is not None and owner == getattr(b, "object_id", None)


def _collide(a: Any, b: Any, margins: Margins) -> bool:
    """Return whether two overlapping boxes collide."""
    if min(a.size_m[2], b.size_m[2]) < margins.thin_m:
        return False
    if shared_height_m(a, b) <= margins.resting_m:
        return False
    smaller_m3 = min(float(np.prod(a.size_m)), float(np.prod(b.size_m)))
    enough = shared_volume_m3(a, b) > margins.shared * smaller_m3
    return enough and overlap_depth_m(a, b) > margins.depth_m


def _interval(hits: int, count: int) -> list[float]:
    found = rate(hits, count)
    return [round(found.low, 4), round(found.high, 4)]


def _share(part: int, whole: int) -> float:
    return round(part / whole, 4) if whole else 0.0
