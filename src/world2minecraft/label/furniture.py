"""Objects among what is no structure: cut at plates, then told apart piece by piece."""

from typing import cast

import numpy as np
from scipy import ndimage

from world2minecraft.classes import SemanticClass
from world2minecraft.label.components import FULL, Piece, find_pieces
from world2minecraft.label.parameters import GeometricParameters
from world2minecraft.label.plates import EIGHT, Plate, find_plates
from world2minecraft.label.rules import class_of_piece, class_of_plate
from world2minecraft.label.surface import Surface

# How far around its plate a thing may reach, in cells, and up to what height in metres; 0 = the
# plate's own. Arms, backs and headboards rise over a seat or a mattress; on a table lie others.
REACH = {
    SemanticClass.TABLE: (1, 0.0),
    SemanticClass.FURN: (1, 0.0),
    SemanticClass.BED: (2, 1.2),
    SemanticClass.SOFA: (4, 1.0),
    SemanticClass.CHAIR: (3, 1.15),
}

# What has a say before what: the arms of an easy chair are plates too, and would pass for a box.
ROUNDS = (
    (SemanticClass.TABLE,),
    (SemanticClass.BED, SemanticClass.SOFA, SemanticClass.CHAIR),
    (SemanticClass.FURN,),
)

# Sides and feet of what a plate has claimed; on top of it lie other things.
JOINING_CLASSES = (
    SemanticClass.FURN,
    SemanticClass.SOFA,
    SemanticClass.BED,
    SemanticClass.CHAIR,
)
JOINING_BOTTOM_M = 0.5
JOINING_SHARE = 0.3


def label_furniture(
    surface: Surface,
    rest: np.ndarray,
    wall: np.ndarray,
    labels: np.ndarray,
    parameters: GeometricParameters,
) -> None:
    """Write the classes of the cells ``rest`` to ``labels``, both [X, Y, Z].

    A plate that says what it is takes its box with it; what is left falls into pieces. A piece
    that only stands under a table is its leg.
    """
    left = rest.copy()
    plates = sorted(find_plates(surface, rest, parameters), key=lambda plate: -plate.area_m2)
    tables: list[Plate] = []
    for wanted in ROUNDS:
        for plate in plates:
            if (plate.mask & left).sum() < 0.5 * plate.mask.sum():
                continue
            kind = class_of_plate(surface, plate, left, parameters)
            if kind not in wanted:
                continue
            claimed = _claimed(surface, plate, left, kind)
            if kind == SemanticClass.CHAIR and not _stands_free(claimed, left):
                continue
            labels[claimed] = kind
            left &= ~claimed
            if kind == SemanticClass.TABLE:
                tables.append(plate)
    contact = {
        kind: ndimage.binary_dilation((labels == kind) & rest, FULL) for kind in JOINING_CLASSES
    }
    for piece in find_pieces(surface, left, wall, parameters):
        joined = _joined_class(piece, contact)
        labels[piece.at] = joined or class_of_piece(surface, piece, tables, parameters)


def _joined_class(piece: Piece, contact: dict[SemanticClass, np.ndarray]) -> SemanticClass | None:
    """Return the class of the thing whose side a piece is: low, and touching it over a third."""
    if piece.low_m[2] > JOINING_BOTTOM_M:
        return None
    shares = {kind: float(touched[piece.at].mean()) for kind, touched in contact.items()}
    best = max(shares, key=lambda kind: shares[kind])
    return best if shares[best] >= JOINING_SHARE else None


def _claimed(surface: Surface, plate: Plate, left: np.ndarray, kind: SemanticClass) -> np.ndarray:
    """Return the cells that go with a plate: a table's top alone, a closed box's whole body."""
    height = surface.points_m[..., 2]
    steps, top = REACH[kind]
    around = ndimage.binary_dilation(plate.footprint, EIGHT, iterations=steps)
    reach = around[:, :, None] & left & (height <= max(top, plate.height_m + 0.06))
    if kind == SemanticClass.TABLE:
        return reach & (height >= plate.height_m - 0.06)
    parts = cast(tuple[np.ndarray, int], ndimage.label(reach, FULL))[0]
    own = np.unique(parts[plate.mask & left])
    return reach & np.isin(parts, own[own > 0])


def _stands_free(claimed: np.ndarray, left: np.ndarray) -> bool:
    """Return whether a chair's cells do not go on into something larger."""
    beyond = ndimage.binary_dilation(claimed, FULL, iterations=2) & left & ~claimed
    return bool(beyond.sum() <= 0.25 * claimed.sum())
