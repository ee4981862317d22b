"""Cupboards in a row, told apart where one hangs over another or is clearly taller."""

from itertools import pairwise

import numpy as np
from scipy import ndimage
from scipy.spatial import KDTree

from world2minecraft.classes import SemanticClass
from world2minecraft.geometry.parts import connected_parts

LONG_M = 1.2  # Shorter furniture is one piece.
STEP_M = 0.3  # Tops that differ by less are one row: a counter with a hob, things on a board.
LEAST_CELLS = 40  # A piece of fewer cells is no cupboard: at 0.08 m, a front of 0.5 m side.
LEAST_M2 = 0.05  # Of the plan: a cupboard's front, one cell deep.
THIN_LAYER = 0.35  # A layer with less of the plan than this parts what hangs from what stands.


def part_rows(owners: np.ndarray, labels: np.ndarray, voxel_m: float) -> np.ndarray:
    """Return owners, int32 [X, Y, Z], in which cupboards of other heights have own numbers."""
    result = owners.copy()
    fresh = int(owners.max(initial=0))
    furniture = labels == SemanticClass.FURN
    for number in np.unique(owners[furniture & (owners > 0)]):
        cells = np.argwhere((owners == number) & furniture)
        if (np.ptp(cells[:, :2], axis=0).max() + 1) * voxel_m < LONG_M:
            continue
        parts = _parts(cells, voxel_m)
        moved = parts > 0
        result[tuple(cells[moved].T)] = fresh + parts[moved]
        fresh += int(parts.max())
    return result


def _parts(cells: np.ndarray, voxel_m: float) -> np.ndarray:
    """Return the part, int32 [N] from 0, of each cell; all 0 where they are one piece."""
    low = cells.min(axis=0)
    own = np.zeros(np.ptp(cells, axis=0) + 1, np.bool_)
    own[tuple((cells - low).T)] = True
    seeds = np.zeros(own.shape, np.int32)
    for bottom, top in _storeys(own):
        storey = np.zeros_like(own)
        storey[:, :, bottom:top] = own[:, :, bottom:top]
        for plan in _levels(storey, voxel_m):
            mask = storey & plan[:, :, None]
            if mask.sum() >= LEAST_CELLS:
                seeds[mask] = seeds.max() + 1
    if seeds.max() < 2:
        return np.zeros(len(cells), np.int32)
    placed = np.argwhere(seeds)
    own_seed = seeds[tuple(placed.T)]
    _, nearest = KDTree(placed).query(cells - low)
    parts = seeds[tuple((cells - low).T)]
    return np.where(parts > 0, parts, own_seed[nearest]).astype(np.int32) - 1


def _storeys(own: np.ndarray) -> list[tuple[int, int]]:
    """Return the first layer and the one past the last of what stands and what hangs over it."""
    # A scan shows shells: a ring is as full as the board that lies on it.
    full = np.empty_like(own)
    for k in range(own.shape[2]):
        ndimage.binary_fill_holes(own[:, :, k], output=full[:, :, k])
    area = full.sum(axis=(0, 1))
    cuts = [0]
    for k in range(2, len(area) - 2):
        limit = THIN_LAYER * min(area[:k].max(), area[k + 1 :].max())
        if area[k] < limit <= area[k + 1] and k - cuts[-1] >= 2:
            cuts.append(k + 1)
    return list(zip(cuts, [*cuts[1:], len(area)], strict=True))


def _levels(storey: np.ndarray, voxel_m: float) -> list[np.ndarray]:
    """Return plans, bool [X, Y], of the pieces of a storey, each of about one height."""
    top = (storey * np.arange(1, storey.shape[2] + 1)).max(axis=2)
    heights = _heights(top[top > 0], STEP_M / voxel_m)
    plans = []
    for first, last in zip(heights, [*heights[1:], storey.shape[2] + 1], strict=True):
        pieces, count = connected_parts((top >= first) & (top < last))
        for piece in range(1, count + 1):
            plan = pieces == piece
            if plan.sum() * voxel_m**2 >= LEAST_M2:
                plans.append(plan)
    return plans


def _heights(tops: np.ndarray, step: float) -> list[int]:
    """Return the lowest top of each group; between groups lie heights that few columns have."""
    values = np.sort(tops)
    bounds = [int(values[0])] if len(values) else []
    counts = np.bincount(values)
    common = np.flatnonzero(counts >= 0.1 * len(values))
    for below, above in pairwise(common.tolist()):
        if above - below >= step:
            bounds.append(int((below + above + 1) // 2))
    return bounds
