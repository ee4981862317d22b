"""Solid parts of a placement: the parts of its template, or its own cells.

A chair pushed under a table is inside the table's box without touching the table. Collisions are
therefore tested between parts.
"""

import numpy as np

from world2minecraft.core.types import OWN_CELLS, OccupancyGrid, Placement
from world2minecraft.furniture import template


def box_m(placement: Placement) -> np.ndarray:
    """Return the rotated box of a placement in metres, float64 [2, 3]: minimum, maximum corner."""
    size = placement.size_m[[1, 0, 2]] if placement.quarter_turns % 2 else placement.size_m
    return np.stack([placement.center_m - size / 2, placement.center_m + size / 2])


def solids_m(placement: Placement, grid: OccupancyGrid | None = None) -> np.ndarray:
    """Return the solid boxes of a placement in the room frame in metres, float64 [N, 2, 3].

    Args:
        placement: A placement with a template consists of the template's parts. A placement of own
            cells consists of its object's cells whose centres are in its box, or of its whole box
            without a grid.
        grid: Grid with the cells.

    Raises:
        UnknownNameError: If the template is unknown.
        ParameterError: If the template rejects a parameter.
    """
    if placement.template == OWN_CELLS:
        whole = box_m(placement)
        return whole[None] if grid is None else _cell_boxes_m(placement, grid)
    parts = template(placement.template).parts(placement.size_m, placement.parameters)
    boxes = np.array([part.box_m for part in parts]).reshape(-1, 2, 3)
    for _ in range(placement.quarter_turns):
        low, high = boxes[:, 0].copy(), boxes[:, 1].copy()
        boxes[:, 0, 0], boxes[:, 1, 0] = -high[:, 1], -low[:, 1]
        boxes[:, 0, 1], boxes[:, 1, 1] = low[:, 0], high[:, 0]
    bottom = np.array([0, 0, placement.size_m[2] / 2])
    return boxes + (placement.center_m - bottom)


def own_cells(placement: Placement, grid: OccupancyGrid) -> np.ndarray:
    """Return the cells of a placement's object whose centres are in its box, int64 [N, 3]."""
    low, high = (box_m(placement) - grid.origin_m) / grid.voxel_m - 0.5
    start = np.clip(np.ceil(low - 1e-6), 0, grid.shape).astype(int)
    stop = np.clip(np.floor(high + 1e-6) + 1, start, grid.shape).astype(int)
    window = tuple(slice(a, b) for a, b in zip(start, stop, strict=True))
    return np.argwhere(grid.instance[window] == placement.object_id) + start


def depth_m(one: np.ndarray, other: np.ndarray) -> float:
    """Return the penetration depth in metres of two sets of boxes [N, 2, 3].

    The depth of a pair of boxes is the smallest displacement along one axis that separates them.
    The result is the maximum over all pairs, or 0 without intersections. A chair's back through a
    thin table top thus counts by the thickness of the back, not of the top.
    """
    if not (len(one) and len(other)):
        return 0.0
    deepest = 0.0
    for box in one:
        ways = np.minimum(box[1] - other[:, 0], other[:, 1] - box[0]).min(axis=1)
        deepest = max(deepest, float(ways.max()))
    return deepest


def _cell_boxes_m(placement: Placement, grid: OccupancyGrid) -> np.ndarray:
    low = grid.origin_m + own_cells(placement, grid) * grid.voxel_m
    return np.stack([low, low + grid.voxel_m], axis=1)
