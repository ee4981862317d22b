"""Tracing of ray packets: data shared by the pixels of a small tile is computed once.

Empty boxes are convex. If the four corner rays of a tile leave a box by the same face, then so do
all rays between them, and none has hit anything. A packet therefore advances from box to box until
all cells ahead are full cubes, so that every pixel hits one plane, or until the rays diverge. Each
ray is then traced separately from the box that was reached.
"""

from typing import NamedTuple

import numpy as np

from world2minecraft.core.jit import inlined, lean
from world2minecraft.rendering.ray_caster.ray import OUTSIDE, away_from_zero, floor_clamped
from world2minecraft.rendering.scene_tables import FULL, NO_FACE

# Values of ``PacketHit.mode``.
DIVERGED = 0  # Each ray is traced alone.
PLANE = 1  # All rays hit full cubes behind one plane.
MISS = 2  # All rays leave the grid.
MAX_PLANE_CELLS = 64  # Larger parts of a plane are not tested.
MAX_BOXES = 64  # Empty boxes that a packet crosses.


class PacketHit(NamedTuple):
    """The distance over which a packet stays together: it enters ``layer`` by ``face``."""

    mode: int
    face: int
    layer: int


@lean
def trace_packet(space, bounds, corners, cells):
    """Return the ``PacketHit`` of a packet.

    Args:
        space: Box of each cell, int32 [X, Y, Z].
        bounds: Bounds of the boxes, int16 [V, 6].
        corners: Origins and directions of the four corner rays, float64 [4, 6]. If they start
            neither in the same box nor outside the grid, the result is ``(DIVERGED, NO_FACE, 0)``.
        cells: Scratch memory, int64 [4, 3]. Its first two rows receive the first and the last cell
            of ``layer`` that the packet covers.
    """
    row = _box_of_origins(space, bounds, corners)
    face, layer = NO_FACE, 0
    low, high = cells[2], cells[3]
    for step in range(MAX_BOXES):
        if row >= 0:
            ahead = _common_exit(bounds, row, corners, low, high)
        else:
            ahead = _common_entry(space.shape, corners, low, high) if step == 0 else NO_FACE
        if ahead == NO_FACE:
            return PacketHit(DIVERGED, face, layer)
        axis = ahead // 2
        if row >= 0:
            behind = int(bounds[row, axis + 3]) if ahead % 2 == 0 else int(bounds[row, axis]) - 1
            if behind < 0 or behind >= space.shape[axis]:
                return PacketHit(MISS, ahead, behind)
        else:
            behind = 0 if ahead % 2 == 0 else space.shape[axis] - 1
        low[axis], high[axis] = behind, behind
        kind = _uniform_kind(space, bounds, low, high)
        if kind != FULL and kind < 0:
            return PacketHit(DIVERGED, face, layer)
        for axis in range(3):
            cells[0, axis], cells[1, axis] = low[axis], high[axis]
        if kind == FULL:
            return PacketHit(PLANE, ahead, behind)
        row, face, layer = kind, ahead, behind
    return PacketHit(DIVERGED, face, layer)


@inlined
def _box_of_origins(space, bounds, corners):
    """Return the empty box that holds the origins of all corner rays, or -1."""
    nx, ny, nz = space.shape
    i, j, k = (
        int(np.floor(corners[0, 0])),
        int(np.floor(corners[0, 1])),
        int(np.floor(corners[0, 2])),
    )
    if not (0 <= i < nx and 0 <= j < ny and 0 <= k < nz):
        return -1
    row = space[i, j, k]
    if row < 0:
        return -1
    for corner in range(4):
        for axis in range(3):
            at = corners[corner, axis]
            if at < bounds[row, axis] or at >= bounds[row, axis + 3]:
                return -1
    return row


@inlined
def _common_entry(shape, corners, low, high):
    """Return the face by which all corner rays enter the grid from outside, or NO_FACE.

    Then so do all rays between them, because a face is convex. ``low`` and ``high`` become the
    first and last cells of the part of the face that the packet covers.
    """
    common = NO_FACE
    for corner in range(4):
        enter, leave, face = 0.0, np.inf, NO_FACE
        for axis in range(3):
            d = away_from_zero(corners[corner, axis + 3])
            at = corners[corner, axis]
            near, far = (0 - at) / d, (shape[axis] - at) / d
            if d < 0:
                near, far = far, near
            if near > enter:
                enter, face = near, 2 * axis + (0 if d > 0 else 1)
            leave = min(leave, far)
        if face == NO_FACE or enter >= leave or (corner > 0 and face != common):
            return NO_FACE
        common = face
        for axis in range(3):
            at = corners[corner, axis] + enter * corners[corner, axis + 3]
            cell = floor_clamped(at, 0, shape[axis])
            low[axis] = cell if corner == 0 else min(low[axis], cell)
            high[axis] = cell if corner == 0 else max(high[axis], cell)
    return common


@inlined
def _common_exit(bounds, row, corners, low, high):
    """Return the face by which all corner rays leave a box, seen from behind it, and where.

    ``low`` and ``high`` become the first and last cells, along the other two axes, of the part of
    the face that the bundle covers.
    """
    common = NO_FACE
    for corner in range(4):
        nearest, face = np.inf, NO_FACE
        for axis in range(3):
            d = away_from_zero(corners[corner, axis + 3])
            t = (bounds[row, axis + 3 if d > 0 else axis] - corners[corner, axis]) / d
            if t < nearest:
                nearest, face = t, 2 * axis + (0 if d > 0 else 1)
        if corner == 0:
            common = face
        elif face != common:
            return NO_FACE
        for axis in range(3):
            at = corners[corner, axis] + nearest * corners[corner, axis + 3]
            cell = floor_clamped(at, int(bounds[row, axis]), int(bounds[row, axis + 3]))
            low[axis] = cell if corner == 0 else min(low[axis], cell)
            high[axis] = cell if corner == 0 else max(high[axis], cell)
    return common


@inlined
def _uniform_kind(space, bounds, low, high):
    """Return the box that holds all cells from ``low`` to ``high``, FULL, or OUTSIDE."""
    first = space[low[0], low[1], low[2]]
    if first >= 0:
        for axis in range(3):
            if low[axis] < bounds[first, axis] or high[axis] >= bounds[first, axis + 3]:
                return OUTSIDE
        return first
    if first != FULL:
        return OUTSIDE
    count = (high[0] - low[0] + 1) * (high[1] - low[1] + 1) * (high[2] - low[2] + 1)
    if count > MAX_PLANE_CELLS:
        return OUTSIDE
    for i in range(low[0], high[0] + 1):
        for j in range(low[1], high[1] + 1):
            for k in range(low[2], high[2] + 1):
                if space[i, j, k] != FULL:
                    return OUTSIDE
    return FULL
