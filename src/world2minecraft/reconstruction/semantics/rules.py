"""What a plate and a piece are: rules of size, height, shape and colour, the first that fits."""

from dataclasses import dataclass

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.geometry.morphology import dilate, erode
from world2minecraft.reconstruction.layout.parameters import (
    PieceParameters,
    PlateParameters,
    within,
)
from world2minecraft.reconstruction.layout.surface_cells import Surface
from world2minecraft.reconstruction.semantics.horizontal_surfaces import Plate
from world2minecraft.reconstruction.semantics.screens import screen_share
from world2minecraft.reconstruction.semantics.seats import class_of_seat
from world2minecraft.reconstruction.semantics.surface_pieces import Piece


@dataclass(frozen=True, eq=False)
class Table:
    """A table that was found: its height, and bool [X, Y] outlines under, on and around its top."""

    height_m: float
    under: np.ndarray
    inner: np.ndarray
    around: np.ndarray

    @classmethod
    def of(cls, plate: Plate, surface: Surface, parameters: PieceParameters) -> "Table":
        """Return the table of a plate."""
        reach = surface.cells_of(parameters.back_gap_m)
        outline = plate.footprint
        return cls(plate.height_m, dilate(outline), erode(outline), dilate(outline, reach))


@dataclass(frozen=True, eq=False)
class Seat:
    """A chair's seat that was found: its height, its middle, and bool [X, Y] what is under it."""

    height_m: float
    middle_m: np.ndarray  # float64 [2]
    under: np.ndarray

    @classmethod
    def of(cls, plate: Plate, surface: Surface, parameters: PieceParameters) -> "Seat":
        """Return the seat of a plate."""
        points = surface.points_m[plate.mask][:, :2].astype(np.float64)
        reach = surface.cells_of(parameters.foot_reach_m)
        middle = (points.min(axis=0) + points.max(axis=0)) / 2
        return cls(plate.height_m, middle, dilate(plate.footprint, reach))


def class_of_plate(
    surface: Surface, plate: Plate, left: np.ndarray, parameters: PlateParameters
) -> SemanticClass | None:
    """Return what a plate is the top, the seat or the mattress of; None where it does not say.

    Args:
        surface: the room.
        plate: the plate.
        left: bool [X, Y, Z], the cells that nothing has claimed yet.
        parameters: the thresholds.
    """
    height, area, width = plate.height_m, plate.area_m2, plate.width_m
    desk_high = within(height, parameters.desk_height_m)
    closed = plate.rim_share >= (parameters.desk_share if desk_high else parameters.box_share)
    seat = class_of_seat(surface, plate, left, closed, parameters)
    if seat is not None:
        return seat
    large = plate.length_m >= parameters.bed_size_m[0] and width >= parameters.bed_size_m[1]
    if large and area >= parameters.bed_area_m2 and within(height, parameters.bed_height_m):
        return SemanticClass.BED
    if not closed and _is_table_top(plate, parameters):
        return SemanticClass.TABLE
    solid = closed or height >= parameters.open_box_height_m
    wide = area >= parameters.box_area_m2 and width >= parameters.box_width_m
    # Of a worktop on which much stands only pieces are seen.
    if closed and within(height, parameters.worktop_height_m):
        least_m, long_m = parameters.worktop_size_m
        wide |= width >= least_m and plate.length_m >= long_m
    return SemanticClass.FURN if solid and wide and height >= parameters.box_height_m else None


def _is_table_top(plate: Plate, parameters: PlateParameters) -> bool:
    """Return whether a plate has the height and the size of a table's top, high or low."""
    if within(plate.height_m, parameters.table_height_m):
        wide = plate.width_m >= parameters.table_width_m
        return wide and plate.area_m2 >= parameters.table_area_m2
    low = within(plate.height_m, parameters.low_table_height_m)
    return low and plate.area_m2 >= parameters.low_table_area_m2


def class_of_piece(
    piece: Piece, tables: list[Table], seats: list[Seat], parameters: PieceParameters
) -> SemanticClass:
    """Return what a piece is that no plate has claimed."""
    if any(_is_leg(piece, table, parameters) for table in tables):
        return SemanticClass.TABLE
    if any(_is_foot(piece, seat, parameters) for seat in seats):
        return SemanticClass.CHAIR
    if _is_screen(piece, parameters):
        return SemanticClass.TVS
    if any(_is_back_at(piece, table, parameters) for table in tables):
        return SemanticClass.CHAIR
    if _is_chair(piece, parameters):
        return SemanticClass.CHAIR
    leafy = piece.oklab[1] <= parameters.leaf[0] and piece.oklab[2] >= parameters.leaf[1]
    if leafy and piece.flat_share < 0.5:
        return SemanticClass.OBJS
    large = piece.long_m >= parameters.box_length_m and piece.tall_m >= parameters.box_height_m
    boxy = piece.flat_share >= parameters.flat_share and len(piece.at[0]) >= parameters.box_cells
    deep = piece.near_wall and piece.off_wall_m > parameters.hanging_m
    return SemanticClass.FURN if large and boxy and deep else SemanticClass.OBJS


def _is_leg(piece: Piece, table: Table, parameters: PieceParameters) -> bool:
    """Return whether a piece stands or hangs under a table, up to its top: a leg, an apron."""
    below = table.height_m - piece.high_m[2]
    return table.under[piece.at[:2]].mean() >= 0.8 and -0.04 <= below <= parameters.under_table_m


def _is_foot(piece: Piece, seat: Seat, parameters: PieceParameters) -> bool:
    """Return whether a piece stands under a seat: the star of a chair whose post is too thin."""
    stands = piece.low_m[2] <= parameters.foot_bottom_m and piece.high_m[2] <= seat.height_m
    off = np.linalg.norm((piece.low_m + piece.high_m)[:2] / 2 - seat.middle_m)
    return bool(stands and off <= parameters.foot_off_m and seat.under[piece.at[:2]].mean() >= 0.8)


def _is_screen(piece: Piece, parameters: PieceParameters) -> bool:
    """Return whether a piece is a thin, upright plate off the floor, wider than high.

    It is dark, or a small flat one blue, as a lit one is: cupboards may be blue too.
    """
    off_floor = piece.low_m[2] >= parameters.screen_bottom_m
    dark = piece.oklab[0] <= parameters.screen_lightness
    small = piece.long_m <= parameters.monitor_m and piece.flat_share >= parameters.monitor_flat
    lit = small and screen_share(piece.oklab[None], parameters) > 0
    if not (off_floor and (dark or lit)):
        return False
    sized = within(piece.long_m, parameters.screen_width_m)
    sized &= within(piece.tall_m, parameters.screen_height_m)
    thin = piece.thin_m <= parameters.screen_thick_m
    return sized and thin and within(piece.long_m / piece.tall_m, parameters.screen_shape)


def _is_back_at(piece: Piece, table: Table, parameters: PieceParameters) -> bool:
    """Return whether a piece is the back of a chair that its table hides: at the rim, upright."""
    sized = within(piece.long_m, parameters.back_length_m)
    sized &= piece.tall_m >= parameters.back_height_m and piece.thin_m <= parameters.back_thick_m
    rises = piece.high_m[2] >= table.height_m + parameters.back_over_m
    at_rim = piece.low_m[2] >= table.height_m - 0.3 and table.height_m >= 0.6
    if not (sized and rises and at_rim and piece.high_m[2] <= parameters.chair_top_m[1]):
        return False
    on, near = table.inner[piece.at[:2]].mean(), table.around[piece.at[:2]].mean()
    return bool(on <= 0.1 and near >= 0.9)


def _is_chair(piece: Piece, parameters: PieceParameters) -> bool:
    """Return whether a piece has a chair's box and stands away from walls."""
    low = piece.low_m[2] <= parameters.chair_bottom_m and piece.tall_m >= 0.25
    sized = within(piece.high_m[2], parameters.chair_top_m)
    return low and sized and within(piece.long_m, parameters.chair_length_m) and not piece.near_wall
