"""Cells as runs: ``[[start, length], ...]`` of flat C-order numbers, sorted and apart."""

from collections.abc import Sequence

import numpy as np

from world2minecraft.core.errors import UsageError


def runs_of_cells(cells: np.ndarray, shape: tuple[int, int, int]) -> np.ndarray:
    """Return the runs, int64 [R, 2], that name the cells int [N, 3] of a grid."""
    flat = np.asarray(np.ravel_multi_index(tuple(cells.T), shape))
    if not (flat[1:] > flat[:-1]).all():  # np.unique takes seconds for millions of cells.
        flat = np.sort(flat)
        flat = flat[np.diff(flat, prepend=-1) > 0]
    if not len(flat):
        return np.zeros((0, 2), np.int64)
    first = np.flatnonzero(np.diff(flat, prepend=flat[0] - 2) > 1)
    lengths = np.diff(first, append=len(flat))
    return np.column_stack([flat[first], lengths])


def cells_of_runs(runs: Sequence[Sequence[int]], shape: tuple[int, int, int]) -> np.ndarray:
    """Return the cells, int32 [N, 3], that runs name; sizes are checked before memory is taken.

    Raises:
        UsageError: a run is empty, leaves the grid, or lies over another.
    """
    total = int(np.prod(shape))
    if not len(runs):
        return np.zeros((0, 3), np.int32)
    try:
        pairs = np.array(runs, np.int64).reshape(len(runs), 2)
    except (ValueError, OverflowError) as error:
        raise UsageError("cells must be pairs of a first number and a length") from error
    pairs = pairs[np.argsort(pairs[:, 0], kind="stable")]
    starts, lengths = pairs.T
    if (lengths < 1).any() or (starts < 0).any() or (lengths > total - starts).any():
        raise UsageError(f"a run of cells leaves the grid of {total:,} cells")
    ends = starts + lengths
    if (starts[1:] < ends[:-1]).any():
        raise UsageError("two runs of cells name the same cell")
    firsts = np.repeat(starts - np.concatenate([[0], np.cumsum(lengths)[:-1]]), lengths)
    flat = np.arange(int(lengths.sum())) + firsts
    return np.column_stack(np.unravel_index(flat, shape)).astype(np.int32)


def box_cells(low: Sequence[int], high: Sequence[int], shape: tuple[int, int, int]) -> np.ndarray:
    """Return the cells, int32 [N, 3] in C order, of a box; both corners are in it.

    Raises:
        UsageError: the box has no cell in the grid.
    """
    first = np.maximum(np.minimum(low, high), 0)
    last = np.minimum(np.maximum(low, high), np.array(shape) - 1)
    if (first > last).any():
        raise UsageError(f"the box from {list(low)} to {list(high)} lies outside the grid {shape}")
    sides = [np.arange(a, b + 1) for a, b in zip(first, last, strict=True)]
    return np.stack(np.meshgrid(*sides, indexing="ij"), axis=-1).reshape(-1, 3).astype(np.int32)
