"""Fitting of an object by stable shapes, searched over sub-block shifts and small stretches.

A table aligned with the room's grid can vanish at 2 blocks per metre, while the same table shifted
by up to half a block is preserved. Objects are therefore fitted around their own centre and placed
on the lattice afterwards. Objects given as boxes may also be stretched by up to a quarter, at a
cost: a seat at a height of 1.8 blocks cannot be connected to legs that end at 1 or 2.
"""

import hashlib
from collections import OrderedDict
from collections.abc import Iterator
from itertools import product
from threading import Lock
from typing import Any, NamedTuple

import numpy as np

from world2minecraft.construction.fitting.problem import (
    THIN_M,
    Problem,
    Rules,
    Target,
    cover_boxes,
    problem_at,
)
from world2minecraft.construction.fitting.selection import choose
from world2minecraft.construction.fitting.shapes import SUB, ShapeSet, shape_set
from world2minecraft.construction.fitting.stabilization import broken_share, stabilize

PHASE_STEP = 1  # Sub-cells: of 64 shifts the best is worth 0.03 of IoU more than of 16.
FINALISTS = 6  # Phases that are solved with joints after all were tried without.
EVEN = 0.85  # IoU with its mirror image from which an object is taken for symmetric.
DEFAULT_RULES = Rules()
MAX_STRETCH, MIN_STRETCH = 1.25, 0.8
TALLEST = 1.15  # A higher chair does not fit under its table.
STRETCH_COST = 0.25  # IoU given up for a stretch by the factor e.
JOINT_COST = 0.5  # IoU given up where no joint touches.
THIN_WORTH = 0.2  # IoU that all of the thin parts are worth.
HEIGHTS = 8  # At most so many heights are tried.
SAME = 1e-6
MAX_KEPT = 256  # Fits; one has some kilobytes.


class Fit(NamedTuple):
    """The block shapes of a fitted object, its centre in the box, and the fit's scores."""

    numbers: np.ndarray  # intp [X, Y, Z]
    middle: np.ndarray  # float64 [2], blocks from the box's low corner
    iou: float  # of sub-cells, not weighted
    thin_recall: float
    lam: float


def fit_solid(target: Target, shapes: ShapeSet, rules: Rules = DEFAULT_RULES) -> Fit:
    """Fit the best stable shapes to a target, over all of its shifts.

    Args:
        target: The occupancy to fit.
        shapes: Shapes that may be used.
        rules: Rules of the fit.
    """
    tried = sorted(
        (-round(reached, 6), phase) for phase, reached in score_phases(target, shapes, rules)
    )
    fits = [solve(target, phase, shapes, rules) for _, phase in tried[:FINALISTS]]
    return max(fits, key=lambda one: round(one.iou, 6))


class _Fits:
    """The latest fits by what they depend on: repair builds a room again and again."""

    def __init__(self):
        self._fits: OrderedDict[tuple[Any, ...], Fit] = OrderedDict()
        self._lock = Lock()

    def get(self, key: tuple[Any, ...]) -> Fit | None:
        """Return a fit, or None."""
        with self._lock:
            if key in self._fits:
                self._fits.move_to_end(key)
            return self._fits.get(key)

    def put(self, key: tuple[Any, ...], fit: Fit) -> None:
        """Keep a fit, and forget the one that was not used for longest."""
        with self._lock:
            self._fits[key] = fit
            while len(self._fits) > MAX_KEPT:
                self._fits.popitem(last=False)


_FITS = _Fits()


def fit_once(
    target: Target,
    kinds: frozenset[str],
    rules: Rules = DEFAULT_RULES,
    phase: tuple[int, int] | None = None,
) -> Fit:
    """Return the result of ``fit_solid``, or of ``solve`` at a phase, and keep it for a repetition.

    Args:
        target: The occupancy to fit.
        kinds: Kinds of shape that may be used.
        rules: Rules of the fit.
        phase: Position of the centre, in sub-cells along x and y. None tries all of them.
    """
    content = hashlib.blake2b(digest_size=16)
    for array in (target.wanted, target.thin):
        content.update(repr((array.shape, array.dtype.str)).encode())
        content.update(np.ascontiguousarray(array).data)
    key = (content.digest(), target.bottom, kinds, rules, phase)
    if (found := _FITS.get(key)) is not None:
        return found
    shapes = shape_set(kinds)
    fit = fit_solid(target, shapes, rules) if phase is None else solve(target, phase, shapes, rules)
    fit.numbers.flags.writeable = fit.middle.flags.writeable = False
    _FITS.put(key, fit)
    return fit


def score_phases(
    target: Target, shapes: ShapeSet, rules: Rules
) -> Iterator[tuple[tuple[int, int], float]]:
    """Yield each phase, in sub-cells along x and y, and the IoU of an unconstrained fit there."""
    for phase in _phases(rules):
        gains = problem_at(target, phase, shapes, rules.calm).gains
        yield phase, gains.iou(choose(gains, shapes, rules.lam)[0])


def _phases(rules: Rules) -> Iterator[tuple[int, int]]:
    """Yield the allowed positions of the centre in its block, in sub-cells along x and y."""
    along = [
        range(0, SUB, SUB // 2 if mirror else PHASE_STEP) if fixed is None else (fixed,)
        for mirror, fixed in zip(rules.even, rules.phase, strict=True)
    ]
    yield from ((x, y) for x in along[0] for y in along[1])


def solve(
    target: Target, phase: tuple[int, int], shapes: ShapeSet, rules: Rules = DEFAULT_RULES
) -> Fit:
    """Fit a target whose centre is at a given phase, in sub-cells along x and y."""
    problem = problem_at(_symmetrize(target, rules.even), phase, shapes, rules.calm)
    grid, lam = stabilize(problem, shapes, rules)
    if not grid.any():
        _put_best(grid, problem, shapes)
    return evaluate_fit(grid, problem, shapes, lam)


def _put_best(grid: np.ndarray, problem: Problem, shapes: ShapeSet) -> None:
    """Set, in place, the best block of an object for which no shape pays, so that it is visible."""
    able = np.flatnonzero(~np.isin(shapes.kinds[: shapes.free], ("empty", "carpet", "post")))
    met, spilt = problem.gains.met[:, able], problem.gains.spilt[:, able]
    row, column = np.unravel_index(int(np.argmax(met / (problem.gains.whole + spilt))), met.shape)
    grid[tuple(problem.cells[row])] = able[column]


def find_symmetry(target: Target) -> tuple[bool, bool]:
    """Return whether a target is nearly mirror-symmetric along x and along y."""
    result = []
    for axis in (0, 1):
        other = np.flip(target.wanted, axis)
        shared = float(np.minimum(target.wanted, other).sum())
        whole = float(np.maximum(target.wanted, other).sum())
        result.append(shared >= EVEN * whole)
    return result[0], result[1]


def _symmetrize(target: Target, even: tuple[bool, bool]) -> Target:
    """Return the mean of a target and its mirror images."""
    for axis in (0, 1):
        if even[axis]:
            wanted, thin = ((one + np.flip(one, axis)) / 2 for one in target[:2])
            target = target._replace(wanted=wanted, thin=thin)
    return target


def evaluate_fit(grid: np.ndarray, problem: Problem, shapes: ShapeSet, lam: float) -> Fit:
    """Score shapes [X, Y, Z] against a problem and trim them to the filled blocks."""
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
    """Return the box of the filled blocks, from the lowest layer up, and its first block."""
    at = np.argwhere(grid > 0)
    if not len(at):
        return (slice(0, 1),) * 3, np.zeros(3, int)
    low, high = at.min(0) * [1, 1, 0], at.max(0) + 1
    return tuple(slice(int(a), int(b)) for a, b in zip(low, high, strict=True)), low


class PartsFit(NamedTuple):
    """A fit of furniture given as boxes, and the box that fills most of each block."""

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
    """Fit the best stable shapes to furniture given as boxes.

    Args:
        boxes_m: Boxes in metres around the centre of the footprint, float64 [N, 6]; z = 0 is the
            bottom.
        blocks_per_metre: Scale of the build.
        shapes: Shapes that may be used.
        counts: Number of blocks to fill along x and y; by default, the fit chooses it.
        bottom: Sub-cell, 0 to 7, above the lower face of a block at which the furniture begins.
        flush: Whether flat tops must end at a block boundary, so that objects can rest on them.

    Raises:
        ValueError: If ``boxes_m`` is empty.
    """
    boxes = np.asarray(boxes_m, np.float64).reshape(-1, 6) * blocks_per_metre
    if not len(boxes):
        raise ValueError("boxes_m must contain at least one box")
    boxes = boxes - np.tile(
        [*((boxes[:, :2].min(0) + boxes[:, 3:5].max(0)) / 2), boxes[:, 2].min()], 2
    )
    thin = (boxes[:, 3:] - boxes[:, :3]).min(1) < THIN_M * blocks_per_metre
    rules = Rules(even=(_is_even(boxes, 0), _is_even(boxes, 1)), flush=flush, legs=True)
    best: tuple[float, Fit, np.ndarray] | None = None
    for factors, phase in _finalists(boxes, thin, shapes, rules, counts, bottom):
        target = _target(boxes * np.tile(factors, 2), thin, bottom)
        problem = problem_at(target, phase, shapes)
        grid, lam = stabilize(problem, shapes, rules)
        fit = evaluate_fit(grid, problem, shapes, lam)
        score = fit.iou + THIN_WORTH * fit.thin_recall - _cost(factors, counts)
        score -= JOINT_COST * broken_share(grid, problem, shapes)
        if best is None or score > best[0] + SAME:
            best = score, fit, factors
    if best is None:
        raise ValueError("no height was tried for the furniture")
    _, fit, factors = best
    return PartsFit(fit, _owners(boxes * np.tile(factors, 2), fit, shapes, bottom))


def _finalists(boxes, thin, shapes, rules, counts, bottom):
    """Return for each height the best stretch and phase without joints."""
    size = boxes[:, 3:].max(0) - boxes[:, :3].min(0)
    sides = [_sides(size[axis], None if counts is None else counts[axis]) for axis in (0, 1)]
    found = []
    for tall in _heights(boxes, bottom):
        tried = []
        for wide in product(*sides):
            factors = np.array([*wide, tall])
            target = _target(boxes * np.tile(factors, 2), thin, bottom)
            for phase, reached in score_phases(target, shapes, rules):
                if counts is not None and phase != tuple(4 * (n % 2) for n in counts):
                    continue
                tried.append((reached - _cost(factors, counts), factors, phase))
        best = max(tried, key=lambda one: round(one[0], 6))
        found.append(best[1:])
    return found


def _sides(size: float, count: int | None) -> list[float]:
    """Return the stretches to try along a horizontal axis."""
    if count is not None:
        return [count / size]
    halves = max(round(2 * size), 1) / 2
    factor = halves / size
    return (
        [1.0, factor] if MIN_STRETCH <= factor <= MAX_STRETCH and abs(factor - 1) > SAME else [1.0]
    )


def _heights(boxes: np.ndarray, bottom: int) -> list[float]:
    """Return the vertical stretches to try; each moves a plate or the top to a block boundary."""
    levels = np.unique(np.round(boxes[:, [2, 5]].ravel(), 4))
    factors = {1.0}
    start = bottom / SUB
    for level in levels[levels > 0.25].tolist():
        for edge in (np.floor(level + start), np.ceil(level + start)):
            factor = (edge - start) / level
            if MIN_STRETCH <= factor <= TALLEST:
                factors.add(round(float(factor), 4))
    return sorted(factors, key=lambda one: abs(np.log(one)))[:HEIGHTS]


def _target(boxes: np.ndarray, thin: np.ndarray, bottom: int) -> Target:
    """Return boxes around their centre as a target."""
    half = np.ceil(boxes[:, 3:5].max(0) * SUB - SAME).astype(int)
    tall = int(np.ceil(boxes[:, 5].max() * SUB - SAME))
    moved = boxes + np.tile([*(half / SUB), 0], 2)
    counts = [-(-side // SUB) for side in (*(2 * half), tall)]
    inside = tuple(slice(0, int(side)) for side in (*(2 * half), tall))
    wanted = cover_boxes(moved, counts)[inside]
    thick = cover_boxes(moved[~thin], counts)[inside]
    return Target(wanted, np.maximum(wanted - thick, 0), bottom)


def _is_even(boxes: np.ndarray, axis: int) -> bool:
    """Return whether boxes are mirror-symmetric along an axis."""
    other = boxes.copy()
    other[:, axis], other[:, axis + 3] = -boxes[:, axis + 3], -boxes[:, axis]
    one, two = (np.round(rows, 4) for rows in (boxes, other))
    return bool(np.array_equal(np.unique(one, axis=0), np.unique(two + 0.0, axis=0)))


def _cost(factors: np.ndarray, counts: tuple[int, int] | None) -> float:
    free = factors if counts is None else factors[2:]
    return STRETCH_COST * float(np.abs(np.log(free)).sum())


def _owners(boxes: np.ndarray, fit: Fit, shapes: ShapeSet, bottom: int) -> np.ndarray:
    """Return the box that fills most of each block, int16 [X, Y, Z]."""
    moved = boxes + np.tile([*fit.middle, bottom / SUB], 2)
    best = np.zeros(fit.numbers.shape, np.float32)
    result = np.zeros(fit.numbers.shape, np.int16)
    shape = fit.numbers.shape
    masks = shapes.masks[fit.numbers]
    for index, box in enumerate(moved, 1):
        share = cover_boxes(box[None], shape)
        cells = share.reshape(shape[0], SUB, shape[1], SUB, shape[2], SUB)
        held = cells.transpose(0, 2, 4, 1, 3, 5).reshape(*shape, -1)
        amount = (held * masks).sum(3) + 0.01 * held.sum(3)
        nearer = amount > best + SAME
        result[nearer], best[nearer] = index, amount[nearer]
    filled = fit.numbers > 0
    result[~filled] = 0
    result[filled & (result == 0)] = 1
    return result
