"""Sloped ceilings: undersides of a roof, planes that rise from a wall towards the room.

A slope is seen from below, and no ray passes above it. Its height increases linearly along one
axis. For each roof, the slope with the most points in one plane is used.
"""

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from world2minecraft.geometry.histogram_peaks import highest_peak
from world2minecraft.reconstruction.layout.parameters import StructureParameters
from world2minecraft.reconstruction.layout.surface_cells import Surface

STEEPNESS_DEG = np.arange(20.0, 62.0, 2.0)
MAX_ROOFS = 4


@dataclass(frozen=True, eq=False)
class Roof:
    """The plane of the points p with ``p @ normal == offset_m``."""

    normal: np.ndarray  # float64 [3]
    offset_m: float


def find_slopes(surface: Surface, level: np.ndarray, parameters: StructureParameters) -> np.ndarray:
    """Return the mask of the cells of sloped ceilings, bool [X, Y, Z].

    Args:
        surface: Surface of the storey.
        level: Mask of the cells of floor and flat ceiling, bool [X, Y, Z].
        parameters: Thresholds.
    """
    cells = np.zeros(surface.occupied.shape, bool)
    at = np.argwhere(_under_roof(surface, parameters) & ~level)
    points = surface.points_m[tuple(at.T)].astype(np.float64)
    for _ in range(MAX_ROOFS):
        roof = _largest_roof(points, surface.voxel_m, parameters)
        if roof is None:
            break
        near = np.abs(points @ roof.normal - roof.offset_m) <= parameters.plane_gate_m
        seen = np.zeros_like(cells)
        seen[tuple(at[near].T)] = True
        # A plane that runs askew through the cells touches some from the side alone; along the
        # ridge it goes on into the gable, which is wall.
        across = np.ones((3, 1, 3) if roof.normal[0] else (1, 3, 3), bool)
        around = ndimage.binary_dilation(seen, across) & surface.occupied & ~level
        around = np.argwhere(around)
        off_m = surface.points_m[tuple(around.T)] @ roof.normal - roof.offset_m
        cells[tuple(around[np.abs(off_m) <= parameters.plane_gate_m].T)] = True
        at, points = at[~near], points[~near]
    return cells


def _under_roof(surface: Surface, parameters: StructureParameters) -> np.ndarray:
    """Return the cells seen from below without free cells above."""
    free_above = np.zeros_like(surface.free)
    free_above[:, :, :-1] = np.logical_or.accumulate(surface.free[:, :, :0:-1], axis=2)[:, :, ::-1]
    below = np.zeros_like(surface.free)
    below[:, :, 1:] = surface.free[:, :, :-1]
    below[:, :, 2:] |= surface.free[:, :, :-2]
    high = surface.points_m[..., 2] >= parameters.roof_bottom_m
    return surface.occupied & below & ~free_above & high


def _largest_roof(
    points: np.ndarray, voxel_m: float, parameters: StructureParameters
) -> Roof | None:
    """Return the plane with the most points, float [N, 3], or None if all have too few."""
    best, best_count = None, parameters.roof_area_m2 / voxel_m**2
    if len(points) < best_count:
        return None
    for degrees in STEEPNESS_DEG:
        sine, cosine = np.sin(np.radians(degrees)), np.cos(np.radians(degrees))
        for axis, sign in ((0, 1), (0, -1), (1, 1), (1, -1)):
            normal = np.array([0.0, 0.0, cosine])
            normal[axis] = -sign * sine
            height = points @ normal
            peak, count = highest_peak(height, parameters.plane_gate_m)
            if count <= best_count:
                continue
            near = np.abs(height - peak) <= parameters.plane_gate_m
            if _is_wide(points[near], axis, parameters):
                best, best_count = Roof(normal, peak), count
    return best


def _is_wide(points: np.ndarray, axis: int, parameters: StructureParameters) -> bool:
    """Return whether points extend far enough along the ridge and up the slope."""
    low, high = np.quantile(points, [0.05, 0.95], axis=0)
    side = (high - low)[1 - axis]
    return bool(side >= parameters.roof_length_m and (high - low)[2] >= parameters.roof_rise_m)
