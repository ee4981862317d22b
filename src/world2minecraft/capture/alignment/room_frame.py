"""Estimation of the room frame of a scan from gravity, floor and walls, with a plausibility check.

The input is a set of views in an arbitrary frame. The result is ``scan_to_room``, which moves the
floor to z = 0, aligns the walls with x and y, and moves the inner corner of the room to (0, 0, 0).
Of the four remaining quarter turns, the one in which the first camera looks towards +y (north in
the game) is used, so that the result does not depend on the frame of the capture.

Gravity and walls are first estimated separately, each from a few surfaces. A joint refinement then
uses the floor, ceilings, walls and large furniture fronts: each face orthogonal to an axis is a
plane at its own position, and one small rotation must fit all of them.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from world2minecraft.capture.alignment.axis_profiles import face_position_m
from world2minecraft.capture.alignment.gravity import find_ground, rotation_to_z
from world2minecraft.capture.alignment.plane_alignment import (
    MIN_FACING_COSINE,
    PlaneAlignment,
    align_planes,
)
from world2minecraft.capture.alignment.walls import RoomBox, find_room_box, find_yaw
from world2minecraft.core.coordinates import COMPASS_OF_SIDE, rotation_about_z
from world2minecraft.core.types import FrameSigmas, Scan, View
from world2minecraft.geometry.oriented_points import OrientedPoints, collect_oriented_points

SIDE_RANGE_M = (1.2, 40.0)  # A shower room and a hall; outside, the unit is wrong or it is no room.
# A ceiling is a room's own height; without one, the capture may show the lower part of a room only.
HEIGHT_RANGE_M, SEEN_HEIGHT_RANGE_M = (1.5, 12.0), (0.6, 12.0)
MIN_POINTS = 500
FLOOR_BAND_M, MIN_FLOOR_SIGMA_M = 0.06, 0.003
MAX_TILT_SIGMA_DEG, MAX_YAW_SIGMA_DEG = 90.0, 45.0  # Standard deviations if nothing is known.
DECIMALS = 9
UNSEEN_NOTE_STARTS = ("no floor was seen", "no wall was seen", "no ceiling was seen")
CAMERA_CLEARANCE_M = (0.3, 0.3, 0.1)  # Space around a hand-held camera for the person, in metres.


@dataclass(frozen=True)
class Alignment:
    """The frame of a room.

    Attributes:
        scan_to_room: Rigid transform, float64 [4, 4].
        room_size_m: Size of the room in metres, float64 [3].
        notes: Remarks for the report.
        sigmas: Uncertainty of the frame; None if the capture states the frame.
    """

    scan_to_room: np.ndarray
    room_size_m: np.ndarray
    notes: tuple[str, ...]
    sigmas: FrameSigmas | None = None


@dataclass(frozen=True, eq=False)
class LevelFrame:
    """The level frame of a scan, with the walls along x and y.

    Attributes:
        scan_to_level: Rigid transform, float64 [4, 4]; the floor is at z = 0.
        floor_seen: Whether a floor was found; otherwise the lowest points are at z = 0.
        planes: Last refinement of the rotation, with its uncertainty.
    """

    scan_to_level: np.ndarray
    floor_seen: bool
    planes: PlaneAlignment


class ImplausibleRoomError(ValueError):
    """The surface is not a plausible room; the message states the reason and what to do."""


def align(views: Iterable[View], up_hint: np.ndarray | None = None) -> Alignment:
    """Estimate the room frame from views, which are read once and one at a time.

    Args:
        views: Views in the frame of the scan, which may have any orientation.
        up_hint: Up direction as for ``find_ground``, or None.

    Raises:
        ImplausibleRoomError: If there is too little surface, or the size is not plausible for a
            room.
    """
    surface = collect_oriented_points(views)
    if len(surface.points_m) < MIN_POINTS:
        raise ImplausibleRoomError(
            f"the depth images contain only {len(surface.points_m)} patches of smooth "
            f"surface, at least {MIN_POINTS} are required; check that the capture shows a "
            "room"
        )
    return align_surface(surface, up_hint)


def align_surface(surface: OrientedPoints, up_hint: np.ndarray | None = None) -> Alignment:
    """Estimate the room frame from oriented points in the frame of the scan.

    Args:
        surface: Oriented points in the frame of the scan.
        up_hint: Up direction as for ``find_ground``, or None.

    Raises:
        ImplausibleRoomError: If the size is not plausible for a room.
    """
    frame = find_level_frame(surface, up_hint)
    scan_to_level, level = frame.scan_to_level, surface.transformed(frame.scan_to_level)
    box = find_room_box(level)
    low_m, high_m = _extend_to_cameras(box, level)
    level_to_room = np.eye(4)
    level_to_room[:3, 3] = -low_m
    size = high_m - low_m
    _check_size(size, "z+" in box.seen)
    # Sums in another order, as with other threads, differ in the last bits; files must not.
    scan_to_room = np.round(level_to_room @ scan_to_level, DECIMALS)
    sigmas = _frame_sigmas(level, frame)
    return Alignment(scan_to_room, np.round(size, DECIMALS), _notes(frame, box, size), sigmas)


def find_level_frame(surface: OrientedPoints, up_hint: np.ndarray | None = None) -> LevelFrame:
    """Return the frame in which a surface is level, its walls along x and y and its floor at 0.

    Args:
        surface: Oriented points in metres, in any orientation.
        up_hint: Up direction as for ``find_ground``, or None.
    """
    ground = find_ground(surface, up_hint)
    floor_seen = ground.floor_area_m2 > 0
    scan_to_level = np.eye(4)
    scan_to_level[:3, :3] = rotation_to_z(ground.up)
    scan_to_level[2, 3] = -ground.height_m
    scan_to_level = _rotation_to_walls(surface.transformed(scan_to_level)) @ scan_to_level
    level = surface.transformed(scan_to_level)
    level_hint = None if up_hint is None else scan_to_level[:3, :3] @ up_hint
    planes = align_planes(level, level_hint)
    scan_to_level = _axis_alignment(level, planes, floor_seen) @ scan_to_level
    return LevelFrame(scan_to_level, floor_seen, planes)


def realign(scan: Scan, surface: OrientedPoints) -> Scan:
    """Return a scan whose room frame is estimated again from a better surface.

    The scan is returned unchanged if the surface is empty or not a plausible room.
    """
    if not len(surface.points_m):
        return scan
    try:
        found = align_surface(surface, scan.world_up)
    except ImplausibleRoomError:
        return scan
    notes = tuple(note for note in scan.notes if not note.startswith(UNSEEN_NOTE_STARTS))
    return replace(
        scan,
        scan_to_room=found.scan_to_room,
        room_size_m=found.room_size_m,
        notes=(*notes, *found.notes),
        frame_sigmas=found.sigmas,
    )


def _rotation_to_walls(level: OrientedPoints) -> np.ndarray:
    """Return the rotation about z that aligns walls with the axes and the first view with +y."""
    yaw_deg = find_yaw(level)
    view_direction = rotation_about_z(-yaw_deg)[:2, :2] @ level.cameras[0, :2, 2]
    heading_deg = np.degrees(np.arctan2(view_direction[1], view_direction[0]))
    quarters = round((90.0 - heading_deg) / 90.0)
    return rotation_about_z(90.0 * quarters) @ rotation_about_z(-yaw_deg)


def _axis_alignment(level: OrientedPoints, planes: PlaneAlignment, has_floor: bool) -> np.ndarray:
    """Return the small move that lays all large faces along the axes and the floor on 0."""
    move = np.eye(4)
    move[:3, :3] = planes.rotation
    if has_floor:
        turned = level.transformed(move)
        move[2, 3] = -face_position_m(
            turned.subset(turned.normals[:, 2] > MIN_FACING_COSINE), 2, 0.0
        )
    return move


def _frame_sigmas(level: OrientedPoints, frame: LevelFrame) -> FrameSigmas:
    """Return the uncertainty of an aligned frame; the floor's is the bend of the depth at it."""
    planes = frame.planes
    tilt_deg = min(float(np.sqrt(np.mean(planes.sigma_deg[:2] ** 2))), MAX_TILT_SIGMA_DEG)
    yaw_deg = min(float(planes.sigma_deg[2]), MAX_YAW_SIGMA_DEG)
    floor_m = None
    if frame.floor_seen:
        on_floor = (level.normals[:, 2] > MIN_FACING_COSINE) & (
            np.abs(level.points_m[:, 2]) < FLOOR_BAND_M
        )
        eyes = level.cameras[level.owner[on_floor], :3, 3]
        squared_m2 = np.sum((level.points_m[on_floor] - eyes) ** 2, axis=1)
        bend_m = planes.bend_per_m2 * float(np.median(squared_m2)) if len(squared_m2) else 0.0
        floor_m = round(float(np.hypot(bend_m, MIN_FLOOR_SIGMA_M)), 4)
    return FrameSigmas(round(tilt_deg, 3), round(yaw_deg, 3), floor_m)


def _extend_to_cameras(box: RoomBox, level: OrientedPoints) -> tuple[np.ndarray, np.ndarray]:
    """Return the corners of the box, extended behind the cameras at sides without a detected wall.

    The person with the camera was inside the room, even if no frame shows the wall behind.
    """
    low, high = box.low_m.copy(), box.high_m.copy()
    places = level.cameras[:, :3, 3]
    for axis, name in enumerate("xyz"):
        if f"{name}+" not in box.seen:
            high[axis] = max(high[axis], places[:, axis].max() + CAMERA_CLEARANCE_M[axis])
        if axis < 2 and f"{name}-" not in box.seen:
            low[axis] = min(low[axis], places[:, axis].min() - CAMERA_CLEARANCE_M[axis])
    return low, high


def _check_size(size: np.ndarray, ceiling_seen: bool) -> None:
    sides = (
        ("long", size[0], SIDE_RANGE_M),
        ("deep", size[1], SIDE_RANGE_M),
        ("high", size[2], HEIGHT_RANGE_M if ceiling_seen else SEEN_HEIGHT_RANGE_M),
    )
    for word, length, (least, maximum) in sides:
        if not least <= length <= maximum:
            raise ImplausibleRoomError(
                f"the room size would be {size[0]:.2f} x {size[1]:.2f} x {size[2]:.2f} m, but a "
                f"room should be {least:g} to {maximum:g} m {word}; check the depth unit and "
                "that poses are in metres"
            )


def _notes(frame: LevelFrame, box: RoomBox, size: np.ndarray) -> tuple[str, ...]:
    notes = []
    if not frame.floor_seen:
        notes.append("no floor was seen; the lowest points are used as floor height")
    sides = [name for side, name in COMPASS_OF_SIDE.items() if side not in box.seen]
    if sides:
        listed = " and ".join(filter(None, (", ".join(sides[:-1]), sides[-1])))
        names = f"the {listed} side{'s' * (len(sides) > 1)}"
        notes.append(f"no wall was seen at {names}; the room extends to the outermost points there")
    if "z+" not in box.seen:
        notes.append(f"no ceiling was seen; the room is at least {size[2]:.2f} m high")
    return tuple(notes)
