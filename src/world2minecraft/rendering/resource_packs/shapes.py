"""One element of a model's file becomes an ``Element``: a box, its faces, its own rotation."""

from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Any

import numpy as np

from world2minecraft.rendering.block_elements import FACE_NAMES, Element, FaceLook, face_uv
from world2minecraft.rendering.resource_packs.json_checks import (
    mapping,
    number,
    numbers,
    quarter,
    shown,
    text,
)
from world2minecraft.rendering.resource_packs.tints import Tint
from world2minecraft.rendering.resource_packs.turning import carry, free_turn, is_quarter

LOWEST, HIGHEST = -16.0, 32.0  # Sixteenths of a block; the game refuses others.


def element_of(
    raw: Mapping[str, Any], texture_of: Callable[[str], str], tint_of: Callable[[int], Tint]
) -> Element:
    """Return an element of a model's file as it stands before the block is turned.

    Args:
        raw: the object of the file.
        texture_of: what a face names to the texture's name.
        tint_of: a tint index to the colour that the texture is times.

    Raises:
        ValueError: it is not as the format says.
    """
    start = np.array(numbers(raw.get("from"), "from", 3, LOWEST, HIGHEST)) / 16
    end = np.array(numbers(raw.get("to"), "to", 3, LOWEST, HIGHEST)) / 16
    low, high = tuple(np.minimum(start, end).tolist()), tuple(np.maximum(start, end).tolist())
    faces = mapping(raw.get("faces", {}), "faces")
    element = Element(
        low,
        high,
        tuple(
            _face(side, faces[name], (low, high), texture_of, tint_of) if name in faces else None
            for side, name in enumerate(FACE_NAMES)
        ),
        shade=raw.get("shade", True) is not False,
        emission=int(number(raw.get("light_emission", 0), "light_emission", 0, 15)),
    )
    turn = _rotation(raw.get("rotation"))
    if turn is None:
        return element
    if is_quarter(turn):
        return carry(element, turn)
    return Element(low, high, element.faces, turn, element.shade, element.emission)


def _face(side: int, raw: Any, box, texture_of, tint_of) -> FaceLook:
    face = mapping(raw, f"face {FACE_NAMES[side]}")
    rect = None
    if face.get("uv") is not None:
        u0, v0, u1, v1 = numbers(face["uv"], "uv", 4, -1024, 1024)
        rect = (u0, v0, u1, v1)
    rotation = quarter(face.get("rotation", 0), "rotation of a face")
    index = int(number(face.get("tintindex", -1), "tintindex"))
    return FaceLook(
        texture_of(text(face.get("texture"), "texture of a face")),
        _uv(side, box[0], box[1], rect, rotation),
        tint_of(index) if index >= 0 else None,
    )


@lru_cache(maxsize=1 << 14)
def _uv(side: int, low, high, rect, rotation: int) -> np.ndarray:
    """Return ``face_uv``; few boxes are those of thousands of blocks."""
    uv = face_uv(side, low, high, rect, rotation)
    uv.flags.writeable = False
    return uv


def _rotation(raw: Any) -> np.ndarray | None:
    """Return float64 [4, 4] of an element's rotation, None for none.

    It is one axis with its angle, or in newer files an angle for each of x, y and z.
    """
    if raw is None:
        return None
    rotation = mapping(raw, "rotation")
    axis = rotation.get("axis")
    if axis is not None:
        if axis not in ("x", "y", "z"):
            raise ValueError(f"axis of a rotation must be x, y or z, not {shown(axis)}")
        angle = number(rotation.get("angle", 0), "angle", -3600, 3600)
        angles = tuple(angle if name == axis else 0.0 for name in "xyz")
    else:
        angles = tuple(number(rotation.get(name, 0), name, -3600, 3600) for name in "xyz")
    if not any(angles):
        return None
    x_deg, y_deg, z_deg = angles
    origin = np.array(numbers(rotation.get("origin", [8, 8, 8]), "origin", 3)) / 16
    return free_turn((x_deg, y_deg, z_deg), origin, rotation.get("rescale", False) is True)
