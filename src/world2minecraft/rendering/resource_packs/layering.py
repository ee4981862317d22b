"""Elements that fill the same box become one, their textures laid one over another.

A grass block is a cube of earth with a second, tinted cube at the very same place. One box with
joined textures leaves no doubt which of the two is seen, and a full cube stays a full cube.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from world2minecraft.rendering.block_elements import Element, FaceLook

OVER, TIMES = "+", "*"  # In names of joined textures: a*rrggbb+b; no resource's name has them.


def merged(elements: Sequence[Element]) -> tuple[Element, ...]:
    """Return the elements with those of one box joined where their faces can be."""
    done: list[Element] = []
    places: dict[tuple, int] = {}  # Of each box, the last element that fills it.
    for element in elements:
        at = places.get(_box_of(element))
        if at is None or not _can_join(done[at], element):
            places[_box_of(element)] = len(done)
            done.append(element)
        else:
            faces = zip(done[at].faces, element.faces, strict=True)
            done[at] = replace(done[at], faces=tuple(_joined(a, b) for a, b in faces))
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


def _joined(below: FaceLook | None, above: FaceLook | None) -> FaceLook | None:
    if below is None or above is None:
        return below or above
    return FaceLook(_tinted(below) + OVER + _tinted(above), below.uv)


def _tinted(face: FaceLook) -> str:
    if face.tint is None:
        return face.texture
    return face.texture + TIMES + "".join(f"{value:02x}" for value in face.tint)
