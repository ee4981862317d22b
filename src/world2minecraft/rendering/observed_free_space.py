"""Observed free space: the air cells that the rays of an image cross."""

import numpy as np

from world2minecraft.core.jit import lean
from world2minecraft.rendering.ray_caster.ray import (
    GridCamera,
    first_cell,
    next_cell,
    ray_of_camera,
)
from world2minecraft.rendering.scene_tables import SceneTables


def observed_free_space(tables: SceneTables, camera: GridCamera, depth: np.ndarray) -> np.ndarray:
    """Return the air cells that rays crossed before their first surface, as bool [X, Y, Z].

    Args:
        tables: The scene.
        camera: Camera of the rays, in grid coordinates.
        depth: z-depth in metres, float32 [H, W], 0 without a surface.
    """
    free = np.zeros(tables.space.shape, np.uint8)
    _mark_crossed_cells(tables.space, camera, depth, free)
    first, shape = tables.window
    low, high = first, first + shape
    return free[low[0] : high[0], low[1] : high[1], low[2] : high[2]].view(bool)


@lean
def _mark_crossed_cells(space, camera, depth, free):
    nx, ny, nz = space.shape
    for v in range(depth.shape[0]):
        for u in range(depth.shape[1]):
            ray = ray_of_camera(camera, u + 0.5, v + 0.5)
            t, i, j, k, _, _ = first_cell(space.shape, ray)
            end = depth[v, u] * (1 - 1e-6) if depth[v, u] > 0 else np.inf
            while i >= 0 and j >= 0 and k >= 0 and i < nx and j < ny and k < nz and t < end:
                if space[i, j, k] >= 0:
                    free[i, j, k] = 1
                t, i, j, k, _ = next_cell(i, j, k, ray)
