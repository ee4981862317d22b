"""The evidence that templates are compared with: an object's cells and their surroundings."""

from dataclasses import dataclass

import numpy as np

from world2minecraft.core.classes import UNKNOWN, SemanticClass
from world2minecraft.core.types import OccupancyGrid

IGNORED, AGAINST, OWN, BEYOND = 0, 1, 2, 3
MARGIN = 3  # Shift, slack and one more cell around the largest box that is tried.


@dataclass(frozen=True, eq=False)
class Evidence:
    """A window of the grid around one object.

    Attributes:
        code: Effect of covering each cell, uint8 [X, Y, Z]. OWN is a cell of the object; AGAINST
            was seen as free or as structure; IGNORED was never seen or belongs to another object
            and does not count; BEYOND is an ignored cell outside the object's box.
        corner: First cell of the window in the grid, int64 [3].
        low: First cell of the object in the window.
        high: Exclusive last cell of the object in the window.
        floor: First layer of the window above the floor of the storey.
        own: Number of cells of the object.
    """

    code: np.ndarray
    corner: np.ndarray
    low: tuple[int, int, int]
    high: tuple[int, int, int]
    floor: int
    own: int


def evidence_of(
    grid: OccupancyGrid,
    cells: np.ndarray,
    reach: tuple[int, int, int],
    paper_compat: bool,
    floor_m: float = 0.0,
) -> Evidence:
    """Return the window around cells int32 [N, 3], large enough for boxes of ``reach`` cells.

    With ``paper_compat``, every cell except the object's own is AGAINST, seen or not. ``floor_m``
    is the height of the floor of the object's storey.
    """
    low, high = cells.min(axis=0).astype(np.int64), cells.max(axis=0).astype(np.int64) + 1
    floor = int(np.floor((floor_m - grid.origin_m[2]) / grid.voxel_m + 0.5))
    pad = MARGIN + np.maximum(np.array(reach) - (high - low), 0)
    begin, end = low - pad, high + pad
    begin[2] = min(begin[2], floor - MARGIN) if floor <= low[2] else begin[2]
    code = np.full(tuple(end - begin), AGAINST if paper_compat else IGNORED, np.uint8)
    inside = np.maximum(begin, 0), np.minimum(end, grid.shape)
    there = tuple(slice(int(a), int(b)) for a, b in zip(*inside, strict=True))
    here = tuple(slice(int(a - o), int(b - o)) for a, b, o in zip(*inside, begin, strict=True))
    if not paper_compat:
        labels = grid.labels[there]
        code[here] = np.where(
            (labels <= SemanticClass.WINDOW) & (labels != UNKNOWN), AGAINST, IGNORED
        )
        code[_outside(code.shape, low - begin, high - begin) & (code == IGNORED)] = BEYOND
    code[tuple((cells - begin).T)] = OWN
    return Evidence(
        code, begin, _triple(low - begin), _triple(high - begin), floor - int(begin[2]), len(cells)
    )


def _outside(shape: tuple[int, ...], low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Return a mask of the columns outside the box; under and over it is within."""
    mask = np.ones(shape, np.bool_)
    mask[low[0] : high[0], low[1] : high[1]] = False
    return mask


def _triple(values: np.ndarray) -> tuple[int, int, int]:
    x, y, z = (int(value) for value in values)
    return x, y, z
