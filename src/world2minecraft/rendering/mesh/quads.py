"""Conversion of element faces to quads, and detection of faces that neighbours hide.

Corners are counter-clockwise seen from outside. Quads are planar, so texture coordinates and light
are stored at the four corners.
"""

from typing import NamedTuple

import numpy as np

from world2minecraft.rendering.block_elements import Element
from world2minecraft.rendering.light.light_settings import NEUTRAL_SHADE
from world2minecraft.rendering.scene_baking import ElementTable
from world2minecraft.rendering.scene_tables import FACE_NORMALS, FLAGS, FULL, PANE, UNSHADED

# For each face of a box, which ends of x, y and z its four corners take.
CORNERS = np.array(
    [
        [[0, 0, 0], [0, 0, 1], [0, 1, 1], [0, 1, 0]],
        [[1, 0, 0], [1, 1, 0], [1, 1, 1], [1, 0, 1]],
        [[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]],
        [[0, 1, 0], [0, 1, 1], [1, 1, 1], [1, 1, 0]],
        [[0, 0, 0], [0, 1, 0], [1, 1, 0], [1, 0, 0]],
        [[0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]],
    ]
)
_RIM = 1e-4  # Blocks: a face so near its block's side lies on it.
INSIDE = -1  # The side of a quad that lies on none.


class Quads(NamedTuple):
    """Q quads, in coordinates of their block, or of the grid for freestanding elements."""

    corners: np.ndarray  # float64 [Q, 4, 3]
    uv: np.ndarray  # float32 [Q, 4, 2]
    layer: np.ndarray  # int32 [Q], the texture
    tint: np.ndarray  # float32 [Q, 3], linear
    side: np.ndarray  # int8 [Q], the side of the block that it lies on, or INSIDE
    facing: np.ndarray  # int8 [Q], the side that it looks most like
    shade: np.ndarray  # float32 [Q], of its direction, screen value
    emission: np.ndarray  # float32 [Q], 0 to 1
    clear: np.ndarray  # bool [Q], drawn over what is behind it

    def select(self, rows: np.ndarray) -> "Quads":
        """Return a subset of the quads, given by a mask bool [Q] or indices int [N]."""
        return Quads(*(values[rows] for values in self))


def quads_of(number: int, element: Element, table: ElementTable) -> Quads:
    """Return the quads of one element, one for each existing face."""
    sides = np.flatnonzero(table.layers[number] >= 0)
    ends = np.array([element.low, element.high], np.float64)
    own = ends[CORNERS[sides], np.arange(3)]
    whole = np.concatenate([own, np.ones((*own.shape[:2], 1))], axis=2)
    uv = np.einsum("fij,fcj->fci", table.uv[number, sides].astype(np.float64), whole)
    normals = FACE_NORMALS[sides].astype(np.float64)
    corners = own
    if element.turn is not None:
        corners = whole @ element.turn[:3].T
        normals = normals @ np.linalg.inv(element.turn[:3, :3])
        normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
        if np.linalg.det(element.turn[:3, :3]) < 0:  # A mirror: the other way round.
            corners, uv = corners[:, ::-1], uv[:, ::-1]
    flags, layers = table.traits[number, FLAGS], table.layers[number, sides]
    facing = np.argmax(normals @ FACE_NORMALS.T, axis=1).astype(np.int8)
    shade = np.ones(len(sides)) if flags & UNSHADED else _shade(normals)
    return Quads(
        corners=corners,
        uv=uv.astype(np.float32),
        layer=layers,
        tint=table.tints[number, sides],
        side=_side(corners, facing),
        facing=facing,
        shade=shade.astype(np.float32),
        emission=np.full(len(sides), table.emission[number], np.float32),
        clear=table.atlas.translucent[layers] | bool(flags & PANE),
    )


def concatenate_quads(parts: list[Quads]) -> Quads:
    """Return the concatenation of several quad lists."""
    if not parts:
        return Quads(
            np.zeros((0, 4, 3)), np.zeros((0, 4, 2), np.float32), np.zeros(0, np.int32),
            np.zeros((0, 3), np.float32), np.zeros(0, np.int8), np.zeros(0, np.int8),
            np.zeros(0, np.float32), np.zeros(0, np.float32), np.zeros(0, bool),
        )  # fmt: skip
    return Quads(*(np.concatenate(values) for values in zip(*parts, strict=True)))


def hidden_sides(
    states: np.ndarray, kinds: np.ndarray, joins: np.ndarray, groups: np.ndarray
) -> np.ndarray:
    """Return the invisible sides of each block as bool [6, X, Y, Z].

    A side is hidden by an adjacent full opaque block, or by an adjacent block of the same state if
    such blocks join, as glass does. Only blocks of the same group hide each other, because a group
    can be hidden as a whole.

    Args:
        states: Palette indices, uint16 [X, Y, Z].
        kinds: The result of ``scene_baking.kind_of`` for each state, int8 [P].
        joins: Whether each state joins with blocks of the same state, bool [P].
        groups: Group of each block, int [X, Y, Z].
    """
    full = (kinds == FULL)[states]
    joining = joins[states]
    result = np.zeros((6, *states.shape), bool)
    for axis in range(3):
        first = tuple(slice(None, -1) if at == axis else slice(None) for at in range(3))
        second = tuple(slice(1, None) if at == axis else slice(None) for at in range(3))
        same = groups[first] == groups[second]
        alike = joining[first] & (states[first] == states[second])
        result[(2 * axis + 1, *first)] = same & (full[second] | alike)
        result[(2 * axis, *second)] = same & (full[first] | alike)
    return result


def _shade(normals: np.ndarray) -> np.ndarray:
    """Return the calm shade of directions, float64 [N] of unit normals [N, 3]."""
    x, up, down, z = NEUTRAL_SHADE
    upright = np.where(normals[:, 1] > 0, up, down)
    squares = normals**2
    return squares[:, 0] * x + squares[:, 1] * upright + squares[:, 2] * z


def _side(corners: np.ndarray, facing: np.ndarray) -> np.ndarray:
    """Return the side of its block that each quad lies on, or INSIDE."""
    axis = facing // 2
    along = np.take_along_axis(corners, axis[:, None, None].repeat(4, 1), 2)[..., 0]
    level = (facing % 2).astype(np.float64)[:, None]
    return np.where((np.abs(along - level) < _RIM).all(axis=1), facing, INSIDE).astype(np.int8)
