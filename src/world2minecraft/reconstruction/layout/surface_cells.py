"""The input of the geometric labeller: occupied and free cells, and their mean surface points."""

from dataclasses import dataclass, replace

import numpy as np

from world2minecraft.core.coordinates import cell_centers_m
from world2minecraft.core.types import FusedEvidence, OccupancyGrid
from world2minecraft.geometry.colour import srgb_to_oklab


@dataclass(frozen=True, eq=False)
class Surface:
    """The observed surface of a room in its cells.

    ``points_m`` is the mean surface point of each occupied cell in the room frame, which locates a
    plane to one or two centimetres, compared to eight for the cell itself.
    """

    occupied: np.ndarray  # bool [X, Y, Z]
    free: np.ndarray  # bool [X, Y, Z]
    points_m: np.ndarray  # float32 [X, Y, Z, 3]
    hits: np.ndarray  # float32 [X, Y, Z]: the points behind each mean, at least 1; 0 not occupied
    oklab: np.ndarray  # float32 [X, Y, Z, 3], 0 where not occupied
    voxel_m: float
    origin_m: np.ndarray

    @property
    def floor_layer(self) -> int:
        """The index of the layer whose top is z = 0; may be outside the grid."""
        return round(-self.origin_m[2] / self.voxel_m) - 1

    def columns(self, x: slice, y: slice) -> "Surface":
        """Return the part of the surface in a box of columns."""
        arrays = ("occupied", "free", "points_m", "hits", "oklab")
        corner = self.origin_m + np.array([x.start, y.start, 0.0]) * self.voxel_m
        cut = {name: getattr(self, name)[x, y] for name in arrays}
        return replace(self, origin_m=corner, **cut)

    def cells_of(self, length_m: float) -> int:
        """Return a length in whole cells, at least 1."""
        return max(round(length_m / self.voxel_m), 1)

    def layers_below(self, height_m: float) -> int:
        """Return the number of layers of the grid whose centre is below a height."""
        cells = np.ceil((height_m - self.origin_m[2]) / self.voxel_m - 0.5 - 1e-9)
        return int(np.clip(cells, 0, self.occupied.shape[2]))


def surface_of(grid: OccupancyGrid, evidence: FusedEvidence) -> Surface:
    """Combine a grid and its evidence into the observed surface of the room.

    Raises:
        ValueError: If grid and evidence do not have the same cells.
    """
    same = grid.shape == evidence.log_odds.shape and grid.voxel_m == evidence.voxel_m
    if not (same and np.allclose(grid.origin_m, evidence.origin_m, atol=1e-9)):
        raise ValueError(
            "grid and evidence must have the same shape and origin, got "
            f"{grid.shape} at {grid.origin_m.tolist()} and "
            f"{evidence.log_odds.shape} at {evidence.origin_m.tolist()}"
        )
    occupied = grid.occupied
    cells = np.argwhere(occupied)
    at = tuple(cells.T)
    hits = np.maximum(evidence.hits[at], 1)[:, None]
    points = np.zeros((*grid.shape, 3), np.float32)
    points[at] = cell_centers_m(cells, grid.origin_m, grid.voxel_m) + evidence.offset_sum[at] / hits
    oklab = np.zeros((*grid.shape, 3), np.float32)
    oklab[at] = srgb_to_oklab(grid.colour[at])
    weight = np.where(occupied, np.maximum(evidence.hits, 1), 0).astype(np.float32)
    return Surface(occupied, grid.labels == 0, points, weight, oklab, grid.voxel_m, grid.origin_m)


def turn_surface(values: np.ndarray, axis: int, sign: int) -> np.ndarray:
    """Return a view of an array [X, Y, Z] whose axis 0 points along an axis, or against it.

    The other two axes keep their order: along a wall, then up; for floors and ceilings x, then y.
    """
    return np.moveaxis(values, axis, 0)[::sign]
