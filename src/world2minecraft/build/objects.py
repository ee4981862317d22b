"""Objects as blocks: templates by their parts or idioms, all else from its own cells."""

from collections.abc import Sequence

import numpy as np

from world2minecraft.build.canvas import Canvas
from world2minecraft.build.cells import shape_of_cells, without_crumbs
from world2minecraft.build.halves import slab_states
from world2minecraft.build.idioms import put_idiom
from world2minecraft.build.lattice import volume_shares
from world2minecraft.build.palettes import Palette
from world2minecraft.build.parameters import BuildParameters
from world2minecraft.build.parts import Design, design_of
from world2minecraft.build.surfaces import block_colours, painted
from world2minecraft.build.tops import top_cells
from world2minecraft.classes import OBJECT_CLASSES
from world2minecraft.furniture import idiom, template
from world2minecraft.types import UNSEEN, OccupancyGrid, Placement

CELLS = "cells"
OPEN = 0.6  # A block of which more than this was seen free holds nothing but a thin part.
FACES = ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1))


class ObjectBuilder:
    """Sets the objects of one room on a canvas whose shell stands."""

    def __init__(
        self,
        canvas: Canvas,
        grid: OccupancyGrid,
        colours: np.ndarray,
        coloured: np.ndarray,
        palette: Palette,
        parameters: BuildParameters,
    ):
        free = (grid.labels == 0) & (grid.source != UNSEEN)
        self.open_share = volume_shares(free, grid, canvas.lattice)
        self.canvas, self.grid, self.palette = canvas, grid, palette
        self.colours, self.coloured = colours, coloured
        self.parameters = parameters
        self.lattice = canvas.lattice

    def put_all(self, placements: Sequence[Placement]) -> None:
        """Set every placement, then the object cells that no block near them shows."""
        for placement in sorted(placements, key=_order):
            cells = self._cells_of(placement)
            if placement.template == CELLS or not self.put_template(placement, cells):
                self.put_cells(cells, placement.class_id, placement.object_id)
        rest = np.isin(self.grid.labels, OBJECT_CLASSES)
        rest &= ~self._shown()
        keys = (self.grid.labels.astype(np.int32) << 16) + self.grid.instance
        for key in np.unique(keys[rest]).tolist():
            self.put_cells(np.argwhere(rest & (keys == key)), key >> 16, key & 0xFFFF)

    def _shown(self) -> np.ndarray:
        """Return the cells, bool [X, Y, Z], that lie in or beside a block of their own object."""
        cells = np.argwhere(np.isin(self.grid.labels, OBJECT_CLASSES))
        numbers = self.grid.instance[tuple(cells.T)]
        blocks = self._blocks_of(cells)
        shape = np.array(self.lattice.shape)
        shown = np.zeros(len(cells), bool)
        for step in ((0, 0, 0), *FACES):
            at = tuple(np.clip(blocks + step, 0, shape - 1).T)
            shown |= (self.canvas.instance[at] == numbers) & (numbers > 0)
        result = np.zeros(self.grid.shape, bool)
        result[tuple(cells[shown].T)] = True
        return result

    def _cells_of(self, placement: Placement) -> np.ndarray:
        """Return the cells, int [N, 3], of a placement's object that lie in its box."""
        cells = np.argwhere(self.grid.instance == placement.object_id)
        centres = self.grid.origin_m + (cells + 0.5) * self.grid.voxel_m
        size = placement.size_m[[1, 0, 2]] if placement.quarter_turns % 2 else placement.size_m
        reach = size / 2 + self.grid.voxel_m
        return cells[(np.abs(centres - placement.center_m) <= reach).all(1)]

    def put_cells(self, cells: np.ndarray, class_id: int, number: int) -> None:
        """Set an object from its own cells."""
        if not len(cells):
            return
        hues = cells
        if self.parameters.close_tops:
            added, alike = top_cells(self.grid, cells)
            cells, hues = np.concatenate([cells, added]), np.concatenate([hues, alike])
        share = self.parameters.object_share
        shape = shape_of_cells(cells, self.grid, self.lattice, share, shift=number > 0)
        free, box = self._window(shape.low, shape.halves.shape)
        halves = shape.halves[box] * free
        halves = without_crumbs(halves, ~free)
        self._put_halves(
            shape.low + [part.start for part in box], halves, cells, shape.blocks, class_id, number
        )

    def put_template(self, placement: Placement, cells: np.ndarray) -> bool:
        """Set a template by its vanilla design at small scales, else by its parts.

        Returns:
            False where its parts would stand in space that was seen free: nothing is set then.
        """
        found = idiom(placement, self.lattice.blocks_per_metre)
        if found is not None:
            put_idiom(self.canvas, found, placement, self._median(cells), self.palette)
            return True
        parts = template(placement.template).parts(placement.size_m, placement.parameters)
        design = design_of(placement, parts, self.lattice)
        if self._contradicted(design) > self.parameters.most_contradicted:
            return False
        self._put_design(design, placement, cells)
        return True

    def _contradicted(self, design: Design) -> float:
        """Return the share of a design's blocks that were seen free and nearly nothing else."""
        _, box = self._window(design.low, design.halves.shape)
        filled = np.argwhere(design.halves[box] > 0) + design.low + [part.start for part in box]
        return float((self.open_share[tuple(filled.T)] > OPEN).mean()) if len(filled) else 0.0

    def _put_design(self, design: Design, placement: Placement, cells: np.ndarray) -> None:
        blocks = self._blocks_of(cells)
        free, box = self._window(design.low, design.halves.shape)
        low = design.low + [part.start for part in box]
        halves = design.halves[box] * free
        part = design.part[box]
        self._put_halves(
            low,
            halves,
            cells,
            blocks,
            placement.class_id,
            placement.object_id,
            part,
            design.posts[box],
        )

    def _median(self, cells: np.ndarray) -> np.ndarray | None:
        chosen = cells[self.coloured[tuple(cells.T)]]
        return np.median(self.colours[tuple(chosen.T)], axis=0) if len(chosen) else None

    def _blocks_of(self, cells: np.ndarray) -> np.ndarray:
        centres = self.grid.origin_m + (cells + 0.5) * self.grid.voxel_m
        blocks = np.floor(self.lattice.coordinates_of(centres)).astype(int)
        blocks[:, 2] = np.maximum(blocks[:, 2], self.lattice.ground)
        return blocks

    def _window(self, low: np.ndarray, shape: tuple[int, ...]):
        """Return where the canvas may take a design, bool, and the slices of it that fit."""
        high = np.minimum(low + shape, self.lattice.shape)
        start = np.maximum(low, [0, 0, self.lattice.ground])
        stop = np.maximum(high, start)
        box = tuple(slice(int(a), int(b)) for a, b in zip(start - low, stop - low, strict=True))
        inside = tuple(slice(int(a), int(b)) for a, b in zip(start, stop, strict=True))
        return self.canvas.states[inside] == 0, box

    def _put_halves(self, low, halves, cells, blocks, class_id, number, part=None, posts=None):
        """Paint half blocks [X, Y, Z] at ``low`` with the colours of cells in blocks; set them."""
        filled = halves > 0
        if not filled.any():
            return
        chosen = self.coloured[tuple(cells.T)]
        colours = self.colours[tuple(cells[chosen].T)]
        local = blocks[chosen] - low
        states = np.empty(halves.shape, object)
        for group in np.unique(part[filled]) if part is not None else [0]:
            mask = filled if part is None else filled & (part == group)
            tinted, known = block_colours(halves.shape, local, colours)
            usable = known & (mask if (known & mask).any() else filled)
            states[mask] = painted(
                mask,
                *_borrowed(tinted, usable, mask),
                class_id,
                self.palette,
                self.parameters,
                self.parameters.object_colours if part is None else 2,
            )
        margin = self.parameters.slab_margin
        states[filled] = slab_states(states[filled], halves[filled], self.palette.slabs, margin)
        if posts is not None:
            self._make_posts(states, filled & posts)
        at = tuple(np.argwhere(filled).T[axis] + low[axis] for axis in range(3))
        names, index = np.unique(states[filled].astype(str), return_inverse=True)
        self.canvas.put(at, self.canvas.ids_of(names.tolist())[index], class_id, number)

    def _make_posts(self, states: np.ndarray, posts: np.ndarray) -> None:
        for block, fence in self.palette.fences.items():
            states[posts & (states == block)] = fence


def _order(placement: Placement) -> tuple:
    return placement.object_id, placement.center_m.tolist(), placement.template


def _borrowed(colours, usable, mask):
    """Return colours and where they hold, so that a part without its own takes its object's."""
    if (usable & mask).any() or not usable.any():
        return colours, usable
    median = np.median(colours[usable], axis=0)
    lent = colours.copy()
    lent[mask] = median
    return lent, mask
