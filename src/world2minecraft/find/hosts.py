"""Small things that touch, told apart by what holds them: the floor, a table, a cupboard, a wall.

A lamp on a sideboard and the plant on the floor beside it are one cluster of ``objs``; what they
stand on is not one.
"""

import numpy as np
from scipy import ndimage

from world2minecraft.classes import OBJECT_CLASSES, SemanticClass
from world2minecraft.find.growth import grow
from world2minecraft.find.heap import floor_below
from world2minecraft.find.owned import cells_by_owner
from world2minecraft.geometry.colour import oklab_of_srgb
from world2minecraft.geometry.parts import connected_parts
from world2minecraft.types import OccupancyGrid

LEAST_COLUMNS = 3  # What stands with fewer cells leans over, or is noise: a vase has four.
LEAST_CELLS = 8  # Of a part, as of any object.
NEAR_WALL_CELLS = 2  # A curtain hangs this near its wall.
LEAST_SHEET = 12  # Cells of a thing on a wall: at 0.08 m, a picture of 0.3 m side.
HIGH_M = 1.8  # What reaches so high beside a wall hangs there, wherever it ends below.
CLEAR_M = 0.24  # As does what has so much free air below it.
AROUND_CELLS = 4  # What stands this near is compared,
UNLIKE = 0.08  # in Oklab: one thing in light and shade differs by less.
UNDER_CELLS = 2  # A thing stands on what lies this near below it.


def part_by_hosts(owners: np.ndarray, grid: OccupancyGrid) -> np.ndarray:
    """Return owners, int32 [X, Y, Z], in which small things of other hosts have own numbers."""
    result = owners.copy()
    fresh = int(owners.max(initial=0))
    for _, cells in cells_by_owner(owners, grid.labels, SemanticClass.OBJS):
        if len(cells) < 2 * LEAST_CELLS:
            continue
        parts = _parts(cells, owners, grid)
        moved = parts > 1
        result[tuple(cells[moved].T)] = fresh + parts[moved] - 1
        fresh += max(int(parts.max()) - 1, 0)
    return result


def _parts(cells: np.ndarray, owners: np.ndarray, grid: OccupancyGrid) -> np.ndarray:
    """Return the part, int32 [N] from 1, of each cell, 1 where all hang together."""
    floor = floor_below(cells, grid)
    low = np.maximum(cells.min(axis=0) - NEAR_WALL_CELLS, 0)
    low[2] = max(int(cells[:, 2].min()) - UNDER_CELLS, 0)
    high = cells.max(axis=0) + 1 + NEAR_WALL_CELLS
    box = tuple(slice(int(a), int(b)) for a, b in zip(low, high, strict=True))
    labels, own = grid.labels[box], np.zeros(grid.labels[box].shape, np.bool_)
    own[tuple((cells - low).T)] = True
    colour = oklab_of_srgb(grid.colour[box])
    seeds = _seeds(own, labels, owners[box], colour, floor - int(low[2]), grid.voxel_m)
    count = int(seeds.max(initial=0))
    if count < 2:
        return np.ones(len(cells), np.int32)
    at = np.argwhere(seeds).astype(np.int32)
    grown = grow(labels, own, at, seeds[tuple(at.T)] - 1)[tuple((cells - low).T)]
    return _large_enough(grown)


def _seeds(
    own: np.ndarray,
    labels: np.ndarray,
    owners: np.ndarray,
    colour: np.ndarray,
    floor: int,
    voxel_m: float,
) -> np.ndarray:
    """Return int32 [X, Y, Z]: the numbers of the hosts in the columns that they hold."""
    bottom = np.where(own.any(axis=2), own.argmax(axis=2), -1)
    hung = _by_wall(own, labels, bottom, floor, voxel_m)
    host = np.where(hung, -1, _hosts(bottom, labels, owners, floor))
    seeds = np.zeros(own.shape, np.int32)
    sheets, count = connected_parts(hung)
    groups = [sheets == sheet for sheet in range(1, count + 1)]
    groups = [plan for plan in groups if _is_sheet(plan, hung, own, colour)]
    for number in np.unique(host[host >= 0]):
        plan = host == number
        if plan.sum() >= LEAST_COLUMNS:
            groups.append(plan)
    for number, plan in enumerate(groups, start=1):
        seeds[own & plan[:, :, None]] = number
    return seeds


def _is_sheet(plan: np.ndarray, hung: np.ndarray, own: np.ndarray, colour: np.ndarray) -> bool:
    """Tell whether what hangs in some columns looks unlike what stands beside them.

    The leaves of a plant that lean to a wall are no thing of their own.
    """
    sheet = own & plan[:, :, None]
    around = ndimage.binary_dilation(plan, np.ones((3, 3), np.bool_), iterations=AROUND_CELLS)
    beside = own & (around & ~hung)[:, :, None]
    if np.count_nonzero(sheet) < LEAST_SHEET:
        return False
    if not beside.any():
        return True
    apart = np.median(colour[sheet], axis=0) - np.median(colour[beside], axis=0)
    return float(np.linalg.norm(apart)) >= UNLIKE


def _by_wall(
    own: np.ndarray, labels: np.ndarray, bottom: np.ndarray, floor: int, voxel_m: float
) -> np.ndarray:
    """Return bool [X, Y]: columns that hang beside a wall."""
    wall = ((labels == SemanticClass.WALL) | (labels == SemanticClass.WINDOW)).any(axis=2)
    if not wall.any():
        return wall
    near = np.asarray(ndimage.distance_transform_cdt(~wall)) <= NEAR_WALL_CELLS
    top = own.shape[2] - 1 - own[:, :, ::-1].argmax(axis=2)
    high = top + 1 - floor >= HIGH_M / voxel_m
    clear = np.zeros_like(near)
    for x, y in np.argwhere(near & (bottom > 0)):
        first = int(bottom[x, y])
        below = labels[x, y, max(first - int(CLEAR_M / voxel_m), 0) : first]
        clear[x, y] = bool((below == 0).all())
    return near & (bottom >= 0) & (high | clear)


def _hosts(bottom: np.ndarray, labels: np.ndarray, owners: np.ndarray, floor: int) -> np.ndarray:
    """Return int64 [X, Y]: what each column stands on: 0 the floor, else an owner; -1 nothing."""
    host = np.full(bottom.shape, -1, np.int64)
    for x, y in np.argwhere(bottom >= 0):
        first = int(bottom[x, y])
        if first - floor < UNDER_CELLS:
            host[x, y] = 0
            continue
        for k in range(first - 1, max(first - 1 - UNDER_CELLS, -1), -1):
            label = int(labels[x, y, k])
            if label in OBJECT_CLASSES and label != SemanticClass.OBJS and owners[x, y, k]:
                host[x, y] = int(owners[x, y, k])
            elif label == SemanticClass.FLOOR:
                host[x, y] = 0
            else:
                continue
            break
    return host


def _large_enough(parts: np.ndarray) -> np.ndarray:
    """Number the parts anew from 1; cells of a part that is too small join the largest."""
    counts = np.bincount(parts)
    keep = counts >= LEAST_CELLS
    keep[0] = False
    if not keep.any():
        return np.ones(len(parts), np.int32)
    largest = int(np.where(keep, counts, 0).argmax())
    kept = np.where(keep[parts], parts, largest)
    return (np.unique(kept, return_inverse=True)[1] + 1).astype(np.int32)
