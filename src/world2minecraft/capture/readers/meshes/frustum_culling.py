"""Frustum culling: divides meshes and surfels into blocks with bounding spheres."""

from dataclasses import dataclass, replace

import numpy as np

from world2minecraft.capture.readers.meshes.mesh_and_cloud import Mesh, PointCloud
from world2minecraft.capture.readers.meshes.surfels import Surfels, assign_cells
from world2minecraft.core.types import Camera

BLOCK_M = 0.5


@dataclass(frozen=True, eq=False)
class Blocks:
    """Spatial blocks of triangles or points, each with a bounding sphere.

    Attributes:
        starts: First element of each block, int64 [B + 1]; block b ends before ``starts[b + 1]``.
        middles_m: Centres of the bounding spheres in metres, float64 [B, 3].
        radii_m: Radii of the bounding spheres in metres, float64 [B].
    """

    starts: np.ndarray
    middles_m: np.ndarray
    radii_m: np.ndarray

    def runs(self, camera: Camera, world_to_camera: np.ndarray) -> np.ndarray:
        """Return the index ranges of blocks that may be visible to a camera, as int64 [R, 2]."""
        middles = self.middles_m @ world_to_camera[:3, :3].T + world_to_camera[:3, 3]
        seen = middles[:, 2] > -self.radii_m
        left, right = camera.cx_px / camera.fx_px, (camera.width_px - camera.cx_px) / camera.fx_px
        over, below = camera.cy_px / camera.fy_px, (camera.height_px - camera.cy_px) / camera.fy_px
        for axis, sign, slope in ((0, -1, left), (0, 1, right), (1, -1, over), (1, 1, below)):
            beyond = (sign * middles[:, axis] - slope * middles[:, 2]) / np.hypot(1, slope)
            seen &= beyond < self.radii_m
        return np.stack([self.starts[:-1][seen], self.starts[1:][seen]], axis=1)


def whole(count: int) -> np.ndarray:
    """Return a single index range that covers all elements, as int64 [1, 2]."""
    return np.array([[0, count]], np.int64)


def sort_mesh_into_blocks(mesh: Mesh) -> tuple[Mesh, Blocks]:
    """Sort the triangles of a mesh in metres by block. Return the new mesh and its blocks."""
    middles = mesh.vertices[mesh.faces].mean(axis=1)
    order, starts = _block_order(middles)
    faces = mesh.faces[order]
    sorted_mesh = replace(
        mesh,
        faces=faces,
        face_image=None if mesh.face_image is None else mesh.face_image[order],
        labels=None if mesh.labels is None else mesh.labels[order],
    )
    low = np.minimum.reduceat(mesh.vertices[faces].min(axis=1), starts[:-1])
    high = np.maximum.reduceat(mesh.vertices[faces].max(axis=1), starts[:-1])
    return sorted_mesh, _bounding_spheres(starts, low, high, np.zeros(len(low)))


def sort_surfels_into_blocks(surfels: Surfels) -> tuple[Surfels, Blocks]:
    """Sort the discs of a cloud by block, and return the sorted discs and their blocks."""
    order, starts = _block_order(surfels.cloud.points)
    cloud = surfels.cloud
    points = cloud.points[order]
    sorted_cloud = PointCloud(
        points,
        None if cloud.colour is None else cloud.colour[order],
        None if cloud.labels is None else cloud.labels[order],
    )
    radius = surfels.radius_m[order]
    low = np.minimum.reduceat(points, starts[:-1])
    high = np.maximum.reduceat(points, starts[:-1])
    most = np.maximum.reduceat(radius, starts[:-1]).astype(np.float64)
    found = Surfels(sorted_cloud, surfels.normals[order], radius)
    return found, _bounding_spheres(starts, low, high, most)


def _block_order(places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the order that groups positions by block, and the start of each block."""
    own, count = assign_cells(places, BLOCK_M)
    order = np.argsort(own, kind="stable")
    starts = np.concatenate([[0], np.cumsum(np.bincount(own, minlength=count))])
    return order, starts.astype(np.int64)


def _bounding_spheres(
    starts: np.ndarray, low: np.ndarray, high: np.ndarray, more: np.ndarray
) -> Blocks:
    low, high = low.astype(np.float64), high.astype(np.float64)
    return Blocks(starts, (low + high) / 2, np.linalg.norm(high - low, axis=1) / 2 + more + 0.01)
