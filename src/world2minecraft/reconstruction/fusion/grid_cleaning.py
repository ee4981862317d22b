"""Grid cleaning: remove floaters and close holes in floor, walls and ceiling.

``remove_floaters`` runs on the extracted grid. ``close_structure`` runs after the structure is
labelled; the cells it fills are marked as completed. Thin furniture is preserved.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy import ndimage

from world2minecraft.core.classes import UNKNOWN, SemanticClass
from world2minecraft.core.errors import UsageError
from world2minecraft.core.parameters import parameter
from world2minecraft.core.types import COMPLETED, OccupancyGrid
from world2minecraft.geometry.connected_components import label_components

MAX_HOLE_M = 10.0  # Above any hole in a floor; the time of the closing grows with its square.


@dataclass(frozen=True)
class CleaningParameters:
    """Parameters of the grid cleaning.

    floater_cells: Number of cells below which an isolated part is removed as noise.
    hole_m: Maximum width of holes in floor, walls and ceiling that are closed. Wider holes may be
        doors or unseen corners.
    """

    floater_cells: int = parameter(
        6, unit="cells", origin="24 x 16 x 8 cm, smaller than a cup with its saucer"
    )
    hole_m: float = parameter(
        0.32,
        unit="m",
        origin="the precision of the cells of the sample kitchen, including completed cells, is "
        "0.988, 0.990 and 0.997 at 0.64, 0.4 and 0.32 m",
    )

    def __post_init__(self):
        if self.floater_cells < 0:
            raise UsageError(f"clean.floater_cells must be 0 or more, got {self.floater_cells}")
        if not 0 <= self.hole_m <= MAX_HOLE_M:
            raise UsageError(f"clean.hole_m must be 0 to {MAX_HOLE_M:g} m, got {self.hole_m:g}")


def remove_floaters(grid: OccupancyGrid, parameters: CleaningParameters) -> OccupancyGrid:
    """Return the grid with small isolated parts set to free.

    A part is isolated if it touches no other cell by a face, edge or corner.
    """
    parts, _ = label_components(grid.occupied)
    sizes = np.bincount(parts.reshape(-1))
    small = sizes < parameters.floater_cells
    small[0] = False
    labels = np.where(small[parts], np.uint8(SemanticClass.EMPTY), grid.labels)
    return replace(grid, labels=labels)


def close_structure(grid: OccupancyGrid, parameters: CleaningParameters) -> OccupancyGrid:
    """Return the grid with the unseen holes of floor, ceiling and walls closed.

    A hole is a set of unknown cells in a layer of the class that a closing with a square of
    ``hole_m`` fills. Cells seen as free are never filled, so doorways stay open.
    """
    labels, source = grid.labels.copy(), grid.source.copy()
    confidence, colour = grid.confidence.copy(), grid.colour.copy()
    for class_id, axes in (
        (SemanticClass.FLOOR, (2,)),
        (SemanticClass.CEILING, (2,)),
        (SemanticClass.WALL, (0, 1)),
    ):
        for axis in axes:
            for layer in structure_layers(grid.labels == class_id, axis):
                at = tuple(layer if a == axis else slice(None) for a in range(3))
                fill = _holes(labels[at], int(class_id), parameters.hole_m / grid.voxel_m)
                labels[at][fill], source[at][fill] = class_id, COMPLETED
                confidence[at][fill] = 0.5
                colour[at][fill] = _nearest_colour(grid, at, int(class_id))[fill]
    return replace(grid, labels=labels, source=source, confidence=confidence, colour=colour)


def structure_layers(mask: np.ndarray, axis: int) -> list[int]:
    """Return the layers across ``axis`` that contain a large flat part of ``mask``.

    A cell is flat if its neighbours within the layer also belong to the mask; a layer needs a
    hundred flat cells (0.6 m2).
    """
    within = np.ones([1 if a == axis else 3 for a in range(3)], bool)
    flat = ndimage.binary_opening(mask, within)
    counts = flat.sum(axis=tuple(a for a in range(3) if a != axis))
    return [int(layer) for layer in np.flatnonzero(counts >= 100)]


def _holes(layer: np.ndarray, class_id: int, hole_cells: float) -> np.ndarray:
    """Return the unknown cells of a layer [A, B] that closing by ``hole_cells`` covers."""
    side = int(hole_cells + 1e-6) + 1  # A closing fills gaps that are narrower than its square.
    present = np.pad(layer == class_id, side)
    closed = ndimage.binary_closing(present, np.ones((side, side), bool))[side:-side, side:-side]
    return closed & (layer == UNKNOWN)


def _nearest_colour(grid: OccupancyGrid, at: tuple, class_id: int) -> np.ndarray:
    """Return, for each cell of a layer, the colour of the nearest cell of the class in it."""
    elsewhere = grid.labels[at] != class_id
    nearest = ndimage.distance_transform_edt(elsewhere, return_distances=False, return_indices=True)
    return grid.colour[at][tuple(np.asarray(nearest))]
