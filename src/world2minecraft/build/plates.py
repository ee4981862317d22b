"""Glossy worktops on the canvas, before what carries them is set."""

import numpy as np

from world2minecraft.build.canvas import Canvas
from world2minecraft.build.fitted import Design
from world2minecraft.build.halves import FULL
from world2minecraft.build.palettes import Palette
from world2minecraft.build.worktops import Worktop, find_worktop, joined
from world2minecraft.classes import SemanticClass
from world2minecraft.geometry.colour import oklab_of_srgb
from world2minecraft.minecraft.colours import colours_of
from world2minecraft.types import OccupancyGrid


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
        for number, top in self.worktops.items():
            self._put_plate(top, top.columns, number)

    def _put_plate(self, top: Worktop, columns: np.ndarray, number: int) -> None:
        """Set the plate of a worktop over columns, bool [X, Y], where nothing stands."""
        mask = np.zeros(self.lattice.shape, bool)
        mask[1:-1, 1:-1, top.layer] = columns[1:-1, 1:-1]
        mask &= self.canvas.states == 0
        choices = (
            list(self.palette.slabs)
            if top.half != FULL
            else list(self.palette.blocks[SemanticClass.FURN])
        )
        apart = np.linalg.norm(oklab_of_srgb(colours_of(choices)) - top.colour, axis=1)
        block = choices[int(apart.argmin())]
        state = f"{self.palette.slabs[block]}[type=bottom]" if top.half != FULL else block
        self.canvas.put(mask, self.canvas.id_of(state), SemanticClass.FURN, number)

    def plate_over(self, design: Design, number: int) -> None:
        """Let an object's worktop cover one of its designs that reaches up to it."""
        top = self.worktops.get(number)
        if top is None:
            return
        level = top.layer - int(design.low[2])
        if level == design.numbers.shape[2] - 1:
            columns = np.zeros(self.lattice.shape[:2], bool)
            for x, y in np.argwhere(design.filled[:, :, level]) + design.low[:2]:
                columns[x, y] = True
            self._put_plate(top, columns, number)
