"""The parts of a model: boxes, flat pictures and crossed ones, as the data files have them.

In: a part of a rule and the properties of a state. Out: ``Element`` values. Lengths are sixteenths
of a block. Keys of a part:

- ``when``: property values, ``a|b`` for either, a list of such for any of them.
- ``boxes``: x0 y0 z0 x1 y1 z1, flat where two are equal; or ``cross``: two upright pictures from
  corner to corner, [half width, bottom, top]; or ``hash``: four upright pictures, [bottom, top].
- ``skin``, ``skins``: as of a rule. ``uv``: "place" (where the face lies in the block), "fit" (the
  whole texture), or a table of faces to [u0, v0, u1, v1] or those words. ``spin``: a table of faces
  to 90, 180 or 270 degrees, clockwise.
- ``sides``: the boxes are for north, drawn for each side whose property has the value; ``faces``:
  for up and down too.
- ``tilt``: [axis, degrees, x, y, z], a turn about a point, or a list of such.
- ``glow``: it shines by itself.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from world2minecraft.rendering.block_elements import FACE_NAMES, Element, FaceLook, face_uv
from world2minecraft.rendering.block_models.face_pictures import is_painted
from world2minecraft.rendering.block_models.texture_recipes import Values, recipe_of
from world2minecraft.rendering.block_models.turning import QUARTERS, quarter, spun, turned

PLAIN = "plain self"
WHOLE = (0.0, 0.0, 16.0, 16.0)
_GROUPS = {
    "west": "side",
    "east": "side",
    "north": "side",
    "south": "side",
    "up": "end",
    "down": "end",
}


@dataclass(frozen=True, eq=False)
class Dress:
    """What the parts of a state are painted with: its name, its properties and known skins."""

    name: str
    values: Mapping[str, str]
    skin: str | Mapping[str, Any]
    skins: Mapping[str, Any]
    light: int


def elements_of(part: Mapping[str, Any], dress: Dress) -> Iterator[Element]:
    """Yield the elements of a part where the state draws it."""
    if not holds(part.get("when", {}), dress.values):
        return
    drawn = [_tilted(one, part.get("tilt", ())) for one in _shapes(part, dress)]
    if "sides" not in part and "faces" not in part:
        yield from drawn
        return
    wanted = part.get("sides", part.get("faces"))
    for side in (*QUARTERS, "up", "down") if "faces" in part else QUARTERS:
        if holds({side: wanted}, dress.values):
            yield from (turned(one, _to_side(side)) for one in drawn)


def box_element(
    low: Sequence[float],
    high: Sequence[float],
    part: Mapping[str, Any],
    dress: Dress,
    shade: bool = True,
) -> Element:
    """Return a box, sixteenths, dressed as its part says."""
    corner = float(low[0]) / 16, float(low[1]) / 16, float(low[2]) / 16
    other = float(high[0]) / 16, float(high[1]) / 16, float(high[2]) / 16
    faces = tuple(_face(side, corner, other, part, dress) for side in range(6))
    glow = dress.light if part.get("glow") else 0
    return Element(corner, other, faces, shade=shade, emission=glow)


def holds(when: Any, values: Mapping[str, str]) -> bool:
    """Tell whether a state has the wanted values."""
    cases = when if isinstance(when, list) else [when]
    return any(
        all(values.get(key, "") in wanted.split("|") for key, wanted in case.items())
        for case in cases
    )


def _to_side(side: str) -> np.ndarray:
    """Return the turn that carries a part at the north side to another side."""
    if side in QUARTERS:
        return quarter(side)
    return spun(90.0 if side == "up" else -90.0, "x")


def _shapes(part: Mapping[str, Any], dress: Dress) -> Iterator[Element]:
    for box in part.get("boxes", ()):
        yield box_element(box[:3], box[3:], part, dress)
    if "cross" in part:
        half, bottom, top = part["cross"]
        upright = {"uv": "fit", **part}
        for angle_deg in (45.0, -45.0):
            flat = box_element((8 - half, bottom, 8), (8 + half, top, 8), upright, dress, False)
            yield turned(flat, spun(angle_deg))
    if "hash" in part:
        bottom, top = part["hash"]
        upright = {"uv": "fit", **part}
        for at in (4.0, 12.0):
            flat = box_element((0, bottom, at), (16, top, at), upright, dress, False)
            yield flat
            yield turned(flat, spun(90.0))


def _tilted(element: Element, tilts: Sequence[Any]) -> Element:
    for axis, angle_deg, *origin in [tilts] if tilts and isinstance(tilts[0], str) else tilts:
        middle = [float(part) / 16 for part in origin or (8, 8, 8)]
        element = turned(element, spun(float(angle_deg), axis, middle))
    return element


def _face(side: int, low, high, part: Mapping[str, Any], dress: Dress) -> FaceLook | None:
    across = side // 2
    if any(low[axis] == high[axis] for axis in range(3) if axis != across):
        return None  # The edge of something flat.
    name = FACE_NAMES[side]
    words = part.get("skin", dress.skin)
    for _ in range(2):  # A table of faces may name a skin that is a table of faces itself.
        words = _of_face(_known(words, part, dress), name)
    words = _known(words, part, dress)
    if words is None:
        return None
    if not is_painted(words := words.format_map(Values(dress.values))):
        words = PLAIN  # A property of a mod's block has a value that the rule does not foresee.
    place = _of_face(part.get("uv", "place"), name) or "place"
    rect = None if place == "place" else WHOLE if place == "fit" else tuple(place)
    matrix = _matrix(side, low, high, rect, part.get("spin", {}).get(name, 0))
    return FaceLook(_recipe(words, dress.name), matrix)


@lru_cache(maxsize=1 << 14)
def _matrix(side: int, low, high, rect, rotation_deg: int) -> np.ndarray:
    """Return ``face_uv``, read-only: many states share a box."""
    matrix = face_uv(side, low, high, rect, rotation_deg)
    matrix.flags.writeable = False
    return matrix


@lru_cache(maxsize=1 << 14)
def _recipe(words: str, name: str) -> str:
    return recipe_of(words, name, {})


def _known(skin: Any, part: Mapping[str, Any], dress: Dress) -> Any:
    """Return what a skin's name stands for."""
    for _ in range(4):
        if not isinstance(skin, str):
            break
        skin = skin.format_map(Values(dress.values))
        if skin in part.get("skins", {}):
            skin = part["skins"][skin]
        elif skin in dress.skins:
            skin = dress.skins[skin]
        elif skin == "own":
            skin = dress.skin
        else:
            break
    return skin


def _of_face(table: Any, name: str) -> Any:
    """Return what a table says of a face: by its name, by its group, or for all."""
    if not isinstance(table, Mapping):
        return table
    for key in (name, _GROUPS[name], "all"):
        if key in table:
            return table[key]
    return None
