"""Block models as lists of elements: boxes with a texture on each face.

Built-in models, resource pack models and display entities are all converted to ``Element`` objects,
the only form that the kernels read. Coordinates are relative to the block: x east, y up, z south,
with the block spanning [0, 1]. An element may extend beyond its block.

Texture coordinates (u, v) are (0, 0) at the upper left, with u to the right and v down. One texture
spans [0, 1]. ``uv`` maps a point (x, y, z, 1) in the element's own frame to (u, v), so that any
rotation, lock or mirror of a model file is a single matrix.
"""

from dataclasses import dataclass, field
from functools import lru_cache
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
    """A face of an element: texture name, texture coordinates and a colour multiplier.

    ``uv`` float64 [2, 4] is explained in the module docstring. ``tint`` is sRGB, 0 to 255.
    """

    texture: str
    uv: np.ndarray
    tint: tuple[int, int, int] | None = None


@dataclass(frozen=True, eq=False)
class Element:
    """A box from ``low`` to ``high`` (in blocks) with six faces, of which missing faces are None.

    ``turn`` float64 [4, 4] transforms the element's own frame to that of the block; None is the
    identity. A box may be flat along one axis; its two faces there are then each visible from one
    side. ``emission`` is the minimum light level at which the element is rendered, 0 to 15.
    """

    low: tuple[float, float, float]
    high: tuple[float, float, float]
    faces: tuple[ElementFace | None, ...]
    turn: np.ndarray | None = None
    shade: bool = True
    emission: int = 0


@dataclass(frozen=True, eq=False)
class BlockModel:
    """All elements of a block state. ``stand_in`` is True if the real appearance is unknown."""

    elements: tuple[Element, ...] = ()
    ambient_occlusion: bool = True
    stand_in: bool = False


class ModelSource(Protocol):
    """A source of block models and textures, such as the built-in set or a resource pack."""

    def model(self, state: str) -> BlockModel | None:
        """Return the model of a block state given as text, or None if the source has no model."""
        ...

    def texture(self, name: str) -> Texture | None:
        """Return a texture used by one of this source's models, or None."""
        ...


def face_uv(
    side: int,
    low: tuple[float, float, float],
    high: tuple[float, float, float],
    rect: tuple[float, float, float, float] | None = None,
    rotation_deg: int = 0,
) -> np.ndarray:
    """Return the uv matrix of a box face, float64 [2, 4].

    Args:
        side: Side of the box, 0 to 5, in the order of ``FACE_NAMES``.
        low: Minimum corner of the box, in blocks.
        high: Maximum corner of the box, in blocks.
        rect: u0, v0, u1, v1 in sixteenths, as in model files. None uses the position in the block,
            so that textures of neighbouring blocks join.
        rotation_deg: 0, 90, 180 or 270, clockwise, as in model files.

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


@lru_cache(maxsize=1 << 14)
def cached_face_uv(
    side: int,
    low: tuple[float, float, float],
    high: tuple[float, float, float],
    rect: tuple[float, float, float, float] | None,
    rotation_deg: int,
) -> np.ndarray:
    """Return ``face_uv``, read-only and cached: thousands of blocks share few boxes."""
    uv = face_uv(side, low, high, rect, rotation_deg)
    uv.flags.writeable = False
    return uv


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
    """A stack of model sources, of which the first with a result is used."""

    sources: tuple[ModelSource, ...] = field(default=())

    def model(self, state: str) -> BlockModel | None:
        """Return the model from the first source that has it."""
        return next(
            (model for one in self.sources if (model := one.model(state)) is not None), None
        )

    def texture(self, name: str) -> Texture | None:
        """Return the texture from the first source that has it."""
        return next(
            (texture for one in self.sources if (texture := one.texture(name)) is not None), None
        )
