"""Glossy worktops on the canvas, before what carries them is set."""

import numpy as np

from world2minecraft.construction.canvas import Canvas
from world2minecraft.construction.fitted import Design
from world2minecraft.construction.halves import FULL
from world2minecraft.construction.palettes import Palette
from world2minecraft.construction.worktops import Worktop, find_worktop, joined
from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import OccupancyGrid
from world2minecraft.geometry.colour import srgb_to_oklab
from world2minecraft.minecraft.block_colours import colours_of
from world2minecraft.minecraft.block_states import known_blocks
from world2minecraft.minecraft.collision_shapes import is_full_cube

PLATES_FROM = 1.5  # Blocks per metre: below, a counter is one block high.


class Plates:
    """The worktops of a room by the number of their object."""

    def __init__(self, canvas: Canvas, palette: Palette):
        self.canvas, self.palette, self.lattice = canvas, palette, canvas.lattice
        self.worktops: dict[int, Worktop] = {}

    def put_worktops(self, grid: OccupancyGrid, colours: np.ndarray, coloured: np.ndarray) -> None:
        """Set the glossy worktops; what else their objects are made of comes under and on them."""
        for number in np.unique(grid.instance[grid.labels == SemanticClass.FURN]):
            cells = np.argwhere((grid.instance == number) & (grid.labels == SemanticClass.FURN))
            top = find_worktop(grid, cells, colours, coloured, self.lattice)
            if number and top is not None:
                self.worktops[int(number)] = top
        self.worktops = joined(self.worktops)
        if self.lattice.blocks_per_metre < PLATES_FROM:
            return
        for number, top in self.worktops.items():
            self._put_plate(top, top.columns, number)

    def _put_plate(self, top: Worktop, columns: np.ndarray, number: int) -> None:
        """Set the plate of a worktop over columns, bool [X, Y], where nothing stands."""
        mask = np.zeros(self.lattice.shape, bool)
        mask[1:-1, 1:-1, top.layer] = columns[1:-1, 1:-1]
        mask &= self.canvas.states == 0
        slabs = self.palette.slabs if top.half != FULL else {}  # A palette of few blocks has none.
        choices = list(slabs or self.palette.blocks[SemanticClass.FURN])
        apart = np.linalg.norm(srgb_to_oklab(colours_of(choices)) - top.colour, axis=1)
        block = choices[int(apart.argmin())]
        state = f"{slabs[block]}[type=bottom]" if slabs else block
        self.canvas.put(mask, self.canvas.id_of(state), SemanticClass.FURN, number)

    def put_carpets(self) -> None:
        """Lay carpets for the worktops of a scale at which a plate would be all of a counter.

        So its front keeps its own colour, and its top shows the worktop's.
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
                apart = np.linalg.norm(srgb_to_oklab(colours_of(carpets)) - top.colour, axis=1)
                mask = np.zeros(self.lattice.shape, bool)
                mask[:, :, top.layer + 1] = under & free
                state = carpets[int(apart.argmin())]
                self.canvas.put(mask, self.canvas.id_of(state), SemanticClass.FURN, number)

    def plate_over(self, design: Design, number: int) -> None:
        """Let an object's worktop cover one of its designs that reaches up to it."""
        top = self.worktops.get(number)
        if top is None or self.lattice.blocks_per_metre < PLATES_FROM:
            return
        level = top.layer - int(design.low[2])
        if level == design.numbers.shape[2] - 1:
            columns = np.zeros(self.lattice.shape[:2], bool)
            for x, y in np.argwhere(design.filled[:, :, level]) + design.low[:2]:
                columns[x, y] = True
            self._put_plate(top, columns, number)
