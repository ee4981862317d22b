"""The last tenths of a degree: one turn that lays all large faces along the axes at once.

Gravity and walls are found one after the other, each from its own few surfaces. Here floor,
ceilings, walls and large fronts say together how the frame still leans and turns: each face that
looks along an axis is a plane across it, at a place of its own, and one small turn of the frame
must fit them all.
"""

from dataclasses import dataclass

import numpy as np

from world2minecraft.capture.alignment.places import BIN_M, LIFT_M, looks
from world2minecraft.capture.alignment.surface import Profile, profile
from world2minecraft.geometry.oriented_points import Surface
from world2minecraft.geometry.rotation import rotation_of_vector

FACING = 0.97  # Cosine of 14 degrees.
FACE_LEAST_M2 = 0.5
FACE_SHARE = 0.15  # Of the largest that looks the same way.
LIMITS_M = (0.05, 0.03, 0.02, 0.012, 0.012)
SPREADS = 8.0  # A level face's limit is at least that many times the median distance from it.
# Walls lean and tables stand askew more often than floors slope: with one say for all, the shared
# kitchen's floor would lean by 0.5 degrees.
WALL_SAY, FLOOR_SAY = 0.1, 4.0
STEADY_M2 = 0.02  # Moments that a face must exceed to be heard: 0.15 m from its middle on average.


@dataclass(frozen=True, eq=False)
class Faces:
    """Patches on large faces: ``points_m`` float64 [N, 3], ``axis`` and ``face`` int64 [N]."""

    points_m: np.ndarray
    axis: np.ndarray
    face: np.ndarray
    weight: np.ndarray
    count: int


def straightening_turn(level: Surface) -> np.ndarray:
    """Return the small rotation [3, 3] that lays large faces along the axes.

    Args:
        level: in a frame that is right within about two degrees; the turn is about its origin.
    """
    turn = np.eye(3)
    faces = find_faces(level)
    if faces.count == 0:
        return turn
    for limit_m in LIMITS_M:
        turn = rotation_of_vector(_step(faces, faces.points_m @ turn.T, limit_m)) @ turn
    return turn


def find_faces(level: Surface) -> Faces:
    """Return the patches that lie on large faces across an axis, each in one face."""
    points, axes, owners, weights, count = [], [], [], [], 0
    for axis in range(3):
        for sign in (-1.0, 1.0):
            facing = np.flatnonzero(sign * level.normals[:, axis] > FACING)
            along = level.points_m[facing, axis]
            found = profile(level.points_m[facing], axis)
            least = max(FACE_LEAST_M2, FACE_SHARE * float(found.area_m2.max()))
            for place in _apart(found, least):
                near = facing[np.abs(along - place) < LIMITS_M[0]]
                points.append(level.points_m[near])
                axes.append(np.full(len(near), axis))
                owners.append(np.full(len(near), count))
                noise = 1 / (level.sigma_m[near] ** 2 + LIFT_M**2)
                say = WALL_SAY if axis < 2 else FLOOR_SAY if abs(place) < LIMITS_M[0] else 1.0
                weights.append(say * noise / looks(level.points_m[near], axis))
                count += 1
    if not count:
        return Faces(np.zeros((0, 3)), np.zeros(0, int), np.zeros(0, int), np.zeros(0), 0)
    points, weights = np.concatenate(points), np.concatenate(weights)
    return Faces(points, np.concatenate(axes), np.concatenate(owners), weights, count)


def _apart(found: Profile, least_m2: float) -> list[float]:
    """Return the peaks that have no larger one within twice the first limit."""
    largest_first = sorted(found.peaks(least_m2), key=lambda place: -found.area_at(float(place)))
    kept: list[float] = []
    for place in largest_first:
        if all(abs(place - other) > 2 * LIMITS_M[0] for other in kept):
            kept.append(float(place))
    return kept


def _step(faces: Faces, points: np.ndarray, limit_m: float) -> np.ndarray:
    """Return the turn vector [3] that flattens the faces, by one reweighted step (Tukey)."""
    index = np.arange(len(points))
    along = points[index, faces.axis]
    places = _fullest_places(faces, along)
    # Where depth bends, a narrow limit would choose among the bends of a floor; a wall's parts a
    # few centimetres apart are to be told apart whatever the spread.
    off = np.abs(along - places[faces.face])
    level = faces.axis == 2
    spread_m = float(np.median(off[level])) if level.any() else 0.0
    limits_m = np.where(level, max(limit_m, SPREADS * spread_m), limit_m)
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
        moment[range(3), range(3)] += STEADY_M2 * weight.sum()
        turn = turn - np.linalg.solve(moment, centred.T @ (weight * off))
    return turn


def _fullest_places(faces: Faces, along: np.ndarray) -> np.ndarray:
    """Return where most weight of each face gathers within 3 cm, in steps of 1 cm."""
    places = np.zeros(faces.count)
    for face in range(faces.count):
        own, weight = along[faces.face == face], faces.weight[faces.face == face]
        bins = np.floor((own - own.min()) / BIN_M).astype(np.int64)
        held = np.convolve(np.bincount(bins, weight), np.ones(3), mode="same")
        places[face] = own.min() + (int(np.argmax(held)) + 0.5) * BIN_M
    return places
