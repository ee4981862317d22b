"""Grids made of labels alone."""

import numpy as np

from world2minecraft.core.types import OccupancyGrid


def grid_of(labels: np.ndarray) -> OccupancyGrid:
    """Return a grid of labels alone, the floor's top after layer 0."""
    return OccupancyGrid(
        labels=labels,
        confidence=np.full(labels.shape, 0.5, np.float16),
        colour=np.zeros((*labels.shape, 3), np.uint8),
        source=(labels != 255).astype(np.uint8),
        instance=np.zeros(labels.shape, np.uint16),
        voxel_m=0.08,
        origin_m=np.array([0.0, 0.0, -0.08]),
    )
