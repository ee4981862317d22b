"""Passable doorways: openings a person can walk through stay passable in the world.

At one block per metre, a gap in a wall that spans two blocks would be closed by both. Gaps are
therefore found in the cells and opened in the blocks, at least one block wide and two high.
"""

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from world2minecraft.construction.block_lattice import Lattice
from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import UNSEEN, OccupancyGrid
from world2minecraft.geometry.connected_components import label_face_components

NARROWEST_M, WIDEST_M = 0.5, 1.8  # A wider gap is open at any scale.
THICKEST_M = 0.45  # A gap that goes on for longer is a corridor.
BODY_M = (0.3, 1.7)  # Over thresholds, under lintels.
BODY_SHARE = 0.9  # Minimum free share of a column at the height of a body.
HIGHEST_M = 2.2
OPEN_COVER = 0.7  # Minimum open share of a block's width.
PLAYER_BLOCKS = 2


class Gap(NamedTuple):
    """A gap in a wall along ``axis``, in cells: half-open ranges along and across the wall."""

    axis: int
    along: tuple[int, int]
    across: tuple[int, int]


def open_doorways(
    walls: np.ndarray, grid: OccupancyGrid, lattice: Lattice, storey: tuple[int, int]
) -> None:
    """Remove, in place, the wall blocks in the doorways of a storey.

    Args:
        walls: Bool [X, Y, Z] mask of wall blocks.
        grid: Grid of the room.
        lattice: Block lattice of the room.
        storey: First layer above the floor of the storey, and its exclusive end.
    """
    ground, top = storey
    free = (grid.labels == 0) & (grid.source != UNSEEN)
    for gap in find_gaps(grid, free, _height_m(lattice, ground)):
        height = _head_blocks(gap, free, grid, lattice, ground)
        for x, y in _columns(gap, grid, lattice, np.any(walls[:, :, ground:top], axis=2)):
            walls[x, y, ground : min(ground + height, top)] = False


def find_gaps(grid: OccupancyGrid, free: np.ndarray, floor_m: float) -> list[Gap]:
    """Find the gaps in the walls of a storey that a person fits through, in cell order.

    Args:
        grid: Grid of the room.
        free: Bool [X, Y, Z] mask of the cells seen as free.
        floor_m: Height of the floor in metres.
    """
    layers = [round((floor_m + m - grid.origin_m[2]) / grid.voxel_m) for m in BODY_M]
    low, high = np.clip(layers, 0, grid.shape[2])
    if high <= low:
        return []
    body = slice(int(low), int(high))
    solid = np.isin(grid.labels[:, :, body], (SemanticClass.WALL, SemanticClass.WINDOW))
    walled = solid.mean(axis=2) > 0.5
    clear = free[:, :, body].mean(axis=2) >= BODY_SHARE
    gaps: list[Gap] = []
    for axis in (0, 1):
        between = _between_walls(walled, clear, axis, round(WIDEST_M / grid.voxel_m))
        parts, sizes = label_face_components(between)
        for number in range(1, len(sizes)):
            cells = np.argwhere(parts == number)
            start, stop = cells.min(axis=0), cells.max(axis=0) + 1
            wide_m, thick_m = (stop - start)[[axis, 1 - axis]] * grid.voxel_m
            if (
                wide_m >= NARROWEST_M
                and thick_m <= THICKEST_M
                and _leads_on(walled, axis, start, stop)
            ):
                spans = [(int(start[i]), int(stop[i])) for i in (axis, 1 - axis)]
                gaps.append(Gap(axis, spans[0], spans[1]))
    return gaps


def _leads_on(walled: np.ndarray, axis: int, start: np.ndarray, stop: np.ndarray) -> bool:
    """Return whether there is no wall directly in front of or behind a gap."""
    plan = np.moveaxis(walled, axis, 0)[start[axis] : stop[axis]]
    beside = (int(start[1 - axis]) - 1, int(stop[1 - axis]))
    return not any(0 <= m < plan.shape[1] and plan[:, m].mean() > 0.5 for m in beside)


def _between_walls(walled: np.ndarray, clear: np.ndarray, axis: int, most: int) -> np.ndarray:
    """Return the clear cells, bool [X, Y], between two walls at most ``most`` apart."""
    rows_walled, rows_clear = np.moveaxis(walled, axis, 1), np.moveaxis(clear, axis, 1)
    result = np.zeros_like(rows_clear)
    for row, (wall, open_cells) in enumerate(zip(rows_walled, rows_clear, strict=True)):
        ends = np.flatnonzero(wall)
        for left, right in pairwise(ends.tolist()):
            inner = slice(left + 1, right)
            if 1 < right - left <= most + 1 and open_cells[inner].mean() >= 0.5:
                result[row, inner] = open_cells[inner]
    return np.moveaxis(result, 1, axis)


def _columns(
    gap: Gap, grid: OccupancyGrid, lattice: Lattice, walled: np.ndarray
) -> list[tuple[int, int]]:
    """Return the wall columns of a gap: at least one block wide and as deep as the wall."""
    edges = lattice.edges_of(grid, gap.axis)
    low, high = edges[gap.along[0]], edges[gap.along[1]]
    touched = np.arange(int(np.floor(low)), int(np.ceil(high)))
    cover = np.minimum(high, touched + 1) - np.maximum(low, touched)
    # A block that a jamb or a pillar shares stays, where others are open.
    chosen = touched[cover >= min(OPEN_COVER, float(cover.max()))]
    across = lattice.edges_of(grid, 1 - gap.axis)
    first = int(np.floor(across[gap.across[0]])) - 1
    last = int(np.ceil(across[gap.across[1]])) + 1
    plan = np.moveaxis(walled, gap.axis, 0)
    found = [(n, m) for n in chosen.tolist() for m in range(first, last) if plan[n, m]]
    return [(n, m) if gap.axis == 0 else (m, n) for n, m in found]


def _head_blocks(
    gap: Gap, free: np.ndarray, grid: OccupancyGrid, lattice: Lattice, ground: int
) -> int:
    """Return the height of a gap in blocks, at least two."""
    spans = (gap.along, gap.across) if gap.axis == 0 else (gap.across, gap.along)
    window = free[slice(*spans[0]), slice(*spans[1])]
    open_share = window.mean(axis=(0, 1))
    floor_m = _height_m(lattice, ground)
    begin = round((floor_m + BODY_M[1] - grid.origin_m[2]) / grid.voxel_m)
    end = round((floor_m + HIGHEST_M - grid.origin_m[2]) / grid.voxel_m)
    shut = np.flatnonzero(open_share[begin:end] < 0.5)
    head_m = BODY_M[1] + (shut[0] if len(shut) else end - begin) * grid.voxel_m
    return max(PLAYER_BLOCKS, round(head_m * lattice.blocks_per_metre))


def _height_m(lattice: Lattice, ground: int) -> float:
    return float((ground - lattice.offset[2]) / lattice.blocks_per_metre)
