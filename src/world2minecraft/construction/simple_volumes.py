"""Simple volumes: the cells of an object reduced to a few boxes.

An object of uncertain class is built as one to four boxes that stand on what is below it, without
legs or ornaments. Holes, stray cells and ragged edges of a scan do not show.
"""

from typing import NamedTuple

import numpy as np
from scipy import ndimage

from world2minecraft.core.classes import UNKNOWN
from world2minecraft.core.types import UNSEEN, OccupancyGrid
from world2minecraft.geometry.connected_components import label_components

MAX_CUTS = 2  # Nested cuts, so that there are at most four boxes.
MIN_SIDE_CELLS = 3  # About a block at 4 blocks per metre.
MIN_CUT_GAIN = 0.15  # Share of the box that a cut must explain; noise explains about 0.05.
FRINGE = 0.25  # A row with less than this share of the fullest row's columns is noise.
MIN_PART = 0.1  # A separate part with less than this share of an object's cells is noise.
TOP_PERCENTILE = 75.0  # Percentile of the columns' tops; most noise is below it.
GROUNDED_M = 0.4  # What begins lower stands on the floor, unless the space below was seen free.
FREE_SHARE = 0.5


class Box(NamedTuple):
    """A box of cells: its first and exclusive last cell, int [3] each."""

    low: np.ndarray
    high: np.ndarray


def simple_boxes(cells: np.ndarray, grid: OccupancyGrid, floor_layer: int) -> tuple[Box, ...]:
    """Return one to four boxes that cover an object.

    Args:
        cells: Cells of the object, int [N, 3]; at least one.
        grid: Grid of the cells.
        floor_layer: First layer above the floor.
    """
    low = cells.min(axis=0)
    mask = np.zeros(np.ptp(cells, axis=0) + 1, bool)
    mask[tuple((cells - low).T)] = True
    mask = _main_parts(mask)
    top = (mask * np.arange(1, mask.shape[2] + 1)).max(axis=2)
    plan = ndimage.binary_closing(np.pad(top > 0, 1), np.ones((3, 3)))[1:-1, 1:-1] | (top > 0)
    top = np.where(plan & (top == 0), ndimage.maximum_filter(top, 3), top)
    first = _bottom(mask, low, grid, floor_layer) - int(low[2])
    boxes = _split(top - first, plan, MAX_CUTS)
    return tuple(
        Box(low + np.array([x0, y0, first]), low + np.array([x1, y1, first + height]))
        for x0, y0, x1, y1, height in boxes
    )


def fill_boxes(boxes: tuple[Box, ...], shape: tuple[int, ...]) -> np.ndarray:
    """Return the cells of boxes within a grid of a shape, int64 [N, 3]."""
    mask = np.zeros(shape, bool)
    for box in boxes:
        start = np.clip(box.low, 0, shape)
        mask[tuple(slice(int(a), int(b)) for a, b in zip(start, box.high, strict=True))] = True
    return np.argwhere(mask)


def _main_parts(mask: np.ndarray) -> np.ndarray:
    """Return the mask without small parts that are two or more cells away from the rest."""
    parts, count = label_components(ndimage.binary_dilation(np.pad(mask, 1)))
    if count < 2:
        return mask
    parts = parts[1:-1, 1:-1, 1:-1] * mask
    sizes = np.bincount(parts.reshape(-1))
    sizes[0] = 0
    return np.isin(parts, np.flatnonzero(sizes >= min(MIN_PART * mask.sum(), sizes.max())))


def _bottom(mask: np.ndarray, low: np.ndarray, grid: OccupancyGrid, floor_layer: int) -> int:
    """Return the first layer of an object, which is the floor if it may stand on it."""
    layers = np.flatnonzero(mask.any(axis=(0, 1)))
    areas = mask.sum(axis=(0, 1))
    layers = layers[areas[layers] >= FRINGE * np.median(areas[layers])]
    first = int(low[2] + layers[0])
    if first <= floor_layer or (first - floor_layer) * grid.voxel_m > GROUNDED_M:
        return max(first, min(floor_layer, int(low[2] + layers[-1])))
    columns = np.argwhere(mask.any(axis=2)) + low[:2]
    below = (columns[:, 0], columns[:, 1], slice(max(floor_layer, 0), first))
    labels, source = grid.labels[below], grid.source[below]
    free = (labels == 0) & (source != UNSEEN)
    filled = (labels > 0) & (labels != UNKNOWN)
    return first if (free | filled).mean() > FREE_SHARE else floor_layer


def _split(height: np.ndarray, plan: np.ndarray, cuts: int) -> list[tuple[int, int, int, int, int]]:
    """Return boxes (x0, y0, x1, y1, height) that approximate columns of the given heights."""
    whole, lost = _fitted_box(height, plan)
    if whole is None:
        return []
    best, parts = lost, None
    for axis in (0, 1) if cuts else ():
        for place in range(MIN_SIDE_CELLS, plan.shape[axis] - MIN_SIDE_CELLS + 1):
            sides = [(slice(None),) * axis + (part,) for part in (slice(place), slice(place, None))]
            losses = [_fitted_box(height[side], plan[side])[1] for side in sides]
            if sum(losses) < best - 1e-9:
                best, parts = sum(losses), (axis, place, sides)
    x0, y0, x1, y1, tall = whole
    if parts is None or lost - best < MIN_CUT_GAIN * (x1 - x0) * (y1 - y0) * tall:
        return [whole]
    axis, place, sides = parts
    result = []
    for side, start in zip(sides, (0, place), strict=True):
        dx, dy = (start, 0) if axis == 0 else (0, start)
        for a, b, c, d, tall in _split(height[side], plan[side], cuts - 1):
            result.append((a + dx, b + dy, c + dx, d + dy, tall))
    return result


def _fitted_box(
    height: np.ndarray, plan: np.ndarray
) -> tuple[tuple[int, int, int, int, int] | None, float]:
    """Return the box of columns without a fringe, and the volume by which it differs from them."""
    if not plan.any():
        return None, 0.0
    spans = []
    for axis in (0, 1):
        counts = plan.sum(axis=1 - axis)
        used = np.flatnonzero(counts >= FRINGE * counts.max())
        spans.append((int(used[0]), int(used[-1]) + 1))
    (x0, x1), (y0, y1) = spans
    inside = np.zeros_like(plan)
    inside[x0:x1, y0:y1] = True
    tall = max(round(float(np.percentile(height[plan & inside], TOP_PERCENTILE))), 1)
    solid = np.where(plan, np.maximum(height, 0), 0)
    lost = float(np.abs(np.where(inside, tall, 0) - solid).sum())
    return (x0, y0, x1, y1, tall), lost
