"""One object by the best stable shapes, in its own frame, with a search over sub-block shifts.

A table on the room's grid vanishes at 2 blocks a metre; the same table moved by up to half a block
is a table. So an object is fitted about its own middle, and goes to the lattice afterwards.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from world2minecraft.fit.choose import Gains, choose, gains_of
from world2minecraft.fit.coverage import as_blocks
from world2minecraft.fit.joins import flows, joined, parts_of_shapes
from world2minecraft.fit.masks import SUB
from world2minecraft.fit.settle import settled, with_corners
from world2minecraft.fit.shapes import ShapeSet

PHASE_STEP = 2  # Sub-cells: quarters of a block; finer ones gained nothing.
THIN_WEIGHT = 2.0  # A thin sub-cell counts double: thin recall grows by half and more.
FINALISTS = 2  # Phases that are solved with joints after all were tried without.
LEG_SHARE = 0.5  # Of what a column of blocks holds, so much is thin: then it is a leg.
POLE_FILL, POLE_CELLS = 0.2, 16  # Seen from above a pole takes a quarter of its block at most.
EVEN = 0.85  # IoU with its mirror image from which an object is taken for symmetric.
CRUMB_SHARE = 0.12  # A loose part of less than this share of an object is left out.


class Target(NamedTuple):
    """What is wanted, in sub-cells about its own middle: x and y from -h to h, z from 0.

    ``bottom`` is the sub-cell, from 0 up to 7, at which it begins over a block's lower face.
    """

    wanted: np.ndarray  # float32 [2 h_x, 2 h_y, Z], the filled share of each sub-cell
    thin: np.ndarray  # float32, the part of it that is thin
    bottom: int = 0


class Fit(NamedTuple):
    """Shapes in a box of blocks, and where in it the object's middle lies."""

    numbers: np.ndarray  # intp [X, Y, Z]
    middle: np.ndarray  # float64 [2], blocks from the box's low corner
    iou: float  # of sub-cells, not weighted
    thin_recall: float
    lam: float
    wanted: np.ndarray  # float32 [X, Y, Z, 512], the target in the same blocks


def fit_solid(
    target: Target,
    shapes: ShapeSet,
    *,
    even: tuple[bool, bool] = (False, False),
    lam: float | None = None,
    stands: bool = True,
    calm: float = 1.0,
) -> Fit:
    """Return the best stable shapes for a target.

    Args:
        target: what is wanted.
        shapes: what may be chosen.
        even: whether the fit must be its own mirror image along x, and along y.
        lam: the IoU that all objects of a room reach together; None finds the object's own.
        stands: whether the layer at its bottom rests on something.
        calm: the factor on the prices of shapes; noisy cells come out quieter above 1.
    """
    tried = sorted(
        (
            (-round(reached, 6), phase)
            for phase, reached in attempts(target, shapes, even, lam, calm)
        ),
    )
    fits = [
        solve(target, phase, shapes, even=even, lam=lam, stands=stands, calm=calm)
        for _, phase in tried[:FINALISTS]
    ]
    return max(fits, key=lambda one: round(one.iou, 6))


def attempts(
    target: Target,
    shapes: ShapeSet,
    even: tuple[bool, bool],
    lam: float | None = None,
    calm: float = 1.0,
) -> Iterator[tuple[tuple[int, int], float]]:
    """Yield each phase, in sub-cells along x and y, and the IoU that free choice reaches there."""
    for phase in _phases(even):
        gains = _problem(target, phase, shapes, calm).gains
        yield phase, gains.iou(choose(gains, shapes, lam)[0])


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


def _phases(even: tuple[bool, bool]) -> Iterator[tuple[int, int]]:
    """Yield where the middle may lie in its block, in sub-cells along x and y."""
    along = [range(0, SUB, SUB // 2 if mirror else PHASE_STEP) for mirror in even]
    yield from ((x, y) for x in along[0] for y in along[1])


class _Problem(NamedTuple):
    wanted: np.ndarray  # float32 [X, Y, Z, 512]
    thin: np.ndarray  # float32 [X, Y, Z, 512]
    cells: np.ndarray  # int [N, 3], the blocks that hold any of it
    gains: Gains
    middle: np.ndarray  # float64 [2]


def _problem(target: Target, phase: tuple[int, int], shapes: ShapeSet, calm: float) -> _Problem:
    """Return a target in blocks, its middle at a phase."""
    half = [side // 2 for side in target.wanted.shape[:2]]
    start = [(phase[axis] - half[axis]) % SUB for axis in (0, 1)]
    before = [*start, target.bottom]
    widths = [(n, -(n + side) % SUB) for n, side in zip(before, target.wanted.shape, strict=True)]
    wanted, thin = (as_blocks(np.pad(values, widths)) for values in target[:2])
    used = wanted.any(3)
    cells = np.argwhere(used)
    own = wanted[used]
    gains = gains_of(own, own + np.float32(THIN_WEIGHT - 1) * thin[used], shapes, calm)
    return _Problem(wanted, thin, cells, gains, (np.array(start) + half) / SUB)


def solve(
    target: Target,
    phase: tuple[int, int],
    shapes: ShapeSet,
    *,
    even: tuple[bool, bool] = (False, False),
    lam: float | None = None,
    stands: bool = True,
    calm: float = 1.0,
) -> Fit:
    """Return the fit of a target at one phase: stable, joined, symmetric and without crumbs.

    Args: as of ``fit_solid``; ``phase`` is where the middle lies in its block, in sub-cells.
    """
    problem = _problem(_averaged(target, even), phase, shapes, calm)
    shape = problem.wanted.shape[:3]
    barred = _uneven(problem.cells, shape, shapes, even)
    barred |= _no_poles(problem, shapes)
    grid, lam = settled(
        problem.gains, problem.cells, shape, shapes, lam, barred, 0 if stands else None
    )
    grid = evened(grid, shapes, even)
    flow = flows(problem.wanted)
    scores = problem.gains.scores(lam).copy()
    scores[barred] = -np.inf
    scores[:, shapes.free :] = -np.inf
    scores[:, np.isin(shapes.kinds, ("carpet", "post"))] = -np.inf
    if stands:
        _add_legs(grid, problem, flow, shapes)
    posts = np.isin(shapes.kinds[grid[tuple(problem.cells.T)]], ("carpet", "post"))
    grid = joined(grid, problem.cells[~posts], scores[~posts], flow, shapes)
    grid = with_corners(evened(grid, shapes, even), shapes)
    grid = without_crumbs(grid, shapes, stands)
    return _fit(grid, problem, shapes, lam)


def _uneven(cells, shape, shapes, even) -> np.ndarray:
    """Return what must not stand on a mirror plane: shapes that are not their own mirror image."""
    barred = np.zeros((len(cells), len(shapes)), bool)
    for axis in (0, 1):
        if even[axis] and shape[axis] % 2:
            on = cells[:, axis] == shape[axis] // 2
            barred |= on[:, None] & (shapes.mirrors[axis] != np.arange(len(shapes)))
    return barred


def _no_poles(problem: _Problem, shapes: ShapeSet) -> np.ndarray:
    """Return where no post may stand: only what is upright and thin both ways is a leg or pole."""
    cells = problem.wanted[tuple(problem.cells.T)].reshape(-1, SUB, SUB, SUB)
    upright = (cells.max((1, 2)) > POLE_FILL).sum(1) >= SUB - 1
    slim = (cells.max(3) > POLE_FILL).sum((1, 2)) <= POLE_CELLS
    return ~(upright & slim)[:, None] & (shapes.kinds == "post")


def evened(grid: np.ndarray, shapes: ShapeSet, even: tuple[bool, bool]) -> np.ndarray:
    """Return shapes, int [X, Y, Z], with the high half made the mirror image of the low one."""
    result = grid.copy()
    for axis in (0, 1):
        if even[axis]:
            half = result.shape[axis] // 2
            low = [slice(None)] * 3
            low[axis] = slice(0, half)
            high = [slice(None)] * 3
            high[axis] = slice(result.shape[axis] - half, None)
            result[tuple(high)] = shapes.mirrors[axis][np.flip(result[tuple(low)], axis)]
    return result


def _add_legs(grid: np.ndarray, problem: _Problem, flow: np.ndarray, shapes: ShapeSet) -> None:
    """Set posts, in place, where something thin runs down to the floor from what was chosen."""
    numbers = np.flatnonzero(shapes.kinds == "post")
    if not len(numbers):
        return
    held = problem.wanted.sum(3)
    thin = problem.thin.sum(3) > LEG_SHARE * held
    for x, y in np.argwhere((grid > 0).any(2)):
        first = int(np.argmax(grid[x, y] > 0))
        below = slice(0, first)
        if first and thin[x, y, below].all() and flow[4, x, y, below].all():
            grid[x, y, below] = numbers[0]


def without_crumbs(grid: np.ndarray, shapes: ShapeSet, stands: bool) -> np.ndarray:
    """Return shapes, int [X, Y, Z], without small parts that touch neither floor nor the rest."""
    parts = parts_of_shapes(grid, shapes)
    volumes = np.bincount(parts.ravel(), shapes.volumes[grid].ravel())
    volumes[0] = 0
    if not volumes.any():
        return grid
    keep = volumes >= CRUMB_SHARE * volumes.sum()
    keep[int(volumes.argmax())] = True
    if stands:
        keep[np.unique(parts[:, :, 0])] = True
    keep[0] = False
    return np.where(keep[parts], grid, 0)


def without_loose(grid: np.ndarray, shapes: ShapeSet, held: np.ndarray) -> np.ndarray:
    """Return shapes, int [X, Y, Z], without single blocks that touch nothing and are not held."""
    parts = parts_of_shapes(grid, shapes)
    sizes = np.bincount(parts.ravel())
    keep = (sizes > 1) | np.isin(np.arange(len(sizes)), parts[held])
    return np.where(keep[parts] & (parts > 0), grid, 0)


def _fit(grid: np.ndarray, problem: _Problem, shapes: ShapeSet, lam: float) -> Fit:
    """Return a fit with its scores, trimmed to the blocks that it fills."""
    masks = shapes.masks[grid]
    shared = float((masks * problem.wanted).sum(dtype=np.float64))
    filled = float(shapes.volumes[grid].sum(dtype=np.float64))
    whole = float(problem.wanted.sum(dtype=np.float64))
    thin = float(problem.thin.sum(dtype=np.float64))
    recall = float((masks * problem.thin).sum(dtype=np.float64)) / thin if thin else 1.0
    box, low = _filled_box(grid)
    middle = problem.middle - low[:2]
    iou = shared / max(whole + filled - shared, 1e-9)
    return Fit(grid[box], middle, iou, recall, lam, problem.wanted[box])


def _filled_box(grid: np.ndarray) -> tuple[tuple[slice, ...], np.ndarray]:
    """Return the box of the filled blocks, from the lowest layer on, and its first block."""
    at = np.argwhere(grid > 0)
    if not len(at):
        return (slice(0, 1),) * 3, np.zeros(3, int)
    low, high = at.min(0) * [1, 1, 0], at.max(0) + 1
    return tuple(slice(int(a), int(b)) for a, b in zip(low, high, strict=True)), low
