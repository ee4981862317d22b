"""What a plate and a piece are: rules of size, height and shape, the first that fits.

Heights and sizes are those of catalogues, widened by about a cell on both sides.
"""

import numpy as np
from scipy import ndimage

from world2minecraft.classes import SemanticClass
from world2minecraft.label.components import Piece
from world2minecraft.label.parameters import GeometricParameters
from world2minecraft.label.plates import EIGHT, Plate
from world2minecraft.label.surface import Surface


def class_of_plate(
    surface: Surface, plate: Plate, left: np.ndarray, parameters: GeometricParameters
) -> SemanticClass | None:
    """Return what a plate is the top, the seat or the mattress of; None where it does not say.

    Args:
        surface: the room.
        plate: the plate.
        left: bool [X, Y, Z], the cells that nothing has claimed yet.
        parameters: the thresholds.
    """
    height, length, width = plate.height_m, plate.length_m, plate.width_m
    closed = plate.rim_share >= parameters.box_share
    back = _back_share(surface, plate, left)
    if 0.3 <= height <= 0.6 and back >= 0.5:
        if length >= 1.1 and 0.35 <= width <= 1.2:
            return SemanticClass.SOFA
        if length <= 0.8 and plate.area_m2 >= 0.07:
            return SemanticClass.CHAIR
    if 0.3 <= height <= 0.65 and length >= 1.6 and width >= 0.75 and plate.area_m2 >= 1.2:
        return SemanticClass.BED
    if 0.55 <= height <= 0.85 and plate.area_m2 >= 0.35 and width >= 0.4 and not closed:
        return SemanticClass.TABLE
    if 0.3 <= height <= 0.55 and plate.area_m2 >= 0.25 and not closed:
        return SemanticClass.TABLE
    if plate.area_m2 >= 0.15 and (closed or height >= 0.8) and width >= 0.2:
        return SemanticClass.FURN
    return None


def class_of_piece(
    surface: Surface, piece: Piece, tables: list[Plate], parameters: GeometricParameters
) -> SemanticClass:
    """Return what a piece is that no plate has claimed."""
    bottom, top = piece.low_m[2], piece.high_m[2]
    height = top - bottom
    if _is_leg(piece, tables):
        return SemanticClass.TABLE
    hung = bottom >= 0.45 and piece.thin_m <= 0.2 and piece.long_m >= 0.45
    if (
        hung
        and 0.25 <= height <= 1.1
        and 1.1 <= piece.long_m / height <= 2.6
        and _dark(piece, parameters)
    ):
        return SemanticClass.TVS
    seat_high = bottom <= 0.6 and 0.65 <= top <= 1.2 and height >= 0.25
    if seat_high and 0.25 <= piece.long_m <= 0.85 and not piece.near_wall:
        return SemanticClass.CHAIR
    if piece.near_wall and piece.long_m >= 0.4 and height >= 0.3 and len(piece.at[0]) >= 20:
        return SemanticClass.FURN
    return SemanticClass.OBJS


def _dark(piece: Piece, parameters: GeometricParameters) -> bool:
    return piece.lightness <= parameters.screen_lightness


def _is_leg(piece: Piece, tables: list[Plate]) -> bool:
    """Return whether a thin upright piece stands under a table and no higher."""
    if piece.long_m > 0.3 and piece.thin_m > 0.15:
        return False
    for table in tables:
        under = ndimage.binary_dilation(table.footprint, EIGHT)[piece.at[0], piece.at[1]]
        if under.mean() >= 0.8 and piece.high_m[2] <= table.height_m + 0.04:
            return True
    return False


def _back_share(surface: Surface, plate: Plate, left: np.ndarray) -> float:
    """Return the greatest share of one side of a plate over which something rises 0.2 to 0.5 m."""
    first = surface.layers_below(plate.height_m + 0.2)
    last = surface.layers_below(plate.height_m + 0.5)
    risen = left[:, :, first:last].any(axis=2)
    rows, columns = np.nonzero(plate.footprint)
    low, high = (rows.min(), columns.min()), (rows.max(), columns.max())
    x = slice(max(low[0] - 1, 0), high[0] + 2)
    y = slice(max(low[1] - 1, 0), high[1] + 2)
    around = risen[x, y]
    reach = 3
    sides = (
        around[:reach].any(axis=0), around[-reach:].any(axis=0),
        around[:, :reach].any(axis=1), around[:, -reach:].any(axis=1),
    )  # fmt: skip
    longest = max(len(side) for side in sides)
    return float(max(side[1:-1].mean() for side in sides if len(side) >= 0.8 * longest))
