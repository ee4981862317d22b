"""Objects as bounding boxes: lookup by id, translation, rotation, extents and free ids."""

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from world2minecraft.core.coordinates import rotation_about_z
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import OWN_CELLS, Placement, SceneObject
from world2minecraft.core.vocabulary import object_title
from world2minecraft.editing.scene.scene_draft import SceneDraft

MAX_OBJECTS = 65535
DECIMALS = 9  # Metres and degrees are rounded, so that four quarter turns are none.
SHOWN = 12  # Maximum number of IDs in an error.


def object_by_id(draft: SceneDraft, number: int) -> SceneObject:
    """Return the object with an id.

    Raises:
        UsageError: If the object does not exist. The message lists the existing objects.
    """
    if number in draft.objects:
        return draft.objects[number]
    known = sorted(draft.objects)
    if not known:
        raise UsageError(f"object {number} not found; the scene has no objects")
    listed = ", ".join(map(str, known[:SHOWN])) + (", ..." if len(known) > SHOWN else "")
    raise UsageError(f"object {number} not found; objects: {listed}")


def objects_by_ids(draft: SceneDraft, ids: Iterable[int]) -> list[SceneObject]:
    """Return the objects with some ids in order, without duplicates.

    Raises:
        UsageError: If an object does not exist.
    """
    return [object_by_id(draft, number) for number in dict.fromkeys(ids)]


def describe_object(one: SceneObject) -> str:
    """Return the description of an object for messages, such as ``object 3 (chair)``."""
    return f"object {one.id} ({object_title(one.name, one.class_id)})"


def free_object_id(draft: SceneDraft, taken: Iterable[int] = ()) -> int:
    """Return an id that no object or cell uses, preferably the highest id plus one.

    Args:
        draft: Scene to search.
        taken: Additional ids that must not be used.

    Raises:
        UsageError: If all ids are in use.
    """
    highest = max([0, int(draft.instance.max(initial=0)), *draft.objects, *taken])
    if highest < MAX_OBJECTS:
        return highest + 1
    used = {*draft.objects, *taken, *np.unique(draft.instance).tolist()}
    for number in range(1, MAX_OBJECTS + 1):
        if number not in used:
            return number
    raise UsageError(f"a scene can contain at most {MAX_OBJECTS:,} objects; delete some first")


def translate_object(one: SceneObject, shift_m: np.ndarray) -> SceneObject:
    """Return an object with its placements moved by a vector in metres, float64 [3]."""
    moved = tuple(
        replace(placed, center_m=_round(placed.center_m + shift_m)) for placed in one.placements
    )
    return replace(one, center_m=_round(one.center_m + shift_m), placements=moved)


def rotate_object(one: SceneObject, quarter_turns: int) -> SceneObject:
    """Return an object rotated about its centre, counter-clockwise from above."""
    turn = rotation_about_z(90.0 * quarter_turns)[:3, :3]
    placements = tuple(
        replace(
            placed,
            center_m=_round(one.center_m + turn @ (placed.center_m - one.center_m)),
            quarter_turns=(placed.quarter_turns + quarter_turns) % 4,
        )
        for placed in one.placements
    )
    yaw_deg = round(float(one.yaw_deg) + 90.0 * quarter_turns, DECIMALS) % 360.0
    return replace(one, yaw_deg=yaw_deg, placements=placements)


def rotate_cells(
    cells: np.ndarray, center_m: np.ndarray, quarter_turns: int, draft: SceneDraft
) -> np.ndarray:
    """Return cells int [N, 3] rotated about the grid point nearest to a centre.

    The grid point depends only on the centre, so four quarter turns restore every cell.
    """
    x, y = ((center_m - draft.origin_m) / draft.voxel_m - 0.5)[:2]
    both, apart = (int(np.floor(value + 0.5 + 1e-6)) for value in (x + y, y - x))
    result = cells.copy()
    for _ in range(quarter_turns % 4):
        result = np.column_stack([both - result[:, 1], apart + result[:, 0], result[:, 2]])
    return result


def is_of_cells(one: SceneObject) -> bool:
    """Return whether an object is built from its own cells, at least in part."""
    return not one.placements or any(p.template == OWN_CELLS for p in one.placements)


def with_placement(one: SceneObject, placement: Placement) -> SceneObject:
    """Return an object with a single piece of furniture, adopting its bounding box and rotation."""
    return replace(
        one,
        center_m=placement.center_m,
        size_m=placement.size_m,
        yaw_deg=90.0 * placement.quarter_turns,
        confidence=1.0,
        placements=(placement,),
    )


def plan_extent_m(one: SceneObject) -> np.ndarray:
    """Return the axis-aligned side lengths of an object along x, y and z in metres, float64 [3]."""
    turn = np.abs(rotation_about_z(one.yaw_deg)[:3, :3])
    return turn @ one.size_m


def copy_object(one: SceneObject, number: int) -> SceneObject:
    """Return a copy of an object and its placements with another id."""
    placements = tuple(replace(placed, object_id=number) for placed in one.placements)
    return replace(one, id=number, placements=placements)


def common_class(objects: list[SceneObject]) -> int | None:
    """Return the class of all objects, or None if their classes differ."""
    classes = {one.class_id for one in objects}
    return classes.pop() if len(classes) == 1 else None


def _round(values: np.ndarray) -> np.ndarray:
    return np.round(values, DECIMALS) + 0.0  # Without -0.0, which prints as another value.
