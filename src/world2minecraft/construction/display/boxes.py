"""Reduction of a template's parts to few boxes, and their conversion to display entities.

If parts overlap, the smaller part is visible, as a shelf between books. The planes of all parts
divide the shape into cells of variable size, and cells of the same block are merged into boxes. The
shape is simplified further only if a limit requires it.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from world2minecraft.core.coordinates import apply, room_to_block, rotation_about_z
from world2minecraft.core.types import Entity
from world2minecraft.furniture import Part
from world2minecraft.geometry.box_decomposition import cover_boxes, partition_boxes, simplify_boxes
from world2minecraft.minecraft.entities import block_display

MIN_IOU = 0.9  # Minimum overlap of coarser boxes with the shape.
FINE_M = 0.02  # The grid on which a shape of too many boxes is made coarser.
SAME_M = 1e-6  # Planes nearer than this are one.
# Blocks by which boxes that overlap stand back from one another, so that faces in one plane do not
# flicker, even across a room.
INSET_BLOCKS = 0.0005
Planes = tuple[np.ndarray, np.ndarray, np.ndarray]


class DisplayBox(NamedTuple):
    """A box of an object and its block state.

    Attributes:
        box_m: Corners x0 y0 z0 x1 y1 z1 in metres in the object's frame, float64 [6].
        state: Block state of the box.
    """

    box_m: np.ndarray  # float64 [6]
    state: str


@dataclass(frozen=True, eq=False)
class Frame:
    """The coordinate frame of an object, with its origin at the bottom centre of its footprint.

    Attributes:
        base_m: Origin of the frame in the room in metres.
        size_m: Depth, width and height of the object along its own axes in metres.
        yaw_deg: Rotation of the object's front from room +x, counter-clockwise from above, in
            degrees.
    """

    base_m: np.ndarray  # float64 [3]
    size_m: np.ndarray  # float64 [3]
    yaw_deg: float

    @property
    def object_to_room(self) -> np.ndarray:
        """The 4x4 transform from the object's frame to the room, both in metres."""
        transform = rotation_about_z(self.yaw_deg)
        transform[:3, 3] = self.base_m
        return transform

    @property
    def bounds_m(self) -> np.ndarray:
        """The minimum and maximum corner of the rotated object in the room, float64 [2, 3]."""
        x, y, z = self.size_m
        corners = np.array(
            [[a, b, c] for a in (-x / 2, x / 2) for b in (-y / 2, y / 2) for c in (0, z)]
        )
        placed = apply(self.object_to_room, corners)
        return np.stack([placed.min(axis=0), placed.max(axis=0)])

    def moved(self, shift_m: np.ndarray) -> "Frame":
        """Return the frame translated in the room by a shift, float64 [3] in metres."""
        return replace(self, base_m=self.base_m + shift_m)


def boxes_in_room(pieces: Sequence[DisplayBox], frame: Frame) -> tuple[np.ndarray, np.ndarray]:
    """Return the centres and the half sizes of boxes, float64 [N, 3] each in metres.

    The centres are in the room frame, the half sizes along the axes of the object.
    """
    boxes = np.array([piece.box_m for piece in pieces]).reshape(-1, 2, 3)
    middles = apply(frame.object_to_room, boxes.mean(axis=1))
    return middles, (boxes[:, 1] - boxes[:, 0]) / 2


def display_entities(
    pieces: Sequence[DisplayBox],
    frame: Frame,
    corner_m: np.ndarray,
    blocks_per_metre: float,
    class_id: int,
    instance: int,
    *,
    view_range: float = 1.0,
    lights: Sequence[int | None] | None = None,
) -> list[Entity]:
    """Return one display entity per box, all positioned at the centre of their object.

    The common position lets commands move and rotate the object as a whole.

    Args:
        pieces: Boxes of the object in its own frame.
        frame: Frame of the object in the room.
        corner_m: Corner of the room that corresponds to block (0, 64, 0), in metres.
        blocks_per_metre: Scale of the build.
        class_id: Class of the object.
        instance: Instance number of the object.
        view_range: View distance in units of 64 blocks.
        lights: Light level of each box; None uses the light at the entity's position.
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


def template_boxes(
    parts: Sequence[Part], states: Sequence[str], most: int, blocks_per_metre: float
) -> list[DisplayBox]:
    """Return the boxes that show the parts of a template, simplified to at most ``most`` boxes.

    Args:
        parts: Boxes of the template in its own frame.
        states: Block state of each part.
        most: Number of boxes above which the shape is simplified, to an IoU of at least
            ``MIN_IOU``.
        blocks_per_metre: Scale, used to separate coplanar faces of overlapping boxes.
    """
    names = sorted(set(states))
    numbers = [names.index(state) + 1 for state in states]
    labels, planes = _cut(parts, numbers)
    boxes = partition_boxes(labels)
    if len(boxes) > most:  # Only then boxes may overlap, as those of a round table's top do.
        boxes = min(boxes, cover_boxes(labels), _whole(parts, numbers, planes), key=len)
    if len(boxes) > most:
        coarse, fine = _coarse(labels, planes, most)
        if len(coarse) < len(boxes):
            boxes, planes = coarse, fine
    inset = INSET_BLOCKS / blocks_per_metre * _depths(boxes)
    pieces = []
    for (label, *cells), back in zip(boxes.tolist(), inset.tolist(), strict=True):
        corners = [planes[axis % 3][cell] for axis, cell in enumerate(cells)]
        box = np.array(corners, np.float64)
        # Nothing thinner than the inset is turned inside out by it.
        step = min(back, float((box[3:] - box[:3]).min()) / 4)
        pieces.append(DisplayBox(box + np.repeat([step, -step], 3), names[label - 1]))
    return pieces


def _whole(parts: Sequence[Part], labels: Sequence[int], planes: Planes) -> np.ndarray:
    """Return the parts as boxes, int64 [N, 7], between planes; the smallest first.

    If parts overlap, the larger part is set back so that the smaller one is visible.
    """
    corners = np.array([part.box_m for part in parts])
    order = np.argsort(np.round(np.prod(corners[:, 3:] - corners[:, :3], axis=1), 9), kind="stable")
    return np.array(
        [
            [labels[n], *(_place(planes[axis % 3], corners[n, axis]) for axis in range(6))]
            for n in order.tolist()
        ]
    )


def _cut(parts: Sequence[Part], labels: Sequence[int]) -> tuple[np.ndarray, Planes]:
    """Return the planes of parts, and the labels of the cells between them, int32 [X, Y, Z]."""
    boxes = np.array([part.box_m for part in parts], np.float64).reshape(-1, 2, 3)
    x, y, z = (_distinct(boxes[:, :, axis].ravel()) for axis in range(3))
    planes = (x, y, z)
    result = np.zeros([max(len(each) - 1, 0) for each in planes], np.int32)
    volumes = np.prod(boxes[:, 1] - boxes[:, 0], axis=1)
    for index in np.argsort(-np.round(volumes, 9), kind="stable").tolist():
        low, high = boxes[index]
        where = tuple(
            slice(_place(planes[axis], low[axis]), _place(planes[axis], high[axis]))
            for axis in range(3)
        )
        result[where] = labels[index]
    return result, planes


def _distinct(values: np.ndarray) -> np.ndarray:
    """Return the increasing values without those close to another value."""
    ordered = np.unique(values)
    return ordered[np.concatenate([[True], np.diff(ordered) > SAME_M])]


def _place(planes: np.ndarray, value: float) -> int:
    return int(np.abs(planes - value).argmin())


def _coarse(labels: np.ndarray, planes: Planes, most: int) -> tuple[np.ndarray, Planes]:
    """Return boxes on a grid of 2 cm whose union has at least the minimum IoU."""
    fine, picks = [], []
    for each in planes:
        count = max(1, round((each[-1] - each[0]) / FINE_M))
        edges = np.linspace(each[0], each[-1], count + 1)
        middles = (edges[:-1] + edges[1:]) / 2
        picks.append(np.clip(np.searchsorted(each, middles) - 1, 0, len(each) - 2))
        fine.append(edges)
    fewer = simplify_boxes(labels[np.ix_(*picks)], MIN_IOU, enough=most)
    return fewer, (fine[0], fine[1], fine[2])


def _depths(boxes: np.ndarray) -> np.ndarray:
    """Return the set-back of each box, int [N]: one step more than the boxes it overlaps."""
    depths = np.zeros(len(boxes), np.int64)
    for n in range(1, len(boxes)):
        meets = (boxes[:n, 1:4] < boxes[n, 4:]) & (boxes[n, 1:4] < boxes[:n, 4:])
        over = meets.all(axis=1)
        if over.any():
            depths[n] = depths[:n][over].max() + 1
    return depths


def voxel_boxes(
    labels: np.ndarray,
    open_cells: np.ndarray,
    names: Sequence[str],
    low_m: np.ndarray,
    cell_m: float,
) -> list[DisplayBox]:
    """Return the boxes of an object's cells, simplified to an IoU of at least ``MIN_IOU``.

    Args:
        labels: Integer [X, Y, Z]; 0 is empty, n selects the n-th block of ``names``.
        open_cells: Bool [X, Y, Z] mask of unseen cells inside the object.
        names: Block states.
        low_m: Corner of cell (0, 0, 0) in the object's frame in metres, float64 [3].
        cell_m: Cell size in metres.
    """
    boxes = simplify_boxes(labels, MIN_IOU, open_cells)
    exact = partition_boxes(labels)
    if len(exact) <= len(boxes):
        boxes = exact
    corners = np.tile(low_m, 2) + boxes[:, 1:] * cell_m
    return [
        DisplayBox(box, str(names[int(label) - 1]))
        for label, box in zip(boxes[:, 0].tolist(), corners, strict=True)
    ]
