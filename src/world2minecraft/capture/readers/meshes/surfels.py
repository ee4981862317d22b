"""Estimation of surfels for a point cloud: disc radii from the point spacing, and normals.

Radius and normal are computed from the points in the same grid cell. A flat patch of n points in a
cell of side s has a point spacing of ``s / sqrt(n)``. The normal is the principal axis along which
the points vary least.
"""

from dataclasses import replace

import numpy as np

from world2minecraft.capture.readers.meshes.cloud_splatting import Surfels
from world2minecraft.capture.readers.meshes.mesh_and_cloud import PointCloud
from world2minecraft.geometry.oriented_points import cell_codes

CELLS_M = (0.06, 0.12, 0.24)  # The first that holds enough points is taken.
MIN_POINTS = 6
RADIUS_SHARE = 1.5  # At random places, discs of 1.5 times the spacing leave 0.1 % open.
RADII_M = (0.006, 0.10)
MAX_FLATNESS = 0.25  # Ratio to the second largest spread; above it is an edge or clutter.


def estimate_surfels(cloud: PointCloud) -> Surfels:
    """Return the surfels (discs) of a point cloud in metres."""
    count = len(cloud.points)
    radius = np.full(count, RADII_M[1], np.float32)
    normals = np.zeros((count, 3), np.float32)
    points = cloud.points.copy()
    left = np.arange(count)
    for cell_m in CELLS_M:
        laid, facing, held = _in_cells(cloud.points[left], cell_m)
        chosen = held >= MIN_POINTS
        radius[left[chosen]] = RADIUS_SHARE * cell_m / np.sqrt(held[chosen])
        normals[left[chosen]] = facing[chosen]
        points[left[chosen]] = laid[chosen]
        left = left[~chosen]
        if not len(left):
            break
    return Surfels(replace(cloud, points=points), normals, np.clip(radius, *RADII_M))


def _in_cells(points: np.ndarray, cell_m: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return each point projected to the plane of its cell, its normal and its cell's count.

    Two grids are used, half a cell apart along each axis; each point is assigned to the cell with
    more points, because a cell boundary may divide a noisy wall.
    """
    half = np.float32(cell_m / 2)
    first, second = (_in_grid(points, shift, cell_m) for shift in (np.float32(0), half))
    better = second[2] > first[2]
    return (
        np.where(better[:, None], second[0], first[0]),
        np.where(better[:, None], second[1], first[1]),
        np.where(better, second[2], first[2]),
    )


def _in_grid(
    points: np.ndarray, shift: np.float32, cell_m: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    own, cells = assign_cells(points + shift, cell_m)
    means, facing, held = cell_normals(points, own, cells)
    return _project_to_planes(points, own, means, facing), facing[own], held[own]


def _project_to_planes(
    points: np.ndarray, own: np.ndarray, means: np.ndarray, facing: np.ndarray
) -> np.ndarray:
    """Return points projected onto the planes of their cells, if those are flat.

    All views see the same noise, so fusing many views would not remove it.
    """
    normals = facing[own].astype(np.float64)
    off = np.einsum("na,na->n", points - means[own], normals)
    return (points - off[:, None] * normals).astype(np.float32)


def assign_cells(points: np.ndarray, cell_m: float) -> tuple[np.ndarray, int]:
    """Return the cell number of each point as int64 [N], and the number of occupied cells."""
    if not len(points):
        return np.zeros(0, np.int64), 0
    _, own = np.unique(cell_codes(points, np.float32(cell_m)), return_inverse=True)
    return own, int(own.max()) + 1


def cell_normals(
    points: np.ndarray, own: np.ndarray, cells: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Compute the mean, unit normal and number of the points in each cell.

    Returns:
        The means as float64 [C, 3], the normals as float32 [C, 3] (0 if the points are not in a
        plane) and the counts as float64 [C].
    """
    held = np.bincount(own, minlength=cells).astype(np.float64)
    means = np.stack([np.bincount(own, points[:, a], cells) / held for a in range(3)], axis=1)
    off = points - means[own]
    spread = np.empty((cells, 3, 3))
    for a in range(3):
        for b in range(a, 3):
            spread[:, a, b] = np.bincount(own, off[:, a] * off[:, b], cells) / held
            spread[:, b, a] = spread[:, a, b]
    sizes, axes = np.linalg.eigh(spread)
    flat = sizes[:, 0] < MAX_FLATNESS * sizes[:, 1]
    return means, np.where(flat[:, None], axes[:, :, 0], 0).astype(np.float32), held
