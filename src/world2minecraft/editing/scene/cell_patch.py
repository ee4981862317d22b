"""Cells as runs, and patches that combine several changes of cells into one operation.

Runs are ``[[start, length], ...]`` of flat C-order cell indices, sorted and without overlap.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import OBSERVED, GridCells, Operation
from world2minecraft.editing.scene.scene_draft import ARRAYS, SceneDraft


def runs_of_cells(cells: np.ndarray, shape: tuple[int, int, int]) -> np.ndarray:
    """Return the runs, int64 [R, 2], of the cells int [N, 3] of a grid."""
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
    """Return the cells, int32 [N, 3], that runs contain, checking sizes before allocating memory.

    Raises:
        UsageError: If a run is empty, extends beyond the grid or overlaps another run.
    """
    total = int(np.prod(shape))
    if not len(runs):
        return np.zeros((0, 3), np.int32)
    try:
        pairs = np.array(runs, np.int64).reshape(len(runs), 2)
    except (ValueError, OverflowError) as error:
        raise UsageError("cells must be [start, length] pairs of integers") from error
    pairs = pairs[np.argsort(pairs[:, 0], kind="stable")]
    starts, lengths = pairs.T
    if (lengths < 1).any() or (starts < 0).any() or (lengths > total - starts).any():
        raise UsageError(f"a run of cells extends beyond the grid of {total:,} cells")
    ends = starts + lengths
    if (starts[1:] < ends[:-1]).any():
        raise UsageError("two runs of cells overlap")
    firsts = np.repeat(starts - np.concatenate([[0], np.cumsum(lengths)[:-1]]), lengths)
    flat = np.arange(int(lengths.sum())) + firsts
    return np.column_stack(np.unravel_index(flat, shape)).astype(np.int32)


def box_cells(low: Sequence[int], high: Sequence[int], shape: tuple[int, int, int]) -> np.ndarray:
    """Return the cells, int32 [N, 3] in C order, of a box with inclusive corners.

    Raises:
        UsageError: If the box contains no cell of the grid.
    """
    first = np.maximum(np.minimum(low, high), 0)
    last = np.minimum(np.maximum(low, high), np.array(shape) - 1)
    if (first > last).any():
        raise UsageError(
            f"the box from {list(low)} to {list(high)} is outside the grid of shape {shape}"
        )
    sides = [np.arange(a, b + 1) for a, b in zip(first, last, strict=True)]
    return np.stack(np.meshgrid(*sides, indexing="ij"), axis=-1).reshape(-1, 3).astype(np.int32)


class Patch:
    """Changes to the cells of a draft, in which later changes of a cell replace earlier ones.

    The draft is not changed. ``plan_operation`` omits cells that stay the same.
    """

    def __init__(self, draft: SceneDraft):
        self._draft = draft
        self._cells: list[np.ndarray] = []
        self._held: list[GridCells] = []

    def put(self, cells: np.ndarray, held: GridCells) -> None:
        """Set the full contents of cells, int [N, 3]."""
        self._cells.append(cells.reshape(-1, 3))
        self._held.append(held)

    def empty(self, cells: np.ndarray) -> None:
        """Set cells to observed and empty."""
        self.fill(cells, 0, 0)

    def fill(self, cells: np.ndarray, class_id: int, instance: int) -> None:
        """Set the class and object id of cells, observed with full confidence, keeping colours."""
        count = len(cells)
        held = GridCells(
            np.full(count, class_id, np.uint8),
            np.ones(count, np.float16),
            self._draft.colour[tuple(cells.T)],
            np.full(count, OBSERVED, np.uint8),
            np.full(count, instance, np.uint16),
        )
        self.put(cells, held)

    def give(self, cells: np.ndarray, instance: int, class_id: int | None = None) -> None:
        """Assign cells to another object (0 for none) and, if given, to its class.

        All other contents of the cells are kept.
        """
        owners = np.full(len(cells), instance, np.uint16)
        if class_id is None:
            self._change(cells, instance=owners)
        else:
            sure = np.ones(len(cells), np.float16)
            labels = np.full(len(cells), class_id, np.uint8)
            self._change(cells, instance=owners, labels=labels, confidence=sure)

    def relabel(self, cells: np.ndarray, class_id: int) -> None:
        """Set the class of occupied cells with full confidence, keeping their object ids."""
        labels, sure = np.full(len(cells), class_id, np.uint8), np.ones(len(cells), np.float16)
        self._change(cells, labels=labels, confidence=sure)

    def _change(self, cells: np.ndarray, **values: np.ndarray) -> None:
        held = self._draft.contents(cells)
        self.put(cells, GridCells(**{name: getattr(held, name) for name in ARRAYS} | values))

    def plan_operation(self, kind: str, **details: Any) -> Operation:
        """Return the operation. ``details`` are passed to ``SceneDraft.plan_operation``."""
        cells = np.concatenate([np.zeros((0, 3), np.int64), *self._cells]).astype(np.int64)
        flat = np.atleast_1d(np.ravel_multi_index(tuple(cells.T), self._draft.shape))
        # The last of equal numbers is the first of the reversed ones.
        _, at = np.unique(flat[::-1], return_index=True)
        at = len(flat) - 1 - at
        cells = cells[at]
        values = {}
        for name in ARRAYS:
            empty = getattr(self._draft, name)[:0, 0, 0]
            parts = [getattr(held, name) for held in self._held]
            values[name] = np.concatenate([empty, *parts])[at]
        before = self._draft.contents(cells)
        changed = np.zeros(len(cells), bool)
        for name in ARRAYS:
            differs = values[name] != getattr(before, name)
            changed |= differs if differs.ndim == 1 else differs.any(axis=1)
        after = GridCells(**{name: values[name][changed] for name in ARRAYS})
        return self._draft.plan_operation(kind, cells[changed], after, **details)
