"""A plan becomes a grid: walls, floor, ceiling, openings and furniture, with its placements.

Cells whose middle lies in a room's outline are its air; what touches them outside is wall. All
that a plan says counts as observed; what is outside stays unseen.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from world2minecraft.core.classes import UNKNOWN, SemanticClass
from world2minecraft.core.types import ObjectInstance, OccupancyGrid, Placement
from world2minecraft.formats.roomplan import CapturedPlan, PlanSurface
from world2minecraft.geometry.morphology import grown
from world2minecraft.reconstruction.floorplans.canvas import Canvas
from world2minecraft.reconstruction.floorplans.colours import DOOR
from world2minecraft.reconstruction.floorplans.furniture_categories import OWN_CELLS
from world2minecraft.reconstruction.floorplans.room_outlines import PlacedRoom, placed_rooms
from world2minecraft.reconstruction.floorplans.standing import stand

REACH_M = 0.20  # How far a wall's cells may lie from the line of an opening in it.
BEYOND_M = 0.35  # Past the wall that an opening is in: there the next room has begun.
ASIDE_M = 0.25  # On both sides of a wall within a room, its floor goes on this far off.
WALL, OBJS, EMPTY = int(SemanticClass.WALL), int(SemanticClass.OBJS), int(SemanticClass.EMPTY)


@dataclass(frozen=True, eq=False)
class PlanCells:
    """A plan as a grid, its objects, and what stands for each."""

    grid: OccupancyGrid
    instances: tuple[ObjectInstance, ...]
    placements: tuple[Placement, ...]


def cells_of_plan(plan: CapturedPlan, voxel_m: float = 0.08) -> PlanCells:
    """Return a straightened plan as cells.

    Args:
        plan: in a frame whose z is up and whose walls lie along x and y.
        voxel_m: the side of a cell.

    Raises:
        UsageError: the plan is too large for such cells.
    """
    rooms = sorted(placed_rooms(plan), key=lambda room: room.floor_z_m)
    canvas = Canvas(rooms, voxel_m)
    columns = _columns_of_rooms(canvas, rooms)
    for room, inside in zip(rooms, columns, strict=True):
        _paint_shell(canvas, room, inside)
    for room, inside in zip(rooms, columns, strict=True):
        _paint_partitions(canvas, room, inside)
    anywhere = np.any(columns, axis=0)
    for room in rooms:
        for opening in room.room.openings:
            _paint_opening(canvas, room, opening, _leads_on(canvas, opening, anywhere))
    for room, inside in zip(rooms, columns, strict=True):
        for item in sorted(room.room.objects, key=lambda item: -float(np.prod(item.size_m))):
            stand(canvas, item, room, inside)
    return PlanCells(canvas.grid(), tuple(canvas.instances), tuple(canvas.placements))


def _columns_of_rooms(canvas: Canvas, rooms: Sequence[PlacedRoom]) -> list[np.ndarray]:
    """Return bool [X, Y] each: the columns of a room, a cell at least from those before it."""
    columns: list[np.ndarray] = []
    for room in rooms:
        inside = _inside(canvas, room.outline_m)
        for other, taken in zip(rooms, columns, strict=False):
            low = max(other.floor_z_m, room.floor_z_m)
            if low < min(other.floor_z_m + other.height_m, room.floor_z_m + room.height_m) - 0.5:
                inside &= ~grown(taken)
        columns.append(inside)
    return columns


def _inside(canvas: Canvas, outline_m: np.ndarray) -> np.ndarray:
    """Return bool [X, Y]: the cells whose middle lies in an outline, by crossings to the right."""
    x, y = canvas.middles_m()
    inside = np.zeros(canvas.labels.shape[:2], bool)
    for (x0, y0), (x1, y1) in zip(outline_m, np.roll(outline_m, -1, axis=0), strict=True):
        if y0 != y1:
            crosses = (y0 > y) != (y1 > y)
            inside ^= crosses & (x < x0 + (y - y0) / (y1 - y0) * (x1 - x0))
    return inside


def _paint_shell(canvas: Canvas, room: PlacedRoom, inside: np.ndarray) -> None:
    """Paint floor, air, ceiling and the walls around a room, these where nothing is known yet."""
    air = canvas.layers(room.floor_z_m, room.floor_z_m + room.height_m)
    part = canvas.labels[:, :, air.start - 1 : air.stop + 1]
    part[(grown(inside) & ~inside)[:, :, None] & (part == UNKNOWN)] = WALL
    part[inside] = EMPTY
    canvas.labels[inside, air.start - 1] = int(SemanticClass.FLOOR)
    canvas.labels[inside, air.stop] = int(SemanticClass.CEILING)


def _paint_partitions(canvas: Canvas, room: PlacedRoom, inside: np.ndarray) -> None:
    """Paint the walls that stand within a room: those with its floor on both sides."""
    for wall in room.room.walls:
        count = max(2, int(np.ceil(3 * wall.length_m / canvas.voxel_m)))
        along = wall.end_m - wall.start_m
        points = wall.start_m + (np.arange(count) + 0.5)[:, None] / count * along
        aside = np.array([-along[1], along[0]]) / max(wall.length_m, 1e-9) * ASIDE_M
        within = np.ones(count, bool)
        for step in (-1, 0, 1):
            within &= inside[tuple(canvas.columns(points + step * aside).T)]
        if within.mean() >= 0.5:
            x, y = np.unique(canvas.columns(points[within]), axis=0).T
            canvas.labels[x, y, canvas.layers(wall.bottom_m, wall.top_m)] = WALL


def _leads_on(canvas: Canvas, opening: PlanSurface, anywhere: np.ndarray) -> bool:
    """Whether there is a room on both sides of an opening."""
    along = (opening.end_m - opening.start_m) / max(opening.length_m, 1e-9)
    middle, aside = (opening.start_m + opening.end_m) / 2, np.array([-along[1], along[0]])
    sides = np.array([middle + sign * BEYOND_M * aside for sign in (1, -1)])
    return bool(anywhere[tuple(canvas.columns(sides).T)].all())


def _paint_opening(canvas: Canvas, room: PlacedRoom, opening: PlanSurface, leads_on: bool) -> None:
    """Cut a window, a door or a doorway into its walls; the leaf of a closed door is an object.

    Doors between two rooms stand open, so that one can walk through the house.
    """
    columns = _columns_of(canvas, opening)
    low = opening.bottom_m if opening.kind == "window" else room.floor_z_m
    layers = canvas.layers(low, opening.top_m)
    part = canvas.labels[:, :, layers]
    walls = columns[:, :, None] & (part == WALL)
    if opening.kind == "window":
        part[walls] = int(SemanticClass.WINDOW)
    elif opening.kind == "doorway" or leads_on:
        part[walls] = EMPTY
    elif walls.any():
        cells = np.argwhere(walls) + np.array([0, 0, layers.start])
        across = int(abs(opening.end_m - opening.start_m).argmax() == 0)
        canvas.add(cells, OBJS, OWN_CELLS, across, DOOR)


def _columns_of(canvas: Canvas, opening: PlanSurface) -> np.ndarray:
    """Return bool [X, Y]: what lies between an opening's ends and near its line."""
    x, y = canvas.middles_m()
    along = (opening.end_m - opening.start_m) / max(opening.length_m, 1e-9)
    dx, dy = x - opening.start_m[0], y - opening.start_m[1]
    place, off = dx * along[0] + dy * along[1], dx * along[1] - dy * along[0]
    return (place > 0) & (place < opening.length_m) & (np.abs(off) < REACH_M)
