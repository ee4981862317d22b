"""Elements of model files: reading, quarter turns, and merging of elements with the same box.

All matrices transform points of the block ([0, 1] on each axis) about its centre. A quarter turn
keeps boxes aligned: faces are permuted, and textures rotate or stay. Elements with the same box are
merged with their textures layered: a grass block is a dirt cube with a second, tinted cube in the
same place, and remains a full cube when merged.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np

from world2minecraft.rendering.block_elements import (
    FACE_AXES,
    FACE_NAMES,
    Element,
    ElementFace,
    cached_face_uv,
    face_uv,
)
from world2minecraft.rendering.resource_packs.json_validation import (
    as_number,
    as_numbers,
    as_object,
    as_quarter_turn,
    as_text,
    describe_value,
)
from world2minecraft.rendering.resource_packs.tints import Tint

OVER, TIMES = "+", "*"  # In names of joined textures: a*rrggbb+b; no resource's name has them.
_NORMALS = np.array([np.cross(u, v) for u, v in FACE_AXES])  # All inward, as v grows down.
_BLOCK = ((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
LOWEST, HIGHEST = -16.0, 32.0  # Sixteenths of a block; the game refuses others.


def merge_coincident(elements: Sequence[Element]) -> tuple[Element, ...]:
    """Return the elements with equal boxes merged if their faces can be layered."""
    done: list[Element] = []
    places: dict[tuple, int] = {}  # Of each box, the last element that fills it.
    for element in elements:
        at = places.get(_box_of(element))
        if at is None or not _can_join(done[at], element):
            places[_box_of(element)] = len(done)
            done.append(element)
        else:
            faces = zip(done[at].faces, element.faces, strict=True)
            done[at] = replace(done[at], faces=tuple(_overlay_face(a, b) for a, b in faces))
    return tuple(done)


def _box_of(element: Element) -> tuple:
    turn = None if element.turn is None else element.turn.tobytes()
    return element.low, element.high, element.shade, element.emission, turn


def _can_join(a: Element, b: Element) -> bool:
    """Return whether where both have a face, their textures lie alike."""
    return all(
        x is None or y is None or np.allclose(x.uv, y.uv)
        for x, y in zip(a.faces, b.faces, strict=True)
    )


def _overlay_face(below: ElementFace | None, above: ElementFace | None) -> ElementFace | None:
    if below is None or above is None:
        return below or above
    return ElementFace(_tinted_name(below) + OVER + _tinted_name(above), below.uv)


def _tinted_name(face: ElementFace) -> str:
    if face.tint is None:
        return face.texture
    return face.texture + TIMES + "".join(f"{value:02x}" for value in face.tint)


@lru_cache(maxsize=64)
def quarter_turn(x_deg: int, y_deg: int, z_deg: int = 0) -> np.ndarray:
    """Return the rotation about x, then y, then z, about the block's centre, float64 [4, 4].

    Positive angles rotate up to north (x), north to east (y) and up to east (z), as in a block
    state file.
    """
    turn = np.eye(3)
    for axis, angle in enumerate((x_deg, y_deg, z_deg)):
        one = np.eye(3)
        first, second = (axis + 1) % 3, (axis + 2) % 3
        sine, cosine = ((0, 1), (1, 0), (0, -1), (-1, 0))[angle // 90 % 4]
        one[first, first] = one[second, second] = cosine
        one[first, second], one[second, first] = sine, -sine
        turn = one @ turn
    return _about(turn, np.full(3, 0.5))


def _about(turn: np.ndarray, origin: np.ndarray) -> np.ndarray:
    """Return float64 [4, 4] of a turn or stretch, [3, 3], about a point."""
    matrix = np.eye(4)
    matrix[:3, :3] = turn
    matrix[:3, 3] = origin - turn @ origin
    return matrix


def free_turn(
    angles_deg: tuple[float, float, float], origin: np.ndarray | list[float], rescale: bool
) -> np.ndarray:
    """Return an element's own rotation about x, then y, then z, float64 [4, 4].

    Args:
        angles_deg: Right-handed angles in degrees, as in a model file.
        origin: Fixed point, in blocks.
        rescale: Whether to stretch the element so that it spans the block again.
    """
    turn = np.eye(3)
    for axis, angle in enumerate(np.radians(angles_deg)):
        one = np.eye(3)
        first, second = (axis + 1) % 3, (axis + 2) % 3
        one[first, first] = one[second, second] = np.cos(angle)
        one[second, first], one[first, second] = np.sin(angle), -np.sin(angle)
        turn = one @ turn
    if rescale:  # Each axis until its end touches the side of the cube that the turn leaves.
        turn = turn / np.abs(turn).max(axis=0)
    return _about(turn, np.asarray(origin, np.float64))


def is_quarter(matrix: np.ndarray) -> bool:
    """Return whether a matrix maps axes to axes."""
    lengths = np.abs(matrix[:3, :3])  # A rescaled turn by 45 degrees has ones too, but more.
    return bool(np.allclose(lengths, lengths.round(), atol=1e-9) and lengths.round().sum() == 3)


def apply_quarter_turn(element: Element, matrix: np.ndarray, uv_lock: bool = False) -> Element:
    """Return an element rotated by a quarter turn.

    Args:
        element: Any element. The rotation of a rotated element is multiplied.
        matrix: Matrix that maps axes to axes, float64 [4, 4].
        uv_lock: Whether textures are aligned as on an element created in the new position.
    """
    faces = element.faces
    if uv_lock:
        faces = tuple(_locked(side, face, matrix) for side, face in enumerate(faces))
    if element.turn is not None:
        return replace(element, faces=faces, turn=matrix @ element.turn)
    ends = np.array([element.low, element.high]) @ matrix[:3, :3].T + matrix[:3, 3]
    ends = np.where(np.abs(ends - ends.round(6)) < 1e-9, ends.round(6), ends)
    back = np.linalg.inv(matrix)
    moved: list[ElementFace | None] = [None] * 6
    for side, face in enumerate(faces):
        if face is not None:
            moved[side_after(side, matrix)] = replace(face, uv=face.uv @ back)
    low, high = ends.min(axis=0).tolist(), ends.max(axis=0).tolist()
    return replace(element, low=tuple(low), high=tuple(high), faces=tuple(moved))


def side_after(side: int, matrix: np.ndarray) -> int:
    """Return the side, 0 to 5 in the order of ``FACE_NAMES``, that a side is rotated to."""
    return int((_NORMALS @ (matrix[:3, :3] @ _NORMALS[side])).argmax())


def _locked(side: int, face: ElementFace | None, matrix: np.ndarray) -> ElementFace | None:
    """Return a face whose texture stays as the world lies while the face is turned."""
    if face is None:
        return None
    lock = _lock(side, matrix.tobytes())
    uv = lock[:, :2] @ face.uv
    uv[:, 3] += lock[:, 2]
    return replace(face, uv=uv)


@lru_cache(maxsize=1024)
def _lock(side: int, matrix_bytes: bytes) -> np.ndarray:
    """Return float64 [2, 3] from a texture point (u, v, 1) to that of a locked texture.

    A texture point goes to the place on the block's side that has it by default, with the turn to
    another side, and there to the texture point of that place.
    """
    matrix = np.frombuffer(matrix_bytes, np.float64).reshape(4, 4)
    before, after = face_uv(side, *_BLOCK), face_uv(side_after(side, matrix), *_BLOCK)
    axes = np.array(FACE_AXES[side], np.float64)
    to_block = np.zeros((4, 3))  # From (u, v, 1) to a point of the side.
    to_block[:3, :2] = axes.T
    to_block[:3, 2] = -(axes.T @ before[:, 3])
    to_block[3, 2] = 1
    return after @ matrix @ to_block


def element_of(
    raw: Mapping[str, Any], texture_of: Callable[[str], str], tint_of: Callable[[int], Tint]
) -> Element:
    """Return an element of a model file before the rotation of the block.

    Args:
        raw: JSON object of the element.
        texture_of: Function from the texture reference of a face to the texture's name.
        tint_of: Function from a tint index to the colour multiplier.

    Raises:
        ValueError: If the JSON object is not a valid element.
    """
    start = np.array(as_numbers(raw.get("from"), "from", 3, LOWEST, HIGHEST)) / 16
    end = np.array(as_numbers(raw.get("to"), "to", 3, LOWEST, HIGHEST)) / 16
    low, high = tuple(np.minimum(start, end).tolist()), tuple(np.maximum(start, end).tolist())
    faces = as_object(raw.get("faces", {}), "faces")
    element = Element(
        low,
        high,
        tuple(
            _face(side, faces[name], (low, high), texture_of, tint_of) if name in faces else None
            for side, name in enumerate(FACE_NAMES)
        ),
        shade=raw.get("shade", True) is not False,
        emission=int(as_number(raw.get("light_emission", 0), "light_emission", 0, 15)),
    )
    turn = _rotation(raw.get("rotation"))
    if turn is None:
        return element
    if is_quarter(turn):
        return apply_quarter_turn(element, turn)
    return Element(low, high, element.faces, turn, element.shade, element.emission)


def _face(side: int, raw: Any, box, texture_of, tint_of) -> ElementFace:
    face = as_object(raw, f"face {FACE_NAMES[side]}")
    rect = None
    if face.get("uv") is not None:
        u0, v0, u1, v1 = as_numbers(face["uv"], "uv", 4, -1024, 1024)
        rect = (u0, v0, u1, v1)
    rotation = as_quarter_turn(face.get("rotation", 0), "rotation of a face")
    index = int(as_number(face.get("tintindex", -1), "tintindex"))
    return ElementFace(
        texture_of(as_text(face.get("texture"), "texture of a face")),
        cached_face_uv(side, box[0], box[1], rect, rotation),
        tint_of(index) if index >= 0 else None,
    )


def _rotation(raw: Any) -> np.ndarray | None:
    """Return float64 [4, 4] of an element's rotation, None for none.

    It is one axis with its angle, or in newer files an angle for each of x, y and z.
    """
    if raw is None:
        return None
    rotation = as_object(raw, "rotation")
    axis = rotation.get("axis")
    if axis is not None:
        if axis not in ("x", "y", "z"):
            raise ValueError(f"axis of a rotation must be x, y or z, got {describe_value(axis)}")
        angle = as_number(rotation.get("angle", 0), "angle", -3600, 3600)
        angles = tuple(angle if name == axis else 0.0 for name in "xyz")
    else:
        angles = tuple(as_number(rotation.get(name, 0), name, -3600, 3600) for name in "xyz")
    if not any(angles):
        return None
    x_deg, y_deg, z_deg = angles
    origin = np.array(as_numbers(rotation.get("origin", [8, 8, 8]), "origin", 3)) / 16
    return free_turn((x_deg, y_deg, z_deg), origin, rotation.get("rescale", False) is True)
