"""Fine cells and boxes as shares of the sub-cells of blocks, and which cells are thin."""

from collections.abc import Sequence

import numpy as np

from world2minecraft.construction.fitting.masks import SUB

THIN_M = 0.1  # Legs, plates and panels; what is thinner than this counts as thin.
SNAP = 6  # Decimals of a sub-cell: 12.5 * 0.08 does not fall short of a whole block.


def covered_blocks(
    layers: Sequence[np.ndarray], edges: Sequence[np.ndarray], counts: Sequence[int]
) -> tuple[np.ndarray, list[np.ndarray]]:
    """Return the blocks that cells reach into, and how far each layer fills their sub-cells.

    Args:
        layers: float or bool arrays, all [X, Y, Z]; the first says which blocks are met.
        edges: for each axis the lattice coordinates, float64 [N + 1], of the cells' edges, evenly
            spaced and rising.
        counts: the number of blocks along each axis; what lies outside them is left out.

    Returns:
        int64 [N, 3], the blocks; for each layer float32 [N, 512], the mean of its sub-cells.
    """
    windows = [_windows(edges[axis], counts[axis]) for axis in range(3)]
    cells = np.argwhere(_met(layers[0] > 0, windows))
    at = [windows[axis][0][cells[:, axis]] for axis in range(3)]
    index = (at[0][:, :, None, None], at[1][:, None, :, None], at[2][:, None, None, :])
    shares = [windows[axis][1][cells[:, axis]] for axis in range(3)]
    return cells, [_carried(layer[index].astype(np.float32), shares) for layer in layers]


def _windows(edges: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return which cells lie by each block, int [count, K], and their shares, [count, 8, K]."""
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
    """Return which blocks have a solid cell in their window, bool [X', Y', Z']."""
    for axis, (cells, shares) in enumerate(windows):
        touched = np.asarray((shares > 0).any(1))
        result = np.zeros((*solid.shape[:axis], len(cells), *solid.shape[axis + 1 :]), bool)
        shape = [1, 1, 1]
        shape[axis] = -1
        for step in range(cells.shape[1]):
            result |= np.take(solid, cells[:, step], axis) & touched[:, step].reshape(shape)
        solid = result
    return solid


def _carried(values: np.ndarray, shares: Sequence[np.ndarray]) -> np.ndarray:
    """Return cells [N, A, B, C] as sub-cells [N, 512] by each block's own shares [N, 8, K]."""
    count, a, b, c = values.shape
    along = np.matmul(shares[0], values.reshape(count, a, b * c)).reshape(count, SUB, b, c)
    across = np.matmul(shares[1][:, None], along)
    up = np.matmul(across, shares[2][:, None].transpose(0, 1, 3, 2))
    return up.reshape(count, SUB**3)


def covered(values: np.ndarray, edges: Sequence[np.ndarray], counts: Sequence[int]) -> np.ndarray:
    """Return the mean of cell values over every sub-cell of a box of blocks.

    Args: as of ``covered_blocks``, with one layer.

    Returns:
        float32 [8 * X', 8 * Y', 8 * Z'].
    """
    cells, (shares,) = covered_blocks([values], edges, counts)
    result = np.zeros((*counts, SUB**3), np.float32)
    result[tuple(cells.T)] = shares
    return from_blocks(result)


def covered_by_boxes(boxes: np.ndarray, counts: Sequence[int]) -> np.ndarray:
    """Return the share of each sub-cell that boxes fill, float32 [8 * X, 8 * Y, 8 * Z].

    Args:
        boxes: float64 [N, 6], low and high corners in blocks; where boxes meet in one sub-cell
            the fuller one counts.
        counts: the number of blocks along each axis.
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
    """Return the first sub-cell that an interval meets and its share of each, float32 [N]."""
    start = int(np.clip(np.floor(low + 1e-9), 0, count - 1))
    stop = int(np.clip(np.ceil(high - 1e-9), start + 1, count))
    at = np.arange(start, stop)
    return start, np.clip(np.minimum(high, at + 1) - np.maximum(low, at), 0, 1).astype(np.float32)


def thin_cells(solid: np.ndarray, voxel_m: float, thin_m: float = THIN_M) -> np.ndarray:
    """Return the cells, bool [X, Y, Z], of what is thinner than ``thin_m`` along some axis.

    They are the cells that no cube of that side covers which itself lies in the solid.
    """
    side = max(2, int(np.ceil(thin_m / voxel_m - 1e-9)))
    core = np.asarray(solid, bool)
    for axis in range(3):
        core = _slid(_padded(core, side - 1, axis), side, axis, np.logical_and)
    for axis in range(3):
        core = _slid(core, side, axis, np.logical_or)
    return solid & ~core


def _padded(values: np.ndarray, reach: int, axis: int) -> np.ndarray:
    widths = [(0, 0)] * values.ndim
    widths[axis] = (reach, reach)
    return np.pad(values, widths)


def _slid(values: np.ndarray, side: int, axis: int, joined: np.ufunc) -> np.ndarray:
    """Return ``joined`` over each run of ``side`` cells along an axis."""
    count = values.shape[axis] - side + 1
    run = [slice(None)] * values.ndim
    run[axis] = slice(0, count)
    result = values[tuple(run)].copy()
    for step in range(1, side):
        run[axis] = slice(step, step + count)
        joined(result, values[tuple(run)], out=result)
    return result


def as_blocks(cells: np.ndarray) -> np.ndarray:
    """Return sub-cells [8 X, 8 Y, 8 Z] as blocks of them, [X, Y, Z, 512]."""
    x, y, z = (side // SUB for side in cells.shape)
    split = cells.reshape(x, SUB, y, SUB, z, SUB).transpose(0, 2, 4, 1, 3, 5)
    return np.ascontiguousarray(split).reshape(x, y, z, SUB**3)


def from_blocks(blocks: np.ndarray) -> np.ndarray:
    """Undo ``as_blocks``."""
    x, y, z = blocks.shape[:3]
    split = blocks.reshape(x, y, z, SUB, SUB, SUB).transpose(0, 3, 1, 4, 2, 5)
    return np.ascontiguousarray(split).reshape(x * SUB, y * SUB, z * SUB)
