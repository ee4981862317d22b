"""Uniform sampling of points and normals on the surface of a mesh or point cloud."""

from dataclasses import dataclass

import numpy as np

from world2minecraft.capture.readers.meshes.mesh_and_cloud import Geometry, Mesh, PointCloud
from world2minecraft.capture.readers.meshes.surfels import assign_cells, cell_normals

MAX_SAMPLES = 60_000
CELLS_ALONG = 48  # Cells along the longest side, for normals: 10 cm in a room of 5 m.
OUTER_SHARE = 0.002  # Share of samples ignored at each end of an axis, as strays.


@dataclass(frozen=True, eq=False)
class SurfaceSamples:
    """Sampled surface points with their normals.

    Attributes:
        points: Positions, float64 [N, 3].
        normals: Unit normals of arbitrary sign, float64 [N, 3]; 0 if unknown.
    """

    points: np.ndarray
    normals: np.ndarray

    def box(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the minimum and maximum corner of the bounding box, without outliers."""
        low, high = np.quantile(self.points, [OUTER_SHARE, 1 - OUTER_SHARE], axis=0)
        return low, high


def sample_surface(geometry: Geometry) -> SurfaceSamples:
    """Return at most ``MAX_SAMPLES`` deterministic samples of a mesh or point cloud."""
    return _sample_mesh(geometry) if isinstance(geometry, Mesh) else _sample_cloud(geometry)


def _sample_mesh(mesh: Mesh) -> SurfaceSamples:
    """Sample triangles in proportion to their area, at low-discrepancy positions."""
    corners = mesh.vertices[mesh.faces].astype(np.float64)
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    twice = np.linalg.norm(cross, axis=1)
    total = twice.cumsum()
    if not len(total) or not total[-1] > 0:
        return SurfaceSamples(np.zeros((0, 3)), np.zeros((0, 3)))
    count = np.arange(MAX_SAMPLES) + 0.5
    face = np.searchsorted(total, count / MAX_SAMPLES * total[-1]).clip(max=len(total) - 1)
    s, t = np.modf(count * 0.7548776662466927)[0], np.modf(count * 0.5698402909980532)[0]
    folded = s + t > 1
    s, t = np.where(folded, 1 - s, s)[:, None], np.where(folded, 1 - t, t)[:, None]
    a, b, c = corners[face, 0], corners[face, 1], corners[face, 2]
    normals = cross[face] / np.maximum(twice[face], 1e-300)[:, None]
    return SurfaceSamples(a + s * (b - a) + t * (c - a), normals)


def _sample_cloud(cloud: PointCloud) -> SurfaceSamples:
    """Sample a cloud by occupied grid cells, so that dense regions have no larger weight."""
    points = cloud.points
    if not len(points):
        return SurfaceSamples(np.zeros((0, 3)), np.zeros((0, 3)))
    low, high = np.quantile(points[:: max(1, len(points) // MAX_SAMPLES)], [0.002, 0.998], axis=0)
    within = ((points >= low - 0.1 * (high - low)) & (points <= high + 0.1 * (high - low))).all(1)
    points = points[within]
    cell = max(float((high - low).max()) / CELLS_ALONG, 1e-9)
    own, count = assign_cells(points, cell)
    means, normals, held = cell_normals(points, own, count)
    normals[held < 4] = 0
    every = max(1, count // MAX_SAMPLES)
    return SurfaceSamples(means[::every], normals[::every].astype(np.float64))
