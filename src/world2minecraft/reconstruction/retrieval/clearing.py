"""Placements that overlap by a cell or two give way: what stands on a thing begins at its top."""

from dataclasses import replace
from itertools import combinations

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import Placement
from world2minecraft.furniture import template

DEEPEST_CELLS = 2  # A scan's noise and the cells that two things share; more is a real overlap.
OWN_CELLS = "cells"
TUCKED = {SemanticClass.CHAIR, SemanticClass.TABLE}  # A chair under its table is no overlap.


def clear_overlaps(placements: list[Placement], voxel_m: float) -> tuple[Placement, ...]:
    """Return the placements, in their order, without overlaps of up to two cells.

    Of two objects that overlap, the upper one gives way in height. In plan, loose cells and small
    things give way to furniture, else the longer one to the shorter, where its template may be
    that small; else the other. None loses more than two cells of a side to all its neighbours
    together. ``iou`` stays that of the match.
    """
    boxes = [_box(one) for one in placements]
    for m, n in combinations(range(len(placements)), 2):
        first, second = placements[m], placements[n]
        if first.object_id == second.object_id or {first.class_id, second.class_id} == TUCKED:
            continue
        depth = np.minimum(boxes[m][1], boxes[n][1]) - np.maximum(boxes[m][0], boxes[n][0])
        axis = int(np.argmin(np.round(depth, 6)))
        if not 1e-6 < depth[axis] <= DEEPEST_CELLS * voxel_m + 1e-6:
            continue
        for yields, stays in _turns(m, n, boxes, axis, placements):
            trimmed = _trimmed(boxes[yields], boxes[stays], axis)
            if _allowed(placements[yields], trimmed, axis, voxel_m):
                boxes[yields] = trimmed
                break
    return tuple(_with_box(one, box) for one, box in zip(placements, boxes, strict=True))


Box = tuple[np.ndarray, np.ndarray]


def _turns(
    m: int, n: int, boxes: list[Box], axis: int, placements: list[Placement]
) -> list[tuple[int, int]]:
    """Return who gives way to whom, the better choice first."""
    if axis == 2:
        upper_first = boxes[m][0][2] > boxes[n][0][2]
        return [(m, n), (n, m)] if upper_first else [(n, m), (m, n)]
    lesser = [_is_lesser(placements[index]) for index in (m, n)]
    if lesser[0] != lesser[1]:
        return [(m, n), (n, m)] if lesser[0] else [(n, m), (m, n)]
    longer = np.ptp(boxes[m], axis=0)[axis] >= np.ptp(boxes[n], axis=0)[axis]
    return [(m, n), (n, m)] if longer else [(n, m), (m, n)]


def _is_lesser(placement: Placement) -> bool:
    return placement.template == OWN_CELLS or placement.class_id == SemanticClass.OBJS


def _trimmed(box: Box, other: Box, axis: int) -> Box:
    low, high = box[0].copy(), box[1].copy()
    if low[axis] + high[axis] >= other[0][axis] + other[1][axis]:
        low[axis] = other[1][axis]
    else:
        high[axis] = other[0][axis]
    return low, high


def _allowed(placement: Placement, box: Box, axis: int, voxel_m: float) -> bool:
    """Return whether a placement may have this box: it keeps its floor and its template's size."""
    side = float(box[1][axis] - box[0][axis])
    if side < voxel_m - 1e-6:
        return False
    if placement.template == OWN_CELLS:
        return True
    before = _box(placement)
    lost = max(np.abs(box[0] - before[0])[axis], np.abs(box[1] - before[1])[axis])
    if lost > DEEPEST_CELLS * voxel_m + 1e-6:
        return False
    one = template(placement.template)
    if axis == 2 and one.mount == "floor" and box[0][2] > _box(placement)[0][2] + 1e-6:
        return False
    own = 1 - axis if axis < 2 and placement.quarter_turns % 2 else axis
    return side >= int(one.size_m[own].minimum / voxel_m + 1e-6) * voxel_m - 1e-6


def _box(placement: Placement) -> Box:
    size = placement.size_m[[1, 0, 2]] if placement.quarter_turns % 2 else placement.size_m
    return placement.center_m - size / 2, placement.center_m + size / 2


def _with_box(placement: Placement, box: Box) -> Placement:
    size = box[1] - box[0]
    own = size[[1, 0, 2]] if placement.quarter_turns % 2 else size
    return replace(placement, center_m=np.round((box[0] + box[1]) / 2, 4), size_m=np.round(own, 4))
