"""Objects among what is no structure: cut at plates, then told apart piece by piece."""

import numpy as np
from scipy import ndimage

from world2minecraft.core.classes import SemanticClass
from world2minecraft.geometry.connected_components import label_components
from world2minecraft.geometry.morphology import dilate, project_to_plan
from world2minecraft.reconstruction.layout.parameters import GeometricParameters, PlateParameters
from world2minecraft.reconstruction.layout.surface_cells import Surface
from world2minecraft.reconstruction.semantics.horizontal_surfaces import Plate, find_plates
from world2minecraft.reconstruction.semantics.rules import (
    Seat,
    Table,
    class_of_piece,
    class_of_plate,
)
from world2minecraft.reconstruction.semantics.surface_pieces import Piece, find_pieces

# How far around its plate a thing may reach and up to what height, in metres; 0 = the plate's own.
# Arms, backs and headboards rise over a seat or a mattress; on a table lie other things.
REACH_M = {
    SemanticClass.TABLE: (0.08, 0.0),
    SemanticClass.FURN: (0.08, 0.0),
    SemanticClass.BED: (0.08, 1.2),
    SemanticClass.SOFA: (0.32, 1.0),
    SemanticClass.CHAIR: (0.24, 1.15),
}
HEAD_M = 0.55  # How far pillows reach from the head of a bed.
APART_M = 0.5  # A chair belongs to a table no further off.
WALL_CELLS = 4  # In a column; then things to both sides of it stand apart.
MARGIN_M = 0.64  # Walls matter within 0.45 m of a thing.
TOP_M = 0.06  # A plate's cells lie this near its height.

# What has a say before what: the arms of an easy chair are plates too, and would pass for a box.
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


def label_furniture(
    surface: Surface,
    rest: np.ndarray,
    wall: np.ndarray,
    labels: np.ndarray,
    parameters: GeometricParameters,
) -> None:
    """Write the classes of the cells ``rest`` to ``labels``, both [X, Y, Z].

    Things that stand apart are looked at apart, so that a house takes as long as its rooms.
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
    """Write the classes of things that stand together.

    A plate that says what it is takes its thing with it; what is left falls into pieces.
    """
    left = rest.copy()
    tables, seats = _label_plates(surface, left, labels, parameters)
    contact = {kind: dilate((labels == kind) & rest & ~left) for kind in JOINING_CLASSES}
    for piece in find_pieces(surface, left, wall, parameters.pieces):
        joined = _joined_class(piece, contact, parameters)
        labels[piece.at] = joined or class_of_piece(piece, tables, seats, parameters.pieces)


def _label_plates(
    surface: Surface, left: np.ndarray, labels: np.ndarray, parameters: GeometricParameters
) -> tuple[list[Table], list[Seat]]:
    """Write what plates say to ``labels``, take their cells from ``left``.

    Returns:
        The tables and the seats of chairs.
    """
    plates = find_plates(surface, left, parameters.plates)
    plates.sort(key=lambda plate: -plate.area_m2)
    tables: list[Table] = []
    seats: list[Seat] = []
    for wanted in ROUNDS:
        for plate in plates:
            if (plate.mask & left).sum() < 0.5 * plate.mask.sum():
                continue
            kind = class_of_plate(surface, plate, left, parameters.plates)
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


def _claimed(surface: Surface, plate: Plate, left: np.ndarray, kind: SemanticClass) -> np.ndarray:
    """Return the cells that go with a plate: a table's top alone, a closed box's whole body."""
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


def _with_head(surface: Surface, plate: Plate, left: np.ndarray) -> np.ndarray:
    """Return a bed's outline with its head: pillows and a headboard rise along a whole side."""
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
    plate: Plate,
    claimed: np.ndarray,
    left: np.ndarray,
    parameters: PlateParameters,
) -> bool:
    """Return whether a chair's cells do not go on into something larger.

    What touches an easy chair, which is closed all around, in another colour is another thing.
    """
    beyond = dilate(claimed, 2) & left & ~claimed
    count = int(beyond.sum())
    if plate.rim_share >= parameters.box_share:
        apart = surface.oklab[beyond] - np.median(surface.oklab[claimed], axis=0)
        count = int((np.linalg.norm(apart, axis=1) <= parameters.same_cloth).sum())
    return count <= 0.25 * int(claimed.sum())


def _joined_class(
    piece: Piece, contact: dict[SemanticClass, np.ndarray], parameters: GeometricParameters
) -> SemanticClass | None:
    """Return the class of the thing whose side a piece is: low, and touching it over a third."""
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
