"""The class of the surface whose height the user stated, such as a table of 0.72 m."""

from dataclasses import replace

import numpy as np

from world2minecraft.capture.scale import parse_known_length
from world2minecraft.core.classes import OBJECT_CLASSES, SemanticClass
from world2minecraft.core.types import FusedEvidence, OccupancyGrid
from world2minecraft.reconstruction.layout.parameters import PlateParameters
from world2minecraft.reconstruction.layout.surface_cells import surface_of
from world2minecraft.reconstruction.semantics.horizontal_surfaces import find_horizontal_surfaces

# A seat may be that of a chair or of a sofa, and is left as it is.
CLASSES = {
    "table height": SemanticClass.TABLE,
    "counter height": SemanticClass.FURN,
    "bed height": SemanticClass.BED,
}
MAX_OFF_M = 0.05  # Three standard deviations of a scale from a known height of 1 m.
CONFIDENCE = 0.9


def label_known_surface(
    grid: OccupancyGrid, evidence: FusedEvidence, name: str, height_m: float
) -> OccupancyGrid:
    """Return the grid in which the surface at a stated height has the stated class.

    The surface is the largest one of objects near this height, as for the scale of the capture.
    Cells below it that had its former class belong to the same object, except below a table.

    Args:
        grid: Labelled grid.
        evidence: Fused evidence of the same cells.
        name: Name of the known length, such as ``table height``; names without a class of their
            own change nothing.
        height_m: Height above the floor in metres.
    """
    kind = CLASSES.get(parse_known_length(name, height_m).name)
    if kind is None:
        return grid
    surface = surface_of(grid, evidence)
    things = np.isin(grid.labels, OBJECT_CLASSES)
    found = find_horizontal_surfaces(surface, things, PlateParameters())
    near = [one for one in found if abs(one.height_m - height_m) <= MAX_OFF_M]
    if not near:
        return grid
    plate = max(near, key=lambda one: one.area_m2)
    former = int(np.bincount(grid.labels[plate.mask]).argmax())
    if former == kind:
        return grid
    cells = plate.mask
    if kind != SemanticClass.TABLE:
        below = plate.footprint[:, :, None] & (grid.labels == former)
        below[:, :, plate.layer + 1 :] = False
        cells = cells | below
    labels, confidence = grid.labels.copy(), grid.confidence.copy()
    labels[cells], confidence[cells] = kind, CONFIDENCE
    return replace(grid, labels=labels, confidence=confidence)
