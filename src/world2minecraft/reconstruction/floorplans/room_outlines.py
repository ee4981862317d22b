"""The outlines of a plan's rooms, and the frame in which its walls are along x and y."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from world2minecraft.core.coordinates import apply, rotation_about_z
from world2minecraft.core.types import Layout, LayoutObject, Opening
from world2minecraft.formats.roomplan import CapturedPlan, PlanObject, PlanRoom, PlanSurface
from world2minecraft.reconstruction.floorplans.furniture_categories import class_of
from world2minecraft.reconstruction.floorplans.wall_directions import main_direction_rad, snap_room

CORNER_M = 0.5  # Walls whose ends are closer meet in a corner.
USUAL_HEIGHT_M = 2.5  # Height of a room whose plan has a floor but no walls.
PARALLEL = 0.2  # Sine under which two walls are one line.


@dataclass(frozen=True, eq=False)
class PlacedRoom:
    """A room of a plan with its outline, float64 [N, 2], counter-clockwise from above."""

    room: PlanRoom
    outline_m: np.ndarray
    floor_z_m: float
    height_m: float
    closed: bool  # Whether its walls or its floor gave the outline; else it is the box around it.


def move_plan(plan: CapturedPlan, move: np.ndarray) -> CapturedPlan:
    """Transform a plan to another frame with z up by a 4x4 rotation about z and translation."""
    rooms = tuple(
        replace(
            room,
            walls=tuple(_moved_surface(wall, move) for wall in room.walls),
            openings=tuple(_moved_surface(opening, move) for opening in room.openings),
            objects=tuple(_moved_object(item, move) for item in room.objects),
            floors=tuple(apply(move, floor) for floor in room.floors),
        )
        for room in plan.rooms
    )
    back = plan.plan_to_session @ np.linalg.inv(move)
    return replace(plan, rooms=rooms, plan_to_session=back)


def straighten_plan(plan: CapturedPlan) -> CapturedPlan:
    """Rotate a plan so that its walls are along x and y, with its lowest floor at z = 0.

    The plan is aligned with the direction that most of its wall length follows. The first wall is
    along x, or near it, and the minimum corner of the plan is at x = y = 0. Walls within a few
    degrees of a multiple of 45 degrees are turned to it.
    """
    walls = [wall for room in plan.rooms for wall in room.walls]
    if walls:
        main = main_direction_rad(walls)
        along = walls[0].end_m - walls[0].start_m
        quarters = np.round((np.arctan2(along[1], along[0]) - main) / (np.pi / 2)) * np.pi / 2
        plan = move_plan(plan, rotation_about_z(-float(np.degrees(main + quarters))))
        plan = replace(plan, rooms=tuple(snap_room(room) for room in plan.rooms))
    placed = place_plan_rooms(plan)
    low = np.min([room.outline_m.min(axis=0) for room in placed], axis=0)
    shift = np.eye(4)
    shift[:3, 3] = [-low[0], -low[1], -min(room.floor_z_m for room in placed)]
    return move_plan(plan, shift)


def place_plan_rooms(plan: CapturedPlan) -> tuple[PlacedRoom, ...]:
    """Return the rooms of a plan with their outlines, in the frame of the plan.

    The outline is that of the floor if available, otherwise the loop of the walls, otherwise their
    bounding box.
    """
    return tuple(_placed(room) for room in plan.rooms)


def layouts_of(plan: CapturedPlan) -> tuple[Layout, ...]:
    """Return the rooms of a plan as layouts with openings and objects, in the plan's frame."""
    return tuple(_layout(placed) for placed in place_plan_rooms(plan))


def _layout(placed: PlacedRoom) -> Layout:
    room = placed.room
    return Layout(
        floor_polygon_m=placed.outline_m,
        wall_height_m=placed.height_m,
        openings=tuple(_opening(one, placed.floor_z_m) for one in room.openings),
        objects=tuple(_object(one) for one in room.objects),
        floor_z_m=placed.floor_z_m,
        name=room.name,
    )


def _opening(surface: PlanSurface, floor_z_m: float) -> Opening:
    sill = max(surface.bottom_m - floor_z_m, 0.0) if surface.kind == "window" else 0.0
    head = max(surface.top_m - floor_z_m, sill + 0.05)
    kind = surface.kind if surface.kind != "wall" else "doorway"
    return Opening(kind, surface.start_m, surface.end_m, sill, head)


def _object(item: PlanObject) -> LayoutObject:
    return LayoutObject(
        class_of(item), item.center_m, item.size_m, item.yaw_deg, item.category or "object"
    )


def _placed(room: PlanRoom) -> PlacedRoom:
    floors = [floor for floor in room.floors if len(floor) >= 3]
    outline = max((floor[:, :2] for floor in floors), key=_area, default=None)
    closed = True
    if outline is None:
        outline = _loop(room.walls)
    if outline is None or abs(_area(outline)) < 0.5:
        ends = np.array([end for wall in room.walls for end in (wall.start_m, wall.end_m)])
        low, high = ends.min(axis=0), np.maximum(ends.max(axis=0), ends.min(axis=0) + 0.5)
        outline, closed = np.array([low, [high[0], low[1]], high, [low[0], high[1]]]), False
    if _signed_area(outline) < 0:
        outline = outline[::-1]
    bottoms = [wall.bottom_m for wall in room.walls] + [float(f[:, 2].mean()) for f in floors]
    tops = [wall.top_m for wall in room.walls]
    floor_z = float(np.median(bottoms))
    height = float(np.median(tops)) - floor_z if tops else USUAL_HEIGHT_M
    return PlacedRoom(room, np.asarray(outline, np.float64), floor_z, max(height, 0.5), closed)


def _loop(walls: Sequence[PlanSurface]) -> np.ndarray | None:
    """Return the corners of the walls connected to a loop, or None if the loop is open."""
    if len(walls) < 3:
        return None
    left = sorted(walls, key=lambda wall: -wall.length_m)
    chain = [(left[0].start_m, left[0].end_m)]
    left = left[1:]
    while left:
        here = chain[-1][1]
        away, index, flipped = min(
            (float(np.linalg.norm(end - here)), index, flipped)
            for index, wall in enumerate(left)
            for flipped, end in ((False, wall.start_m), (True, wall.end_m))
        )
        home = float(np.linalg.norm(chain[0][0] - here))
        if len(chain) >= 3 and home <= min(away, CORNER_M):
            break
        if away > CORNER_M:
            return None
        wall = left.pop(index)
        chain.append((wall.end_m, wall.start_m) if flipped else (wall.start_m, wall.end_m))
    if len(chain) < 3 or np.linalg.norm(chain[0][0] - chain[-1][1]) > CORNER_M:
        return None
    pairs = zip(chain, [*chain[1:], chain[0]], strict=True)
    return np.array([_corner(one, other) for one, other in pairs])


def _corner(one: tuple, other: tuple) -> np.ndarray:
    """Return the corner of two walls: the intersection of their lines or the mean of their ends."""
    middle = (one[1] + other[0]) / 2
    a, b = one[1] - one[0], other[1] - other[0]
    cross = a[0] * b[1] - a[1] * b[0]
    if abs(cross) < PARALLEL * np.linalg.norm(a) * np.linalg.norm(b):
        return middle
    gap = other[0] - one[0]
    meet = one[0] + a * (gap[0] * b[1] - gap[1] * b[0]) / cross
    return meet if np.linalg.norm(meet - middle) <= CORNER_M else middle


def _signed_area(outline: np.ndarray) -> float:
    x, y = outline[:, 0], outline[:, 1]
    return float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y) / 2)


def _area(outline: np.ndarray) -> float:
    return abs(_signed_area(outline))


def _moved_surface(surface: PlanSurface, move: np.ndarray) -> PlanSurface:
    ends = np.array([[*surface.start_m, 0.0], [*surface.end_m, 0.0]])
    start, end = apply(move, ends)[:, :2]
    up = float(move[2, 3])
    return replace(
        surface,
        start_m=start,
        end_m=end,
        bottom_m=surface.bottom_m + up,
        top_m=surface.top_m + up,
    )


def _moved_object(item: PlanObject, move: np.ndarray) -> PlanObject:
    turn = float(np.degrees(np.arctan2(move[1, 0], move[0, 0])))
    return replace(
        item,
        center_m=apply(move, item.center_m),
        yaw_deg=round((item.yaw_deg + turn) % 360, 6),
    )
