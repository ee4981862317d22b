"""The lamps that light the photos of a room or a house: one under each room's ceiling."""

import numpy as np
from scipy import ndimage

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import Layout
from world2minecraft.procgen.rooms.room import Room
from world2minecraft.procgen.sensors.navmesh import is_inside

UNDER_CEILING_M = 0.35
GRID_M, MAX_STEPS = 0.1, 300  # How finely a place for a lamp is looked for.


def hang_lamps(room: Room) -> np.ndarray:
    """Return the places of the lamps, float64 [L, 3] in metres, one a layout."""
    return np.array([_lamp_m(room, layout) for layout in room.layouts])


def _lamp_m(room: Room, layout: Layout) -> list[float]:
    x, y = _middle_m(layout.floor_polygon_m)
    cell = np.floor(([x, y, layout.floor_z_m] - room.origin_m) / room.voxel_m + 1e-6).astype(int)
    i, j, k = np.clip(cell, 0, np.array(room.labels.shape) - 1)  # A room that was read may lie.
    column = room.labels[i, j, k:] == int(SemanticClass.CEILING)
    height = layout.wall_height_m
    if column.any():  # Under a roof the ceiling may be lower than the walls are high.
        height = min(height, float(column.argmax()) * room.voxel_m)
    return [x, y, layout.floor_z_m + height - UNDER_CEILING_M]


def _middle_m(polygon_m: np.ndarray) -> tuple[float, float]:
    """Return the middle of a floor, or where it is no rectangle the place farthest from walls."""
    low, high = polygon_m.min(axis=0), polygon_m.max(axis=0)
    if len(polygon_m) == 4:
        x, y = (low + high) / 2
        return float(x), float(y)
    step = max(GRID_M, float((high - low).max()) / MAX_STEPS)
    counts = np.ceil((high - low) / step).astype(int)
    cells = np.stack(np.meshgrid(*(np.arange(n) for n in counts), indexing="ij"), axis=-1)
    points = low + (cells.reshape(-1, 2) + 0.5) * step
    inside = np.pad(is_inside(polygon_m, points).reshape(counts), 1)
    distance = np.zeros(inside.shape)
    ndimage.distance_transform_edt(inside, distances=distance)
    x, y = points[distance[1:-1, 1:-1].reshape(-1).argmax()]
    return float(x), float(y)


def nearest_lamps(room: Room, shape: tuple[int, ...], cell_m: float) -> np.ndarray:
    """Return which lamp lights each cell of a coarse grid over the room, uint8 of ``shape``.

    It is that of the room in which the cell lies, or of the nearest room of its storey.
    """
    lamp_of = np.zeros(shape, np.uint8)
    if len(room.layouts) == 1:
        return lamp_of
    axes = [room.origin_m[n] + (np.arange(shape[n]) + 0.5) * cell_m for n in range(3)]
    points = np.stack(np.meshgrid(*axes[:2], indexing="ij"), axis=-1).reshape(-1, 2)
    for floor_z_m in sorted({layout.floor_z_m for layout in room.layouts}):
        owner = np.full(len(points), -1)
        for n, layout in enumerate(room.layouts):
            if layout.floor_z_m == floor_z_m:
                owner[is_inside(layout.floor_polygon_m, points)] = n
        owner = owner.reshape(shape[:2])
        nearest = np.zeros((2, *owner.shape), np.int32)
        ndimage.distance_transform_edt(
            owner < 0, return_distances=False, return_indices=True, indices=nearest
        )
        # Storeys come from below: each takes over from the middle of its floor slab up.
        lamp_of[:, :, axes[2] > floor_z_m - 0.12] = owner[tuple(nearest)][:, :, None]
    return lamp_of
