"""Block models: elements, boxes with a texture on each face, the same for every source.

Built-in models, those of a resource pack and display entities all become ``Element`` values; the
kernels read nothing else. Coordinates are those of the block: x east, y up, z south, the block
spans [0, 1]; an element may reach beyond it.

A texture has its (u, v) = (0, 0) at its upper left, u to the right and v down, one texture is
[0, 1] wide. ``uv`` carries a point (x, y, z, 1) of the element's own frame to (u, v), so that any
rotation, lock or mirror of a model file is one matrix.
"""

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from world2minecraft.rendering.texture import Texture

# The order of an element's faces; also the names that model files use.
FACE_NAMES = ("west", "east", "down", "up", "north", "south")  # -x +x -y +y -z +z
# For each face: the directions, in block axes, in which u and v grow when nothing is rotated.
FACE_AXES = (
    ((0, 0, 1), (0, -1, 0)),  # west: u to the south
    ((0, 0, -1), (0, -1, 0)),  # east: u to the north
    ((1, 0, 0), (0, 0, -1)),  # down: u to the east, v to the north
    ((1, 0, 0), (0, 0, 1)),  # up: u to the east, v to the south
    ((-1, 0, 0), (0, -1, 0)),  # north: u to the west
    ((1, 0, 0), (0, -1, 0)),  # south: u to the east
)


@dataclass(frozen=True, eq=False)
class ElementFace:
    """One face: a texture's name, where it lies, and the colour that multiplies it.

    ``uv`` float64 [2, 4] is explained above; ``tint`` is sRGB, 0 to 255.
    """

    texture: str
    uv: np.ndarray
    tint: tuple[int, int, int] | None = None


@dataclass(frozen=True, eq=False)
class Element:
    """A box from ``low`` to ``high`` (blocks) with six faces; a face that is None is not there.

    ``turn`` float64 [4, 4] carries the element's own frame to the block's, None for none. A box
    may be flat along one axis: then its two faces there are drawn, one from each side.
    ``emission`` is 0 to 15, the light that it is seen by at least.
    """

    low: tuple[float, float, float]
    high: tuple[float, float, float]
    faces: tuple[ElementFace | None, ...]
    turn: np.ndarray | None = None
    shade: bool = True
    emission: int = 0


@dataclass(frozen=True, eq=False)
class BlockModel:
    """All elements of a block state. ``stand_in`` says that its true look is not known."""

    elements: tuple[Element, ...] = ()
    ambient_occlusion: bool = True
    stand_in: bool = False


class ModelSource(Protocol):
    """A source of block models and textures: built-in ones, a resource pack, or a stack."""

    def model(self, state: str) -> BlockModel | None:
        """Return the model of a block state's text, or None where this source has none."""
        ...

    def texture(self, name: str) -> Texture | None:
        """Return the texture of a name that one of this source's models uses, or None."""
        ...


def face_uv(
    side: int,
    low: tuple[float, float, float],
    high: tuple[float, float, float],
    rect: tuple[float, float, float, float] | None = None,
    rotation_deg: int = 0,
) -> np.ndarray:
    """Return the uv matrix, float64 [2, 4], of a face of a box.

    Args:
        side: 0 to 5, the order of ``FACE_NAMES``.
        low: the box, blocks.
        high: its other corner.
        rect: u0 v0 u1 v1 in sixteenths, as model files say; None for where the face lies in the
            block, so that textures of neighbours join.
        rotation_deg: 0, 90, 180 or 270, clockwise, as model files say.

    Example:
        >>> face_uv(3, (0, 0, 0), (1, 1, 1)).round(3).tolist()
        [[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]
    """
    rows = np.zeros((2, 4))
    for row, axis in zip(rows, FACE_AXES[side], strict=True):  # s, t: 0 to 1 across the face.
        at = int(np.flatnonzero(axis)[0])
        size = high[at] - low[at] or 1.0
        row[at] = axis[at] / size
        row[3] = (-low[at] if axis[at] > 0 else high[at]) / size
    u0, v0, u1, v1 = (np.array(rect) / 16) if rect is not None else _rect_in_block(side, low, high)
    one = np.array([0.0, 0.0, 0.0, 1.0])
    for _ in range(rotation_deg // 90 % 4):  # Clockwise: what was left is now up.
        rows = np.stack([rows[1], one - rows[0]])
    return np.stack([u0 * one + (u1 - u0) * rows[0], v0 * one + (v1 - v0) * rows[1]])


def _rect_in_block(side: int, low, high) -> tuple[float, float, float, float]:
    """Return u0 v0 u1 v1 of a face by its place in the block."""
    spans = []
    for axis in FACE_AXES[side]:
        at = int(np.flatnonzero(axis)[0])
        span = (low[at], high[at]) if axis[at] > 0 else (1 - high[at], 1 - low[at])
        spans.append(span)
    (u0, u1), (v0, v1) = spans
    return u0, v0, u1, v1


@dataclass(frozen=True, eq=False)
class ModelSourceStack:
    """Several sources of models; the first that has one counts."""

    sources: tuple[ModelSource, ...] = field(default=())

    def model(self, state: str) -> BlockModel | None:
        """Return the first source's model that is there."""
        return next(
            (model for one in self.sources if (model := one.model(state)) is not None), None
        )

    def texture(self, name: str) -> Texture | None:
        """Return the first source's texture that is there."""
        return next(
            (texture for one in self.sources if (texture := one.texture(name)) is not None), None
        )
