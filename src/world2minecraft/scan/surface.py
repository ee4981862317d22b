"""The oriented points that alignment looks at: some of the frames, some of their pixels."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from world2minecraft.coordinates import apply
from world2minecraft.geometry.normals import normals_of_depth
from world2minecraft.types import View

CELL_M = 0.10  # Support is counted in distinct patches of this side: many looks at one are one.


@dataclass(frozen=True)
class Surface:
    """Points, unit normals towards the camera (float64 [N, 3], one frame), and camera poses."""

    points_m: np.ndarray
    normals: np.ndarray
    cameras: np.ndarray  # float64 [F, 4, 4], camera to the frame of the points.

    def turned(self, transform: np.ndarray) -> "Surface":
        """Return the surface in another frame; ``transform`` is rigid."""
        return Surface(
            apply(transform, self.points_m),
            self.normals @ transform[:3, :3].T,
            transform @ self.cameras,
        )


def collect_surface(views: Iterable[View]) -> Surface:
    """Gather the oriented points of views in the scan's frame; views without depth give none."""
    points, normals, cameras = [np.zeros((0, 3))], [np.zeros((0, 3))], []
    for view in views:
        if view.depth_m is None or view.depth_camera is None:
            continue
        step = max(2, round(view.depth_camera.width_px / 106))  # Every 6th pixel at 640.
        found = normals_of_depth(view.depth_m, view.depth_camera, step_px=step, reach_px=step)
        pose = view.depth_camera_to_scan
        points.append(apply(pose, found.points_m))
        normals.append(found.normals @ pose[:3, :3].T)
        cameras.append(pose)
    return Surface(
        np.concatenate(points), np.concatenate(normals), np.array(cameras).reshape(-1, 4, 4)
    )


@dataclass(frozen=True)
class Profile:
    """How much surface lies at each place along an axis, counted in distinct patches.

    ``area_m2`` float64 [bins] counts each bin with its two neighbours, since noise of consumer
    depth at 3 m is about 2 cm; ``bin_area_m2`` counts each alone.
    """

    start_m: float
    bin_m: float
    area_m2: np.ndarray
    bin_area_m2: np.ndarray

    def centers_m(self) -> np.ndarray:
        """The middles of the bins."""
        return self.start_m + (np.arange(len(self.area_m2)) + 0.5) * self.bin_m

    def peaks(self, least_m2: float) -> np.ndarray:
        """Return the places of the local maxima of at least an area, rising."""
        bins = np.concatenate([[0.0], self.bin_area_m2, [0.0]])
        height = bins[1:-1] + (bins[:-2] + bins[2:]) / 2
        padded = np.concatenate([[0.0], height, [0.0]])
        top = (height >= padded[:-2]) & (height > padded[2:]) & (self.area_m2 >= least_m2)
        return self.centers_m()[top]

    def area_at(self, place_m: float) -> float:
        """Return the area in the bin at a place, 0 outside."""
        index = int(np.floor((place_m - self.start_m) / self.bin_m))
        return float(self.area_m2[index]) if 0 <= index < len(self.area_m2) else 0.0


def profile(points_m: np.ndarray, axis: int, bin_m: float = 0.03) -> Profile:
    """Count distinct patches along an axis.

    Args:
        points_m: float64 [N, 3], already chosen to face along the axis.
        axis: 0, 1 or 2.
        bin_m: width of the bins.
    """
    if not len(points_m):
        return Profile(0.0, bin_m, np.zeros(1), np.zeros(1))
    start = float(np.floor(points_m[:, axis].min() / bin_m) - 1) * bin_m
    bins = ((points_m[:, axis] - start) / bin_m).astype(np.int64)
    count = int(bins.max()) + 2
    others = [other for other in range(3) if other != axis]
    patches = np.floor(points_m[:, others] / CELL_M).astype(np.int64)
    patches -= patches.min(axis=0)
    patch = patches[:, 0] * (patches[:, 1].max() + 1) + patches[:, 1]
    held = np.unique(patch * count + bins)
    near = np.unique(np.concatenate([held - 1, held, held + 1]))
    return Profile(start, bin_m, _area(near, count), _area(held, count))


def _area(codes: np.ndarray, count: int) -> np.ndarray:
    return np.bincount(codes % count, minlength=count) * (CELL_M * CELL_M)
