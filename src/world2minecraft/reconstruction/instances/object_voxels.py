"""The voxels of single objects, each in a small box to avoid passes over the whole grid."""

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import OccupancyGrid
from world2minecraft.geometry.colour import srgb_to_oklab

STANDING = (SemanticClass.CHAIR, SemanticClass.BED, SemanticClass.SOFA, SemanticClass.TABLE)
COLOUR_WEIGHTS = np.sqrt([0.4, 1.0, 1.0])  # Objects and walls are lit unevenly.
FLOOR_SEARCH_CELLS = 6  # The floor beside a cupboard is seen, the floor under it is not.
MIN_FLOOR_CELLS = 4


def cells_by_owner(
    owners: np.ndarray, labels: np.ndarray, class_id: int
) -> Iterator[tuple[int, np.ndarray]]:
    """Yield each owner of a class and its cells, int64 [N, 3], ordered by owner.

    Args:
        owners: Owner of each cell, int32 [X, Y, Z]; 0 is none.
        labels: Class of each cell, uint8 [X, Y, Z].
        class_id: Class of the objects.
    """
    cells = np.argwhere((labels == class_id) & (owners > 0))
    numbers = owners[tuple(cells.T)]
    order = np.argsort(numbers, kind="stable")
    found, starts = np.unique(numbers[order], return_index=True)
    yield from zip(found.tolist(), np.split(cells[order], starts[1:]), strict=False)


def split_owners(
    owners: np.ndarray,
    labels: np.ndarray,
    class_id: int,
    parts_of: Callable[[np.ndarray], np.ndarray | None],
) -> np.ndarray:
    """Return owners, int32 [X, Y, Z], with new numbers for the parts of the objects of a class.

    Args:
        owners: Owner of each cell, int32 [X, Y, Z]; 0 is none.
        labels: Class of each cell, uint8 [X, Y, Z].
        class_id: Class of the objects.
        parts_of: Function from the cells of an object, int64 [N, 3], to the part of each, int [N]
            from 1, of which the first keeps the number; None keeps the object.
    """
    result = owners.copy()
    next_id = int(owners.max(initial=0))
    for _, cells in cells_by_owner(owners, labels, class_id):
        parts = parts_of(cells)
        if parts is None:
            continue
        moved = parts > 1
        result[tuple(cells[moved].T)] = next_id + parts[moved] - 1
        next_id += max(int(parts.max()) - 1, 0)
    return result


def colour_distance(one: np.ndarray, other: np.ndarray) -> float:
    """Return the weighted Oklab distance of the medians of sRGB colours, uint8 [N, 3] each.

    Cells without a colour, which are black, do not count. Without any other, it is infinite.
    """
    one, other = one[one.any(axis=1)], other[other.any(axis=1)]
    if not len(one) or not len(other):
        return np.inf
    apart = np.median(srgb_to_oklab(one), axis=0) - np.median(srgb_to_oklab(other), axis=0)
    return float(np.linalg.norm(apart * COLOUR_WEIGHTS))


class ObjectVoxels(NamedTuple):
    """The cells of an object in their bounding box.

    Attributes:
        own: Mask of the object's cells, bool [X, Y, Z].
        free: Mask of the cells seen as empty, bool [X, Y, Z].
        colour: sRGB colours, uint8 [X, Y, Z, 3].
        low: Index of the first cell of the box in the grid, int64 [3].
        floor: Layer of the box directly above the floor; may be outside the box.
        voxel_m: Cell size in metres.
    """

    own: np.ndarray
    free: np.ndarray
    colour: np.ndarray
    low: np.ndarray
    floor: int
    voxel_m: float

    def only(self, own: np.ndarray) -> "ObjectVoxels":
        """Return the voxels with some of the object's cells, bool [X, Y, Z], in the same box."""
        return self._replace(own=own)

    def cells_of(self, length_m: float) -> int:
        """Return the number of cells that a length spans, at least 1."""
        return max(1, int(length_m / self.voxel_m + 0.5))


def main_floor_layer(grid: OccupancyGrid) -> int:
    """Return the layer directly above the room's main floor, whose top is z = 0."""
    return max(int(np.floor(-grid.origin_m[2] / grid.voxel_m + 0.5)), 0)


def floor_layer_below(cells: np.ndarray, grid: OccupancyGrid) -> int:
    """Return the layer directly above the floor under an object of cells int [N, 3].

    In a house with several storeys this is the highest floor under or next to the object, or the
    main floor if none was seen.
    """
    low = np.maximum(cells[:, :2].min(axis=0) - FLOOR_SEARCH_CELLS, 0)
    high = cells[:, :2].max(axis=0) + 1 + FLOOR_SEARCH_CELLS
    top = int(cells[:, 2].min()) + 2
    around = grid.labels[low[0] : high[0], low[1] : high[1], :top] == SemanticClass.FLOOR
    counts = np.count_nonzero(around, axis=(0, 1))
    layers = np.flatnonzero(counts >= max(MIN_FLOOR_CELLS, counts.max(initial=0) / 2))
    return int(layers[-1]) + 1 if len(layers) else main_floor_layer(grid)


def object_voxels(grid: OccupancyGrid, cells: np.ndarray) -> ObjectVoxels:
    """Return the box of voxels around cells int [N, 3]."""
    low, high = cells.min(axis=0).astype(np.int64), cells.max(axis=0) + 1
    box = tuple(slice(int(a), int(b)) for a, b in zip(low, high, strict=True))
    own = np.zeros(high - low, np.bool_)
    own[tuple((cells - low).T)] = True
    floor = floor_layer_below(cells, grid)
    return ObjectVoxels(
        own, grid.labels[box] == 0, grid.colour[box], low, floor - int(low[2]), grid.voxel_m
    )
