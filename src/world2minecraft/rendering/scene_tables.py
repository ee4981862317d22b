"""The arrays of a scene, as read by all kernels.

A cell is air, a full opaque cube, or a list of elements. ``rendering.empty_space_boxes`` describes
the air. ``looks`` is the row of the cell's list: row r has the elements
``refs[look_start[r]:look_start[r + 1]]``. Palette entry p has row p. A cell that a freestanding
element reaches (a display entity, banner cloth) has its own row. Elements are described in
``rendering.block_elements``, mip levels in ``rendering.atlas``, the light in
``rendering.light.light_field``.
"""

from typing import NamedTuple

import numpy as np

# Values of ``space`` for cells that are not air.
FULL, BOXES = -1, -2
# Bits of an element's flags.
ABSOLUTE = 1  # Coordinates are the grid's, not those of the listing cell.
SEE_THROUGH = 2  # Some face has holes or is translucent, or is not there.
UNSHADED = 4  # The same light on every side.
JOINS = 8  # Glass and its like: no face towards a neighbour of the same look.
EVEN = 16  # Corners are not darkened: its model has no ambient occlusion.
PANE = 32  # Glass: where its texture has holes one sees through, and yet there is a surface.
# Columns of ``traits``. An owner is the number of a display entity, -1 for the cell that an element
# was met in, or -2 - n for cell n of the volume, from which it reaches out.
TURN, FLAGS, OWNER = 0, 1, 2

NO_FACE = 255
# The face that is hit, by its outward normal: -x, +x, -y, +y, -z, +z.
FACE_NORMALS = np.array(
    [[-1, 0, 0], [1, 0, 0], [0, -1, 0], [0, 1, 0], [0, 0, -1], [0, 0, 1]], np.int8
)


class SceneTables(NamedTuple):
    """The arrays of X x Y x Z cells, V empty boxes, R rows, E elements, T rotations, L textures."""

    space: np.ndarray  # int32 [X, Y, Z]: FULL, BOXES, or the empty box that a cell of air is in
    bounds: np.ndarray  # int16 [V, 6]: first cell and past the last of each empty box
    looks: np.ndarray  # int32 [X, Y, Z]
    look_start: np.ndarray  # int32 [R + 1]
    refs: np.ndarray  # int32 [N]
    boxes: np.ndarray  # float32 [E, 6]: low and high, in the element's own frame
    traits: np.ndarray  # int32 [E, 3]: row of ``turns`` or -1; flags; owner
    turns: np.ndarray  # float64 [T, 3, 4]: cell (or grid) coordinates to the element's frame
    normals: np.ndarray  # float64 [T, 3, 3]: unit normals of the +x +y +z faces, in the grid
    layers: np.ndarray  # int32 [E, 6]: texture of each face, -1 for no face
    uv: np.ndarray  # float32 [E, 6, 2, 4]: element's frame to texture
    tints: np.ndarray  # float32 [E, 6, 3]: linear, times the texture's colour
    emission: np.ndarray  # float32 [E]: 0 to 1
    texels: np.ndarray  # uint8 [L, M, 4]: sRGB and alpha, mip levels one after another
    translucent: np.ndarray  # bool [L]
    light: np.ndarray  # uint16 [3, X + 2, Y + 2, Z + 2]
    window: np.ndarray  # int64 [2, 3]: the volume's first cell in this grid, and its shape
    semantic: np.ndarray  # uint8 [N]: class of each cell of the volume
    instance: np.ndarray  # uint16 [N]: object of each cell
    thing_semantic: np.ndarray  # uint8 [S]: class of each display entity
    thing_instance: np.ndarray  # uint16 [S]


def owner_of_cell(index: int) -> int:
    """Return the owner id, as in ``traits``, of an element that belongs to a cell."""
    return -2 - index
