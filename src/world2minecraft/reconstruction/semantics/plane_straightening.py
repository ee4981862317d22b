"""Straightening of planes: each position keeps one cell, in the layer of the plane's matter.

Noise spreads a wall over two layers. Only cells of the plane are moved, and only along its normal;
objects in front of it are kept. A moved cell keeps its colour and confidence.
"""

from copy import copy
from dataclasses import replace

import numpy as np

from world2minecraft.core.classes import UNKNOWN, SemanticClass
from world2minecraft.core.types import COMPLETED, UNSEEN, OccupancyGrid
from world2minecraft.reconstruction.layout.plane_residuals import (
    SOLID_M,
    PlaneResiduals,
    measure_plane_residuals,
)
from world2minecraft.reconstruction.layout.storeys import Storey
from world2minecraft.reconstruction.layout.surface_cells import Surface, turn_surface

MOVE_M = 0.02  # A place this far off its plane does not move into a layer where nothing was seen.


class Straightening:
    """The planned changes of the cells of planes, collected by plane and then applied at once."""

    def __init__(self, surface: Surface):
        self.surface = surface
        shape = surface.occupied.shape
        self.labels = np.zeros(shape, np.uint8)  # The class of each cell that is of a plane.
        self.origin = np.arange(np.prod(shape)).reshape(shape)  # Where its surface was seen.
        self.before, self.behind = np.zeros((2, *shape), bool)  # Cells that a plane has left.

    def storey(self, storey: Storey) -> "Straightening":
        """Return a view for one storey; planes added to it are added to the whole."""
        part = copy(self)
        part.surface = storey.surface(self.surface)
        for name in ("labels", "origin", "before", "behind"):
            setattr(part, name, storey.part(getattr(self, name)))
        return part

    def add(
        self, relief: PlaneResiduals, cells: np.ndarray, classes: np.ndarray, depth_m: np.ndarray
    ) -> None:
        """Straighten a plane.

        Args:
            relief: Relief of the plane.
            cells: Mask of the cells of the plane, bool [N, A, B]; no other cell is moved.
            classes: Class of each position, uint8 [A, B].
            depth_m: Position of the surface along axis 0 in metres, float [A, B].
        """
        chosen = cells.any(axis=0)
        layer = self._layer(relief, depth_m)
        count = cells.shape[0]
        chosen &= (layer >= 0) & (layer < count)
        layers = np.arange(count)[:, None, None]
        target = (layers == layer) & chosen
        free_to_take = cells | ~relief.of(self.surface.occupied)
        placed = (target & free_to_take).any(axis=0)
        # Where no cell was seen in that layer, the place itself must say that one belongs there.
        sure = np.abs(relief.depth_m - depth_m) <= MOVE_M
        placed &= sure | (target & cells).any(axis=0)
        target &= placed
        weight = np.where(cells, relief.of(self.surface.hits), -1)
        best = weight.argmax(axis=0)
        index = np.take_along_axis(relief.of(self.origin), best[None], axis=0)
        labels, origin = relief.of(self.labels), relief.of(self.origin)
        first = target & (labels == 0)
        origin[first] = np.broadcast_to(index, first.shape)[first]
        labels[first] = np.broadcast_to(classes, first.shape)[first]
        gone = cells & placed & ~target
        relief.of(self.before)[gone & (layers < layer)] = True
        relief.of(self.behind)[gone & (layers > layer)] = True

    def add_level(
        self, cells: np.ndarray, sign: int, kind: int, height_m: float | None = None
    ) -> None:
        """Straighten a horizontal plane of cells bool [X, Y, Z].

        The solid side of the plane is above it (``sign`` 1) or below it (-1). The plane is at
        ``height_m`` if given, otherwise at its observed height.
        """
        view = turn_surface(cells, 2, sign)
        box = (slice(0, view.shape[0]), slice(0, view.shape[1]), slice(0, view.shape[2]))
        relief = measure_plane_residuals(self.surface, view, 2, sign, box)
        classes = np.full(relief.weight.shape, kind, np.uint8)
        flat = relief.plane_m if height_m is None else np.full(classes.shape, sign * height_m)
        self.add(relief, view, classes, flat)

    def applied(self, grid: OccupancyGrid, labels: np.ndarray) -> OccupancyGrid:
        """Return the straightened grid, with ``labels`` [X, Y, Z] for all other cells."""
        labels, source = labels.copy(), np.array(grid.source)
        confidence, colour = np.array(grid.confidence), np.array(grid.colour)
        labels[self.before] = SemanticClass.EMPTY
        labels[self.behind] = UNKNOWN
        source[self.behind], confidence[self.behind], colour[self.behind] = UNSEEN, 0, 0
        at = self.labels > 0
        taken = self.origin[at]
        labels[at] = self.labels[at]
        colour[at] = grid.colour.reshape(-1, 3)[taken]
        confidence[at] = grid.confidence.reshape(-1)[taken]
        source[at] = np.where(grid.source[at] == UNSEEN, COMPLETED, grid.source[at])
        return replace(grid, labels=labels, source=source, confidence=confidence, colour=colour)

    def _layer(self, relief: PlaneResiduals, depth_m: np.ndarray) -> np.ndarray:
        """Return the layer of the relief's box in which a surface at a depth has its matter."""
        inside_m = depth_m + SOLID_M - relief.edge_m(self.surface)
        return np.floor(inside_m / self.surface.voxel_m + 1e-9).astype(int)
