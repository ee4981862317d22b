"""Small scenes with objects and furniture, and what a scene holds as plain values."""

import numpy as np
from hypothesis import strategies as st

from world2minecraft.core.types import OccupancyGrid, Placement, SceneObject
from world2minecraft.editing.scene import SceneDraft, Tools
from world2minecraft.editing.scene.object_conversion import object_key

VOXEL_M = 0.08
seeds = st.integers(0, 10_000)


def grid_of(labels, instance=None, colour=None) -> OccupancyGrid:
    labels = np.asarray(labels, np.uint8)
    unseen = labels == 255
    return OccupancyGrid(
        labels=labels,
        confidence=np.where(unseen, 0, 0.75).astype(np.float16),
        colour=np.zeros((*labels.shape, 3), np.uint8) if colour is None else colour,
        source=np.where(unseen, 0, 1).astype(np.uint8),
        instance=np.zeros(labels.shape, np.uint16) if instance is None else instance,
        voxel_m=VOXEL_M,
        origin_m=np.zeros(3),
    )


def object_at(number: int, class_id: int, cells: np.ndarray, iou: float = 0.5) -> SceneObject:
    """An object around its cells int [N, 3], with one piece of furniture."""
    low, high = cells.min(axis=0) * VOXEL_M, (cells.max(axis=0) + 1) * VOXEL_M
    box = ((low + high) / 2, high - low)
    placed = Placement(number, class_id, "plain", *box, 0, iou)
    return SceneObject(number, class_id, *box, 0.0, 0.75, (placed,))


def random_scene(seed: int, shape=(5, 4, 6)) -> SceneDraft:
    """Cells of few classes, so that they touch; each part of 5 or 8 an object, some left loose."""
    rng = np.random.default_rng(seed)
    labels = rng.choice([0, 0, 0, 2, 3, 4, 5, 8, 255], shape).astype(np.uint8)
    instance = np.zeros(shape, np.uint16)
    objects = []
    for number, class_id in ((3, 5), (7, 5), (9, 8), (500, 8)):
        mine = (labels == class_id) & (instance == 0) & (rng.random(shape) < 0.5)
        if mine.any():
            instance[mine] = number
            objects.append(object_at(number, class_id, np.argwhere(mine)))
    colour = rng.integers(0, 256, (*shape, 3)).astype(np.uint8)
    return SceneDraft(grid_of(labels, instance, colour), objects)


def no_match(grid, one):
    """Furniture that stands for any object: a plain box."""
    placed = Placement(one.id, one.class_id, "plain", one.center_m, one.size_m, 0, 0.25)
    return (placed,)


TOOLS = Tools(match=no_match, find=lambda grid, fields: (grid.instance, ()))


def held(draft: SceneDraft) -> tuple:
    """All that a scene holds, in values that compare."""
    arrays = (draft.labels, draft.confidence, draft.colour, draft.source, draft.instance)
    objects = tuple(object_key(draft.objects[number]) for number in sorted(draft.objects))
    return (*(array.tobytes() for array in arrays), draft.counts.tolist(), objects)


def check_whole(draft: SceneDraft) -> None:
    """A scene that fits together: the grid is valid, and every instance is an object of it."""
    grid = draft.grid()
    owners = np.unique(grid.instance[grid.instance > 0])
    assert set(owners.tolist()) <= set(draft.objects)
    assert (grid.labels[grid.instance > 0] % 255 > 4).all()
    assert draft.counts.tolist() == np.bincount(grid.labels.ravel(), minlength=256).tolist()


def done(draft: SceneDraft, command):
    """Do a command; the scene must fit together before, after, and be as before when undone."""
    before = held(draft)
    operation = command.plan(draft, TOOLS)
    assert held(draft) == before, "a plan changes nothing"
    draft.apply(operation)
    check_whole(draft)
    after = held(draft)
    draft.apply(operation.inverse())
    assert held(draft) == before, "undone it is as before"
    draft.apply(operation)
    assert held(draft) == after
    return operation
