"""The input of a build, and the cell colours that are transferred to objects."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from world2minecraft.construction.palettes import Palette
from world2minecraft.construction.parameters import BuildParameters
from world2minecraft.construction.worktops import missing_top_cells
from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import UNSEEN, OccupancyGrid, Placement
from world2minecraft.geometry.morphology import dilate_faces


class BuildSource(NamedTuple):
    """The input of a build: the grid, its colours, the palette and the parameters."""

    grid: OccupancyGrid
    colours: np.ndarray  # float32 [X, Y, Z, 3], Oklab, of the grid's cells; 0 where there is none
    coloured: np.ndarray  # bool [X, Y, Z], which cells have a colour
    palette: Palette
    parameters: BuildParameters


class ColourSamples(NamedTuple):
    """Cells that provide the colour of an object, and the block that each cell colours."""

    cells: np.ndarray  # int [N, 3]
    blocks: np.ndarray  # int [N, 3], of the lattice


class ColourSource:
    """Provides the colours of a room's cells for the blocks of objects."""

    def __init__(
        self, grid: OccupancyGrid, colours: np.ndarray, coloured: np.ndarray, close_tops: bool
    ):
        self.grid, self.colours, self.coloured = grid, colours, coloured
        self.close_tops = close_tops
        # Only cells beside free space show how an object looks.
        self.exposed = dilate_faces((grid.labels == 0) & (grid.source != UNSEEN))

    def with_tops(self, cells: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return an object's cells with its top closed, and the cell that colours each of them.

        The top of a chair is not closed, since unseen cells beside its back are under a table.
        """
        if not (self.close_tops and len(cells)):
            return cells, cells
        if np.bincount(self.grid.labels[tuple(cells.T)]).argmax() == SemanticClass.CHAIR:
            return cells, cells
        added, alike = missing_top_cells(self.grid, cells)
        return np.concatenate([cells, added]), np.concatenate([cells, alike])

    def stretched(
        self, cells: np.ndarray, placement: Placement, low: np.ndarray, shape: Sequence[int]
    ) -> ColourSamples:
        """Return the colour samples of a placement stretched to the box of its block design.

        A design snapped to blocks can be up to half a block away from the object. Stretching
        ensures that the front of the design gets the colours of the object's front.
        """
        cells, samples = self.with_tops(cells)
        size = placement.size_m[[1, 0, 2]] if placement.quarter_turns % 2 else placement.size_m
        centres = self.grid.origin_m + (cells + 0.5) * self.grid.voxel_m
        share = (centres - placement.center_m) / size + 0.5
        near = (np.abs(share - 0.5) <= 0.5 + self.grid.voxel_m / size).all(1)
        blocks = np.floor(share[near] * np.array(shape)).astype(int)
        return ColourSamples(samples[near], np.clip(blocks, 0, np.array(shape) - 1) + low)

    def colours_of(self, samples: ColourSamples) -> tuple[np.ndarray, np.ndarray]:
        """Return the colours of samples, float32 [N, 3], and the bool [N] mask of valid colours."""
        at = tuple(samples.cells.T)
        usable = self.coloured[at] & self.exposed[at]
        return self.colours[at], usable if usable.any() else self.coloured[at]
