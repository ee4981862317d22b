"""A labeller without learning: structure from planes, objects by size, height and shape.

Floor and ceiling are found first, then walls. The remaining cells are cut at horizontal plates, and
the pieces are classified by rules. Every observed cell keeps a class, except the floor's spill.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import FusedEvidence, OccupancyGrid
from world2minecraft.reconstruction.layout.parameters import GeometricParameters
from world2minecraft.reconstruction.layout.storeys import Storey, find_storeys
from world2minecraft.reconstruction.layout.structure import structure_of
from world2minecraft.reconstruction.layout.surface_cells import surface_of
from world2minecraft.reconstruction.semantics.backrests import classes_with_backs
from world2minecraft.reconstruction.semantics.furniture_rules import label_furniture
from world2minecraft.reconstruction.semantics.plane_straightening import Straightening
from world2minecraft.reconstruction.semantics.screens import label_screens

# How far a class may be trusted: the share of its cells that were right on generated rooms, objects
# capped at 0.8, because real rooms hold more than the generator knows.
RELIABILITY = np.array([1, 0.95, 0.98, 0.9, 0.7, 0.8, 0.8, 0.8, 0.8, 0.6, 0.8, 0.6], np.float32)


class GeometricLabeller:
    """A labeller that finds structure from planes, and classifies objects by size and shape."""

    def __init__(self, parameters: GeometricParameters | None = None):
        self.parameters = parameters or GeometricParameters()

    def label(self, grid: OccupancyGrid, evidence: FusedEvidence) -> OccupancyGrid:
        """Return the grid with a class for each occupied cell.

        Raises:
            ValueError: If grid and evidence do not have the same cells.
        """
        return self.traced(grid, evidence)[0]

    def traced(
        self,
        grid: OccupancyGrid,
        evidence: FusedEvidence,
        storeys: Sequence[Storey] | None = None,
    ) -> tuple[OccupancyGrid, np.ndarray]:
        """Return the result of ``label`` and the cell in which each cell's surface was seen.

        The second array is int64 [X, Y, Z]: the flat index of the cell from which a cell of a
        straightened plane was moved, or the cell's own index.

        Args:
            grid: Cleaned grid.
            evidence: Evidence of the grid on the same cells.
            storeys: The storeys, where they are known. By default, they are found from the floors.

        Raises:
            ValueError: If grid and evidence do not have the same cells.
        """
        surface = surface_of(grid, evidence)
        labels = np.array(grid.labels)
        labels[surface.occupied] = SemanticClass.OBJS
        straight = Straightening(surface)
        if storeys is None:
            storeys = find_storeys(surface, self.parameters.structure)
        for storey in storeys:
            part = straight.storey(storey)
            self._label_storey(part, storey.part(labels))
        return _trusted(straight.applied(grid, labels)), straight.origin

    def _label_storey(self, straight: Straightening, labels: np.ndarray) -> None:
        """Write the classes of a storey to ``labels`` [X, Y, Z] and straighten its planes."""
        surface = straight.surface
        structure = structure_of(surface, self.parameters.structure)
        rest, floor = structure.rest, structure.floor
        runs = [wall.run for wall in structure.walls]
        rest &= ~label_screens(surface, rest, runs, labels, self.parameters.pieces)
        label_furniture(surface, rest, structure.wall, labels, self.parameters)
        labels[structure.wall] = SemanticClass.WALL
        labels[structure.ceiling | structure.slopes] = SemanticClass.CEILING
        labels[floor.cells | floor.spill] = SemanticClass.FLOOR
        for wall in structure.walls:
            classes = classes_with_backs(surface, wall, labels)
            straight.add(wall.relief, wall.face.cells, classes, wall.face.depth_m)
        if structure.ceiling_m is not None:
            straight.add_level(structure.ceiling, 1, SemanticClass.CEILING)
        straight.add_level(floor.cells | floor.spill, -1, SemanticClass.FLOOR, 0.0)


def _trusted(grid: OccupancyGrid) -> OccupancyGrid:
    """Return the grid with its confidence reduced by the reliability of each class."""
    confidence = np.array(grid.confidence, np.float32)
    known = grid.labels <= SemanticClass.OBJS
    confidence[known] *= RELIABILITY[grid.labels[known]]
    return replace(grid, confidence=confidence.astype(np.float16))
