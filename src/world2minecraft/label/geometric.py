"""The labeller that learns nothing: structure from planes, objects by size, height and shape.

Floor and ceiling first, then walls; the rest is cut at its level plates, and the pieces are told
apart by rules. Evidence wins: every observed cell keeps a class, but for the floor's spill.
"""

from dataclasses import replace

import numpy as np

from world2minecraft.classes import SemanticClass
from world2minecraft.label.furniture import label_furniture
from world2minecraft.label.horizontal import find_ceiling, find_floor
from world2minecraft.label.openings import label_openings
from world2minecraft.label.parameters import GeometricParameters
from world2minecraft.label.screens import label_screens
from world2minecraft.label.surface import surface_of
from world2minecraft.label.walls import find_walls
from world2minecraft.types import COMPLETED, UNSEEN, FusedEvidence, OccupancyGrid

# How far a class may be trusted: the share of its cells that were right on generated rooms, objects
# capped at 0.8, because real rooms hold more than the generator knows.
RELIABILITY = np.array([1, 0.95, 0.98, 0.9, 0.7, 0.8, 0.8, 0.8, 0.8, 0.6, 0.8, 0.6], np.float32)


class GeometricLabeller:
    """Structure from planes and heights; objects by size, height and shape."""

    def __init__(self, parameters: GeometricParameters | None = None):
        self.parameters = parameters or GeometricParameters()

    def label(self, grid: OccupancyGrid, evidence: FusedEvidence) -> OccupancyGrid:
        """Return the grid with a class for each occupied cell.

        Raises:
            ValueError: grid and evidence do not lie on the same cells.
        """
        surface = surface_of(grid, evidence)
        structure = self.parameters.structure
        floor = find_floor(surface, structure)
        ceiling, ceiling_m = find_ceiling(surface, structure)
        wall, runs = find_walls(surface, ceiling, ceiling_m, structure)
        rest = surface.occupied & ~(floor.cells | floor.spill | ceiling | wall)
        labels = np.array(grid.labels)
        labels[surface.occupied] = SemanticClass.OBJS
        rest &= ~label_screens(surface, rest, runs, labels, self.parameters.pieces)
        label_furniture(surface, rest, wall, labels, self.parameters)
        labels[wall] = SemanticClass.WALL
        label_openings(surface, wall, runs, labels, structure)
        labels[ceiling] = SemanticClass.CEILING
        labels[floor.spill] = SemanticClass.EMPTY
        labels[floor.cells] = SemanticClass.FLOOR
        return _with_labels(grid, labels)


def _with_labels(grid: OccupancyGrid, labels: np.ndarray) -> OccupancyGrid:
    """Return the grid with new labels; where spill came down, its colour and confidence with it.

    A floor cell that no ray had reached before is marked as completed.
    """
    source, colour = np.array(grid.source), np.array(grid.colour)
    confidence = np.array(grid.confidence, np.float32)
    filled = (labels == SemanticClass.FLOOR) & ~grid.occupied
    above = np.roll(filled, 1, axis=2)
    colour[filled], confidence[filled] = grid.colour[above], confidence[above]
    source[filled & (source == UNSEEN)] = COMPLETED
    known = labels <= SemanticClass.OBJS
    confidence[known] *= RELIABILITY[labels[known]]
    return replace(
        grid,
        labels=labels,
        source=source,
        colour=colour,
        confidence=confidence.astype(np.float16),
    )
