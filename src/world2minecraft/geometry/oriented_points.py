"""Oriented points of a scan: the planar patches of all its views in a common frame."""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from world2minecraft.core.jit import njit
from world2minecraft.core.types import View
from world2minecraft.geometry.planar_patches import extract_patches

MIN_TRUST = 128  # Of 255.
MAX_POINTS_PER_VIEW = 4096  # All of an image of any size.


@dataclass(frozen=True, eq=False)
class OrientedPoints:
    """Oriented surface points of several frames.

    Attributes:
        points_m: Points in the common frame in metres, float64 [N, 3].
        normals: Unit normals towards the camera in the common frame, float64 [N, 3].
        cameras: Camera-to-frame transforms, float64 [F, 4, 4].
        sigma_m: Standard deviation along the normal in metres, float64 [N].
        owner: Index of the camera that saw each point, int32 [N].
        names: Names of the frames.
    """

    points_m: np.ndarray
    normals: np.ndarray
    cameras: np.ndarray
    sigma_m: np.ndarray
    owner: np.ndarray
    names: tuple[str, ...] = ()

    def transformed(self, transform: np.ndarray) -> "OrientedPoints":
        """Return the points transformed into another frame by a rigid 4x4 transform."""
        return replace(
            self,
            points_m=_moved(self.points_m, transform[:3, :3], transform[:3, 3]),
            normals=_moved(self.normals, transform[:3, :3], np.zeros(3)),
            cameras=transform @ self.cameras,
        )

    def subset(self, which: np.ndarray) -> "OrientedPoints":
        """Return the points selected by a mask or an index array."""
        return replace(
            self,
            points_m=self.points_m[which],
            normals=self.normals[which],
            sigma_m=self.sigma_m[which],
            owner=self.owner[which],
        )


def cell_codes(points: np.ndarray, cell: float | np.float32) -> np.ndarray:
    """Return a number for each point [N, D] that only the points of its cell share, int64 [N]."""
    cells = np.floor(points / cell).astype(np.int64)
    if not len(cells):
        return np.zeros(0, np.int64)
    cells -= cells.min(axis=0)
    codes = cells[:, 0]
    for column in cells.T[1:]:
        codes = codes * (column.max() + 1) + column
    return codes


def collect_oriented_points(
    views: Iterable[View], most_each: int = MAX_POINTS_PER_VIEW
) -> OrientedPoints:
    """Collect the planar patches of views in the scan's frame.

    Views without depth contribute no patches. Depth with a confidence below one half is ignored.

    Args:
        views: The views; read once, one at a time.
        most_each: Maximum number of patches per view, evenly subsampled.
    """
    points, normals, sigmas = [np.zeros((0, 3))], [np.zeros((0, 3))], [np.zeros(0)]
    cameras, names, counts = [], [], []
    for view in views:
        if view.depth_m is None or view.depth_camera is None:
            continue
        depth_m = view.depth_m
        if view.trust is not None:
            depth_m = np.where(view.trust >= MIN_TRUST, depth_m, np.float32(0))
        found = extract_patches(depth_m, view.depth_camera).subsample(most_each)
        pose = view.depth_camera_to_scan
        points.append(_moved(found.points_m, pose[:3, :3], pose[:3, 3]))
        normals.append(_moved(found.normals, pose[:3, :3], np.zeros(3)))
        sigmas.append(found.sigma_m)
        cameras.append(pose)
        names.append(view.name)
        counts.append(len(found.points_m))
    return OrientedPoints(
        np.concatenate(points),
        np.concatenate(normals),
        np.array(cameras).reshape(-1, 4, 4),
        np.concatenate(sigmas),
        np.repeat(np.arange(len(counts), dtype=np.int32), counts),
        tuple(names),
    )


@njit
def _moved(points, rotation, shift):
    """Return R p + t for each row, with a fixed order of operations for identical bits."""
    result = np.empty((len(points), 3))
    for i in range(len(points)):
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        for a in range(3):
            result[i, a] = rotation[a, 0] * x + rotation[a, 1] * y + rotation[a, 2] * z + shift[a]
    return result
