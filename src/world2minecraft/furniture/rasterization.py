"""Rasterization of templates to grid cells, and their overlap with an object's cells."""

from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from world2minecraft.core.coordinates import turn_grid
from world2minecraft.core.jit import njit
from world2minecraft.furniture.template import Parameters, Template

MAX_CELLS = 8_000_000  # A box of 4 m at 0.02 m; more is a mistake in the size.
TOLERANCE_CELLS = 1e-6  # A millionth of a cell, for sums of metres that should be whole cells.


def template_cells(
    template: Template,
    size_m: Sequence[float] | np.ndarray,
    parameters: Parameters | None = None,
    quarter_turns: int = 0,
    shift: Sequence[int] = (0, 0, 0),
    voxel_m: float = 0.08,
) -> np.ndarray:
    """Return the cells of a rotated template whose box starts at ``shift``, int32 [N, 3].

    Args:
        template: The template to rasterize.
        size_m: Depth, width and height in metres, each rounded to at least one whole cell.
        parameters: Values for some of the template's parameters. The others have typical values.
        quarter_turns: Rotation in quarter turns, counter-clockwise from above.
        shift: First cell of the rotated box.
        voxel_m: Cell size in metres.

    Raises:
        ValueError: If the box has more than ``MAX_CELLS`` cells, or if a parameter is rejected.
    """
    counts = size_in_cells(size_m, voxel_m)
    values = tuple(sorted(template.complete(parameters).items()))
    solid = turn_grid(rasterize(template, counts, values, voxel_m), quarter_turns)
    return (np.argwhere(solid) + np.asarray(shift)).astype(np.int32)


def size_in_cells(size_m: Sequence[float] | np.ndarray, voxel_m: float) -> tuple[int, int, int]:
    """Return a size in whole cells, at least one along each axis."""
    depth, width, height = (max(1, int(side / voxel_m + 0.5)) for side in size_m)
    return depth, width, height


@lru_cache(maxsize=1024)
def rasterize(
    template: Template,
    counts: tuple[int, int, int],
    values: tuple[tuple[str, float], ...],
    voxel_m: float,
) -> np.ndarray:
    """Return the solid cells of a template that faces +x, bool [depth, width, height].

    A part fills the cells whose centres are inside it, and at least one cell along each axis, so
    that thin legs and table tops are preserved. The result is cached and read-only.
    """
    if np.prod(counts, dtype=np.float64) > MAX_CELLS:
        raise ValueError(
            f"template {template.name} has {counts} cells, the limit is {MAX_CELLS} in total"
        )
    size = np.array(counts, np.float64) * voxel_m
    parts = template.parts(size, dict(values))
    boxes = np.array([part.box_m for part in parts]) + np.tile((size[0] / 2, size[1] / 2, 0.0), 2)
    grid = np.zeros(counts, np.bool_)
    for low, high in _cell_ranges(boxes / voxel_m, np.array(counts)):
        grid[low[0] : high[0], low[1] : high[1], low[2] : high[2]] = True
    grid.flags.writeable = False
    return grid


def _cell_ranges(boxes: np.ndarray, counts: np.ndarray) -> list[tuple[list[int], list[int]]]:
    """Return the first cell and the one past the last of boxes in cells, float64 [N, 6].

    Bounds are closed at both ends, so that a symmetric shape gives symmetric cells: a thin post
    on the border of two cells takes both.
    """
    low = np.ceil(boxes[:, :3] - 0.5 - TOLERANCE_CELLS)
    high = np.floor(boxes[:, 3:] + 0.5 + TOLERANCE_CELLS)
    thin = high <= low
    middle = (boxes[:, :3] + boxes[:, 3:]) / 2
    low = np.where(thin, np.ceil(middle - 1 - TOLERANCE_CELLS), low)
    high = np.where(thin, np.floor(middle + 1 + TOLERANCE_CELLS), high)
    low = np.clip(low, 0, counts - 1).astype(np.int64)
    high = np.clip(high, low + 1, counts).astype(np.int64)
    return list(zip(low.tolist(), high.tolist(), strict=True))


def surface_cells(solid: np.ndarray) -> np.ndarray:
    """Return the cells of a solid bool [X, Y, Z] that share a face with a cell outside it."""
    padded = np.pad(solid, 1)
    inner = padded.copy()
    for axis in range(3):
        for step in (-1, 1):
            inner &= np.roll(padded, step, axis)
    return solid & ~inner[1:-1, 1:-1, 1:-1]


@njit
def best_shift(template, code, corners, own, beyond_weight):  # pragma: no cover - compiled
    """Return the number of the best corner, its score and its IoU; the first wins a tie.

    The score is ``IoU - beyond_weight * share of the template beyond the object``, compared to 12
    decimals.

    Args:
        template: Cells of the rotated template, bool [A, B, C], C order.
        code: Codes of the cells, as for ``count_overlaps``.
        corners: First cells of the template, int64 [S, 3].
        own: Number of the object's cells.
        beyond_weight: Penalty for a template that is all beyond the object.
    """
    counts = count_overlaps(template, code, corners)
    solid = 0
    for cell in template.ravel():
        solid += cell
    best, best_score, best_iou, most = 0, 0.0, 0.0, -np.inf
    for s in range(len(corners)):
        iou = counts[s, 0] / (own + counts[s, 1])
        score = iou - beyond_weight * counts[s, 2] / solid
        rounded = np.rint(score * 1e12) / 1e12
        if rounded > most:
            best, best_score, best_iou, most = s, score, iou, rounded
    return best, best_score, best_iou


@njit
def count_overlaps(template, code, corners):  # pragma: no cover - compiled
    """Count the covered object cells, opposing cells and cells beyond for each corner.

    Returns int64 [S, 3].

    Args:
        template: Cells of the rotated template, bool [A, B, C], C order.
        code: uint8 [X, Y, Z]: 1 for opposing cells, 2 for the object's own cells, 3 for cells
            beyond the object.
        corners: First cells of the template, int64 [S, 3]. Cells outside the window count as
            opposing.
    """
    counts = np.zeros((len(corners), 3), np.int64)
    for x in range(template.shape[0]):
        for y in range(template.shape[1]):
            for z in range(template.shape[2]):
                if not template[x, y, z]:
                    continue
                for s in range(len(corners)):
                    i, j, k = x + corners[s, 0], y + corners[s, 1], z + corners[s, 2]
                    if (
                        i < 0
                        or j < 0
                        or k < 0
                        or i >= code.shape[0]
                        or j >= code.shape[1]
                        or k >= code.shape[2]
                        or code[i, j, k] == 1
                    ):
                        counts[s, 1] += 1
                    elif code[i, j, k] == 2:
                        counts[s, 0] += 1
                    elif code[i, j, k] == 3:
                        counts[s, 2] += 1
    return counts
