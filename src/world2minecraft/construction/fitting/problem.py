"""What is to be fitted, as blocks of sub-cells, and by which rules."""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from world2minecraft.construction.fitting.coverage import as_blocks
from world2minecraft.construction.fitting.masks import SUB
from world2minecraft.construction.fitting.selection import Gains, gains_of
from world2minecraft.construction.fitting.shapes import ShapeSet

THIN_WEIGHT = 2.0  # A thin sub-cell counts double: thin recall grows by half and more.
LEAST_FLOW = 0.5  # Sub-cells of a face (of 64) from which the wanted runs through it.
WAYS = np.array([(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)])
UP, DOWN = 4, 5


@dataclass(frozen=True)
class Rules:
    """By which rules shapes are chosen.

    lam: the IoU that all objects of a room reach together; None finds the object's own.
    calm: the factor on the prices of shapes; noisy cells come out quieter above 1.
    even: whether the fit must be its own mirror image along x, and along y.
    stands: whether the lowest layer rests on something.
    flush: whether flat tops end with their block, so that things can lie on them.
    legs: whether every leg and pole becomes posts. It reads better and costs some IoU: a panel in
        the right place meets more of a leg than a post in the middle of its block.
    phase: where the middle must lie in its block, in sub-cells along x and y; None is free.
    """

    lam: float | None = None
    calm: float = 1.0
    even: tuple[bool, bool] = (False, False)
    stands: bool = True
    flush: bool = False
    legs: bool = False
    phase: tuple[int | None, int | None] = (None, None)


class Target(NamedTuple):
    """What is wanted, in sub-cells about its own middle: x and y from -h to h, z from 0.

    ``bottom`` is the sub-cell, from 0 up to 7, at which it begins over a block's lower face.
    """

    wanted: np.ndarray  # float32 [2 h_x, 2 h_y, Z], the filled share of each sub-cell
    thin: np.ndarray  # float32, the part of it that is thin
    bottom: int = 0


@dataclass(frozen=True, eq=False)
class Problem:
    """A target in the blocks that hold any of it.

    ``middle`` is where its own middle lies, in blocks; ``floor`` is the sub-cell of the lowest
    layer at which it begins.
    """

    shape: tuple[int, ...]
    cells: np.ndarray  # int64 [N, 3]
    wanted: np.ndarray  # float32 [N, 512]
    thin: np.ndarray  # float32 [N, 512]
    gains: Gains
    middle: np.ndarray  # float64 [2]
    floor: int = 0

    @property
    def at(self) -> tuple[np.ndarray, ...]:
        """The blocks as an index into an array of ``shape``."""
        return tuple(self.cells.T)

    @cached_property
    def rows(self) -> np.ndarray:
        """int64 [X + 2, Y + 2, Z + 2]: the row of each block, -1 where there is none; padded."""
        rows = np.full([side + 2 for side in self.shape], -1)
        rows[tuple((self.cells + 1).T)] = np.arange(len(self.cells))
        return rows

    @cached_property
    def flows(self) -> np.ndarray:
        """Bool [6, N]: through which faces the wanted runs on, in the order of ``WAYS``."""
        cells = self.wanted.reshape(-1, SUB, SUB, SUB)
        result = np.zeros((6, len(cells)), bool)
        for axis in range(3):
            low, high = (np.take(cells, side, axis + 1) for side in (0, SUB - 1))
            other = self.rows[tuple((self.cells + 1 + WAYS[2 * axis]).T)]
            here = np.flatnonzero(other >= 0)
            there = other[here]
            runs = np.minimum(high[here], low[there]).sum((1, 2)) > LEAST_FLOW
            result[2 * axis, here[runs]] = True
            result[2 * axis + 1, there[runs]] = True
        return result


def problem_of(
    cells: np.ndarray,
    wanted: np.ndarray,
    thin: np.ndarray,
    shape: tuple[int, ...],
    shapes: ShapeSet,
    calm: float = 1.0,
    middle: tuple[float, float] = (0.0, 0.0),
    floor: int = 0,
) -> Problem:
    """Return the problem of blocks of sub-cells.

    Args:
        cells: int [N, 3], the blocks that hold any of the wanted.
        wanted: float32 [N, 512], the filled share of their sub-cells.
        thin: float32 [N, 512], the part of it that is thin.
        shape: how many blocks there are along each axis.
        shapes: what may be chosen.
        calm: the factor on their prices.
        middle: where the middle of the wanted lies, in blocks along x and y.
        floor: the sub-cell of the lowest layer at which the wanted begins.
    """
    gains = gains_of(wanted, wanted + np.float32(THIN_WEIGHT - 1) * thin, shapes, calm)
    return Problem(shape, cells, wanted, thin, gains, np.array(middle), floor)


def problem_at(
    target: Target, phase: tuple[int, int], shapes: ShapeSet, calm: float = 1.0
) -> Problem:
    """Return the problem of a target whose middle lies at a phase: sub-cells along x and y."""
    half = [side // 2 for side in target.wanted.shape[:2]]
    start = [(phase[axis] - half[axis]) % SUB for axis in (0, 1)]
    before = [*start, target.bottom]
    widths = [(n, -(n + side) % SUB) for n, side in zip(before, target.wanted.shape, strict=True)]
    wanted, thin = (as_blocks(np.pad(values, widths)) for values in target[:2])
    used = wanted.any(3)
    x, y = ((start[axis] + half[axis]) / SUB for axis in (0, 1))
    blocks = (np.argwhere(used), wanted[used], thin[used], used.shape)
    return problem_of(*blocks, shapes, calm, (x, y), target.bottom)
