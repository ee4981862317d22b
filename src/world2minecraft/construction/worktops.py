"""Glossy worktops: long tops that gave no depth, made whole as one dark plate over their fronts.

Polished stone mirrors the light away from a depth sensor. What is left of a worktop is a step from
seen free space to unseen cells, a rim of a few dark cells over the front and whatever lies on it.
Out of these comes one plate, at one height and of one colour.
"""

from typing import NamedTuple

import numpy as np

from world2minecraft.construction.halves import FULL, LOWER
from world2minecraft.construction.lattice import Lattice, overlaps
from world2minecraft.construction.tops import step_cells
from world2minecraft.core.types import OccupancyGrid
from world2minecraft.geometry.morphology import binary_closing, dilate

LEAST_M2 = 0.3  # Of unseen top; less is a hole that the object's own blocks close.
LEAST_M, MOST_M = 0.6, 1.3  # Heights at which one works standing or sitting.
FRONT_APART = 0.12  # Oklab distance to the front from which a cell at the rim is no part of it.
DARK_SHARE = 0.25  # Of the cells at the rim that are no front. Things that lie on it are lighter.
LEAST_RIM = 8  # Cells; fewer say nothing of the colour.
COVERED = 0.2  # Share of a block's face: a rim of one cell counts.
GAP_CELLS = 2  # Things that lie on a top hide it.
PILLAR_CELLS = 3  # Own cells that go on so far above and below are no top.


class Worktop(NamedTuple):
    """One plate: its blocks, its colour in Oklab, and the height of its top in the room."""

    columns: np.ndarray  # bool [X, Y] of the lattice
    layer: int
    half: int  # LOWER or FULL
    colour: np.ndarray  # float32 [3]
    top_m: float = 0.0
    plan: np.ndarray | None = None  # bool [X, Y] of the grid


def find_worktop(
    grid: OccupancyGrid,
    cells: np.ndarray,
    colours: np.ndarray,
    coloured: np.ndarray,
    lattice: Lattice,
) -> Worktop | None:
    """Return the worktop of an object, None where it has no glossy one.

    Args:
        grid: the room.
        cells: int [M, 3], the object's own.
        colours: float32 [X, Y, Z, 3], the Oklab colours of the grid's cells.
        coloured: bool [X, Y, Z], which cells have one.
        lattice: where blocks stand.
    """
    if not len(cells):
        return None
    steps = step_cells(grid, cells)
    heights = grid.origin_m[2] + (steps[:, 2] + 1) * grid.voxel_m
    steps = steps[(heights >= LEAST_M) & (heights <= MOST_M)]
    if len(steps) * grid.voxel_m**2 < LEAST_M2:
        return None
    level = int(np.bincount(steps[:, 2]).argmax())
    steps = steps[np.abs(steps[:, 2] - level) <= 1]
    rim = cells[(cells[:, 2] >= level) & (cells[:, 2] <= level + 2)]
    front = cells[cells[:, 2] < level - 1]
    if len(steps) * grid.voxel_m**2 < LEAST_M2 or not len(front):
        return None
    dark = _rim_of(rim, front, colours, coloured)
    if dark is None:
        return None
    # Glare lightens a polished plate: its darker half is what it is.
    colour = np.median(colours[tuple(dark[: (len(dark) + 1) // 2].T)], axis=0)
    top = (np.median(dark[:, 2]) + 1) * grid.voxel_m + grid.origin_m[2]
    at = float(lattice.coordinates_of(np.array([0.0, 0.0, top]))[2])
    layer = int(np.floor(at - 1e-6))
    plan = _plan(grid, cells, steps, level)
    cover = [overlaps(lattice.edges_of(grid, axis), lattice.shape[axis]) for axis in (0, 1)]
    columns = cover[0] @ plan.astype(np.float32) @ cover[1].T >= COVERED
    half = LOWER if at - layer <= 0.75 else FULL
    return Worktop(columns, layer, half, colour, float(top), plan)


def joined(tops: dict[int, Worktop]) -> dict[int, Worktop]:
    """Return the worktops with those that touch at about one height of one height and colour.

    The arms of an L are objects of their own, yet one plate lies over both. The larger part says
    what they all are, since it was seen best.
    """
    by_size = sorted(tops, key=lambda number: (-_area(tops[number]), number))
    result: dict[int, Worktop] = {}
    for number in by_size:
        near = dilate(tops[number].columns, (1, 1))
        whole = next((one for one in result.values() if _meets(tops[number], one, near)), None)
        result[number] = tops[number]
        if whole is not None:
            own = tops[number]
            result[number] = whole._replace(columns=own.columns, plan=own.plan)
    return result


def _area(top: Worktop) -> int:
    """Return how large it is, by cells where they are known: at any scale the same is largest."""
    return int((top.columns if top.plan is None else top.plan).sum())


def _meets(top: Worktop, other: Worktop, near: np.ndarray) -> bool:
    return abs(top.layer - other.layer) <= 1 and bool((near & other.columns).any())


def _rim_of(
    rim: np.ndarray, front: np.ndarray, colours: np.ndarray, coloured: np.ndarray
) -> np.ndarray | None:
    """Return the cells, int [N, 3], of the plate's edge: the darkest at the rim but the front's."""
    rim, front = rim[coloured[tuple(rim.T)]], front[coloured[tuple(front.T)]]
    if not len(rim) or not len(front):
        return None
    middle = np.median(colours[tuple(front.T)], axis=0)
    rim = rim[np.linalg.norm(colours[tuple(rim.T)] - middle, axis=1) >= FRONT_APART]
    if len(rim) * DARK_SHARE < LEAST_RIM:
        return None
    order = np.argsort(colours[tuple(rim.T)][:, 0], kind="stable")
    return rim[order[: int(len(rim) * DARK_SHARE)]]


def _plan(grid: OccupancyGrid, cells: np.ndarray, steps: np.ndarray, level: int) -> np.ndarray:
    """Return where the plate lies seen from above, bool [X, Y] of the grid."""
    own = np.zeros(grid.shape, bool)
    own[tuple(cells.T)] = True
    low, high = max(level - PILLAR_CELLS, 0), level + 2 + PILLAR_CELLS
    pillar = own[:, :, low:level].all(2) & own[:, :, level + 2 : high].any(2)
    plan = np.asarray(own[:, :, level : level + 3].any(2) & ~pillar)
    plan[steps[:, 0], steps[:, 1]] = True
    return binary_closing(plan, (GAP_CELLS, GAP_CELLS))
