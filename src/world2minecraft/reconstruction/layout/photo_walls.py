"""Correction of bare walls in depth computed from photos.

Stereo cannot match bare walls: it places surfaces of the wall's colour in front of it and scraps
behind it. The wall's position is known from its edges, posters, windows and the rims of objects in
front of it. If a wall was seen, no occupied cell is kept behind it, surfaces of its own colour
close in front of it are assigned to the wall, and its unseen parts are completed as flat.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy import ndimage
from scipy.spatial import KDTree

from world2minecraft.core.classes import UNKNOWN, SemanticClass
from world2minecraft.core.coordinates import cell_centers_m
from world2minecraft.core.types import COMPLETED, UNSEEN, Layout, OccupancyGrid
from world2minecraft.furniture.layout_checks import inside_polygon

THICK_M = 0.16  # Depth behind its face to which a wall may be occupied.
FACE_M = 0.1  # Cells this near to the face belong to the wall.
BEFORE_M = 0.4  # Stereo errors lie up to this far in front of a wall; beyond, few do.
ALIKE = 12  # Levels of 255 between colours of one paint; errors of stereo differ by 8.
AROUND = 12  # Cells of the wall that give its colour at a position.
SEEN_SHARE = 0.5  # Of a wall's columns: one less seen may be an opening, or a guess itself.
HOLE_CELLS = 4  # Half the width of carved holes; a door is wider.
CONFIDENCE = 0.3  # Confidence of completed cells.


class WallEdge(NamedTuple):
    """One axis-aligned side of a room's outline; lengths in metres."""

    axis: int  # It is square to: 0 for x, 1 for y.
    at_m: float
    inward: float  # 1 where the room lies on the larger side, else -1.
    from_m: float
    to_m: float
    bottom_m: float
    top_m: float

    def depth_m(self, points_m: np.ndarray) -> np.ndarray:
        """Return the distance of points [N, 3] in front of the wall's face; negative behind it."""
        return (points_m[:, self.axis] - self.at_m) * self.inward

    def spans(self, points_m: np.ndarray) -> np.ndarray:
        """Return whether points [N, 3] are in front of or behind the wall, not beside it."""
        along, height = points_m[:, 1 - self.axis], points_m[:, 2]
        beside = (along < self.from_m) | (along > self.to_m)
        return ~beside & (height > self.bottom_m) & (height < self.top_m)


def remove_wall_guesses(grid: OccupancyGrid, rooms: Sequence[Layout]) -> OccupancyGrid:
    """Return a grid without stereo errors in front of and behind the walls of its rooms.

    Args:
        grid: Cleaned grid.
        rooms: Rooms in the room frame.
    """
    cells = np.argwhere(grid.source != UNSEEN)
    points_m = cell_centers_m(cells, grid.origin_m, grid.voxel_m)
    occupied, colour = grid.occupied[tuple(cells.T)], grid.colour[tuple(cells.T)].astype(np.float32)
    hidden, guessed = _outside(rooms, points_m), np.zeros(len(cells), bool)
    for room in rooms:
        for edge in wall_edges(room):
            spanned, depth_m = edge.spans(points_m), edge.depth_m(points_m)
            face = occupied & spanned & (np.abs(depth_m) < FACE_M)
            if _seen_share(edge, points_m[face], grid.voxel_m) < SEEN_SHARE:
                hidden &= ~(spanned & (depth_m < 0))
                continue
            hidden &= ~(_opened(room, edge, points_m) & (depth_m < 0))
            before = occupied & spanned & (depth_m > FACE_M) & (depth_m < BEFORE_M)
            paint = (points_m[face], colour[face])
            guessed[before] |= _alike(edge, *paint, points_m[before], colour[before])
    return _emptied(grid, cells[hidden], cells[guessed & ~hidden])


def complete_walls(grid: OccupancyGrid, rooms: Sequence[Layout]) -> OccupancyGrid:
    """Return a labelled grid with the unseen parts of seen walls, floors and ceilings completed.

    Free cells of a wall are also completed if the wall continues all around them, since they were
    carved by wrong depth behind the wall.

    Args:
        grid: Labelled grid.
        rooms: Rooms in the room frame.
    """
    classes = np.zeros(grid.shape, np.uint8)
    for room in rooms:
        _mark_levels(classes, grid, room)
        for edge in wall_edges(room):
            _mark_wall(classes, grid, room, edge)
    labels, source = np.array(grid.labels), np.array(grid.source)
    confidence = np.array(grid.confidence)
    found = (classes > 0) & ~grid.occupied
    labels[found], source[found], confidence[found] = classes[found], COMPLETED, CONFIDENCE
    labels[_flat_on_walls(grid, rooms)] = SemanticClass.WALL
    return replace(grid, labels=labels, source=source, confidence=confidence)


def _flat_on_walls(grid: OccupancyGrid, rooms: Sequence[Layout]) -> np.ndarray:
    """Return the mask of objects too flat on a wall for stereo, bool [X, Y, Z]."""
    objects = (grid.labels >= SemanticClass.CHAIR) & (grid.labels <= SemanticClass.OBJS)
    cells = np.argwhere(objects)
    points_m = cell_centers_m(cells, grid.origin_m, grid.voxel_m)
    flat = np.zeros(len(cells), bool)
    for room in rooms:
        for edge in wall_edges(room):
            flat |= edge.spans(points_m) & (np.abs(edge.depth_m(points_m)) < FACE_M)
    found = np.zeros(grid.shape, bool)
    found[tuple(cells[flat].T)] = True
    return found


def _mark_levels(classes: np.ndarray, grid: OccupancyGrid, room: Layout) -> None:
    """Mark the unseen cells of a room's floor layer and, if a ceiling was seen, its layer."""
    columns = np.argwhere(np.ones(grid.shape[:2], bool))
    plan_m = grid.origin_m[:2] + (columns + 0.5) * grid.voxel_m
    inside = inside_polygon(plan_m, room.floor_polygon_m, 0.0).reshape(grid.shape[:2])
    half, floor_m = grid.voxel_m / 2, room.floor_z_m
    levels = [(floor_m - half, SemanticClass.FLOOR)]
    if (grid.labels == SemanticClass.CEILING).any():
        levels.append((floor_m + room.wall_height_m + half, SemanticClass.CEILING))
    for z_m, class_id in levels:
        layer = int(np.floor((z_m - grid.origin_m[2]) / grid.voxel_m))
        if 0 <= layer < grid.shape[2]:
            classes[:, :, layer][inside & (grid.source[:, :, layer] == UNSEEN)] = class_id


def _mark_wall(classes: np.ndarray, grid: OccupancyGrid, room: Layout, edge: WallEdge) -> None:
    """Mark the cells of a wall if enough of it was seen."""
    middle_m = edge.at_m - edge.inward * grid.voxel_m / 2
    layer = int(np.floor((middle_m - grid.origin_m[edge.axis]) / grid.voxel_m))
    if not 0 <= layer < grid.shape[edge.axis]:
        return
    at = [slice(None)] * 3
    at[edge.axis] = layer  # type: ignore[call-overload]
    cells = np.argwhere(np.ones(grid.labels[tuple(at)].shape, bool))
    cells = np.insert(cells, edge.axis, layer, axis=1)
    points_m = cell_centers_m(cells, grid.origin_m, grid.voxel_m)
    seen = grid.occupied[tuple(cells.T)] & edge.spans(points_m)
    if _seen_share(edge, points_m[seen], grid.voxel_m) < SEEN_SHARE:
        return
    wall = edge.spans(points_m) & ~_opened(room, edge, points_m)
    shape = classes[tuple(at)].shape
    around = ndimage.binary_closing(np.pad(seen.reshape(shape), HOLE_CELLS), iterations=HOLE_CELLS)
    around = around[HOLE_CELLS:-HOLE_CELLS, HOLE_CELLS:-HOLE_CELLS].reshape(-1)
    unseen = grid.source[tuple(cells.T)] == UNSEEN
    classes[tuple(cells[wall & (unseen | around)].T)] = SemanticClass.WALL


def wall_edges(room: Layout) -> list[WallEdge]:
    """Return the axis-aligned sides of a room's outline."""
    corners = room.floor_polygon_m
    edges = []
    for start, end in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        run = np.abs(end - start)
        if run.min() > 1e-6 or run.max() < 1e-6:
            continue
        axis = int(np.argmin(run))
        # The outline runs counter-clockwise: the room lies to the left of each side.
        inward = -(end - start)[1] if axis == 0 else (end - start)[0]
        low, high = sorted((start[1 - axis], end[1 - axis]))
        bottom = room.floor_z_m
        span_m = (float(low), float(high), bottom, bottom + room.wall_height_m)
        edges.append(WallEdge(axis, float(start[axis]), float(np.sign(inward)), *span_m))
    return edges


def _outside(rooms: Sequence[Layout], points_m: np.ndarray) -> np.ndarray:
    """Return whether points [N, 3] are outside all rooms by more than a wall's thickness."""
    outside = np.ones(len(points_m), bool)
    sides = np.array([[x, y] for x in (-THICK_M, THICK_M) for y in (-THICK_M, THICK_M)])
    for room in rooms:
        top_m = room.floor_z_m + room.wall_height_m + THICK_M
        within = (points_m[:, 2] > room.floor_z_m - THICK_M) & (points_m[:, 2] < top_m)
        for side in sides:
            moved_m = points_m[:, :2] + side
            outside &= ~(within & inside_polygon(moved_m, room.floor_polygon_m, 0.0))
    return outside if rooms else np.zeros(len(points_m), bool)


def _seen_share(edge: WallEdge, face_m: np.ndarray, voxel_m: float) -> float:
    """Return the share of a wall's columns in which its face was seen."""
    columns = np.floor((face_m[:, 1 - edge.axis] - edge.from_m) / voxel_m)
    return len(np.unique(columns)) / max(1.0, (edge.to_m - edge.from_m) / voxel_m)


def _opened(room: Layout, edge: WallEdge, points_m: np.ndarray) -> np.ndarray:
    """Return whether points are in front of or behind a transparent opening of a wall."""
    opened = np.zeros(len(points_m), bool)
    for one in room.openings:
        if np.abs(np.array([one.start_m, one.end_m])[:, edge.axis] - edge.at_m).max() > FACE_M:
            continue
        low, high = sorted((one.start_m[1 - edge.axis], one.end_m[1 - edge.axis]))
        along, height = points_m[:, 1 - edge.axis], points_m[:, 2] - room.floor_z_m
        opened |= (along > low) & (along < high) & (height > one.sill_m) & (height < one.head_m)
    return opened


def _alike(
    edge: WallEdge, face_m: np.ndarray, face: np.ndarray, at_m: np.ndarray, colour: np.ndarray
) -> np.ndarray:
    """Return whether the colours of positions match the wall behind them."""
    if len(face_m) < AROUND or not len(at_m):
        return np.zeros(len(at_m), bool)
    plane = [1 - edge.axis, 2]
    _, nearest = KDTree(face_m[:, plane]).query(at_m[:, plane], k=AROUND)
    behind = np.median(face[nearest], axis=1)
    return np.abs(behind - colour).max(axis=1) < ALIKE


def _emptied(grid: OccupancyGrid, hidden: np.ndarray, guessed: np.ndarray) -> OccupancyGrid:
    """Return a grid with some cells set to unseen and others to free."""
    labels, source = np.array(grid.labels), np.array(grid.source)
    confidence = np.array(grid.confidence)
    at = tuple(hidden.T)
    labels[at], source[at], confidence[at] = UNKNOWN, UNSEEN, 0
    labels[tuple(guessed.T)] = SemanticClass.EMPTY
    return replace(grid, labels=labels, source=source, confidence=confidence)
