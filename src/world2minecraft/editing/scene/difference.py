"""Differences between a scene and another occupancy grid of the same room."""

from dataclasses import dataclass

import numpy as np

from world2minecraft.core.classes import UNKNOWN
from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import OccupancyGrid
from world2minecraft.editing.scene.scene_draft import SceneDraft


@dataclass(frozen=True, eq=False)
class Difference:
    """Masks of the differences between a scene and another grid, bool [X, Y, Z].

    ``added`` cells are occupied only in the scene, ``removed`` cells only in the other grid, and
    ``changed`` cells in both with different classes. Unobserved cells of the scene count as empty.
    Cells that are unknown in the other grid are in no mask.
    """

    added: np.ndarray
    removed: np.ndarray
    changed: np.ndarray


def compare_labels(labels: np.ndarray, other: np.ndarray) -> Difference:
    """Return the differences between two label arrays of the same shape, uint8 [X, Y, Z]."""
    here, there = labels % UNKNOWN > 0, other % UNKNOWN > 0
    known = other != UNKNOWN
    changed = here & there & (labels != other)
    return Difference(here & ~there & known, there & ~here, changed)


def resample_labels(grid: OccupancyGrid, draft: SceneDraft) -> np.ndarray:
    """Return the labels of a grid resampled to the cells of a scene, uint8 [X, Y, Z].

    Each cell takes the label at its centre, so grids with smaller or shifted cells are accepted.
    Cells outside the grid are 255.

    Raises:
        UsageError: If the cells of the grid are larger than those of the scene, or if the grid does
            not overlap the scene.
    """
    if grid.voxel_m > draft.voxel_m * (1 + 1e-6):
        sizes = f"{grid.voxel_m:g} m, larger than the scene's {draft.voxel_m:g} m"
        raise UsageError(
            f"the voxel size is {sizes}; use a grid with voxels of that size or smaller"
        )
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
            "the grid does not overlap this room; use a grid in the coordinate frame of the scene"
        )
    return np.where(reached, grid.labels[np.ix_(*at)], np.uint8(UNKNOWN))
