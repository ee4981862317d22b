"""First estimate of the up direction and of the floor's height.

Up is the direction that much surface faces, that the image rows of the cameras are level to, and
that their image columns point away from. ``plane_alignment`` refines it.
"""

from dataclasses import dataclass

import numpy as np

from world2minecraft.capture.alignment.axis_profiles import axis_profile
from world2minecraft.geometry.oriented_points import OrientedPoints

DIRECTIONS = 2000  # Fibonacci points on the sphere: about 4.5 degrees apart.
MAX_VOTERS = 4000
VOTE_CONE_DEG = 8.0
REFINING_CONES_DEG = (10.0, 7.0, 5.0, 4.0, 4.0)
ROLL_SIGMA = 0.20  # Sine of how far a hand-held camera rolls.
MAX_FACING_DEG = 20.0
MAX_HINT_OFFSET_DEG = 10.0  # ARKit's own world leans by under a degree, one that drifted by a few.
MIN_FLOOR_M2 = 0.3
# Of the largest level surface: a table top is smaller than that many floors.
MIN_FLOOR_SHARE = 0.15
MAX_BELOW_SHARE = 0.02  # Points that reflections and noise put under a true floor.


@dataclass(frozen=True)
class Ground:
    """The up direction and the floor plane ``up . p = height_m``.

    Attributes:
        up: Unit vector in the frame of the scan.
        height_m: Height of the floor along ``up`` in metres.
        floor_area_m2: Area of the floor; 0 if no floor was found and the lowest points are used
            instead.
    """

    up: np.ndarray
    height_m: float
    floor_area_m2: float


def find_ground(surface: OrientedPoints, up_hint: np.ndarray | None = None) -> Ground:
    """Estimate the up direction and the floor plane of a scan.

    Args:
        surface: Oriented points in the frame of the scan.
        up_hint: Up direction stated by the capture, such as from a phone's gravity sensor, as a
            unit vector float64 [3]. The result is within 10 degrees of it.
    """
    voted = _vote_up(surface) if up_hint is None else up_hint
    refined = refine_direction(surface.normals, voted, REFINING_CONES_DEG, 10)
    up = refined if _is_near(refined, up_hint) else voted
    height, area = _floor_height(surface, up)
    return Ground(up, height, area)


def _is_near(up: np.ndarray, up_hint: np.ndarray | None) -> bool:
    return up_hint is None or bool(up @ up_hint >= np.cos(np.radians(MAX_HINT_OFFSET_DEG)))


def _vote_up(surface: OrientedPoints) -> np.ndarray:
    """Return the best of many directions by facing surface, level image rows and upright images."""
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
    """Return evenly distributed unit vectors, float64 [count, 3] (Fibonacci spiral)."""
    index = np.arange(count) + 0.5
    z = 1 - 2 * index / count
    angle = index * np.pi * (1 + 5**0.5)
    flat = np.sqrt(1 - z * z)
    return np.stack([flat * np.cos(angle), flat * np.sin(angle), z], axis=1)


def refine_direction(
    normals: np.ndarray, direction: np.ndarray, cones_deg: tuple[float, ...], least: int
) -> np.ndarray:
    """Move a direction to the mean axis of the normals around it, in narrowing cones.

    The direction is kept where a cone has fewer than ``least`` normals.
    """
    for within_deg in cones_deg:
        near = normals[np.abs(normals @ direction) > np.cos(np.radians(within_deg))]
        if len(near) < least:
            break
        _, vectors = np.linalg.eigh(near.T @ near)
        direction = vectors[:, -1] * (1.0 if vectors[:, -1] @ direction > 0 else -1.0)
    return direction


def _floor_height(surface: OrientedPoints, up: np.ndarray) -> tuple[float, float]:
    """Return the height and the area in m2 of the lowest large surface that faces up."""
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
    """Return a rotation [3, 3] that maps ``up`` to +z, with an arbitrary rotation about z."""
    other = np.eye(3)[int(np.argmin(np.abs(up)))]
    x = np.cross(other, up)
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(up, x), up])
