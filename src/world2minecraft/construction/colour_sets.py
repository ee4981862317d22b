"""Colours of objects that are known better than photos show them: sets, and screens.

Cupboards side by side and the curtains of a room share their colours. Each is scanned in other
light, so that a row of cupboards would come out in two woods and the curtains of a window in two
cloths. The cells of such objects take the colour of the set, each as far as it looks like its
object's main colour: a dark worktop stays. Screens reflect the room, so that they come out brown or
beige; they are black unless they shine.
"""

from collections.abc import Sequence

import numpy as np

from world2minecraft.construction.surface_painting import LIGHTER_SHARE, lit_colour
from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import ObjectInstance, OccupancyGrid

CURTAIN = "curtain"
# Words in the names of furniture that is made in rows; a refrigerator beside it is another thing.
ROWS = ("cabinet", "counter", "cupboard", "sideboard", "shelf", "bookcase", "wardrobe", "furniture")
SAME_FRONT, SAME_CLOTH = 0.1, 0.2  # Oklab distances, guesses: curtains let light through.
OWN_PAINT = 0.12  # Oklab distance of a cell that shows its object's main colour, a guess.
BESIDE_CELLS = 2
LIGHT = 0.7  # Lightness differs by light.
MIN_CELLS = 20
# Oklab lightness above which a screen is lit, or a white sheet to project on, and the black of one
# that is off. Guesses.
LIT_SCREEN, DARK_SCREEN = 0.8, 0.2


def unify_sets(
    instances: Sequence[ObjectInstance],
    colours: np.ndarray,
    usable: np.ndarray,
) -> np.ndarray:
    """Return Oklab colours, float32 [X, Y, Z, 3], in which the objects of a set share their paint.

    Args:
        instances: Objects of the room.
        colours: Oklab colours, float32 [X, Y, Z, 3].
        usable: Bool [X, Y, Z] mask of the cells with a valid colour.
    """
    result = colours.copy()
    cells = {one.id: one.cells[usable[tuple(one.cells.T)]] for one in instances}
    known = [one for one in instances if len(cells[one.id]) >= MIN_CELLS]
    paints = {one.id: lit_colour(colours[tuple(cells[one.id].T)]) for one in known}
    curtains = [one for one in known if one.name == CURTAIN]
    furniture = [one for one in known if _is_row(one)]
    for members, same in ((curtains, SAME_CLOTH), (furniture, SAME_FRONT)):
        for group in _groups(members, paints, same, beside=members is furniture):
            own = [colours[tuple(cells[number].T)] for number in group]
            shared = lit_colour(np.concatenate(own), LIGHTER_SHARE)
            for number, held in zip(group, own, strict=True):
                mine = _distance(held, paints[number]) <= OWN_PAINT
                result[tuple(cells[number][mine].T)] = shared
    return result


def darken_screens(
    grid: OccupancyGrid,
    instances: Sequence[ObjectInstance],
    colours: np.ndarray,
    usable: np.ndarray,
) -> np.ndarray:
    """Return Oklab colours, float32 [X, Y, Z, 3], in which screens that are not lit are black.

    The arguments are those of ``unify_sets`` and the grid of the room.
    """
    result = colours.copy()
    cells = usable & (grid.labels == SemanticClass.TVS)
    for one in instances:
        if one.class_id != SemanticClass.TVS:
            continue
        at = tuple(one.cells[usable[tuple(one.cells.T)]].T)
        if len(at[0]) and np.median(colours[at][:, 0]) > LIT_SCREEN:
            cells[at] = False
    result[cells] = DARK_SCREEN, 0.0, 0.0
    return result


def _is_row(one: ObjectInstance) -> bool:
    words = not one.name or any(word in one.name for word in ROWS)
    return one.class_id == SemanticClass.FURN and words


def _groups(
    members: Sequence[ObjectInstance], paints: dict[int, np.ndarray], same: float, *, beside: bool
) -> list[list[int]]:
    """Return the ids of the objects of each set of several, of one colour and side by side."""
    left, groups = list(members), []
    while left:
        group = [left.pop(0)]
        for one in group:  # Grows while it is read.
            alike = [
                other
                for other in left
                if _distance(paints[one.id], paints[group[0].id]) <= same
                and _distance(paints[other.id], paints[group[0].id]) <= same
                and (not beside or _is_beside(one.cells, other.cells))
            ]
            group += alike
            left = [other for other in left if other not in alike]
        if len(group) > 1:
            groups.append([one.id for one in group])
    return groups


def _is_beside(one: np.ndarray, other: np.ndarray) -> bool:
    """Return whether the boxes of cells [N, 3] and [M, 3] touch, or nearly."""
    gap = np.maximum(one.min(0) - other.max(0), other.min(0) - one.max(0))
    return bool((gap <= 1 + BESIDE_CELLS).all())


def _distance(colours: np.ndarray, other: np.ndarray) -> np.ndarray:
    return np.linalg.norm((colours - other) * [LIGHT, 1, 1], axis=-1)
