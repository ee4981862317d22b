"""Objects as blocks: templates by their parts or idioms, all else from its own cells."""

from collections.abc import Sequence

import numpy as np

from world2minecraft.build.canvas import Canvas
from world2minecraft.build.cells import shape_of_cells, without_crumbs
from world2minecraft.build.halves import slab_states
from world2minecraft.build.idioms import put_idiom
from world2minecraft.build.palettes import Palette
from world2minecraft.build.parameters import BuildParameters
from world2minecraft.build.parts import Design, design_of
from world2minecraft.build.surfaces import block_colours, painted
from world2minecraft.classes import OBJECT_CLASSES
from world2minecraft.furniture import idiom, template
from world2minecraft.types import OccupancyGrid, Placement

CELLS = "cells"


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
        self.canvas, self.grid, self.palette = canvas, grid, palette
        self.colours, self.coloured = colours, coloured
        self.parameters = parameters
        self.lattice = canvas.lattice

    def put_all(self, placements: Sequence[Placement]) -> None:
        """Set every placement, then the object cells that no placement speaks for."""
        explained = np.zeros(self.grid.shape, bool)
        for placement in sorted(placements, key=lambda p: (p.object_id, p.center_m.tolist())):
            cells = self._cells_of(placement)
            explained[tuple(cells.T)] = True
            if placement.template == CELLS:
                self.put_cells(cells, placement.class_id, placement.object_id)
            else:
                self.put_template(placement, cells)
        for class_id in OBJECT_CLASSES:
            rest = (self.grid.labels == class_id) & ~explained
            for number in np.unique(self.grid.instance[rest]):
                cells = np.argwhere(rest & (self.grid.instance == number))
                self.put_cells(cells, class_id, int(number))

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
        share = self.parameters.object_share
        shape = shape_of_cells(cells, self.grid, self.lattice, share, shift=number > 0)
        free, box = self._window(shape.low, shape.halves.shape)
        halves = shape.halves[box] * free
        halves = without_crumbs(halves, ~free)
        self._put_halves(
            shape.low + [part.start for part in box], halves, cells, shape.blocks, class_id, number
        )

    def put_template(self, placement: Placement, cells: np.ndarray) -> None:
        """Set a template by its vanilla design at small scales, else by its parts."""
        found = idiom(placement, self.lattice.blocks_per_metre)
        if found is not None:
            put_idiom(self.canvas, found, placement, self._median(cells), self.palette)
            return
        parts = template(placement.template).parts(placement.size_m, placement.parameters)
        design = design_of(placement, parts, self.lattice)
        self._put_design(design, placement, cells)

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
        """Paint half blocks [X, Y, Z] at ``low`` and set them."""
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


def _borrowed(colours, usable, mask):
    """Return colours and where they hold, so that a part without its own takes its object's."""
    if (usable & mask).any() or not usable.any():
        return colours, usable
    median = np.median(colours[usable], axis=0)
    lent = colours.copy()
    lent[mask] = median
    return lent, mask
