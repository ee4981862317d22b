"""Furniture of a plan, each in its box: the cells of the template that stands for it."""

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.formats.roomplan import PlanObject
from world2minecraft.furniture import cells_of, size_in_cells, template
from world2minecraft.reconstruction.floorplans.canvas import Canvas
from world2minecraft.reconstruction.floorplans.colours import colour_of
from world2minecraft.reconstruction.floorplans.furniture_categories import (
    OWN_CELLS,
    class_of,
    front_of,
    template_of,
)
from world2minecraft.reconstruction.floorplans.room_outlines import PlacedRoom

PUSH = 2  # Cells by which a box that reaches into a wall is moved off it.


def stand(canvas: Canvas, item: PlanObject, room: PlacedRoom, inside: np.ndarray) -> None:
    """Put a thing into its box: those cells of its template that are free air of its room.

    Args:
        canvas: painted in place.
        item: the thing.
        room: where it stands.
        inside: bool [X, Y], the columns of that room.
    """
    name = template_of(item, room.floor_z_m)
    turns = front_of(item, [(wall.start_m, wall.end_m) for wall in room.room.walls])
    counts = np.array(size_in_cells(item.size_m, canvas.voxel_m))
    sides = counts[[1, 0, 2]] if turns % 2 else counts
    corner = np.round(item.center_m / canvas.voxel_m - sides / 2).astype(int) - canvas.first
    ground = canvas.layers(room.floor_z_m, room.floor_z_m).start
    corner[2] = ground if corner[2] - ground <= 1 else corner[2]
    corner[:2] = _pushed_in(corner[:2], sides[:2], inside)
    if name == OWN_CELLS:
        cells = np.argwhere(np.ones(sides, bool)) + corner
    else:
        size = counts * canvas.voxel_m
        cells = cells_of(template(name), size, None, turns, corner.tolist(), canvas.voxel_m)
    cells = cells[((cells >= 0) & (cells < canvas.labels.shape)).all(axis=1)]
    cells = cells[canvas.labels[tuple(cells.T)] == SemanticClass.EMPTY]
    if len(cells):
        box = None if name == OWN_CELLS else (corner, sides)
        look = colour_of(item.category)
        canvas.add(cells, class_of(item), name, turns, look, box, item.confidence)


def _pushed_in(corner: np.ndarray, sides: np.ndarray, inside: np.ndarray) -> np.ndarray:
    """Return a box's corner [2], moved as little as lets most of it stand in the room."""
    steps = sorted(
        ((a, b) for a in range(-PUSH, PUSH + 1) for b in range(-PUSH, PUSH + 1)),
        key=lambda step: (abs(step[0]) + abs(step[1]), step),
    )
    best, most = corner, -1
    for step in steps:
        low, high = np.maximum(corner + step, 0), np.maximum(corner + step + sides, 0)
        held = int(inside[low[0] : high[0], low[1] : high[1]].sum())
        if held > most:
            best, most = corner + step, held
    return best
