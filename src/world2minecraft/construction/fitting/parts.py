"""Furniture that is given as boxes, fitted with a little stretching so that it reads well.

A seat at 1.8 blocks cannot be joined to legs that end at 1 or 2. What a builder does is to make
the chair a hand higher; so sizes may change by up to a quarter, at a price.
"""

from itertools import product
from typing import NamedTuple

import numpy as np

from world2minecraft.construction.fitting.coverage import THIN_M, covered_by_boxes
from world2minecraft.construction.fitting.finish import finished
from world2minecraft.construction.fitting.joins import broken_share
from world2minecraft.construction.fitting.masks import SUB
from world2minecraft.construction.fitting.objects import Fit, attempts, fit_of
from world2minecraft.construction.fitting.problem import Rules, Target, problem_at
from world2minecraft.construction.fitting.shapes import ShapeSet

MOST, LEAST = 1.25, 0.8
TALLEST = 1.15  # A higher chair does not fit under its table.
STRETCH_COST = 0.25  # IoU given up for a stretch by the factor e.
JOINT_COST = 0.5  # IoU given up where no joint touches.
THIN_WORTH = 0.2  # IoU that all of the thin parts are worth.
HEIGHTS = 8  # At most so many heights are tried.
SAME = 1e-6


class PartsFit(NamedTuple):
    """A fit, and which box fills most of each block."""

    fit: Fit
    part: np.ndarray  # int16 [X, Y, Z], index into the boxes + 1; 0 where there is nothing


def fit_parts(
    boxes_m: np.ndarray,
    blocks_per_metre: float,
    shapes: ShapeSet,
    *,
    counts: tuple[int, int] | None = None,
    bottom: int = 0,
    flush: bool = False,
) -> PartsFit:
    """Return the best stable shapes for furniture of boxes.

    Args:
        boxes_m: float64 [N, 6], about the middle of the footprint, z = 0 at the bottom.
        blocks_per_metre: the scale.
        shapes: what may be chosen.
        counts: whole blocks that it must fill along x and y; None leaves that to the fit.
        bottom: the sub-cell, from 0 up to 7, at which it begins over a block's lower face.
        flush: whether flat tops end with their block, so that things can lie on them.

    Raises:
        ValueError: there are no boxes.
    """
    boxes = np.asarray(boxes_m, np.float64).reshape(-1, 6) * blocks_per_metre
    if not len(boxes):
        raise ValueError("furniture needs boxes, at least one")
    boxes = boxes - np.tile(
        [*((boxes[:, :2].min(0) + boxes[:, 3:5].max(0)) / 2), boxes[:, 2].min()], 2
    )
    thin = (boxes[:, 3:] - boxes[:, :3]).min(1) < THIN_M * blocks_per_metre
    rules = Rules(even=(_is_even(boxes, 0), _is_even(boxes, 1)), flush=flush, legs=True)
    best: tuple[float, Fit, np.ndarray] | None = None
    for factors, phase in _finalists(boxes, thin, shapes, rules, counts, bottom):
        target = _target(boxes * np.tile(factors, 2), thin, bottom)
        problem = problem_at(target, phase, shapes)
        grid, lam = finished(problem, shapes, rules)
        fit = fit_of(grid, problem, shapes, lam)
        score = fit.iou + THIN_WORTH * fit.thin_recall - _cost(factors, counts)
        score -= JOINT_COST * broken_share(grid, problem, shapes)
        if best is None or score > best[0] + SAME:
            best = score, fit, factors
    if best is None:
        raise ValueError("no height was tried")
    _, fit, factors = best
    return PartsFit(fit, _owners(boxes * np.tile(factors, 2), fit, shapes, bottom))


def _finalists(boxes, thin, shapes, rules, counts, bottom):
    """Return for each height the stretch and phase that are best without joints."""
    size = boxes[:, 3:].max(0) - boxes[:, :3].min(0)
    sides = [_sides(size[axis], None if counts is None else counts[axis]) for axis in (0, 1)]
    found = []
    for tall in _heights(boxes, bottom):
        tried = []
        for wide in product(*sides):
            factors = np.array([*wide, tall])
            target = _target(boxes * np.tile(factors, 2), thin, bottom)
            for phase, reached in attempts(target, shapes, rules):
                if counts is not None and phase != tuple(4 * (n % 2) for n in counts):
                    continue
                tried.append((reached - _cost(factors, counts), factors, phase))
        best = max(tried, key=lambda one: round(one[0], 6))
        found.append(best[1:])
    return found


def _sides(size: float, count: int | None) -> list[float]:
    """Return the stretches to try along one horizontal axis."""
    if count is not None:
        return [count / size]
    halves = max(round(2 * size), 1) / 2
    factor = halves / size
    return [1.0, factor] if LEAST <= factor <= MOST and abs(factor - 1) > SAME else [1.0]


def _heights(boxes: np.ndarray, bottom: int) -> list[float]:
    """Return the stretches upward to try: each brings some plate or the top to a block's edge."""
    levels = np.unique(np.round(boxes[:, [2, 5]].ravel(), 4))
    factors = {1.0}
    start = bottom / SUB
    for level in levels[levels > 0.25].tolist():
        for edge in (np.floor(level + start), np.ceil(level + start)):
            factor = (edge - start) / level
            if LEAST <= factor <= TALLEST:
                factors.add(round(float(factor), 4))
    return sorted(factors, key=lambda one: abs(np.log(one)))[:HEIGHTS]


def _target(boxes: np.ndarray, thin: np.ndarray, bottom: int) -> Target:
    """Return boxes about their middle as a target."""
    half = np.ceil(boxes[:, 3:5].max(0) * SUB - SAME).astype(int)
    tall = int(np.ceil(boxes[:, 5].max() * SUB - SAME))
    moved = boxes + np.tile([*(half / SUB), 0], 2)
    counts = [-(-side // SUB) for side in (*(2 * half), tall)]
    inside = tuple(slice(0, int(side)) for side in (*(2 * half), tall))
    wanted = covered_by_boxes(moved, counts)[inside]
    thick = covered_by_boxes(moved[~thin], counts)[inside]
    return Target(wanted, np.maximum(wanted - thick, 0), bottom)


def _is_even(boxes: np.ndarray, axis: int) -> bool:
    """Whether boxes are their own mirror image along an axis."""
    other = boxes.copy()
    other[:, axis], other[:, axis + 3] = -boxes[:, axis + 3], -boxes[:, axis]
    one, two = (np.round(rows, 4) for rows in (boxes, other))
    return bool(np.array_equal(np.unique(one, axis=0), np.unique(two + 0.0, axis=0)))


def _cost(factors: np.ndarray, counts: tuple[int, int] | None) -> float:
    free = factors if counts is None else factors[2:]
    return STRETCH_COST * float(np.abs(np.log(free)).sum())


def _owners(boxes: np.ndarray, fit: Fit, shapes: ShapeSet, bottom: int) -> np.ndarray:
    """Return which box fills most of what is shown of each block, int16 [X, Y, Z]."""
    moved = boxes + np.tile([*fit.middle, bottom / SUB], 2)
    best = np.zeros(fit.numbers.shape, np.float32)
    result = np.zeros(fit.numbers.shape, np.int16)
    shape = fit.numbers.shape
    masks = shapes.masks[fit.numbers]
    for index, box in enumerate(moved, 1):
        share = covered_by_boxes(box[None], shape)
        cells = share.reshape(shape[0], SUB, shape[1], SUB, shape[2], SUB)
        held = cells.transpose(0, 2, 4, 1, 3, 5).reshape(*shape, -1)
        amount = (held * masks).sum(3) + 0.01 * held.sum(3)
        nearer = amount > best + SAME
        result[nearer], best[nearer] = index, amount[nearer]
    filled = fit.numbers > 0
    result[~filled] = 0
    result[filled & (result == 0)] = 1
    return result
