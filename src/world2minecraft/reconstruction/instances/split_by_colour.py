"""Split small objects next to each other on one support by colour, such as a ball and bricks.

Parts of different colour above each other stay together: the foot and shade of a lamp, a pot and
its leaves, a pile of books.
"""

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import OccupancyGrid
from world2minecraft.geometry.colour import srgb_to_oklab
from world2minecraft.reconstruction.instances.density_clustering import (
    assign_voxels,
    joined_parts,
)
from world2minecraft.reconstruction.instances.object_voxels import split_owners
from world2minecraft.reconstruction.instances.parameters import InstanceParameters

MAX_COLOUR_DIFFERENCE = 0.12  # Neighbouring cells of one paint differ by less, in Oklab.
MIN_CELLS = 5  # Minimum size of a patch that becomes an object.
MIN_WIDTH_M = 0.4  # Narrower clusters are not split.
MIN_SHARED_PLAN = 0.34  # The share of the smaller plan that lies over or under the other.
STEPS = np.array([(1, 0, 0), (0, 1, 0), (0, 0, 1)])


def split_by_colour(
    owners: np.ndarray, grid: OccupancyGrid, _parameters: InstanceParameters
) -> np.ndarray:
    """Return owners, int32 [X, Y, Z], with separate numbers for small objects of other colours."""

    def parts_of(cells: np.ndarray) -> np.ndarray | None:
        width_m = (np.ptp(cells[:, :2], axis=0).max() + 1) * grid.voxel_m
        return None if width_m <= MIN_WIDTH_M else _part_of_cells(cells, grid)

    return split_owners(owners, grid.labels, SemanticClass.OBJS, parts_of)


def _part_of_cells(cells: np.ndarray, grid: OccupancyGrid) -> np.ndarray:
    """Return the part of each cell, int32 [N] from 1."""
    low = cells.min(axis=0)
    shape = cells.max(axis=0) + 1 - low
    own = np.zeros(shape, np.bool_)
    at = tuple((cells - low).T)
    own[at] = True
    colour = np.zeros((*shape, 3))
    colour[at] = srgb_to_oklab(grid.colour[tuple(cells.T)])
    patches = _colour_patches(own, colour)
    joined = _merge_stacked_patches(patches)
    if joined.max(initial=0) < 2:
        return np.ones(len(cells), np.int32)
    seeds = np.argwhere(joined).astype(np.int32)
    labels = own.astype(np.uint8)
    grown = assign_voxels(labels, own, seeds, joined[tuple(seeds.T)] - 1)[at]
    return np.maximum(grown, 1).astype(np.int32)


def _colour_patches(own: np.ndarray, colour: np.ndarray) -> np.ndarray:
    """Label the large patches of neighbouring cells of similar colour, int32 [X, Y, Z] from 1."""
    index = np.arange(own.size).reshape(own.shape)
    pairs = []
    for step in STEPS:
        near = tuple(slice(None, -1) if s else slice(None) for s in step)
        far = tuple(slice(1, None) if s else slice(None) for s in step)
        alike = np.linalg.norm(colour[near] - colour[far], axis=-1) < MAX_COLOUR_DIFFERENCE
        alike &= own[near] & own[far]
        pairs.append(np.stack([index[near][alike], index[far][alike]]))
    number = joined_parts(np.concatenate(pairs, axis=1), own.size).reshape(own.shape)
    counts = np.bincount(number[own], minlength=int(number.max()) + 1)
    retained = np.flatnonzero(counts >= MIN_CELLS)
    place = np.zeros(len(counts), np.int32)
    place[retained] = np.arange(1, len(retained) + 1)
    return np.where(own, place[number], 0).astype(np.int32)


def _merge_stacked_patches(patches: np.ndarray) -> np.ndarray:
    """Return patches, renumbered, in which patches that share much of their plan are merged."""
    result = patches.copy()
    while True:
        count = int(result.max(initial=0))
        plans = [(result == n).any(axis=2) for n in range(1, count + 1)]
        pair = _first_overlapping_pair(plans)
        if pair is None:
            return result
        low, high = pair
        result[result == high] = low
        result[result > high] -= 1


def _first_overlapping_pair(plans: list[np.ndarray]) -> tuple[int, int] | None:
    for high in range(1, len(plans)):
        for low in range(high):
            shared = np.count_nonzero(plans[low] & plans[high])
            if shared >= MIN_SHARED_PLAN * min(plans[low].sum(), plans[high].sum()):
                return low + 1, high + 1
    return None
