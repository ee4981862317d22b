"""Physical plausibility of layouts: collisions, out-of-bounds objects, floating and lost objects.

The inputs are objects as boxes (ObjectInstance, LayoutObject), placements, or labels. Boxes are
compared in metres, before rasterization, so that touching furniture does not collide.

A **collision** is an intersection of solid parts. A placement consists of its template's parts or
its own cells (``furniture.solid_parts``): a chair pushed under a table does not collide, but a
chair whose back intersects the table top does. For objects that are only boxes, the whole box is
solid. ``overlapping_boxes`` counts overlapping boxes regardless of their parts, as the layout
methods of the paper do.

**Semantic integrity** follows the paper: the number of object categories of the true room that the
scene contains, divided by the number of all its categories (``category_integrity``).
``kept_objects`` returns the detected objects that are still represented by blocks of their class
and object id in their place.
"""

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import numpy as np

from world2minecraft.core.classes import OBJECT_CLASSES, STRUCTURE_CLASSES
from world2minecraft.core.coordinates import apply, invert
from world2minecraft.core.types import BlockVolume, Layout, ObjectInstance, OccupancyGrid, Placement
from world2minecraft.furniture.solid_parts import depth_m, solids_m
from world2minecraft.geometry.connected_components import label_components

OVERLAP_M = 0.04  # Half a default cell: less than the resolution of sizes read from cells.
OUTSIDE_M = 0.04  # The same, for boxes that reach into walls.


@dataclass(frozen=True, eq=False)
class Floaters:
    """Object parts without structural support: their number, their cells and their mask."""

    parts: int
    cells: int
    mask: np.ndarray  # bool [X, Y, Z]


def collisions(
    objects: Sequence[Any], tolerance_m: float = OVERLAP_M, grid: OccupancyGrid | None = None
) -> list[tuple[int, int]]:
    """Return the pairs of indices of objects whose solid parts intersect, sorted.

    Two parts intersect if they must be moved by more than ``tolerance_m`` to be separated. Several
    placements of one object (the segments of an L shape) do not collide.

    Args:
        objects: ObjectInstance, LayoutObject or Placement objects.
        tolerance_m: Overlap depth in metres that is tolerated.
        grid: Grid with the cells of placements that are built from their own cells. Without it, the
            whole box of such a placement is solid.
    """
    pairs = overlapping_boxes(objects, tolerance_m)
    touched = {index for pair in pairs for index in pair if isinstance(objects[index], Placement)}
    solid = {index: solids_m(objects[index], grid) for index in touched}
    return [
        (m, n)
        for m, n in pairs
        if not (m in solid and n in solid) or depth_m(solid[m], solid[n]) > tolerance_m
    ]


def overlapping_boxes(
    objects: Sequence[Any], tolerance_m: float = OVERLAP_M
) -> list[tuple[int, int]]:
    """Return the pairs of indices of objects whose boxes overlap, sorted.

    Args:
        objects: ObjectInstance, LayoutObject or Placement objects, with ``center_m``, ``size_m``
            along their own axes, ``yaw_deg`` or ``quarter_turns``, and optionally ``object_id``.
        tolerance_m: Overlap depth in metres that is tolerated.
    """
    pairs = []
    for (m, a), (n, b) in combinations(enumerate(objects), 2):
        owner = getattr(a, "object_id", None)
        same = owner is not None and owner == getattr(b, "object_id", None)
        if not same and overlap_depth_m(a, b) > tolerance_m:
            pairs.append((m, n))
    return pairs


def overlap_depth_m(a: Any, b: Any) -> float:
    """Return the smallest displacement in metres that separates two boxes, or 0 if disjoint.

    Boxes are upright and rotated about z. They are disjoint if a side of either box separates them
    in plan, or if they do not overlap in height (separating axis theorem).
    """
    gap_z = abs(a.center_m[2] - b.center_m[2])
    depths = [(a.size_m[2] + b.size_m[2]) / 2 - gap_z]
    corners_a, corners_b = plan_corners_m(a), plan_corners_m(b)
    for corners in (corners_a, corners_b):
        for side in (corners[1] - corners[0], corners[2] - corners[1]):
            length = np.hypot(*side)
            if length == 0:
                continue
            along_a, along_b = corners_a @ side / length, corners_b @ side / length
            depths.append(min(along_a.max() - along_b.min(), along_b.max() - along_a.min()))
    return float(max(min(depths), 0.0))


def out_of_bounds(
    objects: Sequence[Any],
    floor_polygon_m: np.ndarray,
    height_m: float | None = None,
    tolerance_m: float = OUTSIDE_M,
    floor_z_m: float = 0.0,
) -> list[int]:
    """Return the indices of objects that extend outside the room.

    Args:
        objects: Objects, as for ``overlapping_boxes``.
        floor_polygon_m: Inner outline of the room, float [N, 2], a simple polygon in either
            direction.
        height_m: Height of the ceiling above the floor in metres. None ignores the ceiling.
        tolerance_m: Distance in metres that a box may extend outside.
        floor_z_m: z coordinate of the floor in metres.
    """
    polygon = np.asarray(floor_polygon_m, np.float64)
    if polygon.ndim != 2 or polygon.shape[1] != 2 or len(polygon) < 3:
        raise ValueError(f"floor_polygon_m must have shape [N, 2] with N >= 3, got {polygon.shape}")
    outside = []
    for index, item in enumerate(objects):
        bottom = item.center_m[2] - item.size_m[2] / 2 - floor_z_m
        top = item.center_m[2] + item.size_m[2] / 2 - floor_z_m
        upright = bottom >= -tolerance_m and (height_m is None or top <= height_m + tolerance_m)
        if not (upright and inside_polygon(_outline_m(item), polygon, tolerance_m).all()):
            outside.append(index)
    return outside


def out_of_rooms(objects: Sequence[Any], rooms: Sequence[Layout]) -> list[int]:
    """Return the indices of objects that are not completely inside any of several rooms.

    Without rooms, no object is outside.
    """
    outside = set(range(len(objects))) if rooms else set()
    for room in rooms:
        outside &= set(
            out_of_bounds(
                objects, room.floor_polygon_m, room.wall_height_m, floor_z_m=room.floor_z_m
            )
        )
    return sorted(outside)


def category_integrity(built: Collection[int], true: Collection[int]) -> float:
    """Return the paper's semantic integrity: the share of the true categories that are present.

    Args:
        built: Class ids of the scene. Only object classes, 5 to 11, are counted.
        true: Class ids of the true room. The result is 1 if there are none.
    """
    wanted = set(true) & set(OBJECT_CLASSES)
    return len(wanted & set(built)) / len(wanted) if wanted else 1.0


def kept_objects(
    volume: BlockVolume,
    instances: Sequence[ObjectInstance],
    grid: OccupancyGrid,
    least_share: float = 0.5,
) -> list[int]:
    """Return the indices of objects that are still represented by blocks of their class.

    An object is kept if at least ``least_share`` of its cells are in, or within one block of, a
    block with its object id and class. The margin of one block accounts for objects on tables,
    which move up to the next free block.

    Args:
        volume: The build.
        instances: The detected objects.
        grid: Grid with the cells of the objects.
        least_share: Minimum share of an object's cells. The default is a half, because templates
            omit noise.
    """
    room_to_block = invert(volume.block_to_room)
    reach_m = max(grid.voxel_m, 1 / volume.blocks_per_metre)
    shape = np.array(volume.states.shape)
    retained = []
    for index, one in enumerate(instances):
        centers_m = grid.origin_m + (one.cells + 0.5) * grid.voxel_m
        shown = np.zeros(len(centers_m), bool)
        for step in np.vstack([np.zeros((1, 3)), np.eye(3), -np.eye(3)]):
            points = apply(room_to_block, centers_m + step * reach_m) - volume.corner
            blocks = np.floor(points + 1e-9).astype(np.int64)
            inside = ((blocks >= 0) & (blocks < shape)).all(axis=1)
            at = tuple(np.clip(blocks, 0, shape - 1).T)
            same = (volume.instance[at] == one.id) & (volume.semantic[at] == one.class_id)
            shown |= inside & same
        if len(shown) and shown.mean() >= least_share:
            retained.append(index)
    return retained


def floaters(labels: np.ndarray) -> Floaters:
    """Return the connected parts of a label grid that contain objects but touch no structure.

    Cells are connected by a face, an edge or a corner. Objects on a floor, on a table on a floor,
    on a wall or on a ceiling are supported.

    Args:
        labels: Labels, uint8 [X, Y, Z], ids 0 to 11 or 255.
    """
    is_object = np.isin(labels, OBJECT_CLASSES)
    structure = np.isin(labels, STRUCTURE_CLASSES)
    parts, count = label_components(is_object | structure)
    carried = np.zeros(count + 1, bool)
    carried[np.unique(parts[structure])] = True
    mask = is_object & ~carried[parts]
    return Floaters(len(np.unique(parts[mask])), int(mask.sum()), mask)


def plan_corners_m(item: Any) -> np.ndarray:
    """Return the four corners of an object's box seen from above, in order, float64 [4, 2]."""
    turned = hasattr(item, "yaw_deg")
    angle = np.radians(item.yaw_deg if turned else 90.0 * item.quarter_turns)
    forward = np.array([np.cos(angle), np.sin(angle)])
    left = np.array([-forward[1], forward[0]])
    ahead, aside = forward * item.size_m[0] / 2, left * item.size_m[1] / 2
    center = np.asarray(item.center_m[:2])
    return np.array(
        [
            center - ahead - aside,
            center + ahead - aside,
            center + ahead + aside,
            center - ahead + aside,
        ]
    )


def _outline_m(item: Any) -> np.ndarray:
    """Return the corners and points about every 10 cm between them, for concave rooms."""
    corners = plan_corners_m(item)
    points = []
    for start, end in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        steps = max(int(np.ceil(np.hypot(*(end - start)) / 0.1)), 1)
        points.append(start + (end - start) * (np.arange(steps) / steps)[:, None])
    return np.concatenate(points)


def inside_polygon(points_m: np.ndarray, polygon_m: np.ndarray, tolerance_m: float) -> np.ndarray:
    """Return which points [M, 2] are inside a polygon [N, 2] or near its outline, as bool [M]."""
    start, end = polygon_m, np.roll(polygon_m, -1, axis=0)
    side = end - start
    to_point = points_m[:, None] - start[None]
    square = np.maximum((side**2).sum(axis=1), 1e-12)
    along = np.clip((to_point * side).sum(axis=2) / square, 0, 1)
    distance_m = np.linalg.norm(to_point - along[..., None] * side, axis=2).min(axis=1)
    crosses = (start[:, 1] > points_m[:, None, 1]) != (end[:, 1] > points_m[:, None, 1])
    height = np.where(side[:, 1] == 0, 1.0, side[:, 1])
    at_x = start[:, 0] + (points_m[:, None, 1] - start[:, 1]) * side[:, 0] / height
    odd = (crosses & (points_m[:, None, 0] < at_x)).sum(axis=1) % 2 == 1
    return odd | (distance_m <= tolerance_m)
