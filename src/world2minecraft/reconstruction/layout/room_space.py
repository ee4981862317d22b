"""The space of a storey's rooms, and the hidden floor and walls that follow from its structure.

Seen from above, a room is the convex hull of its observed free space, cut off at the planes of its
walls and continued to these planes behind furniture. Only cells in the room, or one cell around it,
may be completed; what lies beyond stays free or unknown. The floor continues below furniture, and a
wall continues down to the floor.
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import ConvexHull

from world2minecraft.geometry.connected_components import label_components
from world2minecraft.geometry.morphology import dilate
from world2minecraft.reconstruction.layout.room_layouts import PASSED_CELLS, ROOM_M2, plane_layer
from world2minecraft.reconstruction.layout.structure import Structure, Wall
from world2minecraft.reconstruction.layout.surface_cells import Surface, turn_surface

# Deeper than wardrobes and counters. On 29 generated single frames, 0.4 m to 1.1 m differ by 0.3
# points of IoU.
FURNITURE_M = 0.72
UNDER_CELLS = 0.25  # The floor's layer is the one so far below its top.
AROUND_CELLS = 1  # Cells of floor, wall and ceiling around the free space that belong to the room.


@dataclass(frozen=True, eq=False)
class RoomSpace:
    """The space of the rooms of a storey.

    Attributes:
        cells: Whether a cell belongs to a room or to the first cell of floor, wall or ceiling
            around it, as bool [X, Y, Z].
        floor: The floor's cells, seen or hidden, as bool [X, Y, Z].
        wall: The cells of the walls' faces from the floor to the top that was seen, as bool
            [X, Y, Z].
    """

    cells: np.ndarray
    floor: np.ndarray
    wall: np.ndarray


def room_space(structure: Structure) -> RoomSpace:
    """Return the space of the rooms of a storey, which is empty without observed free space."""
    surface = structure.surface
    cells, floor, wall = np.zeros((3, *surface.occupied.shape), bool)
    passed = surface.free.sum(axis=2) >= PASSED_CELLS
    if not passed.any():
        return RoomSpace(cells, floor, wall)
    around = dilate(room_columns(structure, passed), AROUND_CELLS)
    low, high = _layers(structure)
    cells[:, :, max(low, 0) : high] = around[:, :, None]
    if 0 <= low < cells.shape[2]:
        floor[:, :, low] = around
    for one in structure.walls:
        _mark_face(wall, one, surface)
    return RoomSpace(cells, floor, wall & cells)


def room_columns(structure: Structure, passed: np.ndarray) -> np.ndarray:
    """Return the columns of the rooms, bool [X, Y].

    Args:
        structure: The structure of the storey.
        passed: The columns in which free space was observed, bool [X, Y].
    """
    surface = structure.surface
    beyond, closed = np.zeros((2, *passed.shape), bool)
    for wall in structure.walls:
        layer, span = plane_layer(wall, surface), _span(wall)
        view = turn_surface(beyond, wall.run.axis, wall.run.sign)
        view[max(layer + 1, 0) :, span] = True
        line = turn_surface(closed, wall.run.axis, wall.run.sign)
        if 0 <= layer < len(line):
            line[layer, span] = True
    result = passed.copy()
    parts, count = label_components(passed & ~closed, corners=False)
    for part in range(1, count + 1):
        columns = parts == part
        if columns.sum() * surface.voxel_m**2 >= ROOM_M2:
            result |= convex_hull(columns) & ~beyond
    behind = np.zeros_like(result)
    for wall in structure.walls:
        _continue_to(wall, surface, result, behind)
    return result | (behind & ~beyond)


def convex_hull(columns: np.ndarray) -> np.ndarray:
    """Return the columns whose centres lie in the convex hull of a mask, bool [X, Y].

    Example:
        >>> corner = np.array([[1, 1, 1], [1, 0, 0], [1, 0, 0]], bool)
        >>> convex_hull(corner).astype(int).tolist()
        [[1, 1, 1], [1, 1, 0], [1, 0, 0]]
    """
    at = np.argwhere(columns)
    if len(at) < 3 or np.linalg.matrix_rank(at - at[0]) < 2:
        return columns.copy()
    sides = ConvexHull(at).equations
    every = np.argwhere(np.ones(columns.shape, bool))
    inside = np.all(every @ sides[:, :2].T + sides[:, 2] <= 1e-9, axis=1)
    return np.asarray(inside).reshape(columns.shape)


def _span(wall: Wall) -> slice:
    """Return the cells along a wall, with one on either side."""
    return slice(max(wall.run.span[0] - 1, 0), wall.run.span[1] + 2)


def _continue_to(wall: Wall, surface: Surface, room: np.ndarray, behind: np.ndarray) -> None:
    """Mark the columns between the room and the plane of a wall, as deep as furniture.

    The plane is continued over the whole grid, since furniture often hides where a wall ends.
    """
    view, target = (turn_surface(plan, wall.run.axis, wall.run.sign) for plan in (room, behind))
    layer = plane_layer(wall, surface)
    depth = surface.cells_of(FURNITURE_M)
    before = view[: max(layer, 0)]
    for row in np.flatnonzero(before.any(axis=0)):
        last = int(np.flatnonzero(before[:, row])[-1])
        if layer - 1 - last <= depth:
            target[last + 1 : layer, row] = True


def _layers(structure: Structure) -> tuple[int, int]:
    """Return the first layer of the rooms and the one after the last, floor and ceiling included.

    A ceiling that was not seen is at least as high as the observed free space.
    """
    surface = structure.surface
    top = int(np.flatnonzero(surface.free.any(axis=(0, 1)))[-1]) + AROUND_CELLS
    if structure.ceiling_m is not None:
        height_m = structure.ceiling_m - surface.origin_m[2]
        top = min(top, int(np.floor(height_m / surface.voxel_m + 0.25)))
    return int(np.floor(-surface.origin_m[2] / surface.voxel_m - UNDER_CELLS)), top + 1


def _mark_face(mask: np.ndarray, wall: Wall, surface: Surface) -> None:
    """Mark the cells of a wall's face below its top, outside its openings, in place."""
    layer = plane_layer(wall, surface)
    view = turn_surface(mask, wall.run.axis, wall.run.sign)
    if not 0 <= layer < len(view):
        return
    first, last = wall.run.span
    bottom, top = max(surface.floor_layer + 1, 0), surface.layers_below(wall.run.top_m)
    view[layer, first : last + 1, bottom:top] = True
    along_m = surface.origin_m[1 - wall.run.axis]
    for gap in wall.face.gaps:
        left, right = (round((at - along_m) / surface.voxel_m) for at in gap.along_m)
        low, high = (surface.layers_below(height_m) for height_m in gap.height_m)
        view[layer, max(left, 0) : max(right, 0), low:high] = False
