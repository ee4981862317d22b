"""Door leaves: the closed leaves of a layout, with their hinges and their cells.

``hinge`` is the side of the hinge as seen from inside the room. If it is unknown, the hinge is at
the end of the leaf that is nearer to a corner of the room, so that the leaf opens against a wall.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from world2minecraft.core.classes import OBJECT_CLASSES
from world2minecraft.core.types import UNSEEN, Hinge, Layout, OccupancyGrid, Opening

DEEPEST_M, BEFORE_M = 0.35, 0.04  # A leaf lies this far behind its wall's face, or before it.
MIN_LEAF_SHARE = 0.25  # Of the leaf's face, seen as an object: else the leaf was removed.
OWN_SHARE = 0.5  # Of an object's cells in a leaf: it is the leaf.
SAME_DOOR_M = 0.6  # Two rooms share the leaf of the wall between them.
MAX_SLOPE = 0.05  # Of a wall along an axis.


@dataclass(frozen=True)
class Leaf:
    """A closed door leaf in a wall along an axis, in metres of the room frame.

    The wall is perpendicular to ``axis``, and ``sign`` is the way out of the room along this axis.
    ``head_m`` is the height of the leaf above its floor.
    """

    axis: int
    sign: int
    face_m: float
    along_m: tuple[float, float]
    floor_m: float
    head_m: float
    hinge: Hinge
    is_open: bool
    instance: int = 0


class FoundLeaves(NamedTuple):
    """The leaves of a room and their cells."""

    leaves: tuple[Leaf, ...]
    cells: np.ndarray  # bool [X, Y, Z]: object cells of a leaf
    objects: frozenset[int]  # The objects of which most cells are in a leaf.


def with_hinges(rooms: Sequence[Layout]) -> tuple[Layout, ...]:
    """Return the rooms with a hinge for each door leaf that has none."""
    return tuple(
        replace(
            room,
            openings=tuple(
                replace(one, hinge=usual_hinge(room, one))
                if one.kind == "door" and not one.hinge
                else one
                for one in room.openings
            ),
        )
        for room in rooms
    )


def usual_hinge(room: Layout, opening: Opening) -> Hinge:
    """Return the side, seen from inside the room, on which a leaf is nearer to a corner."""
    ends = np.stack([opening.start_m, opening.end_m])
    # An outline is counter-clockwise: seen from inside, its edges lead from right to left.
    along = _edge_direction(room, ends.mean(axis=0))
    right, left = ends if float((ends[1] - ends[0]) @ along) > 0 else ends[::-1]
    gaps = [np.linalg.norm(room.floor_polygon_m - end, axis=1).min() for end in (left, right)]
    return "left" if gaps[0] <= gaps[1] else "right"


def find_leaves(grid: OccupancyGrid, rooms: Sequence[Layout]) -> FoundLeaves:
    """Find the door leaves of a layout whose cells are objects in the grid.

    The leaves of slanted walls, and those that were removed from the grid, are not included.
    """
    leaves: list[Leaf] = []
    own = np.zeros(grid.shape, bool)
    things = np.isin(grid.labels, OBJECT_CLASSES)
    for leaf in (_leaf(room, one) for room in rooms for one in room.openings):
        if leaf is None or any(_is_same_door(leaf, other) for other in leaves):
            continue
        box = _box_of(leaf, grid)
        inside = things[box]
        if not inside.size or inside.any(axis=leaf.axis).mean() < MIN_LEAF_SHARE:
            continue
        own[box] |= inside
        number = int(np.bincount(grid.instance[box][inside]).argmax())
        leaves.append(replace(leaf, instance=number))
    sizes = np.bincount(grid.instance[things])
    held = np.bincount(grid.instance[own], minlength=len(sizes))
    whole = np.flatnonzero((held > 0) & (held >= OWN_SHARE * sizes))
    objects = frozenset(whole[whole > 0].tolist())
    own |= things & np.isin(grid.instance, list(objects))
    return FoundLeaves(tuple(leaves), own, objects)


def without_leaves(grid: OccupancyGrid, found: FoundLeaves) -> OccupancyGrid:
    """Return a grid in which the cells of the leaves are unseen."""
    if not found.cells.any():
        return grid
    labels, source, instance = grid.labels.copy(), grid.source.copy(), grid.instance.copy()
    labels[found.cells], source[found.cells], instance[found.cells] = 255, UNSEEN, 0
    return replace(grid, labels=labels, source=source, instance=instance)


def _leaf(room: Layout, opening: Opening) -> Leaf | None:
    """Return the leaf of an opening, or None if there is none or its wall is slanted."""
    side = opening.end_m - opening.start_m
    length = float(np.linalg.norm(side))
    if opening.kind != "door" or np.abs(side).min() > MAX_SLOPE * length:
        return None
    axis = int(np.abs(side).argmin())
    middle = (opening.start_m + opening.end_m) / 2
    along = _edge_direction(room, middle)
    outward = float(along[1] if axis == 0 else -along[0])
    low, high = sorted((float(opening.start_m[1 - axis]), float(opening.end_m[1 - axis])))
    return Leaf(
        axis=axis,
        sign=1 if outward > 0 else -1,
        face_m=float(middle[axis]),
        along_m=(low, high),
        floor_m=room.floor_z_m,
        head_m=opening.head_m,
        hinge=opening.hinge or usual_hinge(room, opening),
        is_open=opening.is_open,
    )


def _edge_direction(room: Layout, point: np.ndarray) -> np.ndarray:
    """Return the direction, float64 [2], of the edge of a room's outline nearest to a point."""
    first = room.floor_polygon_m
    side = np.roll(first, -1, axis=0) - first
    length = np.maximum((side**2).sum(axis=1), 1e-12)
    share = np.clip(((point - first) * side).sum(axis=1) / length, 0, 1)
    off_m = np.linalg.norm(first + share[:, None] * side - point, axis=1)
    direction: np.ndarray = side[off_m.argmin()]
    return direction


def _is_same_door(one: Leaf, other: Leaf) -> bool:
    """Return whether two leaves are the two sides of one door."""
    if one.axis != other.axis or abs(one.floor_m - other.floor_m) > 1:
        return False
    apart = abs(sum(one.along_m) - sum(other.along_m)) / 2
    return apart <= SAME_DOOR_M and abs(one.face_m - other.face_m) <= SAME_DOOR_M


def _box_of(leaf: Leaf, grid: OccupancyGrid) -> tuple[slice, ...]:
    """Return the cells in which a leaf may lie."""
    across = sorted((leaf.face_m - leaf.sign * BEFORE_M, leaf.face_m + leaf.sign * DEEPEST_M))
    spans = [(across[0], across[1]), leaf.along_m]
    ranges = [*(spans if leaf.axis == 0 else spans[::-1])]
    ranges.append((leaf.floor_m, leaf.floor_m + leaf.head_m))
    slices = []
    for axis, (low, high) in enumerate(ranges):
        cells = (np.array([low, high]) - grid.origin_m[axis]) / grid.voxel_m
        # Cells of which the middle is inside.
        first, last = np.clip(np.ceil(cells - 0.5), 0, grid.shape[axis]).astype(int).tolist()
        slices.append(slice(first, last))
    return tuple(slices)
