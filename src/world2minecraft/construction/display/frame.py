"""Where an object stands: its own frame in the room, and its boxes as display entities."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from world2minecraft.core.coordinates import apply, room_to_block, rotation_about_z
from world2minecraft.core.types import Entity
from world2minecraft.minecraft.entities import block_display


class Piece(NamedTuple):
    """One box of an object: x0 y0 z0 x1 y1 z1 in metres of its own frame, and its block."""

    box_m: np.ndarray  # float64 [6]
    state: str


@dataclass(frozen=True, eq=False)
class Frame:
    """An object's own frame: its origin in the middle of its footprint, at its bottom.

    ``base_m`` is that origin in the room, ``size_m`` the object's depth, width and height along
    its own axes; ``yaw_deg`` turns its front from room +x, counter-clockwise from above.
    """

    base_m: np.ndarray  # float64 [3]
    size_m: np.ndarray  # float64 [3]
    yaw_deg: float

    @property
    def object_to_room(self) -> np.ndarray:
        """The 4x4 from the object's frame to the room's, both in metres."""
        transform = rotation_about_z(self.yaw_deg)
        transform[:3, 3] = self.base_m
        return transform

    @property
    def bounds_m(self) -> np.ndarray:
        """float64 [2, 3]: the least and the greatest corner of its turned box in the room."""
        x, y, z = self.size_m
        corners = np.array(
            [[a, b, c] for a in (-x / 2, x / 2) for b in (-y / 2, y / 2) for c in (0, z)]
        )
        placed = apply(self.object_to_room, corners)
        return np.stack([placed.min(axis=0), placed.max(axis=0)])

    def moved(self, shift_m: np.ndarray) -> "Frame":
        """Return the frame moved in the room by a shift, float64 [3] in metres."""
        return replace(self, base_m=self.base_m + shift_m)


def boxes_in_room(pieces: Sequence[Piece], frame: Frame) -> tuple[np.ndarray, np.ndarray]:
    """Return the middles and the half sides, float64 [N, 3] both, of pieces.

    The middles are in the room; the half sides are along the object's own axes.
    """
    boxes = np.array([piece.box_m for piece in pieces]).reshape(-1, 2, 3)
    middles = apply(frame.object_to_room, boxes.mean(axis=1))
    return middles, (boxes[:, 1] - boxes[:, 0]) / 2


def entities_of(
    pieces: Sequence[Piece],
    frame: Frame,
    corner_m: np.ndarray,
    blocks_per_metre: float,
    class_id: int,
    instance: int,
    *,
    view_range: float = 1.0,
    lights: Sequence[int | None] | None = None,
) -> list[Entity]:
    """Return a display entity for each piece, all at the middle of their object.

    One place for all of an object's entities lets commands move and turn it as a whole.

    Args:
        pieces: the boxes of the object in its own frame.
        frame: where it stands.
        corner_m: the corner of the room that stands at block (0, 64, 0).
        blocks_per_metre: the scale.
        class_id: the object's class.
        instance: its number.
        view_range: how far it is drawn, in lengths of 64 blocks.
        lights: for each piece the light that it is drawn by, None by that of its place.
    """
    middle_m = np.array([0.0, 0.0, frame.size_m[2] / 2])
    to_block = room_to_block(corner_m, blocks_per_metre)
    position = apply(to_block, apply(frame.object_to_room, middle_m))
    result = []
    for number, piece in enumerate(pieces):
        low, high = piece.box_m[:3] - middle_m, piece.box_m[3:] - middle_m
        # The axes of blocks: x stays, up is z, and south is -y.
        box = np.array([low[0], low[2], -high[1], high[0], high[2], -low[1]]) * blocks_per_metre
        result.append(
            block_display(
                piece.state,
                box,
                position.tolist(),
                yaw_deg=frame.yaw_deg,
                class_id=class_id,
                instance=instance,
                view_range=view_range,
                light=None if lights is None else lights[number],
            )
        )
    return result
