"""Seats: plates at knee height with a back on one side. A chair's is compact, a sofa's is long."""

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.geometry.morphology import project_to_plan
from world2minecraft.reconstruction.layout.parameters import PlateParameters, within
from world2minecraft.reconstruction.layout.surface_cells import Surface
from world2minecraft.reconstruction.semantics.horizontal_surfaces import Plate

AROUND_CELLS = 2  # The edge between seat and back is hidden; the back is looked for this far off.


def class_of_seat(
    surface: Surface, plate: Plate, left: np.ndarray, closed: bool, parameters: PlateParameters
) -> SemanticClass | None:
    """Return whose seat a plate is, a chair's or a sofa's; None where it is no seat.

    Args:
        surface: the room.
        plate: the plate.
        left: bool [X, Y, Z], the cells that nothing has claimed yet.
        closed: whether the plate is the top of a closed box, as upholstery is: then its back must
            be of the same cloth, or a screen on a board would make a sofa of it.
        parameters: the thresholds.
    """
    if not within(plate.height_m, parameters.seat_height_m) or _is_board(
        surface, plate, parameters
    ):
        return None
    share, contrast = back_of(surface, plate, left, parameters)
    padded = contrast <= parameters.same_cloth and plate.height_m <= parameters.closed_seat_m
    if share < parameters.back_share or (closed and not padded):
        return None
    if plate.length_m >= parameters.sofa_length_m:
        return SemanticClass.SOFA if within(plate.width_m, parameters.sofa_width_m) else None
    compact = plate.length_m <= parameters.chair_length_m
    return SemanticClass.CHAIR if compact and plate.width_m >= parameters.chair_width_m else None


def back_of(
    surface: Surface, plate: Plate, left: np.ndarray, parameters: PlateParameters
) -> tuple[float, float]:
    """Return how much of one side of a plate a back takes, and how its colour differs.

    Only long sides count; the difference is that of the median colours in Oklab, 1 for no back.
    """
    first, last = (surface.layers_below(plate.height_m + rise) for rise in parameters.back_rise_m)
    rows, columns = np.nonzero(plate.footprint)
    x = slice(max(int(rows.min()) - AROUND_CELLS, 0), int(rows.max()) + 1 + AROUND_CELLS)
    y = slice(max(int(columns.min()) - AROUND_CELLS, 0), int(columns.max()) + 1 + AROUND_CELLS)
    risen = left[x, y, first:last]
    if not risen.any():
        return 0.0, 1.0
    around, depth = project_to_plan(risen), 2 * AROUND_CELLS
    strips = (around[:depth], around[-depth:], around[:, :depth].T, around[:, -depth:].T)
    sides = [np.atleast_1d(strip.any(axis=0)) for strip in strips]
    longest = max(len(side) for side in sides)
    inner = slice(AROUND_CELLS, -AROUND_CELLS)
    wide = [side for side in sides if len(side) >= max(0.7 * longest, 2 * AROUND_CELLS + 1)]
    share = max((float(side[inner].mean()) for side in wide), default=0.0)  # At the grid's edge.
    back = np.median(surface.oklab[x, y, first:last][risen], axis=0)
    seat = np.median(surface.oklab[plate.mask], axis=0)
    return share, float(np.linalg.norm(back - seat))


def _is_board(surface: Surface, plate: Plate, parameters: PlateParameters) -> bool:
    """Return whether much stands over a plate higher than any chair: then it is a shelf's board."""
    first, last = (surface.layers_below(height) for height in parameters.shelf_m)
    over = project_to_plan(surface.occupied[:, :, first:last])
    return bool(over[plate.footprint].mean() >= parameters.shelf_share)
