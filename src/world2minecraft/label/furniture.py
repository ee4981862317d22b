"""Objects among what is no structure: cut at plates, then told apart piece by piece."""

import numpy as np
from scipy import ndimage

from world2minecraft.classes import SemanticClass
from world2minecraft.label.components import find_pieces
from world2minecraft.label.parameters import GeometricParameters
from world2minecraft.label.plates import EIGHT, Plate, find_plates
from world2minecraft.label.rules import class_of_piece, class_of_plate
from world2minecraft.label.surface import Surface


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
    plates = find_plates(surface, rest, parameters)
    tables: list[Plate] = []
    for plate in sorted(plates, key=lambda one: -one.area_m2):
        fresh = plate.mask & left
        if fresh.sum() < 0.5 * plate.mask.sum():
            continue
        kind = class_of_plate(surface, plate, left, parameters)
        if kind is None:
            continue
        claimed = _claimed(surface, plate, left, kind)
        labels[claimed] = kind
        left &= ~claimed
        if kind == SemanticClass.TABLE:
            tables.append(plate)
    for piece in find_pieces(surface, left, wall):
        labels[piece.at] = class_of_piece(surface, piece, tables, parameters)


def _claimed(surface: Surface, plate: Plate, left: np.ndarray, kind: SemanticClass) -> np.ndarray:
    """Return the cells that go with a plate: a table's top alone, a closed box's whole body."""
    reach = ndimage.binary_dilation(plate.footprint, EIGHT)[:, :, None] & left
    height = surface.points_m[..., 2]
    near = np.abs(height - plate.height_m) <= 0.75 * surface.voxel_m
    if kind == SemanticClass.TABLE:
        return reach & near
    top = plate.height_m + 0.75 * surface.voxel_m
    if kind in (SemanticClass.SOFA, SemanticClass.BED, SemanticClass.CHAIR):
        reach = ndimage.binary_dilation(plate.footprint, EIGHT, iterations=2)[:, :, None] & left
        top = 1.15
    return reach & (height <= top)
