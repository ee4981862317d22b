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

SAME_CLOTH = 0.12  # Oklab: shades of one cloth; a screen on a board differs by 0.3. A guess.


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
    seat = _seat_of(surface, plate, left, closed)
    if seat is not None:
        return seat
    if 0.3 <= height <= 0.65 and length >= 1.6 and width >= 0.75 and plate.area_m2 >= 1.2:
        return SemanticClass.BED
    if 0.55 <= height <= 0.85 and plate.area_m2 >= 0.35 and width >= 0.4 and not closed:
        return SemanticClass.TABLE
    if 0.3 <= height <= 0.55 and plate.area_m2 >= 0.25 and not closed:
        return SemanticClass.TABLE
    if plate.area_m2 >= 0.15 and (closed or height >= 0.8) and width >= 0.2 and height >= 0.42:
        return SemanticClass.FURN
    return None


def _seat_of(
    surface: Surface, plate: Plate, left: np.ndarray, closed: bool
) -> SemanticClass | None:
    """Return whose seat a plate is: a chair's or a sofa's, by its size and its back."""
    if not 0.32 <= plate.height_m <= 0.56:
        return None
    back, contrast = _back_of(surface, plate, left)
    upholstered = not closed or contrast <= SAME_CLOTH
    if back < 0.6 or not upholstered or _goes_on_up(surface, plate):
        return None
    if plate.length_m >= 1.1 and 0.35 <= plate.width_m <= 1.2:
        return SemanticClass.SOFA
    compact = plate.length_m <= 0.85 and plate.width_m >= 0.2
    return SemanticClass.CHAIR if compact else None


def class_of_piece(
    surface: Surface, piece: Piece, tables: list[Plate], parameters: GeometricParameters
) -> SemanticClass:
    """Return what a piece is that no plate has claimed."""
    bottom, top = piece.low_m[2], piece.high_m[2]
    height = top - bottom
    if _is_leg(piece, tables):
        return SemanticClass.TABLE
    if _is_screen(piece, parameters):
        return SemanticClass.TVS
    if _is_back_at_table(piece, tables):
        return SemanticClass.CHAIR
    seat_high = bottom <= 0.6 and 0.65 <= top <= 1.15 and height >= 0.25
    if seat_high and 0.25 <= piece.long_m <= 0.85 and not piece.near_wall:
        return SemanticClass.CHAIR
    leafy = piece.oklab[1] <= parameters.leaf[0] and piece.oklab[2] >= parameters.leaf[1]
    if leafy and piece.flat_share < 0.5:
        return SemanticClass.OBJS
    boxy = piece.flat_share >= parameters.flat_share and piece.long_m >= 0.4 and height >= 0.45
    if boxy and piece.near_wall and len(piece.at[0]) >= 20:
        return SemanticClass.FURN
    return SemanticClass.OBJS


def _is_screen(piece: Piece, parameters: GeometricParameters) -> bool:
    """Return whether a piece is a dark, thin, upright plate off the floor, wider than high."""
    height = piece.high_m[2] - piece.low_m[2]
    if not (piece.low_m[2] >= 0.4 and piece.thin_m <= 0.22 and 0.4 <= piece.long_m <= 1.8):
        return False
    shaped = 0.25 <= height <= 1.1 and 1.0 <= piece.long_m / height <= 2.6
    return shaped and piece.oklab[0] <= parameters.screen_lightness


def _is_leg(piece: Piece, tables: list[Plate]) -> bool:
    """Return whether a piece stands or hangs under a table, up to its top: a leg, an apron."""
    for table in tables:
        under = ndimage.binary_dilation(table.footprint, EIGHT)[piece.at[0], piece.at[1]]
        reach = piece.high_m[2] - table.height_m
        if under.mean() >= 0.8 and -0.16 <= reach <= 0.04:
            return True
    return False


def _is_back_at_table(piece: Piece, tables: list[Plate]) -> bool:
    """Return whether a piece is the back of a chair that its table hides: at the rim, upright."""
    low, high = piece.low_m[2], piece.high_m[2]
    if not (high - low >= 0.1 and 0.25 <= piece.long_m <= 0.65 and piece.thin_m <= 0.4):
        return False
    for table in tables:
        over = low >= table.height_m - 0.3 and table.height_m + 0.08 <= high <= 1.15
        inner = ndimage.binary_erosion(table.footprint, EIGHT, iterations=1)
        near = ndimage.binary_dilation(table.footprint, EIGHT, iterations=6)
        beside = inner[piece.at[:2]].mean() <= 0.1 and near[piece.at[:2]].mean() >= 0.9
        if table.height_m >= 0.6 and over and beside:
            return True
    return False


def _goes_on_up(surface: Surface, plate: Plate) -> bool:
    """Return whether much stands over a plate higher than any chair: then it is a shelf's board."""
    first, last = surface.layers_below(1.25), surface.layers_below(1.9)
    over = surface.occupied[:, :, first:last].any(axis=2)
    return bool(over[plate.footprint].mean() >= 0.3)


def _back_of(surface: Surface, plate: Plate, left: np.ndarray) -> tuple[float, float]:
    """Return the back of a seat: how much of one side it takes, and how its colour differs.

    A back rises 0.2 to 0.5 m over the plate, within 0.2 m of its rim. The colour difference is
    that of the medians in Oklab.
    """
    first = surface.layers_below(plate.height_m + 0.2)
    last = surface.layers_below(plate.height_m + 0.5)
    rows, columns = np.nonzero(plate.footprint)
    reach = 2
    x = slice(max(int(rows.min()) - reach, 0), int(rows.max()) + 1 + reach)
    y = slice(max(int(columns.min()) - reach, 0), int(columns.max()) + 1 + reach)
    risen = left[x, y, first:last]
    around = risen.any(axis=2)
    depth = 2 * reach
    sides = [around[:depth].any(axis=0), around[-depth:].any(axis=0)]
    sides += [around[:, :depth].any(axis=1), around[:, -depth:].any(axis=1)]
    longest = max(len(side) for side in sides)
    shares = [float(side[reach:-reach].mean()) for side in sides if len(side) >= 0.7 * longest]
    if not risen.any():
        return 0.0, 1.0
    cloth = np.median(surface.oklab[x, y, first:last][risen], axis=0)
    seat = np.median(surface.oklab[plate.mask], axis=0)
    return max(shares), float(np.linalg.norm(cloth - seat))
