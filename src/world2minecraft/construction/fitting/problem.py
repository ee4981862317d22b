"""The fitting problem: the sub-cell occupancy to be covered, and the rules of the fit."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from world2minecraft.construction.fitting.selection import Gains, compute_gains
from world2minecraft.construction.fitting.shapes import SUB, ShapeSet

THIN_M = 0.1  # Legs, plates and panels; what is thinner than this counts as thin.
SNAP = 6  # Decimals of a sub-cell: 12.5 * 0.08 does not fall short of a whole block.
THIN_WEIGHT = 2.0  # A thin sub-cell counts double: thin recall grows by half and more.
MIN_FLOW = 0.5  # Sub-cells of a face (of 64) from which the wanted runs through it.
WAYS = np.array([(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)])
UP, DOWN = 4, 5


def cover_blocks(
    layers: Sequence[np.ndarray], edges: Sequence[np.ndarray], counts: Sequence[int]
) -> tuple[np.ndarray, list[np.ndarray]]:
    """Resample cell values to the sub-cells of the blocks that the cells reach into.

    Args:
        layers: Float or bool arrays [X, Y, Z]; the first array defines which blocks are returned.
        edges: Lattice coordinates of the cell edges for each axis, float64 [N + 1], evenly spaced
            and increasing.
        counts: Number of blocks along each axis; cells outside are ignored.

    Returns:
        The block positions as int64 [N, 3], and for each layer the mean value of each sub-cell as
        float32 [N, 512].
    """
    windows = [_windows(edges[axis], counts[axis]) for axis in range(3)]
    cells = np.argwhere(_met(layers[0] > 0, windows))
    at = [windows[axis][0][cells[:, axis]] for axis in range(3)]
    index = (at[0][:, :, None, None], at[1][:, None, :, None], at[2][:, None, None, :])
    shares = [windows[axis][1][cells[:, axis]] for axis in range(3)]
    return cells, [_resample(layer[index].astype(np.float32), shares) for layer in layers]


def _windows(edges: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the cells next to each block, int [count, K], and their shares, [count, 8, K]."""
    side = float(edges[-1] - edges[0]) / (len(edges) - 1)
    places = np.round((np.arange(count * SUB + 1) / SUB - edges[0]) / side, SNAP)
    first = np.floor(places[:-1:SUB]).astype(int)
    width = int((np.ceil(places[SUB::SUB]).astype(int) - first).max())
    cells = first[:, None] + np.arange(width)
    low, high = places[:-1].reshape(count, SUB, 1), places[1:].reshape(count, SUB, 1)
    starts = cells[:, None, :]
    shares = np.clip(np.minimum(high, starts + 1) - np.maximum(low, starts), 0, None) / (high - low)
    shares[np.broadcast_to((starts < 0) | (starts >= len(edges) - 1), shares.shape)] = 0
    return np.clip(cells, 0, len(edges) - 2), shares.astype(np.float32)


def _met(solid: np.ndarray, windows: Sequence[tuple[np.ndarray, np.ndarray]]) -> np.ndarray:
    """Return the mask of blocks with a solid cell in their window, bool [X', Y', Z']."""
    for axis, (cells, shares) in enumerate(windows):
        touched = np.asarray((shares > 0).any(1))
        result = np.zeros((*solid.shape[:axis], len(cells), *solid.shape[axis + 1 :]), bool)
        shape = [1, 1, 1]
        shape[axis] = -1
        for step in range(cells.shape[1]):
            result |= np.take(solid, cells[:, step], axis) & touched[:, step].reshape(shape)
        solid = result
    return solid


def _resample(values: np.ndarray, shares: Sequence[np.ndarray]) -> np.ndarray:
    """Resample cells [N, A, B, C] to sub-cells [N, 512] with each block's shares [N, 8, K]."""
    count, a, b, c = values.shape
    along = np.matmul(shares[0], values.reshape(count, a, b * c)).reshape(count, SUB, b, c)
    across = np.matmul(shares[1][:, None], along)
    up = np.matmul(across, shares[2][:, None].transpose(0, 1, 3, 2))
    return up.reshape(count, SUB**3)


def cover_cells(
    values: np.ndarray, edges: Sequence[np.ndarray], counts: Sequence[int]
) -> np.ndarray:
    """Compute the mean of cell values over every sub-cell of a box of blocks.

    Args:
        values: Float or bool array [X, Y, Z].
        edges: Lattice coordinates of the cell edges for each axis, float64 [N + 1].
        counts: Number of blocks along each axis; cells outside are ignored.

    Returns:
        The mean values as float32 [8 * X', 8 * Y', 8 * Z'].
    """
    cells, (shares,) = cover_blocks([values], edges, counts)
    result = np.zeros((*counts, SUB**3), np.float32)
    result[tuple(cells.T)] = shares
    return join_blocks(result)


def cover_boxes(boxes: np.ndarray, counts: Sequence[int]) -> np.ndarray:
    """Compute the share of each sub-cell that boxes fill, float32 [8 * X, 8 * Y, 8 * Z].

    Args:
        boxes: Minimum and maximum corners in blocks, float64 [N, 6]. If several boxes meet in a
            sub-cell, the largest share counts.
        counts: Number of blocks along each axis.
    """
    result = np.zeros([count * SUB for count in counts], np.float32)
    for box in np.asarray(boxes, np.float64).reshape(-1, 6) * SUB:
        spans = [_span(box[axis], box[axis + 3], side) for axis, side in enumerate(result.shape)]
        where = tuple(slice(start, start + len(share)) for start, share in spans)
        x, y, z = (share for _, share in spans)
        part = x[:, None, None] * y[None, :, None] * z[None, None, :]
        result[where] = np.maximum(result[where], part)
    return result


def _span(low: float, high: float, count: int) -> tuple[int, np.ndarray]:
    """Return the first sub-cell that an interval touches and its share of each, float32 [N]."""
    start = int(np.clip(np.floor(low + 1e-9), 0, count - 1))
    stop = int(np.clip(np.ceil(high - 1e-9), start + 1, count))
    at = np.arange(start, stop)
    return start, np.clip(np.minimum(high, at + 1) - np.maximum(low, at), 0, 1).astype(np.float32)


def thin_cells(solid: np.ndarray, voxel_m: float) -> np.ndarray:
    """Return the bool [X, Y, Z] mask of the cells in parts thinner than ``THIN_M`` along some axis.

    These are the cells that no cube of this size inside the solid covers.
    """
    side = max(2, int(np.ceil(THIN_M / voxel_m - 1e-9)))
    core = np.asarray(solid, bool)
    for axis in range(3):
        core = _sliding_reduce(_pad_axis(core, side - 1, axis), side, axis, np.logical_and)
    for axis in range(3):
        core = _sliding_reduce(core, side, axis, np.logical_or)
    return solid & ~core


def _pad_axis(values: np.ndarray, reach: int, axis: int) -> np.ndarray:
    widths = [(0, 0)] * values.ndim
    widths[axis] = (reach, reach)
    return np.pad(values, widths)


def _sliding_reduce(values: np.ndarray, side: int, axis: int, reduce: np.ufunc) -> np.ndarray:
    """Apply ``reduce`` to each window of ``side`` cells along an axis."""
    count = values.shape[axis] - side + 1
    run = [slice(None)] * values.ndim
    run[axis] = slice(0, count)
    result = values[tuple(run)].copy()
    for step in range(1, side):
        run[axis] = slice(step, step + count)
        reduce(result, values[tuple(run)], out=result)
    return result


def split_into_blocks(cells: np.ndarray) -> np.ndarray:
    """Reshape sub-cells [8 X, 8 Y, 8 Z] to blocks of sub-cells [X, Y, Z, 512]."""
    x, y, z = (side // SUB for side in cells.shape)
    split = cells.reshape(x, SUB, y, SUB, z, SUB).transpose(0, 2, 4, 1, 3, 5)
    return np.ascontiguousarray(split).reshape(x, y, z, SUB**3)


def join_blocks(blocks: np.ndarray) -> np.ndarray:
    """Reshape blocks of sub-cells [X, Y, Z, 512] to sub-cells [8 X, 8 Y, 8 Z]."""
    x, y, z = blocks.shape[:3]
    split = blocks.reshape(x, y, z, SUB, SUB, SUB).transpose(0, 3, 1, 4, 2, 5)
    return np.ascontiguousarray(split).reshape(x * SUB, y * SUB, z * SUB)


@dataclass(frozen=True)
class Rules:
    """The rules by which shapes are chosen.

    Attributes:
        lam: IoU that all objects of a room reach together; None uses the IoU of the object.
        calm: Factor on the prices of shapes; values above 1 reduce noise.
        even: Whether the fit must be mirror-symmetric along x and along y.
        stands: Whether the lowest layer rests on a support.
        flush: Whether flat tops must end at a block boundary, so that objects can rest on them.
        legs: Whether every leg and pole becomes posts. Posts are more recognizable but cost some
            IoU, since a panel at the right position covers more of a leg than a post in the block's
            centre.
        phase: Position of the centre within its block, in sub-cells along x and y; None is free.
    """

    lam: float | None = None
    calm: float = 1.0
    even: tuple[bool, bool] = (False, False)
    stands: bool = True
    flush: bool = False
    legs: bool = False
    phase: tuple[int | None, int | None] = (None, None)


class Target(NamedTuple):
    """The occupancy to fit, in sub-cells around its own centre: x and y from -h to h, z from 0.

    ``bottom`` is the sub-cell, 0 to 7, above the lower face of a block at which the target begins.
    """

    wanted: np.ndarray  # float32 [2 h_x, 2 h_y, Z], the filled share of each sub-cell
    thin: np.ndarray  # float32, the part of it that is thin
    bottom: int = 0


@dataclass(frozen=True, eq=False)
class Problem:
    """A target resampled to the blocks that contain any part of it.

    ``middle`` is the centre of the target in blocks; ``floor`` is the sub-cell of the lowest layer
    at which the target begins.
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
        """The block positions as an index into an array of ``shape``."""
        return tuple(self.cells.T)

    @cached_property
    def rows(self) -> np.ndarray:
        """The row of each block or -1, int64 [X + 2, Y + 2, Z + 2] with a margin of one block."""
        rows = np.full([side + 2 for side in self.shape], -1)
        rows[tuple((self.cells + 1).T)] = np.arange(len(self.cells))
        return rows

    @cached_property
    def flows(self) -> np.ndarray:
        """Bool [6, N]: whether the target continues through each face, in the order of ``WAYS``."""
        cells = self.wanted.reshape(-1, SUB, SUB, SUB)
        result = np.zeros((6, len(cells)), bool)
        for axis in range(3):
            low, high = (np.take(cells, side, axis + 1) for side in (0, SUB - 1))
            other = self.rows[tuple((self.cells + 1 + WAYS[2 * axis]).T)]
            here = np.flatnonzero(other >= 0)
            there = other[here]
            runs = np.minimum(high[here], low[there]).sum((1, 2)) > MIN_FLOW
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
    """Create a problem from blocks of sub-cells.

    Args:
        cells: Blocks that contain any part of the target, int [N, 3].
        wanted: Filled share of their sub-cells, float32 [N, 512].
        thin: Filled share that belongs to thin parts, float32 [N, 512].
        shape: Number of blocks along each axis.
        shapes: Shapes that may be used.
        calm: Factor on the prices of the shapes.
        middle: Centre of the target in blocks along x and y.
        floor: Sub-cell of the lowest layer at which the target begins.
    """
    gains = compute_gains(wanted, wanted + np.float32(THIN_WEIGHT - 1) * thin, shapes, calm)
    return Problem(shape, cells, wanted, thin, gains, np.array(middle), floor)


def problem_at(
    target: Target, phase: tuple[int, int], shapes: ShapeSet, calm: float = 1.0
) -> Problem:
    """Create the problem of a target whose centre is at a phase, in sub-cells along x and y."""
    half = [side // 2 for side in target.wanted.shape[:2]]
    start = [(phase[axis] - half[axis]) % SUB for axis in (0, 1)]
    before = [*start, target.bottom]
    widths = [(n, -(n + side) % SUB) for n, side in zip(before, target.wanted.shape, strict=True)]
    wanted, thin = (split_into_blocks(np.pad(values, widths)) for values in target[:2])
    used = wanted.any(3)
    x, y = ((start[axis] + half[axis]) / SUB for axis in (0, 1))
    return problem_of(
        np.argwhere(used),
        wanted[used],
        thin[used],
        used.shape,
        shapes,
        calm=calm,
        middle=(x, y),
        floor=target.bottom,
    )
