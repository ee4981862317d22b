"""Objects of a grid from their centres alone, as ``centers.json`` has them."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.spatial import KDTree

from world2minecraft.core.classes import OBJECT_CLASSES
from world2minecraft.core.coordinates import cell_centers_m
from world2minecraft.core.errors import LimitError
from world2minecraft.core.types import ObjectInstance, OccupancyGrid
from world2minecraft.formats.occupancy_files import Center
from world2minecraft.furniture.facing import Surroundings, facing, surroundings

MAX_CENTERS = 65535


def instances_at(
    grid: OccupancyGrid, centers: Sequence[Center]
) -> tuple[OccupancyGrid, tuple[ObjectInstance, ...]]:
    """Return the grid with instances, and one object for each centre of an object class.

    Each cell belongs to the nearest centre of its class; cells of a class without a centre belong
    to no object. A centre without cells is an object of one cell's size.

    Raises:
        LimitError: there are more centres than ids.
    """
    wanted = [one for one in centers if one.class_id in OBJECT_CLASSES]
    if len(wanted) > MAX_CENTERS:
        raise LimitError("centers", f"are {len(wanted):,}; at most {MAX_CENTERS:,} are read")
    instance = np.zeros(grid.shape, np.uint16)
    around = surroundings(grid.labels)
    objects: list[ObjectInstance] = []
    for class_id in OBJECT_CLASSES:
        places = np.array([one.position_m for one in wanted if one.class_id == class_id])
        if not len(places):
            continue
        cells = np.argwhere(grid.labels == class_id).astype(np.int32)
        owners = _nearest(cell_centers_m(cells, grid.origin_m, grid.voxel_m), places)
        for number, place in enumerate(places):
            own = cells[owners == number]
            objects.append(_object(len(objects) + 1, class_id, place, own, grid, around))
            instance[tuple(own.T)] = len(objects)
    return replace(grid, instance=instance), tuple(objects)


def _nearest(points_m: np.ndarray, places_m: np.ndarray) -> np.ndarray:
    """Return for each point, float64 [N, 3], the number of the nearest place."""
    found = KDTree(places_m).query(points_m)[1] if len(points_m) else []
    return np.asarray(found, np.int64)


def _object(
    number: int,
    class_id: int,
    place_m: np.ndarray,
    cells: np.ndarray,
    grid: OccupancyGrid,
    around: Surroundings,
) -> ObjectInstance:
    if not len(cells):
        side = np.full(3, grid.voxel_m)
        return ObjectInstance(number, class_id, place_m, side, 0.0, cells, 0.0)
    front = facing(cells, class_id, around)
    first, last = cells.min(axis=0), cells.max(axis=0) + 1
    size = (last - first) * grid.voxel_m
    center = grid.origin_m + (first + last) * grid.voxel_m / 2
    own_axes = size[[1, 0, 2]] if front.quarter_turns % 2 else size
    yaw = 90.0 * front.quarter_turns
    return ObjectInstance(number, class_id, center, own_axes, yaw, cells, 1.0)
