"""Things in walls that the segmentation network names: cabinets, blinds, doors, mirrors.

Labels of cells prefer walls, so that papers and switches on a wall do not become blocks in front of
it. Large flat parts of a wall that enough votes name get the class of that name.
"""

from dataclasses import replace

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import OccupancyGrid
from world2minecraft.core.vocabulary import nyu40_classes, nyu40_names
from world2minecraft.geometry.connected_components import label_components
from world2minecraft.reconstruction.naming.name_votes import (
    CUBE_M,
    CubeIndex,
    NameVotes,
    class_votes,
)
from world2minecraft.reconstruction.semantics.votes_labeller import is_from_network

# Classes that pass for each other, and the least share of their votes. Of the cells of walls in 53
# labelled frames of NYUv2 with such votes, 0.93 to 0.99 are of the class of blinds, 0.78 to 1.0 of
# that of cabinets, and 0.80 of that of doors, which with 0.4 to 0.6 of the votes are 0.33.
THINGS = (
    (("blinds", "curtain", "shower curtain"), 0.4),
    (("cabinet", "counter", "dresser", "bookshelf", "shelves", "refrigerator"), 0.5),
    (("door",), 0.6),
    (("mirror",), 0.5),
    (("whiteboard",), 0.5),
)
MIN_AREA_M2 = 0.15  # A kitchen has smaller parts between its papers that are none of these.


def label_wall_things(grid: OccupancyGrid, votes: NameVotes) -> OccupancyGrid:
    """Return the grid in which cells of walls have the class of the thing that votes name.

    Args:
        grid: Labelled grid.
        votes: Votes for names in the room. Those of label images change nothing, since cells
            already follow them.
    """
    walls = np.argwhere(grid.labels == SemanticClass.WALL)
    middles_m = grid.origin_m + (walls + 0.5) * grid.voxel_m
    rows = CubeIndex(votes.cubes).find(np.floor(middles_m / CUBE_M).astype(np.int64))
    walls, rows = walls[rows >= 0], rows[rows >= 0]
    from_network = is_from_network(votes.votes[rows])
    walls, rows = walls[from_network], rows[from_network]
    shares = class_votes(votes.votes[rows])
    shares /= np.maximum(shares.sum(axis=1, keepdims=True), 1e-6)
    labels, confidence = grid.labels.copy(), grid.confidence.copy()
    for names, least in THINGS:
        ids = [nyu40_names()[name] for name in names]
        share = shares[:, np.array(ids) - 1].sum(axis=1)
        sure = share >= least
        large = _in_large_parts(walls[sure], grid)
        at = tuple(walls[sure][large].T)
        labels[at], confidence[at] = nyu40_classes()[ids[0]], share[sure][large]
    return replace(grid, labels=labels, confidence=confidence)


def _in_large_parts(cells: np.ndarray, grid: OccupancyGrid) -> np.ndarray:
    """Return which cells, int64 [N, 3], belong to a connected part of ``MIN_AREA_M2``."""
    mask = np.zeros(grid.shape, bool)
    mask[tuple(cells.T)] = True
    parts, _ = label_components(mask)
    sizes = np.bincount(parts.reshape(-1))
    return sizes[parts[tuple(cells.T)]] * grid.voxel_m**2 >= MIN_AREA_M2
