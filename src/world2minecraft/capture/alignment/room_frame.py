"""The room's frame in the scan: gravity, floor, walls, and a check of the room's size.

In: views in the scan's frame, any tilt and turn. Out: ``scan_to_room``, which puts the floor at
z = 0, the walls along x and y and the inner corner of the room at (0, 0, 0). Of the four quarter
turns that this leaves open, the one is taken in which the first camera looks towards +y (north
in the game), so that the result does not depend on the frame that the capture chose.

Gravity and walls are found one after the other, each from its own few surfaces. The last tenths of
a degree come from floor, ceilings, walls and large fronts together: each face across an axis is a
plane at a position of its own, and one small rotation must fit them all.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from world2minecraft.capture.alignment.axis_profiles import (
    BIN_M,
    MIN_SIGMA_M,
    AxisProfile,
    axis_profile,
    face_position_m,
    points_per_cell,
)
from world2minecraft.capture.alignment.gravity import Ground, find_ground, rotation_to_z
from world2minecraft.capture.alignment.walls import RoomBox, find_room_box, find_yaw
from world2minecraft.core.coordinates import COMPASS_OF_SIDE, rotation_about_z
from world2minecraft.core.types import Scan, View
from world2minecraft.geometry.oriented_points import OrientedPoints, collect_oriented_points
from world2minecraft.geometry.rotations import rotation_from_vector

MIN_FACING_COSINE = 0.97  # Cosine of 14 degrees.
MIN_FACE_M2 = 0.5
MIN_FACE_SHARE = 0.15  # Of the largest that looks the same way.
LIMITS_M = (0.05, 0.03, 0.02, 0.012, 0.012)
SPREAD_FACTOR = 8.0  # A level face's limit is at least that many times the median distance from it.
# Walls lean and tables stand askew more often than floors slope: with equal weights, the shared
# kitchen's floor would lean by 0.5 degrees.
WALL_WEIGHT, FLOOR_WEIGHT = 0.1, 4.0
DAMPING_M2 = 0.02  # Moments that a face must exceed to count: 0.15 m from its middle on average.
SIDE_RANGE_M = (1.2, 40.0)  # A shower room and a hall; outside, the unit is wrong or it is no room.
HEIGHT_RANGE_M = (1.5, 12.0)
MIN_POINTS = 500
DECIMALS = 9
UNSEEN_NOTE_STARTS = ("no floor was seen", "no wall was seen", "no ceiling was seen")
CAMERA_CLEARANCE_M = (0.3, 0.3, 0.1)  # What a person needs behind and over a hand-held camera.


@dataclass(frozen=True, eq=False)
class Faces:
    """Patches on large faces: ``points_m`` float64 [N, 3], ``axis`` and ``face`` int64 [N]."""

    points_m: np.ndarray
    axis: np.ndarray
    face: np.ndarray
    weight: np.ndarray
    count: int


def axis_aligning_rotation(level: OrientedPoints) -> np.ndarray:
    """Return the small rotation [3, 3] that lays large faces along the axes.

    Args:
        level: in a frame that is right within about two degrees; the turn is about its origin.
    """
    turn = np.eye(3)
    faces = find_faces(level)
    if faces.count == 0:
        return turn
    for limit_m in LIMITS_M:
        turn = (
            rotation_from_vector(_gauss_newton_step(faces, faces.points_m @ turn.T, limit_m)) @ turn
        )
    return turn


def find_faces(level: OrientedPoints) -> Faces:
    """Return the patches that lie on large faces across an axis, each in one face."""
    points, axes, owners, weights, count = [], [], [], [], 0
    for axis in range(3):
        for sign in (-1.0, 1.0):
            facing = np.flatnonzero(sign * level.normals[:, axis] > MIN_FACING_COSINE)
            along = level.points_m[facing, axis]
            found = axis_profile(level.points_m[facing], axis)
            least = max(MIN_FACE_M2, MIN_FACE_SHARE * float(found.area_m2.max()))
            for place in _separate_peaks(found, least):
                near = facing[np.abs(along - place) < LIMITS_M[0]]
                points.append(level.points_m[near])
                axes.append(np.full(len(near), axis))
                owners.append(np.full(len(near), count))
                noise = 1 / (level.sigma_m[near] ** 2 + MIN_SIGMA_M**2)
                face_weight = (
                    WALL_WEIGHT if axis < 2 else FLOOR_WEIGHT if abs(place) < LIMITS_M[0] else 1.0
                )
                weights.append(face_weight * noise / points_per_cell(level.points_m[near], axis))
                count += 1
    if not count:
        return Faces(np.zeros((0, 3)), np.zeros(0, int), np.zeros(0, int), np.zeros(0), 0)
    points, weights = np.concatenate(points), np.concatenate(weights)
    return Faces(points, np.concatenate(axes), np.concatenate(owners), weights, count)


def _separate_peaks(found: AxisProfile, min_area_m2: float) -> list[float]:
    """Return the peaks that have no larger one within twice the first limit."""
    largest_first = sorted(found.peaks(min_area_m2), key=lambda place: -found.area_at(float(place)))
    separate: list[float] = []
    for place in largest_first:
        if all(abs(place - other) > 2 * LIMITS_M[0] for other in separate):
            separate.append(float(place))
    return separate


def _gauss_newton_step(faces: Faces, points: np.ndarray, limit_m: float) -> np.ndarray:
    """Return the turn vector [3] that flattens the faces, by one reweighted step (Tukey)."""
    index = np.arange(len(points))
    along = points[index, faces.axis]
    places = _densest_positions(faces, along)
    # Where depth bends, a narrow limit would choose among the bends of a floor; a wall's parts a
    # few centimetres apart are to be told apart whatever the spread.
    off = np.abs(along - places[faces.face])
    level = faces.axis == 2
    spread_m = float(np.median(off[level])) if level.any() else 0.0
    limits_m = np.where(level, max(limit_m, SPREAD_FACTOR * spread_m), limit_m)
    # A turn w moves a point by w x p; these are its parts along the face's axis.
    rows = np.zeros_like(points)
    rows[index, (faces.axis + 1) % 3] = points[index, (faces.axis + 2) % 3]
    rows[index, (faces.axis + 2) % 3] = -points[index, (faces.axis + 1) % 3]
    turn = np.zeros(3)
    for _ in range(3):
        off = along + rows @ turn - places[faces.face]
        weight = faces.weight * np.where(
            np.abs(off) < limits_m, (1 - (off / limits_m) ** 2) ** 2, 0
        )
        mass = np.bincount(faces.face, weight, faces.count)
        mass = np.maximum(mass, 1e-12)
        places = places + np.bincount(faces.face, weight * off, faces.count) / mass
        means = [np.bincount(faces.face, weight * rows[:, a], faces.count) / mass for a in range(3)]
        centred = rows - np.stack(means, axis=1)[faces.face]
        off = along + rows @ turn - places[faces.face]
        moment = centred.T @ (centred * weight[:, None])
        moment[range(3), range(3)] += DAMPING_M2 * weight.sum()
        turn = turn - np.linalg.solve(moment, centred.T @ (weight * off))
    return turn


def _densest_positions(faces: Faces, along: np.ndarray) -> np.ndarray:
    """Return where most weight of each face gathers within 3 cm, in steps of 1 cm."""
    places = np.zeros(faces.count)
    for face in range(faces.count):
        own, weight = along[faces.face == face], faces.weight[faces.face == face]
        bins = np.floor((own - own.min()) / BIN_M).astype(np.int64)
        held = np.convolve(np.bincount(bins, weight), np.ones(3), mode="same")
        places[face] = own.min() + (int(np.argmax(held)) + 0.5) * BIN_M
    return places


@dataclass(frozen=True)
class Alignment:
    """The room's place: ``scan_to_room`` 4x4, ``room_size_m`` float64 [3], notes for the report."""

    scan_to_room: np.ndarray
    room_size_m: np.ndarray
    notes: tuple[str, ...]


class ImplausibleRoomError(ValueError):
    """The surface cannot be a room; the message states why and what to do."""


def align(views: Iterable[View], up_hint: np.ndarray | None = None) -> Alignment:
    """Find the room in some views of a scan, read once and one at a time.

    Args:
        views: of one scan's frame, in any tilt and turn.
        up_hint: as ``find_ground`` takes it.

    Raises:
        ImplausibleRoomError: too little surface was seen, or the size is no room's.
    """
    surface = collect_oriented_points(views)
    if len(surface.points_m) < MIN_POINTS:
        raise ImplausibleRoomError(
            f"only {len(surface.points_m)} places of the depth images are smooth surface; "
            f"at least {MIN_POINTS} are needed: is this depth of a room?"
        )
    return align_surface(surface, up_hint)


def align_surface(surface: OrientedPoints, up_hint: np.ndarray | None = None) -> Alignment:
    """Find the room in oriented points of the scan's frame; ``find_ground`` takes the hint."""
    ground = find_ground(surface, up_hint)
    scan_to_level = np.eye(4)
    scan_to_level[:3, :3] = rotation_to_z(ground.up)
    scan_to_level[2, 3] = -ground.height_m
    level = surface.transformed(scan_to_level)
    scan_to_level = _rotation_to_walls(level) @ scan_to_level
    level = surface.transformed(scan_to_level)
    scan_to_level = _axis_alignment(level, ground.floor_area_m2 > 0) @ scan_to_level
    level = surface.transformed(scan_to_level)
    box = find_room_box(level)
    low_m, high_m = _extend_to_cameras(box, level)
    level_to_room = np.eye(4)
    level_to_room[:3, 3] = -low_m
    size = high_m - low_m
    _check_size(size)
    # Sums in another order, as with other threads, differ in the last bits; files must not.
    scan_to_room = np.round(level_to_room @ scan_to_level, DECIMALS)
    return Alignment(scan_to_room, np.round(size, DECIMALS), _notes(ground, box, size))


def realign(scan: Scan, surface: OrientedPoints) -> Scan:
    """Return a scan whose room is found again in a better surface of its frame.

    Where that is no plausible room, or nothing was seen by depth, the scan stays as it is.
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
    )


def _rotation_to_walls(level: OrientedPoints) -> np.ndarray:
    """Return the turn about z that puts walls along the axes and the first camera's look to +y."""
    yaw_deg = find_yaw(level)
    view_direction = rotation_about_z(-yaw_deg)[:2, :2] @ level.cameras[0, :2, 2]
    heading_deg = np.degrees(np.arctan2(view_direction[1], view_direction[0]))
    quarters = round((90.0 - heading_deg) / 90.0)
    return rotation_about_z(90.0 * quarters) @ rotation_about_z(-yaw_deg)


def _axis_alignment(level: OrientedPoints, has_floor: bool) -> np.ndarray:
    """Return the small move that lays all large faces along the axes and the floor on 0."""
    move = np.eye(4)
    move[:3, :3] = axis_aligning_rotation(level)
    if has_floor:
        turned = level.transformed(move)
        move[2, 3] = -face_position_m(
            turned.subset(turned.normals[:, 2] > MIN_FACING_COSINE), 2, 0.0
        )
    return move


def _extend_to_cameras(box: RoomBox, level: OrientedPoints) -> tuple[np.ndarray, np.ndarray]:
    """Return the box's corners, moved out behind the cameras at the sides where none was seen.

    Whoever held the camera stood in the room, even where no frame looks at the wall behind.
    """
    low, high = box.low_m.copy(), box.high_m.copy()
    places = level.cameras[:, :3, 3]
    for axis, name in enumerate("xyz"):
        if f"{name}+" not in box.seen:
            high[axis] = max(high[axis], places[:, axis].max() + CAMERA_CLEARANCE_M[axis])
        if axis < 2 and f"{name}-" not in box.seen:
            low[axis] = min(low[axis], places[:, axis].min() - CAMERA_CLEARANCE_M[axis])
    return low, high


def _check_size(size: np.ndarray) -> None:
    sides = (
        ("long", size[0], SIDE_RANGE_M),
        ("deep", size[1], SIDE_RANGE_M),
        ("high", size[2], HEIGHT_RANGE_M),
    )
    for word, length, (least, maximum) in sides:
        if not least <= length <= maximum:
            raise ImplausibleRoomError(
                f"the room would be {size[0]:.2f} x {size[1]:.2f} x {size[2]:.2f} m; {least:g} to "
                f"{maximum:g} m {word} is plausible: check the depth unit and that poses are in "
                "metres"
            )


def _notes(ground: Ground, box: RoomBox, size: np.ndarray) -> tuple[str, ...]:
    notes = []
    if ground.floor_area_m2 == 0:
        notes.append("no floor was seen; the lowest points stand for it")
    sides = [name for side, name in COMPASS_OF_SIDE.items() if side not in box.seen]
    if sides:
        names = f"the {' and '.join(sides)} side{'s' * (len(sides) > 1)}"
        notes.append(f"no wall was seen at {names}; the room ends where its points end")
    if "z+" not in box.seen:
        notes.append(f"no ceiling was seen; the room is taken to be {size[2]:.2f} m high")
    return tuple(notes)
