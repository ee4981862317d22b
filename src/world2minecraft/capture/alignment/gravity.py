"""Estimation of the up direction and of the floor's plane.

Up is the direction that much surface faces, that the cameras' image rows are level to, and that
their image columns point away from; the floor is then fitted as a plane.
"""

from dataclasses import dataclass

import numpy as np

from world2minecraft.capture.alignment.axis_profiles import axis_profile
from world2minecraft.geometry.oriented_points import OrientedPoints

DIRECTIONS = 2000  # Fibonacci points on the sphere: about 4.5 degrees apart.
MAX_VOTERS = 4000
VOTE_CONE_DEG = 8.0
ROLL_SIGMA = 0.20  # Sine of how far a hand-held camera rolls.
MAX_FACING_DEG = 20.0
MAX_HINT_OFFSET_DEG = 10.0  # ARKit's own world leans by under a degree, one that drifted by a few.
MIN_FLOOR_M2 = 0.3
# Of the largest level surface: a table top is smaller than that many floors.
MIN_FLOOR_SHARE = 0.15
FLOOR_BAND_M = 0.15  # The first guess of up is off by under 2 degrees, over 4 m.
PATCH_M = 0.05
MAX_BELOW_SHARE = 0.02  # Points that reflections and noise put under a true floor.


@dataclass(frozen=True)
class Ground:
    """``up`` is a unit vector of the scan's frame; the floor is where ``up . p = height_m``."""

    up: np.ndarray
    height_m: float
    floor_area_m2: float  # 0 where no floor was seen and the lowest points stand for it.


def find_ground(surface: OrientedPoints, up_hint: np.ndarray | None = None) -> Ground:
    """Return up and the floor's plane; see the module's text.

    Args:
        surface: oriented points of the scan's frame.
        up_hint: unit vector float64 [3] where the capture knows up, as a phone does by its sense
            of gravity; then up lies within 10 degrees of it, and is it where no surface says more.
    """
    voted = _vote_up(surface) if up_hint is None else up_hint
    refined = _refine_up(surface.normals, voted)
    up = refined if _is_near(refined, up_hint) else voted
    height, area = _floor_height(surface, up)
    if area == 0:
        return Ground(up, height, 0.0)
    for _ in range(2):
        fitted, fitted_height = _fit_floor(surface, up, height)
        if not _is_near(fitted, up_hint):
            break
        up, height = fitted, fitted_height
    return Ground(up, height, area)


def _is_near(up: np.ndarray, up_hint: np.ndarray | None) -> bool:
    return up_hint is None or bool(up @ up_hint >= np.cos(np.radians(MAX_HINT_OFFSET_DEG)))


def _vote_up(surface: OrientedPoints) -> np.ndarray:
    """Return the best of many directions by support, level image rows and upright images."""
    directions = _fibonacci_sphere(DIRECTIONS)
    every = max(1, len(surface.normals) // MAX_VOTERS)
    voters = surface.normals[::every]
    near = np.abs(directions @ voters.T) > np.cos(np.radians(VOTE_CONE_DEG))
    support = near.mean(axis=1) + 1e-4
    right, down = surface.cameras[:, :3, 0], surface.cameras[:, :3, 1]
    roll = np.mean((right @ directions.T) ** 2, axis=0)
    upright = np.clip(-(down @ directions.T).mean(axis=0), 0.02, 1)
    score = np.log(support) - roll / (2 * ROLL_SIGMA**2) + 2 * np.log(upright)
    return directions[int(np.argmax(score))]


def _fibonacci_sphere(count: int) -> np.ndarray:
    """Return float64 [count, 3] unit vectors, evenly spread (Fibonacci's spiral)."""
    index = np.arange(count) + 0.5
    z = 1 - 2 * index / count
    angle = index * np.pi * (1 + 5**0.5)
    flat = np.sqrt(1 - z * z)
    return np.stack([flat * np.cos(angle), flat * np.sin(angle), z], axis=1)


def _refine_up(normals: np.ndarray, up: np.ndarray) -> np.ndarray:
    """Move a direction to the middle of the normals around it, in narrowing cones."""
    for within_deg in (10.0, 7.0, 5.0, 4.0, 4.0):
        near = normals[np.abs(normals @ up) > np.cos(np.radians(within_deg))]
        if len(near) < 10:
            return up
        _, vectors = np.linalg.eigh(near.T @ near)
        up = vectors[:, -1] * np.sign(vectors[:, -1] @ up)
    return up


def _floor_height(surface: OrientedPoints, up: np.ndarray) -> tuple[float, float]:
    """Return the height of the lowest large surface that faces up, and its area in m2."""
    frame = rotation_to_z(up)
    points = surface.points_m @ frame.T
    facing = points[surface.normals @ up > np.cos(np.radians(MAX_FACING_DEG))]
    found = axis_profile(facing, axis=2)
    heights = np.sort(points[:, 2])
    for height in found.peaks(max(MIN_FLOOR_M2, MIN_FLOOR_SHARE * found.area_m2.max())):
        if np.searchsorted(heights, height - 0.10) <= MAX_BELOW_SHARE * len(heights):
            return float(height), found.area_at(float(height))
    return float(np.quantile(heights, 0.005)), 0.0


def rotation_to_z(up: np.ndarray) -> np.ndarray:
    """Return a rotation [3, 3] that carries ``up`` to +z; the turn about it is arbitrary."""
    other = np.eye(3)[int(np.argmin(np.abs(up)))]
    x = np.cross(other, up)
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(up, x), up])


def _fit_floor(
    surface: OrientedPoints, up: np.ndarray, height_m: float
) -> tuple[np.ndarray, float]:
    """Fit the floor's plane by reweighted least squares (Tukey), starting from ``up``.

    Patches weigh alike however often they were looked at: by pixels alone, the floor nearest to
    the camera, with its own bend of the depth, would tip the kitchen's floor by 0.3 degrees.
    """
    frame = rotation_to_z(up)
    points = surface.points_m @ frame.T
    level = surface.normals @ up > np.cos(np.radians(MAX_FACING_DEG))
    points = points[level & (np.abs(points[:, 2] - height_m) < FLOOR_BAND_M)]
    share = 1 / (_patch_counts(points) + 3.0)
    plane = np.array([0.0, 0.0, height_m])  # z = a x + b y + c
    middle = np.zeros(2)
    for limit_m in (0.08, 0.06, 0.04, 0.03, 0.03):
        off = points[:, 2] - (points[:, :2] - middle) @ plane[:2] - plane[2]
        weight = np.where(np.abs(off) < limit_m, (1 - (off / limit_m) ** 2) ** 2, 0.0)
        if np.count_nonzero(weight) < 20:
            break
        weight *= share
        shift = np.average(points[:, :2], axis=0, weights=weight)
        columns = np.column_stack([points[:, :2] - shift, np.ones(len(points))])
        moment = columns.T @ (columns * weight[:, None])
        # A floor strip narrower than about 20 cm cannot say how it leans across.
        moment[[0, 1], [0, 1]] += 0.01 * weight.sum() * 0.2**2
        plane, middle = np.linalg.solve(moment, columns.T @ (weight * points[:, 2])), shift
    normal = np.array([-plane[0], -plane[1], 1.0])
    size = np.linalg.norm(normal)
    return normal / size @ frame, float((plane[2] - plane[:2] @ middle) / size)


def _patch_counts(points: np.ndarray) -> np.ndarray:
    """Return for each point how many points its patch of the plan holds."""
    patches = np.floor(points[:, :2] / PATCH_M).astype(np.int64)
    patches -= patches.min(axis=0, initial=0)
    code = patches[:, 0] * (patches[:, 1].max(initial=0) + 1) + patches[:, 1]
    _, index, counts = np.unique(code, return_inverse=True, return_counts=True)
    return counts[index]
