"""Horizontal surfaces of a fused room, with heights more precise than a cell.

The surfaces are found in the occupied cells and the mean surface point of each cell. A table top
is level to millimetres, so the mean of its many points is far more precise than a cell of 0.08 m.
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
    """A horizontal, upward-facing surface with its height, its area and its majority class."""

    class_id: int
    height_m: float
    area_m2: float


def find_horizontal_planes(
    labels: np.ndarray, mean_height_m: np.ndarray, hits: np.ndarray, voxel_m: float
) -> tuple[HorizontalPlane, ...]:
    """Find the horizontal surfaces that face up.

    Args:
        labels: uint8 [X, Y, Z]; 0 is free, 1 to 11 are occupied classes, 255 is unknown.
        mean_height_m: Mean height of the surface points of each cell in metres, float [X, Y, Z].
        hits: Number of surface points of each cell, integer [X, Y, Z].
        voxel_m: Cell size in metres.

    Returns:
        The planes, sorted by height, then from large to small.
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
    """Return the cells below free air: their columns [N, 2], heights [N] and classes [N].

    A surface close to a cell border is divided between two layers; both get the weighted mean.
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
    """Return the most frequent heights, the most frequent first."""
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
