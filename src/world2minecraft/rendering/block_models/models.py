"""Construction of block models: the matching rule, its parts, and their rotation by the state.

A model is written once, facing north or up, and rotated according to the state. Matrices are
float64 [4, 4] and transform points of the block about its centre. Lengths in the data files are
sixteenths of a block. Keys of a part:

- ``when``: Property values, ``a|b`` for alternatives, or a list of which any may match.
- ``boxes``: x0 y0 z0 x1 y1 z1, flat if two are equal. Or ``cross``: two upright faces from corner
  to corner, [half width, bottom, top]. Or ``hash``: four upright faces, [bottom, top].
- ``skin``, ``skins``: As in a rule.
- ``uv``: "place" (position of the face in the block), "fit" (the whole texture), or a table of
  faces to [u0, v0, u1, v1] or those words.
- ``spin``: A table of faces to 90, 180 or 270 degrees, clockwise.
- ``sides``: The boxes are for north and repeated for each side whose property has the value.
  ``faces``: Also for up and down.
- ``tilt``: [axis, degrees, x, y, z], a rotation about a point, or a list of such rotations.
- ``glow``: The part is luminous.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np

from world2minecraft.minecraft.block_states import BlockState, complete, parse_state
from world2minecraft.minecraft.block_table import block_table
from world2minecraft.minecraft.rules.light import BRIGHTEST, emitted_light
from world2minecraft.minecraft.visual_shapes import is_luminous, visual_boxes
from world2minecraft.rendering.block_elements import (
    FACE_NAMES,
    BlockModel,
    Element,
    ElementFace,
    cached_face_uv,
)
from world2minecraft.rendering.block_models.face_pictures import has_texture
from world2minecraft.rendering.block_models.rules import ModelRule, rule_for
from world2minecraft.rendering.block_models.texture_recipes import Values, recipe_of, values_of

# Clockwise from above, from the side that models are written for.
QUARTERS = ("north", "east", "south", "west")
MIDDLE = (0.5, 0.5, 0.5)
_NORMALS = np.array([[-1, 0, 0], [1, 0, 0], [0, -1, 0], [0, 1, 0], [0, 0, -1], [0, 0, 1]])
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


def rotation_about(
    angle_deg: float, axis: str = "y", origin: Sequence[float] = MIDDLE
) -> np.ndarray:
    """Return a rotation about an axis. Rotations about y are clockwise as seen from above.

    Args:
        angle_deg: Angle in degrees. Multiples of 90 give exact matrices.
        axis: "x", "y" or "z".
        origin: A point on the axis, in blocks.
    """
    cosine, sine = np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))
    if angle_deg % 90 == 0:
        cosine, sine = float(round(cosine)), float(round(sine))
    first, second = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
    matrix = np.eye(4)
    turn = -sine if axis == "y" else sine
    matrix[first, first] = matrix[second, second] = cosine
    matrix[first, second], matrix[second, first] = -turn, turn
    return about_point(matrix, origin)


def about_point(matrix: np.ndarray, origin: Sequence[float]) -> np.ndarray:
    """Return a matrix translated so that it leaves ``origin`` in place."""
    moved = matrix.copy()
    middle = np.asarray(origin, np.float64)
    moved[:3, 3] = middle - matrix[:3, :3] @ middle
    return moved


def rotation_from_north(facing: str) -> np.ndarray:
    """Return the rotation from north to a side, or the identity if it is not a side."""
    return rotation_about(90.0 * QUARTERS.index(facing)) if facing in QUARTERS else np.eye(4)


def rotation_from_up(facing: str) -> np.ndarray:
    """Return the rotation from up to one of the six sides."""
    if facing == "down":
        return rotation_about(180.0, "x")
    if facing in QUARTERS:
        return rotation_from_north(facing) @ rotation_about(-90.0, "x")
    return np.eye(4)


def rotation_from_y(axis: str) -> np.ndarray:
    """Return the rotation from the y axis to another axis."""
    return {"x": rotation_from_up("east"), "z": rotation_from_up("north")}.get(axis, np.eye(4))


def rotation_of_sixteenths(rotation: str, front: str = "south") -> np.ndarray:
    """Return the rotation of a sign, banner or head, clockwise in sixteenths from ``front``."""
    step = int(rotation) % 16 if rotation.isdecimal() and len(rotation) < 4 else 0
    return rotation_about(90.0 * QUARTERS.index(front) + 22.5 * step)


def rotate_element(element: Element, matrix: np.ndarray) -> Element:
    """Return a rotated element. Quarter turns keep aligned boxes aligned."""
    rotation = matrix[:3, :3]
    if element.turn is not None or not np.isin(rotation, (-1.0, 0.0, 1.0)).all():
        before = np.eye(4) if element.turn is None else element.turn
        return replace(element, turn=matrix @ before)
    corners = np.array([element.low, element.high]) @ rotation.T + matrix[:3, 3]
    back = np.eye(4)
    back[:3, :3], back[:3, 3] = rotation.T, -rotation.T @ matrix[:3, 3]
    faces: list[ElementFace | None] = [None] * 6
    for side, face in enumerate(element.faces):
        normal = rotation @ _NORMALS[side]
        if face is not None:
            to = int(np.flatnonzero((normal == _NORMALS).all(axis=1))[0])
            faces[to] = replace(face, uv=face.uv @ back)
    low, high = corners.min(0), corners.max(0)
    return replace(
        element,
        low=(float(low[0]), float(low[1]), float(low[2])),
        high=(float(high[0]), float(high[1]), float(high[2])),
        faces=tuple(faces),
    )


@dataclass(frozen=True, eq=False)
class PartContext:
    """The context for the parts of a state: its name, its properties and the known skins."""

    name: str
    values: Mapping[str, str]
    skin: str | Mapping[str, Any]
    skins: Mapping[str, Any]
    light: int


def elements_of(part: Mapping[str, Any], dress: PartContext) -> Iterator[Element]:
    """Yield the elements of a part if the state shows it."""
    if not matches(part.get("when", {}), dress.values):
        return
    drawn = [_tilt(one, part.get("tilt", ())) for one in _shapes(part, dress)]
    if "sides" not in part and "faces" not in part:
        yield from drawn
        return
    wanted = part.get("sides", part.get("faces"))
    for side in (*QUARTERS, "up", "down") if "faces" in part else QUARTERS:
        if matches({side: wanted}, dress.values):
            yield from (rotate_element(one, _to_side(side)) for one in drawn)


def box_element(
    low: Sequence[float],
    high: Sequence[float],
    part: Mapping[str, Any],
    dress: PartContext,
    shade: bool = True,
) -> Element:
    """Return the element of a box in sixteenths, with the textures of its part."""
    corner = float(low[0]) / 16, float(low[1]) / 16, float(low[2]) / 16
    other = float(high[0]) / 16, float(high[1]) / 16, float(high[2]) / 16
    faces = tuple(_face(side, corner, other, part, dress) for side in range(6))
    glow = dress.light if part.get("glow") else 0
    return Element(corner, other, faces, shade=shade, emission=glow)


def matches(when: Any, values: Mapping[str, str]) -> bool:
    """Return whether a state has the required property values."""
    cases = when if isinstance(when, list) else [when]
    return any(
        all(values.get(key, "") in wanted.split("|") for key, wanted in case.items())
        for case in cases
    )


def _to_side(side: str) -> np.ndarray:
    """Return the turn that carries a part at the north side to another side."""
    if side in QUARTERS:
        return rotation_from_north(side)
    return rotation_about(90.0 if side == "up" else -90.0, "x")


def _shapes(part: Mapping[str, Any], dress: PartContext) -> Iterator[Element]:
    for box in part.get("boxes", ()):
        yield box_element(box[:3], box[3:], part, dress)
    if "cross" in part:
        half, bottom, top = part["cross"]
        upright = {"uv": "fit", **part}
        for angle_deg in (45.0, -45.0):
            flat = box_element((8 - half, bottom, 8), (8 + half, top, 8), upright, dress, False)
            yield rotate_element(flat, rotation_about(angle_deg))
    if "hash" in part:
        bottom, top = part["hash"]
        upright = {"uv": "fit", **part}
        for at in (4.0, 12.0):
            flat = box_element((0, bottom, at), (16, top, at), upright, dress, False)
            yield flat
            yield rotate_element(flat, rotation_about(90.0))


def _tilt(element: Element, tilts: Sequence[Any]) -> Element:
    for axis, angle_deg, *origin in [tilts] if tilts and isinstance(tilts[0], str) else tilts:
        middle = [float(part) / 16 for part in origin or (8, 8, 8)]
        element = rotate_element(element, rotation_about(float(angle_deg), axis, middle))
    return element


def _face(side: int, low, high, part: Mapping[str, Any], dress: PartContext) -> ElementFace | None:
    across = side // 2
    if any(low[axis] == high[axis] for axis in range(3) if axis != across):
        return None  # The edge of something flat.
    name = FACE_NAMES[side]
    words = part.get("skin", dress.skin)
    for _ in range(2):  # A table of faces may name a skin that is a table of faces itself.
        words = _value_for_face(_resolve_skin(words, part, dress), name)
    words = _resolve_skin(words, part, dress)
    if words is None:
        return None
    if not has_texture(words := words.format_map(Values(dress.values))):
        words = PLAIN  # A property of a mod's block has a value that the rule does not foresee.
    place = _value_for_face(part.get("uv", "place"), name) or "place"
    rect = None if place == "place" else WHOLE if place == "fit" else tuple(place)
    matrix = cached_face_uv(side, low, high, rect, part.get("spin", {}).get(name, 0))
    return ElementFace(_recipe(words, dress.name), matrix)


@lru_cache(maxsize=1 << 14)
def _recipe(words: str, name: str) -> str:
    return recipe_of(words, name, {})


def _resolve_skin(skin: Any, part: Mapping[str, Any], dress: PartContext) -> Any:
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


def _value_for_face(table: Any, name: str) -> Any:
    """Return what a table says of a face: by its name, by its group, or for all."""
    if not isinstance(table, Mapping):
        return table
    for key in (name, _GROUPS[name], "all"):
        if key in table:
            return table[key]
    return None


@lru_cache(maxsize=1 << 16)
def model_of(state: str) -> BlockModel:
    """Return the model of a block state. Missing properties have their default values.

    A block without a rule is rendered by its visible boxes in its own colour, and marked as a
    stand-in.

    Raises:
        UsageError: If the text is not a valid block state.
    """
    whole = complete(parse_state(state))
    rule = rule_for(whole)
    dress = _context_of(whole, rule)
    if rule is None or rule.parts is None:
        elements = _visual_elements(whole, dress, glows=rule is not None and rule.glow)
        return BlockModel(tuple(elements), not dress.light, stand_in=rule is None)
    turn = _turn(rule, dress)
    drawn = [one for part in rule.parts for one in elements_of(_with_glow(part, rule), dress)]
    flat = any("cross" in part or "hash" in part for part in rule.parts)
    elements = (
        drawn if np.array_equal(turn, np.eye(4)) else [rotate_element(one, turn) for one in drawn]
    )
    return BlockModel(tuple(elements), ambient_occlusion=not (flat or dress.light))


def _context_of(state: BlockState, rule: ModelRule | None) -> PartContext:
    values = values_of(state.name, _known_values(state))
    light = BRIGHTEST if is_luminous(str(state)) else emitted_light(str(state))
    skin = PLAIN if rule is None or rule.skin is None else rule.skin
    return PartContext(state.name, values, skin, {} if rule is None else rule.skins, light)


def _known_values(state: BlockState) -> dict[str, str]:
    """Return a state's properties; a value that the game does not know is the default's."""
    values = dict(state.properties)
    block = block_table().blocks.get(state.name)
    return values if block is None else values | block.values_at(block.index_of(values))


def _visual_elements(state: BlockState, dress: PartContext, glows: bool) -> list[Element]:
    boxes = visual_boxes(str(state)).astype(float) * 16
    return [box_element(box[:3], box[3:], {"glow": glows}, dress) for box in boxes.tolist()]


def _with_glow(part, rule: ModelRule):
    return {"glow": True, **part} if rule.glow else part


def _turn(rule: ModelRule, dress: PartContext) -> np.ndarray:
    """Return the matrix that carries the written model to the state's."""
    matrix = np.eye(4)
    for kind, key in rule.turns:
        value = dress.values[key].partition("_")[0]  # A jigsaw's "down_east" points down.
        if kind == "turn":
            matrix = rotation_from_north(value) @ matrix
        elif kind == "point":
            matrix = rotation_from_up(value) @ matrix
        elif kind == "axis":
            matrix = rotation_from_y(value) @ matrix
        else:
            matrix = (
                rotation_of_sixteenths(value, "south" if kind == "rotation" else "north") @ matrix
            )
    return matrix
