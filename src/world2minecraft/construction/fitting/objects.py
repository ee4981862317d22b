"""One object by the best stable shapes, in its own frame, with a search over sub-block shifts.

A table on the room's grid vanishes at 2 blocks a metre; the same table moved by up to half a block
is a table. So an object is fitted about its own middle, and goes to the lattice afterwards.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from world2minecraft.construction.fitting.finish import finished
from world2minecraft.construction.fitting.masks import SUB
from world2minecraft.construction.fitting.problem import Problem, Rules, Target, problem_at
from world2minecraft.construction.fitting.selection import choose
from world2minecraft.construction.fitting.shapes import ShapeSet

PHASE_STEP = 1  # Sub-cells: of 64 shifts the best is worth 0.03 of IoU more than of 16.
FINALISTS = 6  # Phases that are solved with joints after all were tried without.
EVEN = 0.85  # IoU with its mirror image from which an object is taken for symmetric.
USUAL = Rules()


class Fit(NamedTuple):
    """Shapes in a box of blocks, and where in it the object's middle lies."""

    numbers: np.ndarray  # intp [X, Y, Z]
    middle: np.ndarray  # float64 [2], blocks from the box's low corner
    iou: float  # of sub-cells, not weighted
    thin_recall: float
    lam: float


def fit_solid(target: Target, shapes: ShapeSet, rules: Rules = USUAL) -> Fit:
    """Return the best stable shapes for a target, at the best of its shifts.

    Args:
        target: what is wanted.
        shapes: what may be chosen.
        rules: how.
    """
    tried = sorted(
        (-round(reached, 6), phase) for phase, reached in attempts(target, shapes, rules)
    )
    fits = [solve(target, phase, shapes, rules) for _, phase in tried[:FINALISTS]]
    return max(fits, key=lambda one: round(one.iou, 6))


def attempts(
    target: Target, shapes: ShapeSet, rules: Rules
) -> Iterator[tuple[tuple[int, int], float]]:
    """Yield each phase, in sub-cells along x and y, and the IoU that free choice reaches there."""
    for phase in _phases(rules):
        gains = problem_at(target, phase, shapes, rules.calm).gains
        yield phase, gains.iou(choose(gains, shapes, rules.lam)[0])


def _phases(rules: Rules) -> Iterator[tuple[int, int]]:
    """Yield where the middle may lie in its block, in sub-cells along x and y."""
    along = [
        range(0, SUB, SUB // 2 if mirror else PHASE_STEP) if fixed is None else (fixed,)
        for mirror, fixed in zip(rules.even, rules.phase, strict=True)
    ]
    yield from ((x, y) for x in along[0] for y in along[1])


def solve(target: Target, phase: tuple[int, int], shapes: ShapeSet, rules: Rules = USUAL) -> Fit:
    """Return the fit of a target whose middle lies at a phase: sub-cells along x and y."""
    problem = problem_at(_averaged(target, rules.even), phase, shapes, rules.calm)
    grid, lam = finished(problem, shapes, rules)
    if not grid.any():
        _put_best(grid, problem, shapes)
    return fit_of(grid, problem, shapes, lam)


def _put_best(grid: np.ndarray, problem: Problem, shapes: ShapeSet) -> None:
    """Set, in place, the one block that shows most of what no shape is worth: nothing vanishes."""
    able = np.flatnonzero(~np.isin(shapes.kinds[: shapes.free], ("empty", "carpet", "post")))
    met, spilt = problem.gains.met[:, able], problem.gains.spilt[:, able]
    row, column = np.unravel_index(int(np.argmax(met / (problem.gains.whole + spilt))), met.shape)
    grid[tuple(problem.cells[row])] = able[column]


def even_of(target: Target) -> tuple[bool, bool]:
    """Return whether a target is nearly its own mirror image along x, and along y."""
    result = []
    for axis in (0, 1):
        other = np.flip(target.wanted, axis)
        shared = float(np.minimum(target.wanted, other).sum())
        whole = float(np.maximum(target.wanted, other).sum())
        result.append(shared >= EVEN * whole)
    return result[0], result[1]


def _averaged(target: Target, even: tuple[bool, bool]) -> Target:
    """Return the mean of a target and its mirror images."""
    for axis in (0, 1):
        if even[axis]:
            wanted, thin = ((one + np.flip(one, axis)) / 2 for one in target[:2])
            target = target._replace(wanted=wanted, thin=thin)
    return target


def fit_of(grid: np.ndarray, problem: Problem, shapes: ShapeSet, lam: float) -> Fit:
    """Return shapes [X, Y, Z] with their scores, trimmed to the blocks that they fill."""
    masks = shapes.masks[grid[problem.at]]
    shared = float((masks * problem.wanted).sum(dtype=np.float64))
    filled = float(shapes.volumes[grid].sum(dtype=np.float64))
    whole = float(problem.wanted.sum(dtype=np.float64))
    thin = float(problem.thin.sum(dtype=np.float64))
    recall = float((masks * problem.thin).sum(dtype=np.float64)) / thin if thin else 1.0
    box, low = _filled_box(grid)
    iou = shared / max(whole + filled - shared, 1e-9)
    return Fit(grid[box], problem.middle - low[:2], iou, recall, lam)


def _filled_box(grid: np.ndarray) -> tuple[tuple[slice, ...], np.ndarray]:
    """Return the box of the filled blocks, from the lowest layer on, and its first block."""
    at = np.argwhere(grid > 0)
    if not len(at):
        return (slice(0, 1),) * 3, np.zeros(3, int)
    low, high = at.min(0) * [1, 1, 0], at.max(0) + 1
    return tuple(slice(int(a), int(b)) for a, b in zip(low, high, strict=True)), low
