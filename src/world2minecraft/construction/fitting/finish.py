"""From gains to shapes that stand: stable, on legs, joined, symmetric, and without crumbs."""

import numpy as np

from world2minecraft.construction.fitting.joins import joined, parts_of_shapes
from world2minecraft.construction.fitting.masks import SUB
from world2minecraft.construction.fitting.problem import UP, Problem, Rules
from world2minecraft.construction.fitting.settle import settled, with_corners
from world2minecraft.construction.fitting.shapes import ShapeSet
from world2minecraft.construction.fitting.stilts import grounded, on_stilts

LEG_SHARE = 0.5  # Of what a column of blocks holds, so much is thin: then it is a leg.
POLE_FILL, POLE_SPAN = 0.2, 4  # A pole is half a block thick at most, both ways.
CRUMB_SHARE = 0.12  # A loose part of less than this share of an object is left out.


def finished(
    problem: Problem, shapes: ShapeSet, rules: Rules, held: np.ndarray | None = None
) -> tuple[np.ndarray, float]:
    """Return the shape of each block, intp [X, Y, Z], and the lam that chose it.

    Args:
        problem: what is wanted.
        shapes: what may be chosen.
        rules: how.
        held: bool [X, Y, Z], the blocks that have a wall or a ceiling beside them; None for none.
    """
    barred = _barred(problem, shapes, rules)
    ground = 0 if rules.stands else None
    grid, lam = settled(
        problem.gains, problem.cells, problem.shape, shapes, rules.lam, barred, ground
    )
    grid = evened(grid, shapes, rules.even)
    scores = problem.gains.scores(lam)
    scores[barred] = -np.inf
    apart = np.isin(shapes.kinds, ("carpet", "post"))
    scores[:, apart] = -np.inf
    if rules.stands and rules.legs:
        _add_legs(grid, problem, shapes)
    movable = np.flatnonzero(~apart[grid[problem.at]])
    grid = joined(grid, movable, scores, problem, shapes)
    grid = with_corners(evened(grid, shapes, rules.even), shapes)
    if rules.stands:
        grid = on_stilts(grid, problem, scores, shapes, held)
    grid = without_crumbs(grid, shapes, rules.stands, held, problem.floor)
    return with_corners(_without_bare_carpets(grid, shapes, ground), shapes), lam


def _barred(problem: Problem, shapes: ShapeSet, rules: Rules) -> np.ndarray:
    """Return what may not stand where, bool [N, S]."""
    barred = np.zeros((len(problem.cells), len(shapes)), bool)
    for axis in (0, 1):  # On a mirror plane, only what is its own mirror image.
        if rules.even[axis] and problem.shape[axis] % 2:
            on = problem.cells[:, axis] == problem.shape[axis] // 2
            barred |= on[:, None] & (shapes.mirrors[axis] != np.arange(len(shapes)))
    poles = _poles(problem)
    if (shapes.kinds == "post").any():
        barred |= ~poles[:, None] & (shapes.kinds == "post")
        barred |= (poles & rules.legs)[:, None] & shapes.is_upright
    if rules.flush:
        barred |= shapes.is_low
    return barred


def evened(grid: np.ndarray, shapes: ShapeSet, even: tuple[bool, bool]) -> np.ndarray:
    """Return shapes, int [X, Y, Z], with the high half made the mirror image of the low one."""
    result = grid.copy()
    for axis in (0, 1):
        if even[axis]:
            half = result.shape[axis] // 2
            low, high = [slice(None)] * 3, [slice(None)] * 3
            low[axis], high[axis] = slice(0, half), slice(result.shape[axis] - half, None)
            result[tuple(high)] = shapes.mirrors[axis][np.flip(result[tuple(low)], axis)]
    return result


def _poles(problem: Problem) -> np.ndarray:
    """Return which blocks hold a leg or a pole, bool [N]: upright, thin both ways, or its foot."""
    filled = problem.wanted.reshape(-1, SUB, SUB, SUB) > POLE_FILL
    upright = filled.any((1, 2)).sum(1) >= SUB - 1
    along, across = (np.asarray(filled.any(axes)) for axes in ((2, 3), (1, 3)))
    slim = np.maximum(_span(along), _span(across)) <= POLE_SPAN
    foot = np.median(filled.sum((1, 2)), axis=1) <= POLE_SPAN**2
    foot &= problem.cells[:, 2] == 0
    thin = problem.thin.sum(1) > LEG_SHARE * problem.wanted.sum(1)
    return upright & (slim | foot) & thin


def _span(rows: np.ndarray) -> np.ndarray:
    """Return how far apart the first and the last set cells of rows, bool [N, 8], are, int [N]."""
    first, last = rows.argmax(1), SUB - 1 - rows[:, ::-1].argmax(1)
    return np.where(rows.any(1), last - first + 1, 0)


def _add_legs(grid: np.ndarray, problem: Problem, shapes: ShapeSet) -> None:
    """Set posts, in place, where legs or a pole run from the floor to what was chosen."""
    numbers = np.flatnonzero(shapes.kinds == "post")
    if not len(numbers):
        return
    poles, runs = (np.zeros(problem.shape, bool) for _ in range(2))
    poles[problem.at] = _poles(problem)
    runs[problem.at] = problem.flows[UP]
    tall = np.logical_and.accumulate(poles & runs, axis=2).sum(2)
    for x, y in np.argwhere(tall):
        top = int(tall[x, y])
        if top < grid.shape[2] and grid[x, y, top]:
            grid[x, y, :top] = numbers[0]


def without_crumbs(
    grid: np.ndarray,
    shapes: ShapeSet,
    stands: bool,
    held: np.ndarray | None = None,
    floor: int = 0,
) -> np.ndarray:
    """Return shapes, int [X, Y, Z], without the parts that touch neither floor, wall nor rest.

    Of what does not stand the larger parts stay, and something always does. ``floor`` is the
    sub-cell of the lowest layer on which it stands.
    """
    parts = parts_of_shapes(grid, shapes)
    volumes = np.bincount(parts.ravel(), shapes.volumes[grid].ravel())
    volumes[0] = 0
    if not volumes.any():
        return grid
    keep = grounded(grid, parts, shapes, stands, held, floor)
    if not stands:
        keep |= volumes >= CRUMB_SHARE * volumes.sum()
    keep[0] = False
    if not keep.any():
        keep[int(volumes.argmax())] = True
    return np.where(keep[parts], grid, 0)


def _without_bare_carpets(grid: np.ndarray, shapes: ShapeSet, ground: int | None) -> np.ndarray:
    """Return shapes, int [X, Y, Z], without carpets under which nothing is left."""
    bare = np.zeros(grid.shape, bool)
    bare[:, :, 1:] = grid[:, :, :-1] == 0
    bare[:, :, 0] = ground is None
    return np.where(bare & (shapes.kinds[grid] == "carpet"), 0, grid)


def without_loose(grid: np.ndarray, shapes: ShapeSet, held: np.ndarray) -> np.ndarray:
    """Return shapes, int [X, Y, Z], without single blocks that touch nothing and are not held."""
    parts = parts_of_shapes(grid, shapes)
    sizes = np.bincount(parts.ravel())
    keep = (sizes > 1) | np.isin(np.arange(len(sizes)), parts[held])
    return np.where(keep[parts] & (parts > 0), grid, 0)
