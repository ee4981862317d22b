"""A small furnished room for commands on objects, and tools that know no stage."""

import numpy as np

from world2minecraft.core.types import (
    OBSERVED,
    ObjectInstance,
    OccupancyGrid,
    Placement,
    SceneObject,
)
from world2minecraft.editing.scene import SceneDraft, Tools

VOXEL_M = 0.1
SHAPE = (24, 20, 16)  # 2.4 x 2.0 m; the floor is the layer under z = 0, the walls are x = 0, y = 0.
CHAIR, TABLE, LAMP = 1, 2, 3


def furnished_room() -> SceneDraft:
    """A floor, two walls, a chair (template), a table (own cells) and a lamp without cells."""
    labels = np.zeros(SHAPE, np.uint8)
    labels[:, :, 0] = 2
    labels[0, :, 1:] = labels[:, 0, 1:] = 3
    labels[-1, -1, -1] = 255  # One cell that was never seen.
    instance = np.zeros(SHAPE, np.uint16)
    put(labels, instance, (5, 5, 1), (4, 4, 5), 5, CHAIR)
    put(labels, instance, (12, 8, 1), (6, 4, 4), 8, TABLE)
    colour = np.zeros((*SHAPE, 3), np.uint8)
    colour[instance > 0] = (90, 60, 30)
    grid = OccupancyGrid(
        labels=labels,
        confidence=np.full(SHAPE, 0.5, np.float16),
        colour=colour,
        source=np.where(labels == 255, 0, OBSERVED).astype(np.uint8),
        instance=instance,
        voxel_m=VOXEL_M,
        origin_m=np.array([0.0, 0.0, -VOXEL_M]),
    )
    chair = Placement(CHAIR, 5, "chair", [0.7, 0.7, 0.25], [0.4, 0.4, 0.5], 1, 0.8)
    return SceneDraft(
        grid,
        [
            SceneObject(CHAIR, 5, [0.7, 0.7, 0.25], [0.4, 0.4, 0.5], 90.0, 0.5, (chair,)),
            SceneObject(TABLE, 8, [1.5, 1.0, 0.2], [0.6, 0.4, 0.4], 0.0, 0.5),
            SceneObject(LAMP, 11, [2.0, 0.5, 0.5], [0.2, 0.2, 1.0], 0.0, 0.5),
        ],
    )


def put(labels, instance, low, size, class_id, number) -> None:
    """Fill a box of cells."""
    box = tuple(slice(a, a + n) for a, n in zip(low, size, strict=True))
    labels[box], instance[box] = class_id, number


def plain_tools() -> Tools:
    """Tools that tell an object by the box of its cells, and match it by a box of its own cells."""

    def measure(grid, number, class_id, cells):
        low, high = cells.min(axis=0), cells.max(axis=0) + 1
        center_m = grid.origin_m + (low + high) / 2 * grid.voxel_m
        size_m = (high - low) * grid.voxel_m
        return ObjectInstance(number, class_id, center_m, size_m, 0.0, cells, 1.0)

    def fit(grid, one, name, turns):
        return Placement(one.id, one.class_id, name, one.center_m, one.size_m, turns or 0, 0.5)

    def match(grid, one):
        return (fit(grid, one, "cells", 0),)

    def find(grid, parameters):
        instance = np.where(grid.labels % 255 > 4, 1, 0).astype(np.uint16)
        return instance, (measure(grid, 1, 5, np.argwhere(instance).astype(np.int32)),)

    return Tools(match, find, fit, measure)
