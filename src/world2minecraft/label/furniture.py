"""Objects among what is no structure: cut at plates, then told apart piece by piece."""

from typing import cast

import numpy as np
from scipy import ndimage

from world2minecraft.classes import SemanticClass
from world2minecraft.label.components import FULL, find_pieces
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
    (SemanticClass.BED, SemanticClass.SOFA, SemanticClass.CHAIR),
    (SemanticClass.TABLE, SemanticClass.FURN),
)


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
            labels[claimed] = kind
            left &= ~claimed
            if kind == SemanticClass.TABLE:
                tables.append(plate)
    for piece in find_pieces(surface, left, wall, parameters):
        labels[piece.at] = class_of_piece(surface, piece, tables, parameters)


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
