"""Label furniture by rules: objects are cut at horizontal surfaces and classified by piece.

The rules test the size, height, shape and colour of a surface and its surroundings; the first rule
that matches decides.
"""

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from world2minecraft.core.classes import SemanticClass
from world2minecraft.geometry.connected_components import label_components
from world2minecraft.geometry.morphology import dilate, erode, project_to_plan
from world2minecraft.reconstruction.layout.parameters import (
    GeometricParameters,
    PieceParameters,
    PlateParameters,
    within,
)
from world2minecraft.reconstruction.layout.surface_cells import Surface
from world2minecraft.reconstruction.semantics.horizontal_surfaces import (
    HorizontalSurface,
    find_horizontal_surfaces,
)
from world2minecraft.reconstruction.semantics.screens import screen_share
from world2minecraft.reconstruction.semantics.surface_pieces import Piece, find_pieces

# Seats: plates at knee height with a back on one side. A chair's is compact, a sofa's is long.
AROUND_CELLS = 2  # The edge between seat and back is hidden; the back is looked for this far off.

# Extent of an object around its plate, and its maximum height, in metres; 0 is the plate's height.
# Arms, backs and headboards rise above a seat or a mattress; other objects lie on a table.
REACH_M = {
    SemanticClass.TABLE: (0.08, 0.0),
    SemanticClass.FURN: (0.08, 0.0),
    SemanticClass.BED: (0.08, 1.2),
    SemanticClass.SOFA: (0.32, 1.0),
    SemanticClass.CHAIR: (0.24, 1.15),
}
HEAD_M = 0.55  # Extent of pillows from the head of a bed, in metres.
APART_M = 0.5  # Maximum distance of a chair from its table.
WALL_CELLS = 4  # Minimum cells of wall in a column that separates objects on its two sides.
FLUSH_M = 0.12  # Maximum extent of a picture from its wall.
MARGIN_M = 0.64  # Walls up to 0.45 m from an object affect its class.
TOP_M = 0.06  # Maximum distance of a plate's cells from its height.
# Classes in the order of their search: the arms of an easy chair are plates too, and would be taken
# for a box.
ROUNDS = (
    (SemanticClass.TABLE,),
    (SemanticClass.BED, SemanticClass.SOFA, SemanticClass.CHAIR),
    (SemanticClass.FURN,),
)
JOINING_CLASSES = (
    SemanticClass.FURN,
    SemanticClass.SOFA,
    SemanticClass.BED,
    SemanticClass.CHAIR,
)


def class_of_seat(
    surface: Surface,
    plate: HorizontalSurface,
    left: np.ndarray,
    closed: bool,
    parameters: PlateParameters,
) -> SemanticClass | None:
    """Return whether a plate is the seat of a chair or a sofa, or None if it is not a seat.

    Args:
        surface: Surface of the room.
        plate: The plate.
        left: Mask of the cells not assigned yet, bool [X, Y, Z].
        closed: Whether the plate is the top of a closed box, such as upholstery. Its back must then
            have the same colour, so that a screen on a sideboard is not taken for a sofa.
        parameters: Thresholds.
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
    surface: Surface, plate: HorizontalSurface, left: np.ndarray, parameters: PlateParameters
) -> tuple[float, float]:
    """Return the share of one side of a plate that a back covers, and its difference in colour.

    Only long sides are tested. The difference is that of the median Oklab colours, 1 without a
    back.
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


def _is_board(surface: Surface, plate: HorizontalSurface, parameters: PlateParameters) -> bool:
    """Return whether tall objects above a plate make it the board of a shelf."""
    first, last = (surface.layers_below(height) for height in parameters.shelf_m)
    over = project_to_plan(surface.occupied[:, :, first:last])
    return bool(over[plate.footprint].mean() >= parameters.shelf_share)


@dataclass(frozen=True, eq=False)
class Table:
    """A table, with its height and bool [X, Y] masks of the area under, on and around its top."""

    height_m: float
    under: np.ndarray
    inner: np.ndarray
    around: np.ndarray

    @classmethod
    def of(cls, plate: HorizontalSurface, surface: Surface, parameters: PieceParameters) -> "Table":
        """Return the table of a plate."""
        reach = surface.cells_of(parameters.back_gap_m)
        outline = plate.footprint
        return cls(plate.height_m, dilate(outline), erode(outline), dilate(outline, reach))


@dataclass(frozen=True, eq=False)
class Seat:
    """The seat of a chair, with its height, its centre and a bool [X, Y] mask of the area below."""

    height_m: float
    middle_m: np.ndarray  # float64 [2]
    under: np.ndarray

    @classmethod
    def of(cls, plate: HorizontalSurface, surface: Surface, parameters: PieceParameters) -> "Seat":
        """Return the seat of a plate."""
        points = surface.points_m[plate.mask][:, :2].astype(np.float64)
        reach = surface.cells_of(parameters.foot_reach_m)
        middle = (points.min(axis=0) + points.max(axis=0)) / 2
        return cls(plate.height_m, middle, dilate(plate.footprint, reach))


def classify_surface(
    surface: Surface, plate: HorizontalSurface, left: np.ndarray, parameters: PlateParameters
) -> SemanticClass | None:
    """Return the class of the object whose top, seat or mattress a plate is, or None.

    Args:
        surface: Surface of the room.
        plate: The plate.
        left: Mask of the cells not assigned yet, bool [X, Y, Z].
        parameters: Thresholds.
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


def _is_table_top(plate: HorizontalSurface, parameters: PlateParameters) -> bool:
    """Return whether a plate has the height and the size of a high or low table top."""
    if within(plate.height_m, parameters.table_height_m):
        wide = plate.width_m >= parameters.table_width_m
        return wide and plate.area_m2 >= parameters.table_area_m2
    low = within(plate.height_m, parameters.low_table_height_m)
    return low and plate.area_m2 >= parameters.low_table_area_m2


def classify_piece(
    piece: Piece, tables: list[Table], seats: list[Seat], parameters: PieceParameters
) -> SemanticClass:
    """Return the class of a piece that belongs to no plate."""
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
    """Return whether a piece is a leg or apron, below a table and up to its top."""
    below = table.height_m - piece.high_m[2]
    return table.under[piece.at[:2]].mean() >= 0.8 and -0.04 <= below <= parameters.under_table_m


def _is_foot(piece: Piece, seat: Seat, parameters: PieceParameters) -> bool:
    """Return whether a piece is the star base below a seat whose post is too thin."""
    stands = piece.low_m[2] <= parameters.foot_bottom_m and piece.high_m[2] <= seat.height_m
    off = np.linalg.norm((piece.low_m + piece.high_m)[:2] / 2 - seat.middle_m)
    return bool(stands and off <= parameters.foot_off_m and seat.under[piece.at[:2]].mean() >= 0.8)


def _is_screen(piece: Piece, parameters: PieceParameters) -> bool:
    """Return whether a piece is a thin upright plate above the floor, wider than high.

    It must be dark, or small, flat and blue like a lit screen that is not flush with a wall, since
    cupboards and pictures may also be blue.
    """
    off_floor = piece.low_m[2] >= parameters.screen_bottom_m
    dark = piece.oklab[0] <= parameters.screen_lightness
    small = piece.long_m <= parameters.monitor_m and piece.flat_share >= parameters.monitor_flat
    lit = small and piece.off_wall_m > FLUSH_M and screen_share(piece.oklab[None], parameters) > 0
    if not (off_floor and (dark or lit)):
        return False
    sized = within(piece.long_m, parameters.screen_width_m)
    sized &= within(piece.tall_m, parameters.screen_height_m)
    thin = piece.thin_m <= parameters.screen_thick_m
    return sized and thin and within(piece.long_m / piece.tall_m, parameters.screen_shape)


def _is_back_at(piece: Piece, table: Table, parameters: PieceParameters) -> bool:
    """Return whether a piece is the upright back, at the rim, of a chair hidden by a table."""
    sized = within(piece.long_m, parameters.back_length_m)
    sized &= piece.tall_m >= parameters.back_height_m and piece.thin_m <= parameters.back_thick_m
    rises = piece.high_m[2] >= table.height_m + parameters.back_over_m
    at_rim = piece.low_m[2] >= table.height_m - 0.3 and table.height_m >= 0.6
    if not (sized and rises and at_rim and piece.high_m[2] <= parameters.chair_top_m[1]):
        return False
    on, near = table.inner[piece.at[:2]].mean(), table.around[piece.at[:2]].mean()
    return bool(on <= 0.1 and near >= 0.9)


def _is_chair(piece: Piece, parameters: PieceParameters) -> bool:
    """Return whether a piece has the size of a chair and is away from walls."""
    low = piece.low_m[2] <= parameters.chair_bottom_m and piece.tall_m >= 0.25
    sized = within(piece.high_m[2], parameters.chair_top_m)
    return low and sized and within(piece.long_m, parameters.chair_length_m) and not piece.near_wall


def label_furniture(
    surface: Surface,
    rest: np.ndarray,
    wall: np.ndarray,
    labels: np.ndarray,
    parameters: GeometricParameters,
) -> None:
    """Write the classes of the cells ``rest`` to ``labels``, both [X, Y, Z].

    Separate objects are processed separately, so the time for a house is the sum of that of its
    rooms.
    """
    plan, inside = project_to_plan(rest), wall.sum(axis=2) < WALL_CELLS
    groups, count = label_components(plan | (dilate(plan, surface.cells_of(APART_M / 2)) & inside))
    margin = surface.cells_of(MARGIN_M)
    for number, box in enumerate(ndimage.find_objects(groups, count), 1):
        x, y = (slice(max(side.start - margin, 0), side.stop + margin) for side in box)
        own = rest[x, y] & (groups[x, y] == number)[:, :, None]
        _label_group(surface.columns(x, y), own, wall[x, y], labels[x, y], parameters)


def _label_group(
    surface: Surface,
    rest: np.ndarray,
    wall: np.ndarray,
    labels: np.ndarray,
    parameters: GeometricParameters,
) -> None:
    """Write the classes of connected objects.

    A plate with a known class determines the class of its object; the remaining cells are divided
    into pieces.
    """
    left = rest.copy()
    tables, seats = _label_plates(surface, left, labels, parameters)
    contact = {kind: dilate((labels == kind) & rest & ~left) for kind in JOINING_CLASSES}
    for piece in find_pieces(surface, left, wall, parameters.pieces):
        joined = _joined_class(piece, contact, parameters)
        labels[piece.at] = joined or classify_piece(piece, tables, seats, parameters.pieces)


def _label_plates(
    surface: Surface, left: np.ndarray, labels: np.ndarray, parameters: GeometricParameters
) -> tuple[list[Table], list[Seat]]:
    """Write the classes of plates to ``labels`` and remove their cells from ``left``.

    Returns:
        The tables and the seats of chairs.
    """
    plates = find_horizontal_surfaces(surface, left, parameters.plates)
    plates.sort(key=lambda plate: -plate.area_m2)
    tables: list[Table] = []
    seats: list[Seat] = []
    for wanted in ROUNDS:
        for plate in plates:
            if (plate.mask & left).sum() < 0.5 * plate.mask.sum():
                continue
            kind = classify_surface(surface, plate, left, parameters.plates)
            if kind is None or kind not in wanted:
                continue
            claimed = _claimed(surface, plate, left, kind)
            if kind == SemanticClass.CHAIR and not _stands_free(
                surface, plate, claimed, left, parameters.plates
            ):
                continue
            labels[claimed] = kind
            left &= ~claimed
            if kind == SemanticClass.TABLE:
                tables.append(Table.of(plate, surface, parameters.pieces))
            if kind == SemanticClass.CHAIR:
                seats.append(Seat.of(plate, surface, parameters.pieces))
    return tables, seats


def _claimed(
    surface: Surface, plate: HorizontalSurface, left: np.ndarray, kind: SemanticClass
) -> np.ndarray:
    """Return the cells of a plate's object: only the top of a table, all of a closed box."""
    height = surface.points_m[..., 2]
    reach_m, top_m = REACH_M[kind]
    is_bed = kind == SemanticClass.BED
    outline = _with_head(surface, plate, left) if is_bed else plate.footprint
    around = dilate(outline, surface.cells_of(reach_m))[:, :, None]
    reach = around & left & (height <= max(top_m, plate.height_m + TOP_M))
    if kind == SemanticClass.TABLE:
        # Beside its rim, what rises higher is the back of a chair.
        rises = np.zeros_like(left)
        rises[:, :, :-1] = left[:, :, 1:] & ~plate.footprint[:, :, None]
        return reach & (height >= plate.height_m - TOP_M) & ~rises
    parts, _ = label_components(reach)
    own = np.unique(parts[plate.mask & left])
    return reach & np.isin(parts, own[own > 0])


def _with_head(surface: Surface, plate: HorizontalSurface, left: np.ndarray) -> np.ndarray:
    """Return the outline of a bed including its pillows and headboard along one side."""
    first = surface.layers_below(plate.height_m + TOP_M)
    risen = project_to_plan(left[:, :, first : surface.layers_below(REACH_M[SemanticClass.BED][1])])
    rows, columns = np.nonzero(plate.footprint)
    x, y = slice(rows.min(), rows.max() + 1), slice(columns.min(), columns.max() + 1)
    more = surface.cells_of(HEAD_M)
    result = plate.footprint.copy()
    for beyond, axis in (
        ((slice(max(x.start - more, 0), x.start), y), 0),
        ((slice(x.stop, x.stop + more), y), 0),
        ((x, slice(max(y.start - more, 0), y.start)), 1),
        ((x, slice(y.stop, y.stop + more)), 1),
    ):
        if np.any(risen[beyond], axis=axis).mean() >= 0.6:
            result[beyond] = True
    return result


def _stands_free(
    surface: Surface,
    plate: HorizontalSurface,
    claimed: np.ndarray,
    left: np.ndarray,
    parameters: PlateParameters,
) -> bool:
    """Return whether a chair's cells do not continue into a larger object.

    Cells that touch an upholstered chair in another colour belong to another object.
    """
    beyond = dilate(claimed, 2) & left & ~claimed
    count = int(beyond.sum())
    if plate.rim_share >= parameters.box_share:
        difference = surface.oklab[beyond] - np.median(surface.oklab[claimed], axis=0)
        count = int((np.linalg.norm(difference, axis=1) <= parameters.same_cloth).sum())
    return count <= 0.25 * int(claimed.sum())


def _joined_class(
    piece: Piece, contact: dict[SemanticClass, np.ndarray], parameters: GeometricParameters
) -> SemanticClass | None:
    """Return the class of the object of which a low piece, in contact over a third, is a side."""
    if piece.low_m[2] > parameters.pieces.joining_bottom_m:
        return None
    # A curtain beside an easy chair is no side of it.
    shares = {
        kind: float(touched[piece.at].mean())
        for kind, touched in contact.items()
        if kind == SemanticClass.FURN or piece.high_m[2] <= REACH_M[kind][1]
    }
    if not shares:
        return None
    best = max(shares, key=lambda kind: shares[kind])
    return best if shares[best] >= parameters.pieces.joining_share else None
