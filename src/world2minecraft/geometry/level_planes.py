"""Flat level surfaces of a fused room, their heights finer than a cell.

In: the cells that hold surface and the mean surface point of each. Out: planes with height and
area. A table top is level to millimetres, so the mean of its many points is far finer than 0.08 m.
"""

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from world2minecraft.geometry.connected_components import label_components

SAME_HEIGHT_M = 0.03  # Two columns of one plane differ by sensor noise, about 1 cm.
MIN_AREA_M2 = 0.08  # A chair's seat has 0.16 m2, a screen's foot 0.05.
BIN_M = 0.01


@dataclass(frozen=True)
class HorizontalPlane:
    """A level surface seen from above: its height, its area and the class of most of its cells."""

    class_id: int
    height_m: float
    area_m2: float


def find_horizontal_planes(
    labels: np.ndarray, mean_height_m: np.ndarray, hits: np.ndarray, voxel_m: float
) -> tuple[HorizontalPlane, ...]:
    """Find the level surfaces that face up.

    Args:
        labels: uint8 [X, Y, Z], 0 free, 1 to 11 occupied, 255 unknown.
        mean_height_m: float [X, Y, Z], the height of the mean surface point of each cell.
        hits: integer [X, Y, Z], the number of points of each cell.
        voxel_m: the cell's size in metres.

    Returns:
        Planes from low to high, large before small.
    """
    columns, heights, classes = _tops(labels, mean_height_m, hits, voxel_m)
    found = []
    for peak in _peaks(heights):
        near = np.abs(heights - peak) <= SAME_HEIGHT_M
        plan = np.zeros(labels.shape[:2], bool)
        plan[tuple(columns[near].T)] = True
        parts, count = label_components(plan)
        owner = parts[tuple(columns[near].T)]
        for part in range(1, count + 1):
            inside = owner == part
            area_m2 = len(np.unique(columns[near][inside], axis=0)) * voxel_m**2
            if area_m2 >= MIN_AREA_M2:
                height_m = float(np.median(heights[near][inside]))
                class_id = int(np.bincount(classes[near][inside]).argmax())
                found.append(HorizontalPlane(class_id, round(height_m, 4), round(area_m2, 4)))
    return tuple(sorted(found, key=lambda p: (p.height_m, -p.area_m2, p.class_id)))


def _tops(labels: np.ndarray, mean_height_m: np.ndarray, hits: np.ndarray, voxel_m: float):
    """Return the cells under free air: their columns [N, 2], heights [N] and classes [N].

    A surface near a cell's edge falls into two layers; both then give one weighted mean.
    """
    occupied = (labels > 0) & (labels != 255) & (hits > 0)
    above_free = np.zeros_like(occupied)
    above_free[:, :, :-1] = labels[:, :, 1:] == 0
    top = occupied & above_free
    weight = hits.astype(np.float64)
    below_joins = np.zeros_like(occupied)
    gap = mean_height_m[:, :, 1:] - mean_height_m[:, :, :-1]
    below_joins[:, :, 1:] = occupied[:, :, :-1] & (gap <= 0.6 * voxel_m)
    lower = np.zeros_like(weight)
    lower[:, :, 1:] = weight[:, :, :-1]
    lower *= below_joins
    lower_height = np.zeros_like(weight)
    lower_height[:, :, 1:] = mean_height_m[:, :, :-1]
    mean = (mean_height_m * weight + lower_height * lower) / np.maximum(weight + lower, 1)
    cells = np.argwhere(top)
    at = tuple(cells.T)
    return cells[:, :2], mean[at], labels[at]


def _peaks(heights: np.ndarray) -> list[float]:
    """Return the heights at which columns gather, the fullest first."""
    if not len(heights):
        return []
    low = np.floor(heights.min() / BIN_M) - 4
    bins = ((heights / BIN_M) - low).astype(int)
    counts = ndimage.gaussian_filter1d(np.bincount(bins, minlength=bins.max() + 5) * 1.0, 1.5)
    reach = int(2 * SAME_HEIGHT_M / BIN_M)
    is_peak = (counts == ndimage.maximum_filter1d(counts, reach + 1)) & (counts >= 2)
    order = np.flatnonzero(is_peak)
    order = order[np.argsort(-counts[order], kind="stable")]
    return [float((low + index + 0.5) * BIN_M) for index in order]
