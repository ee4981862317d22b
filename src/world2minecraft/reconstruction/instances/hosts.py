"""Small things that touch, told apart by what holds them: the floor, a table, a cupboard, a wall.

A lamp on a sideboard and the plant on the floor beside it are one cluster of ``objs``; what they
stand on is not one.
"""

import numpy as np
from scipy import ndimage

from world2minecraft.core.classes import OBJECT_CLASSES, SemanticClass
from world2minecraft.core.types import OccupancyGrid
from world2minecraft.geometry.colour import oklab_of_srgb
from world2minecraft.geometry.connected_components import connected_parts
from world2minecraft.reconstruction.instances.growth import grow
from world2minecraft.reconstruction.instances.heap import floor_below
from world2minecraft.reconstruction.instances.owned import cells_by_owner
from world2minecraft.reconstruction.instances.sheets import (
    NEAR_CELLS,
    UNLIKE,
    Scene,
    hung_plans,
    joined_in_air,
)

LEAST_COLUMNS = 3  # What stands with fewer cells leans over, or is noise: a vase has four.
LEAST_CELLS = 8  # Of a part, as of any object.
LEAST_SHADE = 20  # Cells of a shade that floats.
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
    low = np.maximum(cells.min(axis=0) - NEAR_CELLS, 0)
    low[2] = max(int(cells[:, 2].min()) - UNDER_CELLS, 0)
    high = cells.max(axis=0) + 1 + NEAR_CELLS
    box = tuple(slice(int(a), int(b)) for a, b in zip(low, high, strict=True))
    labels, own = grid.labels[box], np.zeros(grid.labels[box].shape, np.bool_)
    own[tuple((cells - low).T)] = True
    scene = Scene(oklab_of_srgb(grid.colour[box]), floor - int(low[2]), grid.voxel_m)
    seeds = _seeds(own, labels, owners[box], scene)
    count = int(seeds.max(initial=0))
    if count < 2:
        return np.ones(len(cells), np.int32)
    at = np.argwhere(seeds).astype(np.int32)
    grown = _connected(own, grow(labels, own, at, seeds[tuple(at.T)] - 1))
    return _large_enough(grown[tuple((cells - low).T)])


def _seeds(own: np.ndarray, labels: np.ndarray, owners: np.ndarray, scene: Scene) -> np.ndarray:
    """Return int32 [X, Y, Z]: the numbers of the hosts in the columns that they hold."""
    host = _hosts(own, labels, owners, scene.floor)
    sheets = hung_plans(own, labels, host >= 0, scene)
    hung = np.logical_or.reduce([np.zeros(host.shape, np.bool_), *sheets])
    host = np.where(hung, -1, host)
    stood = host >= 0
    groups = [own & plan[:, :, None] for plan in joined_in_air(sheets, own, stood)]
    for number in np.unique(host[stood]):
        plan = host == number
        if plan.sum() >= LEAST_COLUMNS:
            groups.append(own & plan[:, :, None])
    if sheets:
        groups += _shades(own & ~(hung | stood)[:, :, None], stood, own & hung[:, :, None], scene)
    seeds = np.zeros(own.shape, np.int32)
    for number, cells in enumerate(groups, start=1):
        seeds[cells] = number
    return seeds


def _shades(
    rest: np.ndarray, stood: np.ndarray, hung: np.ndarray, scene: Scene
) -> list[np.ndarray]:
    """Return what floats before a curtain, bool [X, Y, Z] each: a lamp whose post is unseen."""
    pieces, count = connected_parts(rest)
    beside = ndimage.binary_dilation(stood, np.ones((3, 3), np.bool_))[:, :, None]
    curtain = np.median(scene.colour[hung], axis=0)
    found = [pieces == piece for piece in range(1, count + 1)]
    return [
        piece
        for piece in found
        if np.count_nonzero(piece) >= LEAST_SHADE
        and not (piece & beside).any()
        and np.linalg.norm(np.median(scene.colour[piece], axis=0) - curtain) >= UNLIKE
    ]


def _hosts(own: np.ndarray, labels: np.ndarray, owners: np.ndarray, floor: int) -> np.ndarray:
    """Return int64 [X, Y]: what each column stands on: 0 the floor, else an owner; -1 nothing.

    What lies flat on a table may fill the cells of its top; then the top beside it counts.
    """
    object_ = (labels >= OBJECT_CLASSES[0]) & (labels <= OBJECT_CLASSES[-1])
    holder = np.where(object_ & (labels != SemanticClass.OBJS) & (owners > 0), owners, -1)
    holder = np.where(labels == SemanticClass.FLOOR, 0, holder).astype(np.int64)
    host = np.full(own.shape[:2], -1, np.int64)
    for x, y in np.argwhere(own.any(axis=2)):
        first = int(own[x, y].argmax())
        if first - floor < UNDER_CELLS:
            host[x, y] = 0
            continue
        near = (slice(max(x - 1, 0), x + 2), slice(max(y - 1, 0), y + 2))
        below = holder[x, y, max(first - UNDER_CELLS, 0) : first]
        beside = holder[near][:, :, max(first - 1, 0) : first + 1]
        for held in (below[::-1], np.sort(beside.reshape(-1))[::-1]):
            known = held[held >= 0]
            if len(known):
                host[x, y] = known[0]
                break
    return host


def _connected(own: np.ndarray, parts: np.ndarray) -> np.ndarray:
    """Return parts, int32 [X, Y, Z], of which each hangs together: what a curtain joined is two."""
    result = np.zeros_like(parts)
    for number in range(1, int(parts.max(initial=0)) + 1):
        pieces, _ = connected_parts(own & (parts == number))
        result = np.where(pieces > 0, pieces + result.max(), result)
    return result.astype(np.int32)


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
