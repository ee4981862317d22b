"""The free space inside: cells of a coarse grid that surface surrounds, where one could stand.

Each free cell looks along the 26 directions to its neighbours, through the grid to its end. One
is inside where it has a floor below and surface at most sides; a ceiling helps but need not be
there, and neither need one wall. What is too narrow for a person (inside cupboards, between the
two faces of a wall) falls away.
"""

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from world2minecraft.capture.readers.meshes.grid import Grid
from world2minecraft.core.jit import njit
from world2minecraft.geometry.connected_components import connected_parts

CLEAR_CELLS = 2  # About 0.25 m, a head's breadth: no nearer to surface than that is looked from.
LEAST_SPACE_M3 = 1.5  # Of cells so clear: a bathroom of 1.5 x 1.2 m; inside a wardrobe are 0.6.
LEAST_ALONE_M3 = 0.6  # Of the largest space, where there is no such: a shower room.
LEAST_HEIGHT_M = 0.8  # Of the clear part of a space in which one can stand.
DOWN_VOTES, SIDE_VOTES, BOTH_VOTES = 5, 6, 12  # Of 9 down, 8 level, and 17 level or up.
TOLD_SIDE_VOTES, TOLD_BOTH_VOTES = 3, 6  # Where the user names a place inside.
NEAR_M = 1.0  # So far may the named place be from the space that it names.


@dataclass(frozen=True, eq=False)
class Interior:
    """``clear`` bool [X, Y, Z]: cells to look from; ``drop`` int16: cells down to the floor."""

    clear: np.ndarray
    drop: np.ndarray
    spaces: int


def find_interior(grid: Grid, inside_m: np.ndarray | None = None) -> Interior | None:
    """Return the space inside, or None where there is none.

    Args:
        grid: z up.
        inside_m: a place inside that the user names; only the space around it is taken.
    """
    down, side, up, drop = votes(grid.held)
    side_least, both_least = SIDE_VOTES, BOTH_VOTES
    if inside_m is not None:
        side_least, both_least = TOLD_SIDE_VOTES, TOLD_BOTH_VOTES
    enclosed = (side >= side_least) | (side + up >= both_least)
    inside = ~grid.held & (drop > 0) & (down >= DOWN_VOTES) & enclosed
    near = ndimage.binary_dilation(
        grid.held, ndimage.generate_binary_structure(3, 2), iterations=CLEAR_CELLS
    )
    parts, count = connected_parts(inside & np.logical_not(near), corners=False)
    chosen = _standing_spaces(parts, count, grid.cell_m)
    if inside_m is not None:
        chosen = _around(parts, grid, inside_m)
    if not chosen:
        return None
    return Interior(np.isin(parts, chosen), drop, len(chosen))


def _standing_spaces(parts: np.ndarray, count: int, cell_m: float) -> list[int]:
    """Return the numbers of the spaces in which one can stand, the largest at least."""
    volumes = np.bincount(parts.ravel(), minlength=count + 1) * cell_m**3
    boxes = ndimage.find_objects(parts)
    high = [
        number
        for number, box in enumerate(boxes, 1)
        if (box[2].stop - box[2].start) * cell_m >= LEAST_HEIGHT_M
    ]
    large = [number for number in high if volumes[number] >= LEAST_SPACE_M3]
    if large or not high:
        return large
    largest = max(high, key=lambda number: volumes[number])
    return [largest] if volumes[largest] >= LEAST_ALONE_M3 else []


def _around(parts: np.ndarray, grid: Grid, inside_m: np.ndarray) -> list[int]:
    """Return the number of the space that is nearest to a named place, if it is near."""
    cells = np.argwhere(parts > 0)
    if not len(cells):
        return []
    away = np.linalg.norm(grid.centers_m(cells) - inside_m, axis=1)
    nearest = int(np.argmin(away))
    return [int(parts[tuple(cells[nearest])])] if away[nearest] <= NEAR_M else []


@njit
def _sweep(held, dx, dy, dz, hit):
    """Fill ``hit`` with whether a walk by (dx, dy, dz) from each cell meets a held one.

    A step aslant in one plane does not slip between two held cells that meet at their edges.
    """
    nx, ny, nz = held.shape
    for step_x in range(nx):
        x = nx - 1 - step_x if dx > 0 else step_x
        for step_y in range(ny):
            y = ny - 1 - step_y if dy > 0 else step_y
            for step_z in range(nz):
                z = nz - 1 - step_z if dz > 0 else step_z
                a, b, c = x + dx, y + dy, z + dz
                if a < 0 or b < 0 or c < 0 or a >= nx or b >= ny or c >= nz:
                    hit[x, y, z] = False
                    continue
                found = held[a, b, c] or hit[a, b, c]
                if not found and abs(dx) + abs(dy) + abs(dz) == 2:
                    if dz == 0:
                        found = held[a, y, z] and held[x, b, z]
                    elif dy == 0:
                        found = held[a, y, z] and held[x, y, c]
                    else:
                        found = held[x, b, z] and held[x, y, c]
                hit[x, y, z] = found


@njit
def votes(held):
    """Return how many of the 9, 8 and 9 directions down, level and up meet surface, and the drop.

    Returns:
        uint8 [X, Y, Z] each; int16 [X, Y, Z], how many cells below the next surface lies, 0 where
        there is none.
    """
    down, side = np.zeros(held.shape, np.uint8), np.zeros(held.shape, np.uint8)
    up, hit = np.zeros(held.shape, np.uint8), np.zeros(held.shape, np.bool_)
    for dx in range(-1, 2):
        for dy in range(-1, 2):
            for dz in range(-1, 2):
                if dx == 0 and dy == 0 and dz == 0:
                    continue
                _sweep(held, dx, dy, dz, hit)
                if dz < 0:
                    down += hit
                elif dz == 0:
                    side += hit
                else:
                    up += hit
    return down, side, up, _drops(held)


@njit
def _drops(held):
    drop = np.zeros(held.shape, np.int16)
    for x in range(held.shape[0]):
        for y in range(held.shape[1]):
            for z in range(1, held.shape[2]):
                if held[x, y, z - 1]:
                    drop[x, y, z] = 1
                elif drop[x, y, z - 1] > 0:
                    drop[x, y, z] = drop[x, y, z - 1] + 1
    return drop
