"""Voxel downsampling of point clouds during reading, which keeps the mean point of each small cell.

Memory use stays close to ``MAX_POINTS`` points for files of any length.
"""

import numpy as np

from world2minecraft.capture.readers.meshes.mesh_and_cloud import PointCloud, are_places
from world2minecraft.geometry.oriented_points import cell_codes

CELL_M = 0.015  # Under a fifth of a cell of the room; a scanner's noise is half of it.
MAX_POINTS = 4_000_000
UNIT_BY_LENGTH = ((120.0, 1.0), (6000.0, 0.01))  # (maximum length in units, unit in metres).


class VoxelDownsampler:
    """A collector that merges chunks of points into one downsampled cloud.

    An offset near the first points is subtracted, so that large survey coordinates keep millimetre
    precision in float32.

    Attributes:
        offset: Vector subtracted from all points, float64 [3]; None before the first point.
        unit_m: Metres per unit, or None to infer the unit from the extent of the cloud.
        cell: Edge length of the merging cells in file units; 0 before the first merge.
        read: Number of points added so far.
    """

    def __init__(self, unit_m: float | None = None) -> None:
        self._unit_m = unit_m
        self.offset: np.ndarray | None = None
        self._points: list[np.ndarray] = []
        self._colours: list[np.ndarray] = []
        self._labels: list[np.ndarray] = []
        self._held = 0
        self.cell = 0.0
        self.read = 0

    def add(
        self,
        points: np.ndarray,
        colour: np.ndarray | None = None,
        labels: np.ndarray | None = None,
    ) -> None:
        """Add points with optional colours and class labels.

        Args:
            points: Point positions in file units, float64 [N, 3]; points that are not
                finite, or far beyond any place, are ignored.
            colour: sRGB colours, uint8 [N, 3], or None.
            labels: Class ids, uint8 [N], or None.
        """
        good = are_places(points)
        if not good.any():
            return
        points = points[good]
        self.read += len(points)
        if self.offset is None:
            self.offset = np.floor(np.median(points, axis=0))
        self._points.append((points - self.offset).astype(np.float32))
        if colour is not None:
            self._colours.append(colour[good])
        if labels is not None:
            self._labels.append(labels[good])
        self._held += len(points)
        if self._held > MAX_POINTS:
            self._merge(self._fitting_cell())

    def cloud(self) -> PointCloud:
        """Return the downsampled cloud, with one point per cell if there were too many points."""
        if not self._points:
            return PointCloud(np.zeros((0, 3), np.float32))
        if self._held > MAX_POINTS // 8:
            self._merge(self._fitting_cell())
        count = self._held
        colour = np.concatenate(self._colours) if self._colours else None
        labels = np.concatenate(self._labels) if self._labels else None
        return PointCloud(
            np.concatenate(self._points),
            colour if colour is not None and len(colour) == count else None,
            labels if labels is not None and len(labels) == count else None,
        )

    def _fitting_cell(self) -> float:
        """Return the edge length of a cell in file units, equal to 1.5 cm in a room.

        An extent of at most 120 units is read as metres (or feet), up to 6,000 as centimetres, and
        beyond as millimetres.
        """
        if self._unit_m is not None:
            return max(self.cell, CELL_M / self._unit_m)
        spans = [np.quantile(part[::16], [0.01, 0.99], axis=0) for part in self._points]
        low = np.min([span[0] for span in spans], axis=0)
        high = np.max([span[1] for span in spans], axis=0)
        longest = float((high - low).max())
        unit_m = next((unit for most, unit in UNIT_BY_LENGTH if longest <= most), 0.001)
        return max(self.cell, CELL_M / unit_m)

    def _merge(self, cell: float) -> None:
        """Merge the points to one per cell, and use larger cells if there are still too many."""
        points = np.concatenate(self._points)
        colours = np.concatenate(self._colours) if self._colours else None
        labels = np.concatenate(self._labels) if self._labels else None
        while True:
            first, own, counts = _cells(points, cell)
            if len(first) <= MAX_POINTS // 2 or cell == 0:
                break
            cell *= 1.26
        means = [np.bincount(own, points[:, a].astype(np.float64)) / counts for a in range(3)]
        self._points = [np.stack(means, axis=1).astype(np.float32)]
        if colours is not None and len(colours) == len(points):
            mixed = [np.bincount(own, colours[:, c]) / counts + 0.5 for c in range(3)]
            self._colours = [np.stack(mixed, axis=1).astype(np.uint8)]
        if labels is not None and len(labels) == len(points):
            self._labels = [labels[first]]
        self._held, self.cell = len(first), cell


def _cells(points: np.ndarray, cell: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the first point of each cell, the cell of each point, and the cells' point counts."""
    codes = cell_codes(points, np.float32(cell))
    return np.unique(codes, return_index=True, return_inverse=True, return_counts=True)[1:]
