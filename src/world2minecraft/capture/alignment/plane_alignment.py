"""Rotation of a nearly aligned scan that levels its horizontal faces and squares its walls.

Every large face across an axis is fitted as a plane of its own. Its slope says how the scan leans,
and how far it can be trusted:

- The error of a depth camera bends smoothly over a frame by an amount that grows with the squared
  distance, so the many points of one face do not average it out. A face's slope is uncertain by
  that bend over the face's extent, however many points it has. The bend is measured from what the
  planes leave over.
- Real faces lean: floors hardly, table tops and counters a little, walls and doors more.

The normals of all level patches together, and gravity as the device reported it, join as further
observations. All of them are weighed by their variances in one robust least-squares problem, so a
scrap of floor cannot tip a room whose table says otherwise. The result carries its covariance.
"""

from dataclasses import dataclass

import numpy as np

from world2minecraft.capture.alignment.axis_profiles import (
    AxisProfile,
    axis_profile,
    points_per_cell,
    tukey_weights,
)
from world2minecraft.geometry.oriented_points import OrientedPoints, cell_codes
from world2minecraft.geometry.rotations import rotation_from_vector

MIN_FACING_COSINE = 0.97  # Cosine of 14 degrees.
MIN_FACE_M2 = 0.25
MIN_FACE_SHARE = 0.08  # Minimum area, as a share of the largest face in the same direction.
BAND_M = 0.06  # Distance from a face's position within which patches belong to it.
LIMITS_M = (0.06, 0.05, 0.04, 0.03, 0.03)  # Tukey limits of the plane fit, one per iteration.
MIN_FACE_PATCHES = 15
MIN_EXTENT_M = 0.05  # A narrower strip does not define a slope across.
# How far real faces lean, in degrees (one sigma).
FLOOR_LEAN_DEG, LEVEL_LEAN_DEG, WALL_LEAN_DEG, WALL_YAW_DEG = 0.1, 0.7, 2.0, 0.5
NORMALS_SIGMA_DEG, NORMALS_CONE_DEG = 0.5, 4.0
GRAVITY_SIGMA_DEG = 1.0  # A phone's gravity is better, but its world drifts.
BEND_PER_M2 = 0.003  # Of a structured-light camera; used where no face is large enough to measure.
BEND_RANGE_PER_M2 = (0.0005, 0.01)
BEND_OFFSET_M = 0.001
BEND_CELL_M = 0.2
MIN_BEND_CELLS = 8
ROUNDS, ROBUST_STEPS = 4, 8
PRIOR_RAD = 10.0  # Keeps directions that nothing observes where they are.


@dataclass(frozen=True, eq=False)
class PlanarFace:
    """The patches of one face: their indices in the surface, and the sign of their normals."""

    axis: int
    sign: float
    position_m: float
    members: np.ndarray


@dataclass(frozen=True, eq=False)
class PlaneFit:
    """The plane fitted to a face: ``p[axis] = position + slope . (uv - centre)``.

    Attributes:
        slope: Slopes along the other two axes u and v, float64 [2].
        covariance_m2: float64 [2, 2], spread of the patches over the face.
        distance4_m4: Mean fourth power of the patches' distances from their cameras.
        bend: Sums (squared residuals of cell means, fourth powers of distance, cells) that
            measure the bend; zeros if the face is too small.
    """

    face: PlanarFace
    slope: np.ndarray
    covariance_m2: np.ndarray
    distance4_m4: float
    bend: np.ndarray


@dataclass(frozen=True, eq=False)
class Observations:
    """The linear system ``rows @ turn = values`` for a rotation vector ``turn`` in radians."""

    rows: np.ndarray
    values: np.ndarray
    variances: np.ndarray


@dataclass(frozen=True, eq=False)
class PlaneAlignment:
    """A small rotation and its uncertainty.

    Attributes:
        rotation: float64 [3, 3], to be applied on the left.
        sigma_deg: float64 [3] about x, y and z.
        bend_per_m2: Smooth error of the depth in metres per squared metre of distance.
    """

    rotation: np.ndarray
    sigma_deg: np.ndarray
    bend_per_m2: float = BEND_PER_M2


def align_planes(level: OrientedPoints, up_hint: np.ndarray | None = None) -> PlaneAlignment:
    """Return the small rotation that aligns the large faces of a scan with the axes.

    Args:
        level: Surface in a frame with z up, whose axes are correct to about three degrees. The
            rotation is about its origin.
        up_hint: Unit vector float64 [3] in the same frame that the device reported as up.
    """
    turn = np.eye(3)
    sigma, bend_per_m2 = np.full(3, np.inf), BEND_PER_M2
    for _ in range(ROUNDS):
        moved = _rotated(level, turn)
        fits = [fit for face in find_faces(moved) if (fit := fit_plane(moved, face)) is not None]
        bend_per_m2 = _bend_per_m2(fits)
        observed = [_slope_observations(fits, bend_per_m2), _normal_observations(moved)]
        if up_hint is not None:
            observed.append(_up_observations(turn @ up_hint, GRAVITY_SIGMA_DEG))
        step, sigma = _solve(observed)
        turn = rotation_from_vector(step) @ turn
    return PlaneAlignment(turn, sigma, bend_per_m2)


def _rotated(surface: OrientedPoints, rotation: np.ndarray) -> OrientedPoints:
    transform = np.eye(4)
    transform[:3, :3] = rotation
    return surface.transformed(transform)


def find_faces(level: OrientedPoints) -> list[PlanarFace]:
    """Return the large faces perpendicular to each axis; faces within 12 cm count as one."""
    faces = []
    for axis in range(3):
        for sign in (-1.0, 1.0):
            facing = np.flatnonzero(sign * level.normals[:, axis] > MIN_FACING_COSINE)
            along = level.points_m[facing, axis]
            profile = axis_profile(level.points_m[facing], axis)
            least = max(MIN_FACE_M2, MIN_FACE_SHARE * float(profile.area_m2.max()))
            for position in _separate_peaks(profile, least):
                members = facing[np.abs(along - position) < BAND_M]
                faces.append(PlanarFace(axis, sign, position, members))
    return faces


def _separate_peaks(profile: AxisProfile, min_area_m2: float) -> list[float]:
    """Return the peaks that have no larger one within twice the band."""
    peaks = profile.peaks(min_area_m2)
    largest_first = sorted(peaks, key=lambda position: -profile.area_at(float(position)))
    separate: list[float] = []
    for position in largest_first:
        if all(abs(position - other) > 2 * BAND_M for other in separate):
            separate.append(float(position))
    return separate


def fit_plane(surface: OrientedPoints, face: PlanarFace) -> PlaneFit | None:
    """Fit a plane to a face by reweighted least squares (Tukey); None if too few patches fit.

    Patches share the weight of their 10 cm cell, so that a part seen often does not count more.
    """
    points = surface.points_m[face.members]
    uv, along = points[:, [(face.axis + 1) % 3, (face.axis + 2) % 3]], points[:, face.axis]
    eyes = surface.cameras[surface.owner[face.members], :3, 3]
    distance_m = np.linalg.norm(points - eyes, axis=1)
    error_m = BEND_OFFSET_M + BEND_PER_M2 * distance_m**2
    base = 1 / (surface.sigma_m[face.members] ** 2 + error_m**2)
    base /= points_per_cell(points, face.axis)
    plane, centre = np.array([0.0, 0.0, face.position_m]), np.zeros(2)
    weight = base
    for limit_m in LIMITS_M:
        off = _off_plane(uv, along, plane, centre)
        weight = base * tukey_weights(off, limit_m)
        if np.count_nonzero(weight) < MIN_FACE_PATCHES:
            return None
        plane, centre = _weighted_plane(uv, along, weight)
    total = weight.sum()
    off = _off_plane(uv, along, plane, centre)
    return PlaneFit(
        face,
        plane[:2],
        ((uv - centre).T * weight) @ (uv - centre) / total,
        float(np.sum(weight * distance_m**4) / total),
        _bend_sums(uv, off, weight, distance_m),
    )


def _off_plane(
    uv: np.ndarray, along: np.ndarray, plane: np.ndarray, centre: np.ndarray
) -> np.ndarray:
    return along - (uv - centre) @ plane[:2] - plane[2]


def _weighted_plane(
    uv: np.ndarray, along: np.ndarray, weight: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the plane (two slopes and a position) by least squares, and the centre of ``uv``."""
    centre = np.average(uv, axis=0, weights=weight)
    columns = np.column_stack([uv - centre, np.ones(len(uv))])
    moment = columns.T @ (columns * weight[:, None])
    moment[[0, 1], [0, 1]] += weight.sum() * MIN_EXTENT_M**2
    return np.linalg.solve(moment, columns.T @ (weight * along)), centre


def _bend_sums(
    uv: np.ndarray, off: np.ndarray, weight: np.ndarray, distance_m: np.ndarray
) -> np.ndarray:
    """Return what cells of 20 cm leave over after the plane; see ``PlaneFit.bend``."""
    _, index = np.unique(cell_codes(uv, BEND_CELL_M), return_inverse=True)
    mass = np.bincount(index, weight)
    kept = mass > 0
    count = int(kept.sum())
    if count < MIN_BEND_CELLS:
        return np.zeros(3)
    mean_off = np.bincount(index, weight * off)[kept] / mass[kept]
    mean_d2 = np.bincount(index, weight * distance_m**2)[kept] / mass[kept]
    freedom = count / (count - 3)
    return np.array([freedom * np.sum(mean_off**2), np.sum(mean_d2**2), count])


def _bend_per_m2(fits: list[PlaneFit]) -> float:
    """Return the bend of the depth in metres per squared metre of distance."""
    residual, distance, count = np.sum([np.zeros(3), *(fit.bend for fit in fits)], axis=0)
    measured = np.sqrt(residual / distance) if count else BEND_PER_M2
    return float(np.clip(measured, *BEND_RANGE_PER_M2))


def _slope_observations(fits: list[PlaneFit], bend_per_m2: float) -> Observations:
    """Return each face's slope along its two principal directions, which the turn must undo."""
    rows, values, variances = [np.zeros((0, 3))], [np.zeros(0)], [np.zeros(0)]
    for fit in fits:
        u, v = (fit.face.axis + 1) % 3, (fit.face.axis + 2) % 3
        spread, directions = np.linalg.eigh(fit.covariance_m2)
        bend2 = BEND_OFFSET_M**2 + bend_per_m2**2 * fit.distance4_m4
        row = np.zeros((2, 3))
        row[:, u], row[:, v] = directions[1], -directions[0]
        rows.append(row)
        values.append(-(fit.slope @ directions))
        variances.append(bend2 / np.maximum(spread, 1e-6) + _lean_variances(fit, row))
    return Observations(np.concatenate(rows), np.concatenate(values), np.concatenate(variances))


def _lean_variances(fit: PlaneFit, rows: np.ndarray) -> np.ndarray:
    """Return the variance by which a real face of this kind leans in two directions, rad^2."""
    if fit.face.axis == 2:
        is_floor = fit.face.sign > 0 and abs(fit.face.position_m) < BAND_M
        return np.full(2, np.radians(FLOOR_LEAN_DEG if is_floor else LEVEL_LEAN_DEG) ** 2)
    share = rows[:, 2] ** 2  # Of the turn about z; the rest is a lean from the vertical.
    yaw, lean = np.radians(WALL_YAW_DEG) ** 2, np.radians(WALL_LEAN_DEG) ** 2
    return share * yaw + (1 - share) * lean


def _normal_observations(level: OrientedPoints) -> Observations:
    """Return the mean normal of all level patches, each 10 cm cell counted once."""
    near = np.abs(level.normals[:, 2]) > np.cos(np.radians(NORMALS_CONE_DEG))
    if np.count_nonzero(near) < MIN_FACE_PATCHES:
        return Observations(np.zeros((0, 3)), np.zeros(0), np.zeros(0))
    normals = level.normals[near] * np.sign(level.normals[near, 2])[:, None]
    weight = 1 / points_per_cell(level.points_m[near], 2)
    return _up_observations(np.average(normals, axis=0, weights=weight), NORMALS_SIGMA_DEG)


def _up_observations(up: np.ndarray, sigma_deg: float) -> Observations:
    """Return the two observations that turn a direction near z to z."""
    variance = np.radians(sigma_deg) ** 2
    return Observations(np.eye(3)[:2], np.array([up[1], -up[0]]), np.full(2, variance))


def _solve(observed: list[Observations]) -> tuple[np.ndarray, np.ndarray]:
    """Return the turn [3] in radians and its sigmas [3] in degrees (Cauchy weights)."""
    rows = np.concatenate([one.rows for one in observed])
    values = np.concatenate([one.values for one in observed])
    variances = np.concatenate([one.variances for one in observed])
    turn, moment = np.zeros(3), np.eye(3) / PRIOR_RAD**2
    for _ in range(ROBUST_STEPS):
        turn, moment = _robust_step(rows, values, variances, turn)
    return turn, np.degrees(np.sqrt(np.diag(np.linalg.inv(moment))))


def _robust_step(
    rows: np.ndarray, values: np.ndarray, variances: np.ndarray, turn: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the turn weighed by what an earlier one leaves over, and its normal matrix."""
    off = rows @ turn - values
    weight = 1 / (variances + off**2)
    moment = rows.T @ (rows * weight[:, None]) + np.eye(3) / PRIOR_RAD**2
    return np.linalg.solve(moment, rows.T @ (weight * values)), moment
