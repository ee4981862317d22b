"""Support shapes of blocks: which faces can support an attached block, as the game decides.

A face is the part of the block's support shape at one side of its cube. It is *full* if it covers
the whole square, *rigid* if it covers the outer two sixteenths all around, and has a *centre* if it
covers the middle two sixteenths. The support shape equals the collision shape, except for a few
blocks that are listed in ``data/block_rules.json``.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from world2minecraft.minecraft.block_states import BlockState, complete, parse_state
from world2minecraft.minecraft.collision_shapes import FULL_CUBE, boxes_of, is_full_cube
from world2minecraft.minecraft.rules.block_traits import is_among

# Directions by number: north (-z), east (+x), south (+z), west (-x), up, down.
NORTH, EAST, SOUTH, WEST, UP, DOWN = range(6)
DIRECTIONS = ("north", "east", "south", "west", "up", "down")
STEPS = ((0, 0, -1), (1, 0, 0), (0, 0, 1), (-1, 0, 0), (0, 1, 0), (0, -1, 0))
OPPOSITE = (SOUTH, WEST, NORTH, EAST, DOWN, UP)
STEPS_A_SIDE = 32  # Sixteenths would do but for a few thin shapes.
_AXES = (2, 0, 2, 0, 1, 1)
_MIDDLE = slice(14, 18)
_LAYERS = tuple("12345678")  # Of snow.
_MEAN_SIDE = 35 / 48  # Of a shape's box: from here on it counts as solid.


class Faces(NamedTuple):
    """The kinds of support that the six faces of a block state offer, as tuples by direction."""

    full: tuple[bool, ...]
    rigid: tuple[bool, ...]
    centre: tuple[bool, ...]
    down_arms: tuple[bool, ...]  # Lower face: middle to each of the four sides, then the middle.


_ALL, _NONE = (True,) * 6, (False,) * 6
_WHOLE = Faces(_ALL, _ALL, _ALL, _ALL[:5])
_EMPTY = Faces(_NONE, _NONE, _NONE, _NONE[:5])


@lru_cache(maxsize=1 << 16)
def faces_of(state: str) -> Faces:
    """Return the kinds of support that the faces of a block state offer.

    Raises:
        UsageError: If the text is not a valid block state.

    Example:
        >>> faces_of("minecraft:oak_slab[type=top]").full[UP]
        True
    """
    boxes = support_boxes_of(state)
    if not len(boxes):
        return _EMPTY if not is_full_cube(state) else _EMPTY._replace(down_arms=_WHOLE.down_arms)
    if boxes is FULL_CUBE or np.array_equal(boxes, FULL_CUBE):
        return _WHOLE
    squares = [_face(boxes, direction) for direction in range(6)]
    lower = _face(boxes_of(state), DOWN)  # Walls ask for the collision shape.
    arms = ((_MIDDLE, slice(0, 18)), (slice(14, 32), _MIDDLE),
            (_MIDDLE, slice(14, 32)), (slice(0, 18), _MIDDLE), (_MIDDLE, _MIDDLE))  # fmt: skip
    return Faces(
        full=tuple(bool(square.all()) for square in squares),
        rigid=tuple(_is_rigid(square) for square in squares),
        centre=tuple(bool(square[_MIDDLE, _MIDDLE].all()) for square in squares),
        down_arms=tuple(bool(lower[arm].all()) for arm in arms),
    )


def support_boxes_of(state: str) -> np.ndarray:
    """Return the boxes of a block state's support shape as float32 [N, 6] in block units."""
    parsed = complete(parse_state(state))
    if is_among(parsed.name, "no_support"):
        return FULL_CUBE[:0]
    if is_among(parsed.name, "whole_support"):
        return FULL_CUBE
    if parsed.name == "minecraft:snow":
        layers = parsed.get("layers")
        height = int(layers) / 8 if layers in _LAYERS else 1 / 8
        return np.array([[0, 0, 0, 1, height, 1]], np.float32)
    return boxes_of(state)


@lru_cache(maxsize=1 << 16)
def is_solid(state: str) -> bool:
    """Return whether a block state is large enough to support a sign or a banner."""
    parsed = parse_state(state)
    if is_among(parsed.name, "solid"):
        return True
    boxes = boxes_of(state)
    if is_among(parsed.name, "not_solid") or not len(boxes):
        return False
    sides = boxes[:, 3:].max(axis=0) - boxes[:, :3].min(axis=0)
    return bool(sides.mean() >= _MEAN_SIDE - 1e-6 or sides[1] >= 1)


def has_centre_below(state: BlockState) -> bool:
    """Return whether a block can hang from the middle of a block state's lower face."""
    if is_among(state.name, "no_centre_below"):
        return False
    return faces_of(str(state)).centre[DOWN]


def _face(boxes: np.ndarray, direction: int) -> np.ndarray:
    """Return the covered area of a face as bool [32, 32]: x then z, or x or z, then y."""
    axis = _AXES[direction]
    at = 1 - 1e-6 if direction in (EAST, SOUTH, UP) else 1e-6
    touching = boxes[(boxes[:, axis] < at) & (boxes[:, axis + 3] > at)]
    square = np.zeros((STEPS_A_SIDE, STEPS_A_SIDE), bool)
    across = (0, 2) if axis == 1 else (2 - axis, 1)
    low = np.ceil(np.clip(touching[:, across], 0, 1) * STEPS_A_SIDE - 1e-3).astype(int)
    ends = [axis + 3 for axis in across]
    high = np.floor(np.clip(touching[:, ends], 0, 1) * STEPS_A_SIDE + 1e-3).astype(int)
    for (u0, v0), (u1, v1) in zip(low.tolist(), high.tolist(), strict=True):
        square[u0:u1, v0:v1] = True
    return square


def _is_rigid(square: np.ndarray) -> bool:
    ring = square.copy()
    ring[4:28, 4:28] = True
    return bool(ring.all())
