"""Quarter turns of elements: boxes stay aligned, faces change places, textures turn or stay.

All matrices carry points of the block ([0, 1] on each axis) and turn about its middle.
"""

from dataclasses import replace
from functools import lru_cache

import numpy as np

from world2minecraft.rendering.block_elements import FACE_AXES, Element, FaceLook, face_uv

_NORMALS = np.array([np.cross(u, v) for u, v in FACE_AXES])  # All inward, as v grows down.
_BLOCK = ((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))


@lru_cache(maxsize=64)
def quarter_turn(x_deg: int, y_deg: int, z_deg: int = 0) -> np.ndarray:
    """Return float64 [4, 4]: turn about x, then y, then z, about the block's middle.

    Positive angles take up to north (x), north to east (y) and up to east (z), as in a
    blockstates file.
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
    """Return float64 [4, 4] of an element's own rotation: about x, then y, then z.

    Args:
        angles_deg: right-handed, as in a model's file.
        origin: the point that stays, blocks.
        rescale: whether the element is stretched to span the block again.
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
    """Return whether a matrix maps axes onto axes."""
    lengths = np.abs(matrix[:3, :3])  # A rescaled turn by 45 degrees has ones too, but more.
    return bool(np.allclose(lengths, lengths.round(), atol=1e-9) and lengths.round().sum() == 3)


def carry(element: Element, matrix: np.ndarray, uv_lock: bool = False) -> Element:
    """Return an element moved by a quarter turn.

    Args:
        element: any element; a turned one gets the product as its turn.
        matrix: float64 [4, 4] that maps axes onto axes.
        uv_lock: whether textures lie as they would on an element that was made in the new place.
    """
    faces = element.faces
    if uv_lock:
        faces = tuple(_locked(side, face, matrix) for side, face in enumerate(faces))
    if element.turn is not None:
        return replace(element, faces=faces, turn=matrix @ element.turn)
    ends = np.array([element.low, element.high]) @ matrix[:3, :3].T + matrix[:3, 3]
    ends = np.where(np.abs(ends - ends.round(6)) < 1e-9, ends.round(6), ends)
    back = np.linalg.inv(matrix)
    moved: list[FaceLook | None] = [None] * 6
    for side, face in enumerate(faces):
        if face is not None:
            moved[side_after(side, matrix)] = replace(face, uv=face.uv @ back)
    low, high = ends.min(axis=0).tolist(), ends.max(axis=0).tolist()
    return replace(element, low=tuple(low), high=tuple(high), faces=tuple(moved))


def side_after(side: int, matrix: np.ndarray) -> int:
    """Return the side, 0 to 5 in the order of ``FACE_NAMES``, that a side is turned to."""
    return int((_NORMALS @ (matrix[:3, :3] @ _NORMALS[side])).argmax())


def _locked(side: int, face: FaceLook | None, matrix: np.ndarray) -> FaceLook | None:
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
