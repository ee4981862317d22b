"""Worktops and wall units without measured depth, as detailed geometry.

Glossy worktops reflect the sensor's light, so a kitchen row is matched by its fronts alone, as a
shelf or a thin panel. If a worktop was found, the row becomes a counter with this plate. A panel in
front of a wall, with unseen space between them, becomes the front of a wall unit.
"""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from world2minecraft.construction.display.block_alignment import WALLS
from world2minecraft.construction.display.boxes import DisplayBox, Frame
from world2minecraft.construction.worktops import Worktop
from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import UNSEEN, OccupancyGrid, Placement
from world2minecraft.geometry.box_decomposition import partition_boxes

COUNTER = "counter"
REACHES_M = 0.2  # A row whose top is this near to a worktop's carries it.
ROW_M = (0.55, 1.25)  # Heights of rows that carry a worktop.
PLATE_M = 0.04
PANEL_M = 0.17  # Maximum depth of a panel: two cells of 8 cm.
WIDE_M = 0.3  # Minimum width of a front.
UNIT_M = 0.5  # The depth of a wall unit, at most.
UNSEEN_SHARE = 0.6  # Minimum unobserved share of the space between front and wall.
WALL_SHARE = 0.1  # Minimum observed share of the wall behind a unit, above or below it.
AROUND_CELLS = 4  # Cells above and below a unit in which its wall is searched.


def as_counter(placement: Placement, tops: Mapping[int, Worktop]) -> Placement:
    """Convert a kitchen row under a worktop to a counter; return other placements unchanged."""
    top = tops.get(placement.object_id)
    if top is None or placement.class_id != SemanticClass.FURN:
        return placement
    low = placement.center_m[2] - placement.size_m[2] / 2
    high = low + placement.size_m[2]
    if abs(high - top.top_m) > REACHES_M or not ROW_M[0] <= high - low <= ROW_M[1]:
        return placement
    size = np.array([*placement.size_m[:2], top.top_m - low])
    middle = np.array([*placement.center_m[:2], low + size[2] / 2])
    known = placement.parameters if placement.template == COUNTER else {}
    return replace(placement, template=COUNTER, size_m=size, center_m=middle, parameters=known)


def plate_pieces(
    top: Worktop, covered: np.ndarray, grid: OccupancyGrid, state: str
) -> tuple[list[DisplayBox], Frame] | None:
    """Return the boxes of a worktop's plate and their frame, or None if it is completely covered.

    Args:
        top: The worktop.
        covered: Bool [X, Y] mask of columns in which a counter already has a plate.
        grid: Grid of the room.
        state: Block state of the plate.
    """
    if top.plan is None or not (top.plan & ~covered).any():
        return None
    boxes = partition_boxes((top.plan & ~covered)[:, :, None].astype(np.int32))
    low, high = boxes[:, 1:3].min(axis=0), boxes[:, 4:6].max(axis=0)
    size = (high - low) * grid.voxel_m
    base = np.array([*(grid.origin_m[:2] + low * grid.voxel_m + size / 2), top.top_m - PLATE_M])
    pieces = []
    for x0, y0, x1, y1 in boxes[:, [1, 2, 4, 5]].tolist():
        first = (np.array([x0, y0]) - low) * grid.voxel_m - size / 2
        last = (np.array([x1, y1]) - low) * grid.voxel_m - size / 2
        pieces.append(DisplayBox(np.array([*first, 0.0, *last, PLATE_M]), state))
    return pieces, Frame(base, np.array([*size, PLATE_M]), 0.0)


def deepened(placement: Placement, grid: OccupancyGrid) -> Placement:
    """Extend a panel in front of a wall to the wall; return other placements unchanged."""
    low = placement.center_m - _turned(placement.size_m, placement.quarter_turns) / 2
    high = 2 * placement.center_m - low
    size = high - low
    axis = int(size[:2].argmin())
    if size[axis] > PANEL_M or size[1 - axis] < WIDE_M or size[2] < WIDE_M / 2:
        return placement
    if placement.class_id not in (SemanticClass.FURN, SemanticClass.OBJS) or low[2] < ROW_M[0]:
        return placement
    depths = {side: _unseen_depth(low, high, axis, side, grid) for side in (-1, 1)}
    side = max(depths, key=lambda one: depths[one])
    if depths[side] <= 0 or min(depths.values()) > 0:
        return placement
    if side < 0:
        low[axis] -= depths[side]
    else:
        high[axis] += depths[side]
    size_m = _turned(high - low, placement.quarter_turns)
    return replace(placement, center_m=(low + high) / 2, size_m=size_m)


def _unseen_depth(
    low: np.ndarray, high: np.ndarray, axis: int, side: int, grid: OccupancyGrid
) -> float:
    """Return the distance in metres from a side to a wall across unseen space, or 0."""
    first = np.clip(np.floor((low - grid.origin_m) / grid.voxel_m + 0.5), 0, grid.shape).astype(int)
    last = np.clip(np.floor((high - grid.origin_m) / grid.voxel_m + 0.5), first + 1, grid.shape)
    window = [slice(int(a), int(b)) for a, b in zip(first, last, strict=True)]
    for step in range(1, int(UNIT_M / grid.voxel_m) + 2):
        layer = int(last[axis]) - 1 + step if side > 0 else int(first[axis]) - step
        if not 0 <= layer < grid.shape[axis]:
            return 0.0
        window[axis] = slice(layer, layer + 1)
        labels, source = grid.labels[tuple(window)], grid.source[tuple(window)]
        rows = slice(max(window[2].start - AROUND_CELLS, 0), window[2].stop + AROUND_CELLS)
        behind = grid.labels[(*window[:2], rows)]
        if np.isin(behind, WALLS).mean() >= WALL_SHARE and not (labels == 0).mean() > WALL_SHARE:
            return (step - 1) * grid.voxel_m
        if ((source == UNSEEN) | np.isin(labels, WALLS)).mean() < UNSEEN_SHARE:
            return 0.0
    return 0.0


def _turned(size: np.ndarray, quarter_turns: int) -> np.ndarray:
    return size[[1, 0, 2]] if quarter_turns % 2 else size.copy()
