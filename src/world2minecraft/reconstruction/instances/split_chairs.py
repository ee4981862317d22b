"""Split chairs that touch by fitting whole chairs to cells that are too wide for one chair."""

import numpy as np
from scipy.spatial import KDTree

from world2minecraft.core.classes import UNKNOWN, SemanticClass
from world2minecraft.core.types import OccupancyGrid
from world2minecraft.furniture import template
from world2minecraft.furniture.chair_fitting import (
    AGAINST,
    OWN,
    SeatFit,
    direction_to_table,
    fit_seat,
)
from world2minecraft.geometry.connected_components import label_components
from world2minecraft.reconstruction.instances.object_voxels import cells_by_owner, floor_layer_below
from world2minecraft.reconstruction.instances.parameters import InstanceParameters

MAX_CHAIR_M = 0.85  # A chair turned by half a quarter is this wide; an easy chair may be wider.
MAX_EASY_CHAIR_M = 1.2
TABLE_SEARCH_M = 1.0
MIN_SHARE = 0.15  # Each chair meets at least this share of the voxels,
MIN_CELLS = 12  # and so many cells: half of a back.
MAX_OPPOSED_SHARE = 0.2  # The share of a chair that may stand where nothing was seen to be.
MIN_GAIN = 0.1  # By how much of the cells chairs must meet the voxels better than an easy chair.
MAX_CHAIRS = 6
MAX_SEAT_HEIGHT_M = 0.4  # Objects that begin higher have no seat.
MIN_BACK_HEIGHT_M = 0.7  # Objects that end lower have no back.
MAX_GAP_CELLS = 1
MIN_TORN_CELLS = 8  # The top of a back. Fewer cells stay with the chair they joined.
MARGIN_CELLS = 10  # Cells around the voxels: a chair's depth and some more.


def split_touching_chairs(
    owners: np.ndarray, grid: OccupancyGrid, _parameters: InstanceParameters
) -> np.ndarray:
    """Return owners, int32 [X, Y, Z], with separate numbers for chairs that touch."""
    owners = _separate_far_pieces(owners, grid)
    tables = (grid.labels == SemanticClass.TABLE).any(axis=2)
    result = owners.copy()
    next_id = int(owners.max(initial=0))
    for _, cells in cells_by_owner(owners, grid.labels, SemanticClass.CHAIR):
        if np.ptp(cells[:, :2], axis=0).max() + 1 <= MAX_CHAIR_M / grid.voxel_m:
            continue
        part = _chair_of_cells(
            cells, grid.labels, tables, grid.voxel_m, floor_layer_below(cells, grid)
        )
        moved = part > 0
        result[tuple(cells[moved].T)] = next_id + part[moved]
        next_id += int(part.max())
    return result


def merge_chair_backs(
    owners: np.ndarray, grid: OccupancyGrid, _parameters: InstanceParameters
) -> np.ndarray:
    """Return owners in which a chair back is merged with the seat next to it.

    A scan sees the back of a chair above the edge of a table and its seat below it. A back without
    seat and a seat without back are merged unless they are wider than one chair.
    """
    result = owners.copy()
    pieces = {}
    seats, backs = [], []
    for number, cells in cells_by_owner(owners, grid.labels, SemanticClass.CHAIR):
        floor = floor_layer_below(cells, grid)
        box = cells.min(axis=0), cells.max(axis=0) + 1
        pieces[number] = cells, box
        if box[1][2] <= floor + MIN_BACK_HEIGHT_M / grid.voxel_m:
            seats.append(number)
        if box[0][2] >= floor + MAX_SEAT_HEIGHT_M / grid.voxel_m:
            backs.append(number)
    for number in backs:
        distances = {n: _gap_cells(pieces[n][1], pieces[number][1]) for n in seats if n != number}
        near = {one: gap for one, gap in distances.items() if gap is not None}
        wide = {one: _joint_width(pieces[one][1], pieces[number][1]) for one in near}
        fitting = [one for one in near if wide[one] <= MAX_CHAIR_M / grid.voxel_m]
        if fitting:
            chosen = min(fitting, key=lambda one: (near[one], wide[one], one))
            result[tuple(pieces[number][0].T)] = chosen
            seats.remove(chosen)
    return result


def _separate_far_pieces(owners: np.ndarray, grid: OccupancyGrid) -> np.ndarray:
    """Return owners in which pieces far from their chair have a separate number.

    Of a chair with an unseen seat, the top of the back remains and is merged with a neighbour.
    Together with the largest piece it is wider than an easy chair.
    """
    result = owners.copy()
    next_id = int(owners.max(initial=0))
    for _, cells in cells_by_owner(owners, grid.labels, SemanticClass.CHAIR):
        if (np.ptp(cells[:, :2], axis=0).max() + 1) * grid.voxel_m <= MAX_EASY_CHAIR_M:
            continue
        own = np.zeros(np.ptp(cells, axis=0) + 1, np.bool_)
        own[tuple((cells - cells.min(axis=0)).T)] = True
        parts, count = label_components(own)
        number = parts[tuple((cells - cells.min(axis=0)).T)]
        sizes = np.bincount(number)
        main = _box(cells[number == sizes.argmax()])
        for part in range(1, count + 1):
            piece = cells[number == part]
            if (
                sizes[part] >= MIN_TORN_CELLS
                and _joint_width(main, _box(piece)) > MAX_EASY_CHAIR_M / grid.voxel_m
            ):
                next_id += 1
                result[tuple(piece.T)] = next_id
    return result


def _box(cells: np.ndarray) -> "Box":
    return cells.min(axis=0), cells.max(axis=0) + 1


Box = tuple[np.ndarray, np.ndarray]


def _gap_cells(one: Box, other: Box) -> float | None:
    """Return the number of cells between two boxes, or None above ``MAX_GAP_CELLS``."""
    gap = np.maximum(np.maximum(one[0] - other[1], other[0] - one[1]), 0)
    return float(gap.sum()) if gap.max() <= MAX_GAP_CELLS else None


def _joint_width(one: Box, other: Box) -> float:
    """Return the longer side, in plan, of the bounding box of two boxes."""
    return float((np.maximum(one[1], other[1]) - np.minimum(one[0], other[0]))[:2].max())


def _chair_of_cells(
    cells: np.ndarray, labels: np.ndarray, tables: np.ndarray, voxel_m: float, floor: int
) -> np.ndarray:
    """Return the chair of each cell, int32 [N] from 0; all 0 for a single chair."""
    code, corner = _crop(cells, labels)
    own = cells - corner
    look = direction_to_table(cells, tables, int(TABLE_SEARCH_M / voxel_m))
    fits = _fit_chairs(code.copy(), own, floor - int(corner[2]), voxel_m, look)
    if len(fits) < 2 or not _clearly_better(fits, code, own, floor - int(corner[2]), voxel_m):
        return np.zeros(len(cells), np.int32)
    distances = np.stack([KDTree(fit.cells).query(own)[0] for fit in fits])
    return np.round(distances, 9).argmin(axis=0).astype(np.int32)


def _crop(cells: np.ndarray, labels: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the observations around cells, as codes uint8 [X, Y, Z], and the first cell."""
    low = np.maximum(cells.min(axis=0) - (MARGIN_CELLS, MARGIN_CELLS, 0), 0)
    low[2] = 0
    high = np.minimum(cells.max(axis=0) + 1 + MARGIN_CELLS, labels.shape)
    seen = labels[low[0] : high[0], low[1] : high[1], low[2] : high[2]]
    code = np.where((seen <= SemanticClass.WINDOW) & (seen != UNKNOWN), AGAINST, 0)
    code[tuple((cells - low).T)] = OWN
    return code.astype(np.uint8), low


def _fit_chairs(
    code: np.ndarray, own: np.ndarray, floor: int, voxel_m: float, look: np.ndarray
) -> list[SeatFit]:
    """Fit chairs to the voxels one by one, each to most of the remaining cells."""
    fits: list[SeatFit] = []
    while len(fits) < MAX_CHAIRS:
        fit = fit_seat(template("chair"), code, floor, voxel_m, look)
        least = max(MIN_CELLS, MIN_SHARE * len(own))
        if fit is None or fit.met.sum() < least or fit.opposed > MAX_OPPOSED_SHARE:
            break
        fits.append(fit)
        code[tuple(np.argwhere(code == OWN)[fit.met].T)] = 0
    return fits


def _clearly_better(
    fits: list[SeatFit], code: np.ndarray, own: np.ndarray, floor: int, voxel_m: float
) -> bool:
    """Return whether several chairs fit the voxels better than one easy chair."""
    if (np.ptp(own[:, :2], axis=0).max() + 1) * voxel_m > MAX_EASY_CHAIR_M:
        return True
    easy = [fit_seat(template(name), code, floor, voxel_m, np.zeros(2))
            for name in ("armchair", "office_chair")]  # fmt: skip
    single = max(fit.gain for fit in easy if fit is not None)
    return sum(fit.gain for fit in fits) >= single + MIN_GAIN * 2 * len(own)
