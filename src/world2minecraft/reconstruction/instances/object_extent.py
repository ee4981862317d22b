"""The extent of an object: its layers, and the rotated rectangle of an oblique chair.

A scan misses thin parts, such as the post or cord of a lamp or a chair's legs. The extent of an
object therefore reaches beyond the observed cells: to the floor, its support or the ceiling.
"""

from typing import NamedTuple

import numpy as np

from world2minecraft.core.classes import UNKNOWN, SemanticClass
from world2minecraft.core.types import OccupancyGrid
from world2minecraft.reconstruction.instances.object_voxels import STANDING, floor_layer_below

# Chairs that stand askew: the smallest rectangle around their cells in plan, turned freely.
ANGLES_DEG = np.array([sign * a for a in range(8, 38) for sign in (1, -1)], np.float64)
MAX_AREA_RATIO = 0.95  # Ratio to the upright rectangle; straight chairs exceed it.
MIN_MIRRORED_EXCESS = 0.02  # A rectangle turned the other way that is as small: the turn is open.
RIM_CELLS = 0.6  # Cells from the outermost centres to the sides; cells are met by their corners.
SIDES_M = (0.34, 0.66)  # Of a whole chair, and of no easy chair, pile, or back alone.
MAX_STANDING_BASE_M = 1.0  # Objects that begin higher stand on another object.
MIN_HANGING_BASE_M = 1.3  # An object in the air above this hangs from the ceiling, below it stands.
WALL_CELLS = 2  # Maximum distance to the wall of a hanging object, in cells.
MIN_FREE_CELLS = 2  # What has so much free air below it
MIN_FREE_SHARE = 0.6  # under so many of its columns has nothing that holds it there.


class Rectangle(NamedTuple):
    """A rectangle in plan: counter-clockwise angle in degrees, centre and sides in cells."""

    angle_deg: float
    middle: np.ndarray
    sides: np.ndarray


def min_area_rectangle(cells: np.ndarray, class_id: int, voxel_m: float) -> Rectangle | None:
    """Return the rectangle of an oblique chair of cells int [N, 3], rotated by 8 to 37 degrees.

    The result is None for other classes, if the axis-aligned rectangle is about as small, or if the
    sides are not those of a single chair. ``middle`` is relative to the corner of the grid.
    """
    if class_id != SemanticClass.CHAIR:
        return None
    plan = np.unique(cells[:, :2], axis=0) + 0.5
    upright = np.prod(np.ptp(plan, axis=0) + RIM_CELLS)
    every = [_rectangle_at(plan, angle) for angle in ANGLES_DEG]
    areas = np.round([float(np.prod(one.sides)) for one in every], 9)
    best = every[int(areas.argmin())]
    mirrored = areas[np.sign(ANGLES_DEG) != np.sign(best.angle_deg)].min()
    sides_m = best.sides * voxel_m
    if (
        areas.min() > MAX_AREA_RATIO * upright
        or mirrored < (1 + MIN_MIRRORED_EXCESS) * areas.min()
        or not (SIDES_M[0] <= sides_m.min() and sides_m.max() <= SIDES_M[1])
    ):
        return None
    return best


def _rectangle_at(plan: np.ndarray, angle_deg: float) -> Rectangle:
    """Return the rectangle at an angle around points, float64 [N, 2]."""
    cos, sin = np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))
    along = plan[:, 0] * cos + plan[:, 1] * sin
    aside = plan[:, 1] * cos - plan[:, 0] * sin
    u, v = ((line.min() + line.max()) / 2 for line in (along, aside))
    middle = np.array([u * cos - v * sin, u * sin + v * cos])
    return Rectangle(float(angle_deg), middle, np.array([np.ptp(along), np.ptp(aside)]) + RIM_CELLS)


def vertical_extent(cells: np.ndarray, grid: OccupancyGrid, class_id: int) -> tuple[int, int]:
    """Return the first layer of an object of cells int [N, 3], and the exclusive last layer."""
    low, high = int(cells[:, 2].min()), int(cells[:, 2].max()) + 1
    floor = floor_layer_below(cells, grid)
    if class_id in STANDING and 0 < (low - floor) * grid.voxel_m <= MAX_STANDING_BASE_M:
        return floor, high
    if class_id == SemanticClass.OBJS and low >= floor + MIN_FREE_CELLS and _is_in_air(cells, grid):
        return _lamp_layers(cells, grid, floor)
    return low, high


def _is_in_air(cells: np.ndarray, grid: OccupancyGrid) -> bool:
    """Return whether an object has no support, neither below nor beside it."""
    labels = grid.labels
    low = np.maximum(cells[:, :2].min(axis=0) - WALL_CELLS, 0)
    high = cells[:, :2].max(axis=0) + 1 + WALL_CELLS
    first, last = int(cells[:, 2].min()), int(cells[:, 2].max()) + 1
    around = labels[low[0] : high[0], low[1] : high[1], first:last]
    if np.isin(around, (SemanticClass.WALL, SemanticClass.WINDOW)).any():
        return False
    columns = np.unique(cells[cells[:, 2] <= first + 1][:, :2], axis=0)
    under = labels[columns[:, 0], columns[:, 1], first - MIN_FREE_CELLS : first]
    return bool((under == 0).all(axis=1).mean() >= MIN_FREE_SHARE)


def _lamp_layers(cells: np.ndarray, grid: OccupancyGrid, floor: int) -> tuple[int, int]:
    """Return the layers of an object with an unseen post below or an unseen cord above."""
    low, high = int(cells[:, 2].min()), int(cells[:, 2].max()) + 1
    x, y = (int(value) for value in np.round(cells[:, :2].mean(axis=0)))
    column = grid.labels[x, y]
    full = np.flatnonzero((column > 0) & (column != UNKNOWN))
    below, above = full[full < low], full[full >= high]
    floors = np.flatnonzero(column[above] == SemanticClass.FLOOR)
    above = above[: int(floors[0])] if len(floors) else above  # Over that is another storey.
    rest = int(below[-1]) + 1 if len(below) else floor
    on_table = bool(len(below)) and column[below[-1]] == SemanticClass.TABLE
    hangs = on_table or (low - floor) * grid.voxel_m >= MIN_HANGING_BASE_M
    if hangs:
        ceiling = above[column[above] == SemanticClass.CEILING]
        return low, int(ceiling[0]) if len(ceiling) else _ceiling_layer(grid, high)
    return max(rest, floor), high


def _ceiling_layer(grid: OccupancyGrid, high: int) -> int:
    """Return the layer of the ceiling over most of the room, or ``high`` if there is none.

    The search ends at the next floor above ``high``, which belongs to another storey.
    """
    layers = np.count_nonzero(grid.labels == SemanticClass.CEILING, axis=(0, 1))
    floors = np.count_nonzero(grid.labels == SemanticClass.FLOOR, axis=(0, 1))
    upper = np.flatnonzero(floors[high:] >= max(floors.max(initial=0) / 2, 1))
    if len(upper):
        layers = layers[: high + int(upper[0])]
    return max(int(layers.argmax()), high) if layers.any() else high
