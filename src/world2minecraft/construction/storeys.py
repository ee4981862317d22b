"""The storeys of a house: the heights of their floors and their layers of blocks.

The floor of the ground storey is always layer 63. An upper storey is a level floor of sufficient
size at least a room's height above the storey below; its floor is the layer of blocks closest to
its surface.
"""

from dataclasses import replace

import numpy as np

from world2minecraft.construction.block_lattice import Lattice
from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import OccupancyGrid

MIN_HEIGHT_M = 1.9  # Between two floors: under a loft one still has to stand.
MIN_AREA_M2 = 2.0
MIN_SHARE = 0.15  # Minimum area, as a share of the largest floor; excludes podiums.
SLAB_M = 0.4  # Layers of one floor lie no farther apart.
MIN_BLOCKS = 3  # A floor, and two blocks to stand in.


def upper_floors_m(grid: OccupancyGrid) -> list[float]:
    """Return the heights of the upper storeys' floors in metres, in increasing order.

    The surface of a floor is the top of the highest full layer of its cells, since slabs are thick.
    """
    area_m2 = (grid.labels == SemanticClass.FLOOR).sum(axis=(0, 1)) * grid.voxel_m**2
    tops_m = grid.origin_m[2] + np.arange(1, grid.shape[2] + 1) * grid.voxel_m
    least = max(MIN_AREA_M2, MIN_SHARE * float(area_m2.max(initial=0)))
    layers = np.flatnonzero(area_m2 >= least)
    levels = [0.0]
    for slab in np.split(layers, np.flatnonzero(np.diff(tops_m[layers]) > SLAB_M) + 1):
        if not len(slab):
            continue
        full = slab[area_m2[slab] >= 0.5 * area_m2[slab].max()]
        top = float(tops_m[full[-1]])
        if top - levels[-1] >= MIN_HEIGHT_M:
            levels.append(top)
    return levels[1:]


def add_storeys(lattice: Lattice, grid: OccupancyGrid) -> Lattice:
    """Return the lattice with the first layers of the upper storeys found in the grid."""
    grounds: list[int] = []
    for height_m in upper_floors_m(grid):
        level = lattice.ground + round(height_m * lattice.blocks_per_metre)
        below = grounds[-1] if grounds else lattice.ground
        level = max(level, below + MIN_BLOCKS)
        if level < lattice.shape[2]:
            grounds.append(level)
    return replace(lattice, upper=tuple(grounds))
