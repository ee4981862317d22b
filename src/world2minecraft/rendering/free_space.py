"""Observed free space: the cells of air that the rays of a picture have crossed."""

import numpy as np

from world2minecraft.core.jit import lean
from world2minecraft.rendering.ray_caster.ray import (
    away_from_zero,
    first_cell,
    next_cell,
    ray_of_pixel,
)
from world2minecraft.rendering.scene_tables import SceneTables


def observed_free_space(
    tables: SceneTables, pose: np.ndarray, rays: np.ndarray, spread: float, depth: np.ndarray
) -> np.ndarray:
    """Return the cells of air, bool [X, Y, Z], that rays crossed before their first surface.

    Args:
        tables: the scene.
        pose: float64 [3, 4], camera to grid.
        rays: float64 [4], fx, fy, cx, cy in pixels, or pixels a metre for parallel rays.
        spread: 1 for a pinhole camera, 0 for parallel rays.
        depth: float32 [H, W], z-depth in metres, 0 where there is nothing.
    """
    free = np.zeros(tables.space.shape, np.uint8)
    _mark_crossed_cells(tables.space, pose, rays, spread, depth, free)
    first, shape = tables.window
    low, high = first, first + shape
    return free[low[0] : high[0], low[1] : high[1], low[2] : high[2]].view(bool)


@lean
def _mark_crossed_cells(space, pose, rays, spread, depth, free):
    nx, ny, nz = space.shape
    for v in range(depth.shape[0]):
        for u in range(depth.shape[1]):
            x, y = (u + 0.5 - rays[2]) / rays[0], (v + 0.5 - rays[3]) / rays[1]
            ox, oy, oz, dx, dy, dz = ray_of_pixel(pose, x, y, spread)
            dx, dy, dz = away_from_zero(dx), away_from_zero(dy), away_from_zero(dz)
            rx, ry, rz = 1.0 / dx, 1.0 / dy, 1.0 / dz
            t, i, j, k, _ = first_cell(space.shape, ox, oy, oz, dx, dy, dz, rx, ry, rz)
            end = depth[v, u] * (1 - 1e-6) if depth[v, u] > 0 else np.inf
            while i >= 0 and j >= 0 and k >= 0 and i < nx and j < ny and k < nz and t < end:
                if space[i, j, k] >= 0:
                    free[i, j, k] = 1
                t, i, j, k, _ = next_cell(i, j, k, ox, oy, oz, dx, dy, dz, rx, ry, rz)
