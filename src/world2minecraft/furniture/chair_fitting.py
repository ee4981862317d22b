"""Fitting of a whole chair to partially observed cells, over all positions, turns and sizes.

A chair rotated by an eighth turn is diagonal to the cells of its template, and only the back of a
chair at a table is visible. Cells next to the template therefore count as covered, and free cells
next to the chair are ignored.
"""

from itertools import product
from typing import NamedTuple

import numpy as np
from scipy import ndimage

from world2minecraft.core.coordinates import turn_grid
from world2minecraft.furniture.rasterization import count_overlaps, rasterize
from world2minecraft.furniture.template import Template

AGAINST, OWN = 1, 2  # As in the codes that ``count_overlaps`` reads.
FACE_NEIGHBOURS = np.zeros((3, 3, 3), np.bool_)
FACE_NEIGHBOURS[:, :, 1] = True
SIDES = np.array([(1, 0), (0, 1), (-1, 0), (0, -1)])  # Where a front looks, by quarter turns.
LOOK_WEIGHT = 0.15  # What looking at its table is worth, as a share of the chair's cells.
OPEN_TOP = 0.4  # A top layer of which more than this was seen free is hardly there.
EDGE = 4  # Cells behind the nearest edge of a table that still are that edge.
MARGIN = np.array((1, 1, 0))
AROUND = np.array([(x, y, 0) for x in (0, -1, 1) for y in (0, -1, 1)])  # Other forms' places.

Cells = tuple[int, int, int]
Values = tuple[tuple[str, float], ...]


class SeatFit(NamedTuple):
    """The fit of a chair: size in cells along its own axes, parameters, turn and first cell.

    ``met`` bool [N] marks the cells in or beside the chair. ``gain`` is the number of these cells,
    plus the cells covered exactly, minus twice the opposing cells. ``opposed`` is the share of the
    chair's cells that were observed as free.
    """

    gain: float
    opposed: float
    counts: Cells
    values: Values
    quarter_turns: int
    corner: Cells
    solid: np.ndarray  # bool [A, B, C], turned
    met: np.ndarray

    @property
    def cells(self) -> np.ndarray:
        """The cells that the chair fills, int64 [M, 3]."""
        return np.argwhere(self.solid) + self.corner


def ignore_adjacent_free_cells(code: np.ndarray) -> np.ndarray:
    """Return the code, uint8 [X, Y, Z], without the free cells next to the object."""
    adjacent = ndimage.binary_dilation(code == OWN, FACE_NEIGHBOURS)
    return np.where(adjacent & (code == AGAINST), 0, code).astype(np.uint8)


def fit_seat(
    template: Template,
    code: np.ndarray,
    floor: int,
    voxel_m: float,
    look: np.ndarray,
) -> SeatFit | None:
    """Return the best fit of a chair for the ``OWN`` cells in ``code``, or None without such cells.

    Args:
        template: The chair template.
        code: Cell codes as for ``count_overlaps``, uint8 [X, Y, Z].
        floor: Layer on which the chair stands.
        voxel_m: Cell size in metres.
        look: Unit vector in plan towards the table of the chair, float64 [2], or zeros.
    """
    cells = np.argwhere(code == OWN)
    if not len(cells) or floor < 0:
        return None
    target = _ObjectCells(cells, ignore_adjacent_free_cells(code), look)
    low, high = cells.min(axis=0), cells.max(axis=0) + 1
    best: SeatFit | None = None
    usual, *others = _candidate_shapes(template, int(high[2]) - floor, voxel_m)
    for turns in range(template.turns):
        solid = _turn_template(template, *usual, turns, voxel_m)
        home = target.best_fit(
            *usual, turns, solid, _candidate_corners(solid.shape, low, high, floor)
        )
        around = np.array(home.corner) + AROUND
        moved = (
            target.best_fit(*form, turns, _turn_template(template, *form, turns, voxel_m), around)
            for form in others
        )
        for fit in (home, *moved):
            best = fit if best is None or fit.gain > best.gain + 1e-9 else best
    return best


def without_open_top(fit: SeatFit, template: Template, code: np.ndarray, voxel_m: float) -> SeatFit:
    """Return the chair without its top layer if much of that layer was observed as free.

    The last cell of a back is often filled by only a third, which is less than half a block.
    """
    depth, width, height = fit.counts
    tops = fit.cells[fit.cells[:, 2] == fit.corner[2] + height - 1]
    inside = tops[((tops >= 0) & (tops < code.shape)).all(axis=1)]
    opened = np.count_nonzero(code[tuple(inside.T)] == AGAINST)
    least = int(template.size_m[2].minimum / voxel_m + 0.5)
    if height <= least or opened <= OPEN_TOP * len(tops):
        return fit
    counts = (depth, width, height - 1)
    solid = _turn_template(template, counts, fit.values, fit.quarter_turns, voxel_m)
    return fit._replace(counts=counts, solid=solid)


class _ObjectCells(NamedTuple):
    """Cells, int64 [N, 3], the code that a chair is compared with, and which way it may look."""

    cells: np.ndarray
    code: np.ndarray
    look: np.ndarray

    def best_fit(
        self, counts: Cells, values: Values, turns: int, solid: np.ndarray, corners: np.ndarray
    ) -> SeatFit:
        """Return the best of several chair positions, int64 [S, 3]; the first of equal ones."""
        exact = count_overlaps(solid, self.code, corners)
        wide = ndimage.binary_dilation(np.pad(solid, ((1, 1), (1, 1), (0, 0))), FACE_NEIGHBOURS)
        near = count_overlaps(wide, self.code, corners - MARGIN)[:, 0]
        gain = near + exact[:, 0] - 2 * exact[:, 1]
        gain = gain + LOOK_WEIGHT * len(self.cells) * (SIDES[turns] @ self.look)
        at = int(np.argmax(np.round(gain, 9)))
        x, y, z = (int(value) for value in corners[at])
        opposed = float(exact[at, 1] / np.count_nonzero(solid))
        met = _within(self.cells, wide, corners[at] - MARGIN)
        return SeatFit(float(gain[at]), opposed, counts, values, turns, (x, y, z), solid, met)


def _candidate_shapes(template: Template, tall: int, voxel_m: float) -> list[tuple[Cells, Values]]:
    """Return candidate sizes and parameters: the typical ones, then variants."""
    depth, width = (int(span.typical / voxel_m + 0.5) for span in template.size_m[:2])
    least, most = (int(limit / voxel_m + 0.5) for limit in template.size_m[2][::2])
    height = min(max(tall, least), most)
    usual = tuple((name, span.typical) for name, span in template.parameters.items())
    spans = [sorted(set(span)) for span in template.parameters.values()]
    every = [tuple(zip(template.parameters, steps, strict=True)) for steps in product(*spans)]
    sizes = [(depth, width, height), (max(depth - 1, 1), width, height)]
    rest = [(size, values) for size in sizes for values in every]
    return [(sizes[0], usual), *(form for form in rest if form != (sizes[0], usual))]


def _turn_template(
    template: Template, counts: Cells, values: Values, turns: int, voxel_m: float
) -> np.ndarray:
    return np.ascontiguousarray(turn_grid(rasterize(template, counts, values, voxel_m), turns))


def _candidate_corners(
    shape: tuple[int, ...], low: np.ndarray, high: np.ndarray, floor: int
) -> np.ndarray:
    """Return all first cells at which a box of ``shape`` overlaps the object's, int64 [S, 3]."""
    along = [np.arange(low[axis] - shape[axis] + 1, high[axis]) for axis in (0, 1)]
    x, y = np.meshgrid(*along, indexing="ij")
    return np.stack([x.ravel(), y.ravel(), np.full(x.size, floor)], axis=1).astype(np.int64)


def _within(cells: np.ndarray, solid: np.ndarray, corner: np.ndarray) -> np.ndarray:
    at = cells - corner
    inside = ((at >= 0) & (at < solid.shape)).all(axis=1)
    result = np.zeros(len(cells), np.bool_)
    result[inside] = solid[tuple(at[inside].T)]
    return result


def direction_to_table(cells: np.ndarray, tables: np.ndarray, reach: int) -> np.ndarray:
    """Return the direction in plan from cells to the nearest table, float64 [2], or zeros.

    The direction leads to the centre of the nearby part of the table, so that neither the far end
    of a long table nor a more distant table affects it.

    Args:
        cells: Cells of the object, int [N, 3].
        tables: Mask of all tables in plan, bool [X, Y].
        reach: Maximum distance in cells between the cells' bounding box and a table.
    """
    low, high = cells[:, :2].min(axis=0), cells[:, :2].max(axis=0) + 1
    first = np.maximum(low - reach - EDGE, 0)
    at = np.argwhere(tables[tuple(map(slice, first, high + reach + EDGE))]) + first
    gaps = np.maximum(np.maximum(low - at, at + 1 - high), 0)
    distance = np.round(np.hypot(gaps[:, 0], gaps[:, 1]), 9)
    if not len(at) or distance.min() > reach:
        return np.zeros(2)
    way = at[distance <= distance.min() + EDGE].mean(axis=0) + 0.5 - (low + high) / 2
    length = float(np.linalg.norm(way))
    return way / length if length else np.zeros(2)
