"""Turning elements: a model is written once, for north or for up, and turned to what a state says.

Matrices are float64 [4, 4] and carry points of the block to points of the block, about its middle.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from world2minecraft.rendering.block_elements import Element, FaceLook

# Clockwise from above, from the side that models are written for.
QUARTERS = ("north", "east", "south", "west")
MIDDLE = (0.5, 0.5, 0.5)
_NORMALS = np.array([[-1, 0, 0], [1, 0, 0], [0, -1, 0], [0, 1, 0], [0, 0, -1], [0, 0, 1]])


def spun(angle_deg: float, axis: str = "y", origin: Sequence[float] = MIDDLE) -> np.ndarray:
    """Return the turn about an axis: about y clockwise as seen from above.

    Args:
        angle_deg: multiples of 90 give exact matrices.
        axis: "x", "y" or "z".
        origin: a point on the axis, blocks.
    """
    cosine, sine = np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))
    if angle_deg % 90 == 0:
        cosine, sine = float(round(cosine)), float(round(sine))
    first, second = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
    matrix = np.eye(4)
    turn = -sine if axis == "y" else sine
    matrix[first, first] = matrix[second, second] = cosine
    matrix[first, second], matrix[second, first] = -turn, turn
    return about(matrix, origin)


def about(matrix: np.ndarray, origin: Sequence[float]) -> np.ndarray:
    """Return a matrix so moved that it leaves ``origin`` where it is."""
    moved = matrix.copy()
    middle = np.asarray(origin, np.float64)
    moved[:3, 3] = middle - matrix[:3, :3] @ middle
    return moved


def quarter(facing: str) -> np.ndarray:
    """Return the turn that carries north to a side; none for what is no side."""
    return spun(90.0 * QUARTERS.index(facing)) if facing in QUARTERS else np.eye(4)


def tipped(facing: str) -> np.ndarray:
    """Return the turn that carries up to one of the six sides."""
    if facing == "down":
        return spun(180.0, "x")
    if facing in QUARTERS:
        return quarter(facing) @ spun(-90.0, "x")
    return np.eye(4)


def along(axis: str) -> np.ndarray:
    """Return the turn that carries the y axis to another."""
    return {"x": tipped("east"), "z": tipped("north")}.get(axis, np.eye(4))


def sixteenth(rotation: str, front: str = "south") -> np.ndarray:
    """Return the turn of a sign, a banner or a head: 0 looks to ``front``, clockwise from there."""
    step = int(rotation) % 16 if rotation.isdecimal() and len(rotation) < 4 else 0
    return spun(90.0 * QUARTERS.index(front) + 22.5 * step)


def turned(element: Element, matrix: np.ndarray) -> Element:
    """Return an element carried by a turn: an aligned box stays aligned where that can be."""
    rotation = matrix[:3, :3]
    if element.turn is not None or not np.isin(rotation, (-1.0, 0.0, 1.0)).all():
        before = np.eye(4) if element.turn is None else element.turn
        return replace(element, turn=matrix @ before)
    corners = np.array([element.low, element.high]) @ rotation.T + matrix[:3, 3]
    back = np.eye(4)
    back[:3, :3], back[:3, 3] = rotation.T, -rotation.T @ matrix[:3, 3]
    faces: list[FaceLook | None] = [None] * 6
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
