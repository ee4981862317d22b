"""How far an object reaches beyond the cells that were seen: to the floor, its host, the ceiling.

A scan misses what is thin: the post of a lamp, the cord of a pendant, a chair's legs.
"""

import numpy as np

from world2minecraft.core.classes import UNKNOWN, SemanticClass
from world2minecraft.core.types import OccupancyGrid
from world2minecraft.reconstruction.instances.heap import floor_below

STANDING = (SemanticClass.CHAIR, SemanticClass.BED, SemanticClass.SOFA, SemanticClass.TABLE)
STANDS_BELOW_M = 1.0  # What begins higher stands on something else; a chair's back does not.
HANGS_ABOVE_M = 1.3  # A thing in the air above this hangs from the ceiling, below it stands.
BESIDE_CELLS = 2  # What has a wall this near hangs on it.
TOUCH_CELLS = 2  # What has so much free air below it
FREE_SHARE = 0.6  # under so many of its columns has nothing that holds it there.


def layers_reached(cells: np.ndarray, grid: OccupancyGrid, class_id: int) -> tuple[int, int]:
    """Return the first layer of an object of ``cells``, int [N, 3], and the one past its last."""
    low, high = int(cells[:, 2].min()), int(cells[:, 2].max()) + 1
    floor = floor_below(cells, grid)
    if class_id in STANDING and 0 < (low - floor) * grid.voxel_m <= STANDS_BELOW_M:
        return floor, high
    if class_id == SemanticClass.OBJS and low >= floor + TOUCH_CELLS and _is_in_air(cells, grid):
        return _pole(cells, grid, floor)
    return low, high


def _is_in_air(cells: np.ndarray, grid: OccupancyGrid) -> bool:
    """Tell whether nothing holds an object: neither below nor beside."""
    labels = grid.labels
    low = np.maximum(cells[:, :2].min(axis=0) - BESIDE_CELLS, 0)
    high = cells[:, :2].max(axis=0) + 1 + BESIDE_CELLS
    first, last = int(cells[:, 2].min()), int(cells[:, 2].max()) + 1
    around = labels[low[0] : high[0], low[1] : high[1], first:last]
    if np.isin(around, (SemanticClass.WALL, SemanticClass.WINDOW)).any():
        return False
    columns = np.unique(cells[cells[:, 2] <= first + 1][:, :2], axis=0)
    under = labels[columns[:, 0], columns[:, 1], first - TOUCH_CELLS : first]
    return bool((under == 0).all(axis=1).mean() >= FREE_SHARE)


def _pole(cells: np.ndarray, grid: OccupancyGrid, floor: int) -> tuple[int, int]:
    """Return the layers of a thing with a post below or a cord above that was not seen."""
    low, high = int(cells[:, 2].min()), int(cells[:, 2].max()) + 1
    x, y = (int(value) for value in np.round(cells[:, :2].mean(axis=0)))
    column = grid.labels[x, y]
    full = np.flatnonzero((column > 0) & (column != UNKNOWN))
    below, above = full[full < low], full[full >= high]
    floors = np.flatnonzero(column[above] == SemanticClass.FLOOR)
    above = above[: int(floors[0])] if len(floors) else above  # Over that is another storey.
    rest = int(below[-1]) + 1 if len(below) else floor
    on_table = bool(len(below)) and column[below[-1]] == SemanticClass.TABLE
    hangs = on_table or (low - floor) * grid.voxel_m >= HANGS_ABOVE_M
    if hangs:
        ceiling = above[column[above] == SemanticClass.CEILING]
        return low, int(ceiling[0]) if len(ceiling) else _ceiling(grid, high)
    return max(rest, floor), high


def _ceiling(grid: OccupancyGrid, high: int) -> int:
    """Return the layer of the ceiling over most of the room; ``high`` where there is none.

    The next floor over ``high`` ends the search: over that is another storey's ceiling.
    """
    layers = np.count_nonzero(grid.labels == SemanticClass.CEILING, axis=(0, 1))
    floors = np.count_nonzero(grid.labels == SemanticClass.FLOOR, axis=(0, 1))
    upper = np.flatnonzero(floors[high:] >= max(floors.max(initial=0) / 2, 1))
    if len(upper):
        layers = layers[: high + int(upper[0])]
    return max(int(layers.argmax()), high) if layers.any() else high
