"""An object of full blocks from its own cells: resampled so that thin things survive.

That is what becomes of an object in whose colours no finer shape exists.
"""

from typing import NamedTuple

import numpy as np

from world2minecraft.construction.halves import of_half_layers
from world2minecraft.construction.lattice import Lattice, face_shares
from world2minecraft.core.types import OccupancyGrid

PHASES = 4  # Shifts of a quarter block along x and y; finer ones changed nothing in reference/fit.


class Shape(NamedTuple):
    """Half blocks in a box of the lattice, and the block of each cell."""

    low: np.ndarray  # int [3], the lattice index of the box's first block
    halves: np.ndarray  # uint8 [X, Y, Z]
    blocks: np.ndarray  # int [N, 3], lattice indices, one for each cell


def shape_of_cells(
    cells: np.ndarray, grid: OccupancyGrid, lattice: Lattice, share: float, shift: bool
) -> Shape:
    """Return the half blocks that show cells.

    Args:
        cells: int [N, 3], indices into the grid, at least one.
        grid: where the cells lie.
        lattice: where the blocks stand.
        share: the least share of a block's face that the cells cover.
        shift: whether the object may move by up to half a block sideways, and a quarter up or
            down, to fall on the lattice crisply.
    """
    low_cell, high_cell = cells.min(0), cells.max(0) + 1
    mask = np.zeros(high_cell - low_cell, bool)
    mask[tuple((cells - low_cell).T)] = True
    edges = [
        lattice.edges_of(grid, axis)[low_cell[axis] : high_cell[axis] + 1] for axis in range(3)
    ]
    if shift:
        edges = _best_phase(mask, edges)
        # Its bottom goes to a half block, as a template's does: so a book lies on its table.
        edges[2] = edges[2] + np.floor(2 * edges[2][0] + 0.5) / 2 - edges[2][0]
    edges[2] = np.maximum(
        edges[2], lattice.ground_under(float(edges[2][0]))
    )  # What dips into the floor stands on it.
    low = np.array([int(np.floor(axis[0])) for axis in edges])
    high = np.array([int(np.ceil(axis[-1])) for axis in edges])
    high = np.maximum(high, low + 1)
    local = [edge - start for edge, start in zip(edges, low, strict=True)]
    halves = _halves(mask, local, high - low, share)
    middles = [np.floor((edge[:-1] + edge[1:]) / 2).astype(int) for edge in edges]
    blocks = np.stack([middles[axis][cells[:, axis] - low_cell[axis]] for axis in range(3)], 1)
    return Shape(low, halves, blocks)


def _halves(mask: np.ndarray, edges: list[np.ndarray], size: np.ndarray, share: float):
    """Return the half blocks whose faces are covered; upright sheets are judged whole."""
    shape = tuple(size.tolist())
    doubled = [edges[0], edges[1], edges[2] * 2]
    shares = face_shares(mask, edges, shape)
    share = min(share, float(shares.max()))  # Nothing vanishes for being small.
    fine = face_shares(mask, doubled, (shape[0], shape[1], 2 * shape[2])) >= share
    whole = shares >= share
    halves = of_half_layers(fine)
    halves[~whole] = 0
    halves[whole & (halves == 0)] = 3
    return halves


def _best_phase(mask: np.ndarray, edges: list[np.ndarray]) -> list[np.ndarray]:
    """Return the edges shifted along x and y so that few blocks are covered by halves."""
    best = list(edges)
    for axis in (0, 1):
        profile = mask.sum(tuple({0, 1, 2} - {axis})).astype(np.float64)
        scores = []
        for phase in range(-PHASES // 2, PHASES // 2 + 1):
            shifted = edges[axis] + phase / PHASES
            scores.append((_blur(profile, shifted), abs(phase), phase))
        best[axis] = edges[axis] + min(scores)[2] / PHASES
    return best


def _blur(profile: np.ndarray, edges: np.ndarray) -> float:
    """Return how far a profile of cells is from filling whole blocks; small is crisp."""
    start = int(np.floor(edges[0]))
    count = int(np.ceil(edges[-1])) - start
    blocks = np.arange(start, start + count)[:, None]
    share = np.clip(
        np.minimum(edges[None, 1:], blocks + 1) - np.maximum(edges[None, :-1], blocks), 0, None
    )
    filled = share @ profile
    # The sum of squares is greatest when the mass stands in few blocks.
    return -round(float((filled**2).sum()), 6)
