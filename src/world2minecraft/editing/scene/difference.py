"""Differences between a scene and another occupancy grid of the same room."""

from dataclasses import dataclass

import numpy as np

from world2minecraft.core.classes import UNKNOWN
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import OccupancyGrid
from world2minecraft.editing.scene.scene_draft import SceneDraft


@dataclass(frozen=True, eq=False)
class Difference:
    """Masks bool [X, Y, Z] of a scene; cells that the other does not know are in none.

    ``added`` are occupied here alone, ``removed`` there alone, ``changed`` in both, with another
    class. A cell that was not seen here counts as empty.
    """

    added: np.ndarray
    removed: np.ndarray
    changed: np.ndarray


def compare_labels(labels: np.ndarray, other: np.ndarray) -> Difference:
    """Return how labels uint8 [X, Y, Z] differ from others of the same shape."""
    here, there = labels % UNKNOWN > 0, other % UNKNOWN > 0
    known = other != UNKNOWN
    changed = here & there & (labels != other)
    return Difference(here & ~there & known, there & ~here, changed)


def resample_labels(grid: OccupancyGrid, draft: SceneDraft) -> np.ndarray:
    """Return the labels of a grid, uint8 [X, Y, Z], in the cells of a scene.

    A cell takes the label at its centre, so that a grid with smaller cells, or with the same ones
    elsewhere, is read too; where the grid does not reach it is 255.

    Raises:
        UsageError: its cells are larger than the scene's, or it does not meet the scene.
    """
    if grid.voxel_m > draft.voxel_m * (1 + 1e-6):
        sizes = f"{grid.voxel_m:g} m, larger than the scene's {draft.voxel_m:g} m"
        raise UsageError(f"its voxel size is {sizes}; use a grid with voxels of that size or less")
    at, inside = [], []
    for axis in range(3):
        middles_m = draft.origin_m[axis] + (np.arange(draft.shape[axis]) + 0.5) * draft.voxel_m
        cells = np.floor((middles_m - grid.origin_m[axis]) / grid.voxel_m).astype(np.int64)
        inside.append((cells >= 0) & (cells < grid.shape[axis]))
        at.append(np.clip(cells, 0, grid.shape[axis] - 1))
    x, y, z = inside
    reached = x[:, None, None] & y[None, :, None] & z[None, None, :]
    if not reached.any():
        raise UsageError(
            "it does not overlap this room; use a grid in the coordinate frame of the scene"
        )
    return np.where(reached, grid.labels[np.ix_(*at)], np.uint8(UNKNOWN))
