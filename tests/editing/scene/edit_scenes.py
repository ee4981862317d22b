"""Small scenes and random operations on them, for the laws of histories, bytes and journals."""

import numpy as np

from world2minecraft.core.types import (
    Alternative,
    GridCells,
    ObjectInstance,
    OccupancyGrid,
    Operation,
    Placement,
)
from world2minecraft.editing.scene import SceneDraft, objects_of

SHAPE = (7, 6, 5)


def random_cells(rng: np.random.Generator, count: int) -> GridCells:
    """What ``count`` cells may hold, all kinds of it."""
    labels = rng.choice([0, 2, 3, 5, 8, 255], count).astype(np.uint8)
    return GridCells(
        labels,
        rng.random(count).astype(np.float16),
        rng.integers(0, 256, (count, 3), np.uint8),
        np.where(labels == 255, 0, rng.integers(1, 3, count)).astype(np.uint8),
        rng.integers(0, 4, count).astype(np.uint16),
    )


def placement(number: int, class_id: int, quarter_turns: int = 0, template="chair") -> Placement:
    box = (np.array([0.2, 0.3, 0.1]), np.array([0.1, 0.2, 1 / 3]))
    others = (Alternative("stool", 1, 0.25), Alternative("bench", 2, 1 / 7))
    return Placement(
        number, class_id, template, *box, quarter_turns, 0.75, {"seat": 0.1, "back": 1 / 3}, others
    )


def instance(number: int, class_id: int) -> ObjectInstance:
    box = (np.array([0.2, 0.3, 0.1]), np.array([0.24, 0.32, 0.4]))
    return ObjectInstance(number, class_id, *box, 90.0, np.zeros((0, 3), np.int32), 0.5)


def small_grid(seed: int = 0) -> OccupancyGrid:
    rng = np.random.default_rng(seed)
    held = random_cells(rng, int(np.prod(SHAPE)))
    fields = {
        "labels": held.labels.reshape(SHAPE),
        "confidence": held.confidence.reshape(SHAPE),
        "colour": held.colour.reshape(*SHAPE, 3),
        "source": held.source.reshape(SHAPE),
        "instance": held.instance.reshape(SHAPE),
    }
    return OccupancyGrid(**fields, voxel_m=0.08, origin_m=np.array([-0.16, 0.0, -0.08]))


def small_draft(seed: int = 0) -> SceneDraft:
    objects = objects_of([instance(1, 5), instance(2, 8)], [placement(1, 5), placement(2, 8, 3)])
    return SceneDraft(small_grid(seed), objects)


def random_operation(draft: SceneDraft, rng: np.random.Generator) -> Operation:
    """A change of some cells and objects of a scene: any that the types allow."""
    flat = rng.choice(int(np.prod(SHAPE)), rng.integers(0, 60), replace=False)
    if rng.random() < 0.5:
        flat.sort()
    cells = np.column_stack(np.unravel_index(flat, SHAPE)).astype(np.int32)
    gone = [number for number in draft.objects if rng.random() < 0.3]
    number, class_id = int(rng.integers(1, 6)), int(rng.integers(5, 12))
    changed = objects_of(
        [instance(number, class_id)], [placement(number, class_id, int(rng.integers(4)))]
    )
    told = {
        "counts_as": str(rng.choice(["add", "delete", "orient", "move", "other"])),
        "class_id": None if rng.random() < 0.5 else class_id,
        "actor": "ü tab",
        "time_s": float(rng.random() * 1e9),
    }
    after = random_cells(rng, len(cells))
    return draft.plan_operation("paint", cells, after, gone=gone, objects=changed, **told)


def state(draft: SceneDraft) -> tuple:
    """Everything that a scene holds, in a form that compares."""
    from world2minecraft.editing.scene.object_conversion import object_key

    arrays = (draft.labels, draft.confidence, draft.colour, draft.source, draft.instance)
    held = tuple(array.tobytes() for array in arrays)
    return (
        *held,
        draft.counts.tobytes(),
        *(object_key(draft.objects[n]) for n in sorted(draft.objects)),
    )
