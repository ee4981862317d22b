"""Furniture that stands in a row, told apart.

What hangs is parted from what stands, what is taller from what is lower, each arm of an L from the
other, and along an arm what looks different from its neighbour.

In: owners from the clusters. Out: owners in which each cupboard has a number of its own. The paper
has no such step: its clusters take a whole kitchen for one object.
"""

import numpy as np
from scipy.spatial import KDTree

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import OccupancyGrid
from world2minecraft.reconstruction.instances.absorb import absorbed
from world2minecraft.reconstruction.instances.arms import arms
from world2minecraft.reconstruction.instances.hanging import hung_cells
from world2minecraft.reconstruction.instances.heap import Heap, heap_of
from world2minecraft.reconstruction.instances.levels import levels
from world2minecraft.reconstruction.instances.owned import cells_by_owner
from world2minecraft.reconstruction.instances.seams import seams

LONG_M = 0.9  # Shorter furniture is one piece.


def part_rows(owners: np.ndarray, grid: OccupancyGrid) -> np.ndarray:
    """Return owners, int32 [X, Y, Z], in which cupboards of a row have own numbers."""
    result = owners.copy()
    fresh = int(owners.max(initial=0))
    for _, cells in cells_by_owner(owners, grid.labels, SemanticClass.FURN):
        size_m = (np.ptp(cells, axis=0) + 1) * grid.voxel_m
        if size_m[:2].max() < LONG_M:
            continue
        parts = pieces(heap_of(grid, cells))[tuple((cells - cells.min(axis=0)).T)]
        moved = parts > 1
        result[tuple(cells[moved].T)] = fresh + parts[moved] - 1
        fresh += int(parts.max()) - 1
    return result


def pieces(heap: Heap) -> np.ndarray:
    """Return the piece, int32 [X, Y, Z] from 1, of each own cell; 0 elsewhere."""
    seeds = np.zeros(heap.own.shape, np.int32)
    hung = hung_cells(heap)
    for storey in (heap.own & ~hung, hung):
        for level in levels(heap.only(storey)):
            for arm in arms(level, heap):
                for piece in seams(heap.only(storey & arm[:, :, None])):
                    seeds[piece] = seeds.max() + 1
    return absorbed(_to_nearest(heap.own, seeds), heap)


def _to_nearest(own: np.ndarray, seeds: np.ndarray) -> np.ndarray:
    """Give every own cell the number of its seed, or of the nearest one; of equals the lowest."""
    if seeds.max(initial=0) < 2:
        return own.astype(np.int32)
    loose = np.argwhere(own & (seeds == 0))
    if not len(loose):
        return seeds
    placed = np.argwhere(seeds)
    numbers = seeds[tuple(placed.T)]
    order = np.argsort(numbers, kind="stable")
    distance, nearest = KDTree(placed[order]).query(loose, k=min(4, len(placed)))
    distance, nearest = distance.reshape(len(loose), -1), nearest.reshape(len(loose), -1)
    tied = np.round(distance, 9) <= np.round(distance[:, :1], 9)
    claims = np.where(tied, numbers[order][nearest], seeds.max() + 1)
    seeds[tuple(loose.T)] = claims.min(axis=1)
    return seeds
