"""Where the room is in the scan: gravity, floor, walls, and whether its size is plausible.

In: views in the scan's frame, any tilt and turn. Out: ``scan_to_room``, which puts the floor at
z = 0, the walls along x and y and the inner corner of the room at (0, 0, 0). Of the four quarter
turns that this leaves open, that one is taken in which the first camera looks towards +y (north
in the game), so that the result does not depend on the frame that the capture chose.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from world2minecraft.capture.alignment.gravity import Ground, find_ground, frame_of_up
from world2minecraft.capture.alignment.places import face_place_m
from world2minecraft.capture.alignment.straighten import FACING, straightening_turn
from world2minecraft.capture.alignment.walls import Box, find_box, find_yaw
from world2minecraft.core.coordinates import COMPASS_OF_SIDE, rotation_about_z
from world2minecraft.core.types import Scan, View
from world2minecraft.geometry.oriented_points import Surface, collect_surface

SIDE_M = (1.2, 40.0)  # A shower room and a hall; outside, the unit is wrong or it is no room.
HEIGHT_M = (1.5, 12.0)
LEAST_POINTS = 500
DECIMALS = 9
UNSEEN_NOTES = ("no floor was seen", "no wall was seen", "no ceiling was seen")
ELBOW_M = (0.3, 0.3, 0.1)  # What a person needs behind and over a hand-held camera.


@dataclass(frozen=True)
class Alignment:
    """The room's place: ``scan_to_room`` 4x4, ``room_size_m`` float64 [3], notes for the report."""

    scan_to_room: np.ndarray
    room_size_m: np.ndarray
    notes: tuple[str, ...]


class ImplausibleRoomError(ValueError):
    """What was seen cannot be a room; the text says why and what to do."""


def align(views: Iterable[View], up_hint: np.ndarray | None = None) -> Alignment:
    """Find the room in some views of a scan, read once and one at a time.

    Args:
        views: of one scan's frame, in any tilt and turn.
        up_hint: as ``find_ground`` takes it.

    Raises:
        ImplausibleRoomError: too little surface was seen, or the size is no room's.
    """
    surface = collect_surface(views)
    if len(surface.points_m) < LEAST_POINTS:
        raise ImplausibleRoomError(
            f"only {len(surface.points_m)} places of the depth images are smooth surface; "
            f"at least {LEAST_POINTS} are needed: is this depth of a room?"
        )
    return align_surface(surface, up_hint)


def align_surface(surface: Surface, up_hint: np.ndarray | None = None) -> Alignment:
    """Find the room in oriented points of the scan's frame; ``find_ground`` takes the hint."""
    ground = find_ground(surface, up_hint)
    scan_to_level = np.eye(4)
    scan_to_level[:3, :3] = frame_of_up(ground.up)
    scan_to_level[2, 3] = -ground.height_m
    level = surface.turned(scan_to_level)
    scan_to_level = _turn_to_walls(level) @ scan_to_level
    level = surface.turned(scan_to_level)
    scan_to_level = _straightened(level, ground.floor_area_m2 > 0) @ scan_to_level
    level = surface.turned(scan_to_level)
    box = find_box(level)
    low_m, high_m = _with_cameras(box, level)
    level_to_room = np.eye(4)
    level_to_room[:3, 3] = -low_m
    size = high_m - low_m
    _check_size(size)
    # Sums in another order, as with other threads, differ in the last bits; files must not.
    scan_to_room = np.round(level_to_room @ scan_to_level, DECIMALS)
    return Alignment(scan_to_room, np.round(size, DECIMALS), _notes(ground, box, size))


def realigned(scan: Scan, surface: Surface) -> Scan:
    """Return a scan whose room is found anew in a better surface of its frame.

    Where that is no plausible room, or nothing was seen by depth, the scan stays as it is.
    """
    if not len(surface.points_m):
        return scan
    try:
        found = align_surface(surface, scan.world_up)
    except ImplausibleRoomError:
        return scan
    notes = tuple(note for note in scan.notes if not note.startswith(UNSEEN_NOTES))
    return replace(
        scan,
        scan_to_room=found.scan_to_room,
        room_size_m=found.room_size_m,
        notes=(*notes, *found.notes),
    )


def _turn_to_walls(level: Surface) -> np.ndarray:
    """Return the turn about z that puts walls along the axes and the first camera's look to +y."""
    yaw_deg = find_yaw(level)
    look = rotation_about_z(-yaw_deg)[:2, :2] @ level.cameras[0, :2, 2]
    heading_deg = np.degrees(np.arctan2(look[1], look[0]))
    quarters = round((90.0 - heading_deg) / 90.0)
    return rotation_about_z(90.0 * quarters) @ rotation_about_z(-yaw_deg)


def _straightened(level: Surface, has_floor: bool) -> np.ndarray:
    """Return the small move that lays all large faces along the axes and the floor on 0."""
    move = np.eye(4)
    move[:3, :3] = straightening_turn(level)
    if has_floor:
        turned = level.turned(move)
        move[2, 3] = -face_place_m(turned.chosen(turned.normals[:, 2] > FACING), 2, 0.0)
    return move


def _with_cameras(box: Box, level: Surface) -> tuple[np.ndarray, np.ndarray]:
    """Return the box's corners, moved out behind the cameras at the sides where none was seen.

    Whoever held the camera stood in the room, even where no frame looks at the wall behind.
    """
    low, high = box.low_m.copy(), box.high_m.copy()
    places = level.cameras[:, :3, 3]
    for axis, name in enumerate("xyz"):
        if f"{name}+" not in box.seen:
            high[axis] = max(high[axis], places[:, axis].max() + ELBOW_M[axis])
        if axis < 2 and f"{name}-" not in box.seen:
            low[axis] = min(low[axis], places[:, axis].min() - ELBOW_M[axis])
    return low, high


def _check_size(size: np.ndarray) -> None:
    sides = (("long", size[0], SIDE_M), ("deep", size[1], SIDE_M), ("high", size[2], HEIGHT_M))
    for word, length, (least, most) in sides:
        if not least <= length <= most:
            raise ImplausibleRoomError(
                f"the room would be {size[0]:.2f} x {size[1]:.2f} x {size[2]:.2f} m; {least:g} to "
                f"{most:g} m {word} is plausible: check the depth unit and that poses are in metres"
            )


def _notes(ground: Ground, box: Box, size: np.ndarray) -> tuple[str, ...]:
    notes = []
    if ground.floor_area_m2 == 0:
        notes.append("no floor was seen; the lowest points stand for it")
    sides = [name for side, name in COMPASS_OF_SIDE.items() if side not in box.seen]
    if sides:
        told = f"the {' and '.join(sides)} side{'s' * (len(sides) > 1)}"
        notes.append(f"no wall was seen at {told}; the room ends where its points end")
    if "z+" not in box.seen:
        notes.append(f"no ceiling was seen; the room is taken to be {size[2]:.2f} m high")
    return tuple(notes)
