"""Estimation of an object's front in quarter turns, from its shape, its wall or its table."""

from typing import NamedTuple

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.furniture.chair_fitting import direction_to_table

SIDES = ((0, 1), (1, 1), (0, -1), (1, -1))  # (axis, sign) of the fronts at 0, 90, 180, 270 degrees.
WALL_REACH = 3  # Cells beyond a side in which a wall counts: a 0.2 m gap at 0.08 m.
UPPER_SHARE = 0.4  # The part of the height that holds a chair's back and a bed's headboard.
SEATS = (SemanticClass.CHAIR, SemanticClass.SOFA)
FLAT_SCORE = 0.15  # A lean or wall share under this says nothing.
TABLE_REACH = 8  # Cells from a chair's side to the edge of its table: 0.64 m at 0.08 m.
TABLE_BELOW = 5  # A table whose top lies this far below a chair's is a low one: one sits beside it.
TABLE_WEIGHT = 0.4  # A back that is seen leans by 0.5 to 0.9, one half hidden by 0.3 and less.
BACK_CELLS = 3  # A chair seen no deeper than this is its back alone, and a back does not lean.


class Facing(NamedTuple):
    """A front as quarter turns from +x, with its confidence from 0 to 1."""

    quarter_turns: int
    confidence: float


class Surroundings(NamedTuple):
    """The surroundings of an object: walls, windows, tables, screens and the room's centre."""

    walls: np.ndarray  # bool [X, Y, Z]
    middle: np.ndarray  # float64 [2], in cells
    tables: np.ndarray  # int64 [X, Y], the layer on the highest table or screen, 0 without


def read_surroundings(labels: np.ndarray) -> Surroundings:
    """Return the walls and tables of a grid, and the centre of the observed free cells."""
    walls = (labels == SemanticClass.WALL) | (labels == SemanticClass.WINDOW)
    free = np.argwhere((labels == SemanticClass.EMPTY).any(axis=2))
    shape = np.array(labels.shape[:2], np.float64)
    tables = (labels == SemanticClass.TABLE) | (labels == SemanticClass.TVS)
    tops = np.where(tables.any(axis=2), labels.shape[2] - tables[:, :, ::-1].argmax(axis=2), 0)
    return Surroundings(walls, free.mean(axis=0) + 0.5 if len(free) else shape / 2, tops)


def estimate_facing(cells: np.ndarray, class_id: int, around: Surroundings) -> Facing:
    """Estimate the front of an object with the given cells, int32 [N, 3].

    Chairs face away from their high side, or without a visible back towards a nearby table or
    screen. Sofas face away from their high side or their wall. Beds face along their long side,
    away from the wall or the high side (headboard). Screens and tables face along their thin side,
    away from the wall. Other objects face away from the wall that covers most of a side, preferably
    along their thin side, or else towards the centre of the room.
    """
    low, high = cells.min(axis=0), cells.max(axis=0) + 1
    lean = _lean(cells, low, high)
    wall = np.array([_wall_share(low, high, axis, -sign, around) for axis, sign in SIDES])
    inward = _inward(low, high, around)
    table = _table(cells, around) if class_id == SemanticClass.CHAIR else np.zeros(len(SIDES))
    if table.any():
        return _best(_seen_back(lean, low, high) + TABLE_WEIGHT * table + 0.05 * inward)
    if class_id in SEATS:
        return _best(lean + 0.3 * wall + 0.05 * inward)
    if class_id == SemanticClass.TABLE:
        return _best(_across(low, high) + 0.3 * wall + 0.05 * inward)
    if class_id == SemanticClass.BED:
        return _best(0.5 * wall + lean + 0.05 * inward + _along(low, high))
    if class_id == SemanticClass.TVS:
        return _best(wall + 0.2 * inward + _across(low, high))
    return _best(wall + 0.1 * inward + 0.3 * _across(low, high))


def _best(score: np.ndarray) -> Facing:
    order = np.argsort(-np.round(score, 9), kind="stable")
    margin = float(score[order[0]] - score[order[1]])
    return Facing(int(order[0]), min(max(margin, 0.0) / (2 * FLAT_SCORE), 1.0))


def _lean(cells: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Return how far the upper part leans away from each front, 0 to 1 of half the side."""
    upper = cells[:, 2] >= high[2] - max(1.0, UPPER_SHARE * (high[2] - low[2]))
    offset = cells[upper, :2].mean(axis=0) + 0.5 - (low[:2] + high[:2]) / 2
    share = offset / np.maximum((high[:2] - low[:2]) / 2, 1.0)
    return np.array([max(0.0, -sign * share[axis]) for axis, sign in SIDES])


def _seen_back(lean: np.ndarray, low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Return the lean; a chair of which only the back was seen faces across it."""
    depth = (high - low)[:2]
    alone = depth.min() <= BACK_CELLS and depth.min() * 2 <= depth.max()
    return _across(low, high) if alone else lean


def _table(cells: np.ndarray, around: Surroundings) -> np.ndarray:
    """Return how directly each front faces the nearest table edge, 0 to 1; zeros without tables."""
    high = around.tables > cells[:, 2].max() + 1 - TABLE_BELOW
    way = direction_to_table(cells, high, TABLE_REACH)
    return np.array([max(0.0, sign * way[axis]) for axis, sign in SIDES])


def _wall_share(
    low: np.ndarray, high: np.ndarray, axis: int, sign: int, around: Surroundings
) -> float:
    """Return the share of a side's face that has a wall within reach."""
    begin, end = low.copy(), high.copy()
    if sign > 0:
        begin[axis], end[axis] = high[axis] - 1, high[axis] + WALL_REACH
    else:
        begin[axis], end[axis] = low[axis] - WALL_REACH, low[axis] + 1
    begin = np.maximum(begin, 0)
    window = around.walls[tuple(slice(int(a), int(b)) for a, b in zip(begin, end, strict=True))]
    covered = window.any(axis=axis)
    return float(covered.mean()) if covered.size else 0.0


def _inward(low: np.ndarray, high: np.ndarray, around: Surroundings) -> np.ndarray:
    towards = around.middle - (low[:2] + high[:2]) / 2
    length = float(np.hypot(*towards))
    return np.array([sign * towards[axis] / length if length else 0.0 for axis, sign in SIDES])


def _across(low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Return 1 for fronts across the thin side, at which the long side is the object's side."""
    size = (high - low)[:2]
    thin = 0 if size[0] <= size[1] else 1
    return np.array([float(axis == thin) for axis, _ in SIDES])


def _along(low: np.ndarray, high: np.ndarray) -> np.ndarray:
    size = (high - low)[:2]
    long = 0 if size[0] >= size[1] else 1
    return np.array([float(axis == long) for axis, _ in SIDES])
