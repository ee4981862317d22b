"""Backs and sides of cases at a wall.

The back of an open shelf is as flat on its wall as a picture, but it is surrounded by the shelf and
has the same colour.
"""

from collections.abc import Iterator

import numpy as np
from scipy import ndimage

from world2minecraft.core.classes import SemanticClass
from world2minecraft.geometry.connected_components import label_components
from world2minecraft.reconstruction.layout.structure import Wall
from world2minecraft.reconstruction.layout.surface_cells import Surface, turn_surface

REACH_M = 0.4  # A shelf is 0.2 to 0.35 m deep.
INSIDE_SHARE = 0.8  # Minimum share of a back inside its case; noise widens both.
ALIKE = 0.12  # Oklab difference of one wood in the light and in its own shadow.


def classes_with_backs(surface: Surface, wall: Wall, labels: np.ndarray) -> np.ndarray:
    """Return the classes of a wall's positions, uint8 [A, B], with the backs of cases assigned.

    Args:
        surface: Surface of the room.
        wall: The wall; flat objects on it have the class objs before this step.
        labels: Known classes of furniture, uint8 [X, Y, Z].
    """
    relief, face = wall.relief, wall.face
    hung = (face.classes == SemanticClass.OBJS) & (face.depth_m < relief.plane_m)
    cases = list(_cases_before(surface, wall, labels)) if hung.any() else []
    if not cases:
        return face.classes
    classes, oklab = face.classes.copy(), relief.of(surface.oklab)
    patches, count = label_components(hung)
    for patch in (patches == number for number in range(1, count + 1)):
        cells = face.cells & patch
        if not cells.any():
            continue
        colour = np.median(oklab[cells], axis=0)
        for box, wood in cases:
            inside = patch[box].sum() >= INSIDE_SHARE * patch.sum()
            if inside and np.linalg.norm(colour - wood) <= ALIKE:
                classes[patch] = SemanticClass.FURN
    return classes


def _cases_before(
    surface: Surface, wall: Wall, labels: np.ndarray
) -> Iterator[tuple[tuple[slice, ...], np.ndarray]]:
    """Yield the box on the wall's face, two slices, and the Oklab colour of each case."""
    deep, *across = wall.relief.box
    first = max(deep.start - surface.cells_of(REACH_M), 0)
    box = (slice(first, deep.stop), *across)
    axis, sign = wall.relief.axis, wall.relief.sign
    parts, count = label_components(turn_surface(labels, axis, sign)[box] == SemanticClass.FURN)
    oklab = turn_surface(surface.oklab, axis, sign)[box]
    for number, place in enumerate(ndimage.find_objects(parts, count), 1):
        own = parts[place] == number
        grown = tuple(slice(max(side.start - 1, 0), side.stop + 1) for side in place[1:])
        yield grown, np.median(oklab[place][own], axis=0)
