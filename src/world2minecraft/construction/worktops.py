"""Completion of glossy worktops and glass tops without measured depth.

Polished stone reflects the light of a depth sensor. A worktop is then visible only as a step from
free to unseen cells, a rim of a few dark cells above the front, and the objects on it. A step level
with the rim of an object and connected to it is completed as the object's top. Each plate has one
height and one colour.
"""

from typing import NamedTuple

import numpy as np

from world2minecraft.construction.block_lattice import Lattice, overlap_weights
from world2minecraft.construction.canvas import Canvas
from world2minecraft.construction.fitted_objects import FULL, LOWER
from world2minecraft.construction.palettes import Palette
from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import UNSEEN, OccupancyGrid
from world2minecraft.geometry.colour import srgb_to_oklab
from world2minecraft.geometry.morphology import (
    binary_closing,
    dilate,
    dilate_within,
    nearest_set_cells,
)
from world2minecraft.minecraft.block_colours import colours_of
from world2minecraft.minecraft.block_states import known_blocks
from world2minecraft.minecraft.collision_shapes import is_full_cube

RIM_LAYERS = 1  # A top lies within a cell of the rim that it joins.
REACH_M = 0.7  # Distance from the rim: the depth of a worktop, in metres.
MIN_RIM_M = 0.3  # Lower objects have no top.
MIN_M2 = 0.3  # Of unseen top; less is a hole that the object's own blocks close.
MIN_M, MAX_M = 0.6, 1.3  # Heights at which one works standing or sitting.
FRONT_APART = 0.12  # Oklab distance to the front from which a cell at the rim is no part of it.
DARK_SHARE = 0.25  # Of the cells at the rim that are no front. Things that lie on it are lighter.
MIN_RIM = 8  # Cells; fewer say nothing of the colour.
COVERED = 0.2  # Share of a block's face: a rim of one cell counts.
GAP_CELLS = 2  # Things that lie on a top hide it.
PILLAR_CELLS = 3  # Own cells that go on so far above and below are no top.
PLATES_FROM = 1.5  # Blocks per metre: below, a counter is one block high.


def missing_top_cells(grid: OccupancyGrid, cells: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the unseen cells that close the top of an object, and seen cells that look like them.

    Args:
        grid: Grid of the room, whose free cells show where the top must be.
        cells: Cells of the object, int [M, 3].

    Returns:
        The unseen cells as int [N, 3], and for each the nearest cell of the object that was seen
        from above, int [N, 3].
    """
    low, box = _box(grid, cells)
    steps, free = _steps(grid, box)
    body, joined = _body_and_steps(grid, cells, low, steps)
    upper = body & np.concatenate([free[:, :, 1:], np.zeros_like(free[:, :, :1])], axis=2)
    flat = upper & ~np.concatenate([np.zeros_like(body[:, :, :1]), body[:, :, :-1]], axis=2)
    upper = flat if flat.any() else upper  # The edge over a front mixes both their colours.
    if not joined.any() or not upper.any():
        return np.zeros((0, 3), int), np.zeros((0, 3), int)
    nearest, _ = nearest_set_cells(upper)
    return np.argwhere(joined) + low, np.stack([axis[joined] for axis in nearest], 1) + low


def step_cells(grid: OccupancyGrid, cells: np.ndarray) -> np.ndarray:
    """Return the unseen cells, int [N, 3], that close the top of an object of cells [M, 3]."""
    low, box = _box(grid, cells)
    steps, _ = _steps(grid, box)
    return np.argwhere(_body_and_steps(grid, cells, low, steps)[1]) + low


def _box(grid: OccupancyGrid, cells: np.ndarray) -> tuple[np.ndarray, tuple[slice, ...]]:
    """Return the box around an object that may contain its top, and its low corner, int [3]."""
    reach = max(1, round(REACH_M / grid.voxel_m))
    low = np.maximum(cells.min(0) - [reach, reach, 1], 0)
    high = np.minimum(cells.max(0) + np.array([reach + 1, reach + 1, 3]), grid.shape)
    return low, tuple(slice(int(a), int(b)) for a, b in zip(low, high, strict=True))


def _body_and_steps(
    grid: OccupancyGrid, cells: np.ndarray, low: np.ndarray, steps: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the tall cells of an object and the steps connected to it, as bool masks."""
    reach = max(1, round(REACH_M / grid.voxel_m))
    body = np.zeros(steps.shape, bool)
    tall = grid.origin_m[2] + (cells[:, 2] + 1) * grid.voxel_m >= MIN_RIM_M
    body[tuple((cells[tall] - low).T)] = True
    return body, _steps_at_rim(steps, dilate(body, (0, 0, RIM_LAYERS)), reach)


def _steps(grid: OccupancyGrid, box: tuple[slice, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Return the unseen cells directly below free space, and that space, as bool masks."""
    unseen = grid.source[box] == UNSEEN
    free = (grid.labels[box] == 0) & ~unseen
    steps = np.zeros_like(unseen)
    steps[:, :, :-1] = unseen[:, :, :-1] & free[:, :, 1:]
    return steps, free


def _steps_at_rim(steps: np.ndarray, rim: np.ndarray, reach: int) -> np.ndarray:
    """Return the steps connected to the rim by layer, within ``reach`` cells."""
    flat = np.zeros((3, 3, 3), bool)
    flat[:, :, 1] = [[0, 1, 0], [1, 1, 1], [0, 1, 0]]
    return dilate_within(rim, steps | rim, flat, reach) & steps & ~rim


class Worktop(NamedTuple):
    """A worktop plate: its blocks, its Oklab colour, and the height of its top in metres."""

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
    """Find the glossy worktop of an object, or return None.

    Args:
        grid: Grid of the room.
        cells: Cells of the object, int [M, 3].
        colours: Oklab colours of the grid's cells, float32 [X, Y, Z, 3].
        coloured: Bool [X, Y, Z] mask of valid colours.
        lattice: Block lattice of the room.
    """
    if not len(cells):
        return None
    steps = step_cells(grid, cells)
    heights = grid.origin_m[2] + (steps[:, 2] + 1) * grid.voxel_m
    steps = steps[(heights >= MIN_M) & (heights <= MAX_M)]
    if len(steps) * grid.voxel_m**2 < MIN_M2:
        return None
    level = int(np.bincount(steps[:, 2]).argmax())
    steps = steps[np.abs(steps[:, 2] - level) <= 1]
    rim = cells[(cells[:, 2] >= level) & (cells[:, 2] <= level + 2)]
    front = cells[cells[:, 2] < level - 1]
    if len(steps) * grid.voxel_m**2 < MIN_M2 or not len(front):
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
    cover = [overlap_weights(lattice.edges_of(grid, axis), lattice.shape[axis]) for axis in (0, 1)]
    columns = cover[0] @ plan.astype(np.float32) @ cover[1].T >= COVERED
    half = LOWER if at - layer <= 0.75 else FULL
    return Worktop(columns, layer, half, colour, float(top), plan)


def join_worktops(tops: dict[int, Worktop]) -> dict[int, Worktop]:
    """Give worktops that touch at about the same height a common height and colour.

    The arms of an L-shaped kitchen are separate objects under one plate. The values of the largest
    part are used, since it was seen best.
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
    """Return the area of a worktop, in cells if known, so that it does not depend on the scale."""
    return int((top.columns if top.plan is None else top.plan).sum())


def _meets(top: Worktop, other: Worktop, near: np.ndarray) -> bool:
    return abs(top.layer - other.layer) <= 1 and bool((near & other.columns).any())


def _rim_of(
    rim: np.ndarray, front: np.ndarray, colours: np.ndarray, coloured: np.ndarray
) -> np.ndarray | None:
    """Return the cells of the plate's edge, int [N, 3]: the darkest of the rim except the front."""
    rim, front = rim[coloured[tuple(rim.T)]], front[coloured[tuple(front.T)]]
    if not len(rim) or not len(front):
        return None
    middle = np.median(colours[tuple(front.T)], axis=0)
    rim = rim[np.linalg.norm(colours[tuple(rim.T)] - middle, axis=1) >= FRONT_APART]
    if len(rim) * DARK_SHARE < MIN_RIM:
        return None
    order = np.argsort(colours[tuple(rim.T)][:, 0], kind="stable")
    return rim[order[: int(len(rim) * DARK_SHARE)]]


def _plan(grid: OccupancyGrid, cells: np.ndarray, steps: np.ndarray, level: int) -> np.ndarray:
    """Return the area of the plate from above, bool [X, Y] of the grid."""
    own = np.zeros(grid.shape, bool)
    own[tuple(cells.T)] = True
    low, high = max(level - PILLAR_CELLS, 0), level + 2 + PILLAR_CELLS
    pillar = own[:, :, low:level].all(2) & own[:, :, level + 2 : high].any(2)
    plan = np.asarray(own[:, :, level : level + 3].any(2) & ~pillar)
    plan[steps[:, 0], steps[:, 1]] = True
    return binary_closing(plan, (GAP_CELLS, GAP_CELLS))


class PlateBuilder:
    """Places the worktops of a room, one per object."""

    def __init__(self, canvas: Canvas, palette: Palette):
        self.canvas, self.palette, self.lattice = canvas, palette, canvas.lattice
        self.worktops: dict[int, Worktop] = {}

    def put_worktops(self, grid: OccupancyGrid, colours: np.ndarray, coloured: np.ndarray) -> None:
        """Place the glossy worktops, and the other blocks of their objects around them."""
        for number in np.unique(grid.instance[grid.labels == SemanticClass.FURN]):
            cells = np.argwhere((grid.instance == number) & (grid.labels == SemanticClass.FURN))
            top = find_worktop(grid, cells, colours, coloured, self.lattice)
            if number and top is not None:
                self.worktops[int(number)] = top
        self.worktops = join_worktops(self.worktops)
        if self.lattice.blocks_per_metre < PLATES_FROM:
            return
        for number, top in self.worktops.items():
            self._put_plate(top, top.columns, number)

    def _put_plate(self, top: Worktop, columns: np.ndarray, number: int) -> None:
        """Set the plate of a worktop in the free blocks of columns bool [X, Y]."""
        mask = np.zeros(self.lattice.shape, bool)
        mask[1:-1, 1:-1, top.layer] = columns[1:-1, 1:-1]
        mask &= self.canvas.states == 0
        slabs = self.palette.slabs if top.half != FULL else {}  # A palette of few blocks has none.
        choices = list(slabs or self.palette.blocks[SemanticClass.FURN])
        distances = np.linalg.norm(srgb_to_oklab(colours_of(choices)) - top.colour, axis=1)
        block = choices[int(distances.argmin())]
        state = f"{slabs[block]}[type=bottom]" if slabs else block
        self.canvas.put(mask, self.canvas.id_of(state), SemanticClass.FURN, number)

    def put_carpets(self) -> None:
        """Place carpets as worktops at scales at which a plate would hide the whole counter.

        The front of the counter keeps its colour, and the top shows that of the worktop.
        """
        if self.lattice.blocks_per_metre >= PLATES_FROM:
            return
        carpets = [block for block in known_blocks() if block.endswith("_carpet")]
        carpets = [block for block in carpets if self.palette.allows(block)]
        if not carpets:
            return
        for number, top in self.worktops.items():
            full = np.array([is_full_cube(state) for state in self.canvas.palette])  # It grows.
            own = (self.canvas.instance == number) & full[self.canvas.states]
            under = own[:, :, top.layer] & top.columns
            free = self.canvas.states[:, :, top.layer + 1] == 0
            if (under & free).any():
                distances = np.linalg.norm(srgb_to_oklab(colours_of(carpets)) - top.colour, axis=1)
                mask = np.zeros(self.lattice.shape, bool)
                mask[:, :, top.layer + 1] = under & free
                state = carpets[int(distances.argmin())]
                self.canvas.put(mask, self.canvas.id_of(state), SemanticClass.FURN, number)

    def plate_over(self, filled: np.ndarray, low: np.ndarray, number: int) -> None:
        """Let an object's worktop replace the top of a design that reaches up to it.

        Args:
            filled: Blocks of the design, bool [X, Y, Z].
            low: First block of the design, int [3].
            number: Number of the object.
        """
        top = self.worktops.get(number)
        if top is None or self.lattice.blocks_per_metre < PLATES_FROM:
            return
        level = top.layer - int(low[2])
        if level == filled.shape[2] - 1:
            columns = np.zeros(self.lattice.shape[:2], bool)
            for x, y in np.argwhere(filled[:, :, level]) + low[:2]:
                columns[x, y] = True
            self._put_plate(top, columns, number)
