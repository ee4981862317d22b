"""Estimation of the up axis and the unit of a mesh or point cloud.

A room has three dominant directions at right angles. The up axis is the direction that the most
surface faces (floor, ceiling, tables) and along which the room is shortest. Its sign follows from
the distribution of surface: between floor and ceiling, there is more surface in the lower half. The
usual up axis of the file format decides ambiguous cases.

The unit is the one that gives the room a plausible height.
"""

from dataclasses import dataclass

import numpy as np

from world2minecraft.capture.alignment.gravity import refine_direction
from world2minecraft.capture.options import MESH_UNITS_M
from world2minecraft.capture.readers.meshes.surface_sampling import SurfaceSamples

AXES = {
    "x": (1.0, 0.0, 0.0),
    "y": (0.0, 1.0, 0.0),
    "z": (0.0, 0.0, 1.0),
    "-x": (-1.0, 0.0, 0.0),
    "-y": (0.0, -1.0, 0.0),
    "-z": (0.0, 0.0, -1.0),
}
ALIGNED = 0.985  # Cosine of 10 degrees: the file's own axis is meant.
FACING = 0.94  # Cosine of 20 degrees.
DIRECTIONS = 1500
MAX_VOTERS = 4000
REFINING_CONES_DEG = (8.0, 5.0, 4.0)
OUTER = 0.08  # Of a length: the shell's share at each end.
# What each sign is worth, in the natural logarithm of odds. Guesses, then held to the rooms of
# the tests, turned to all six axes.
FORMAT_AXIS, UPRIGHT_AXIS, DOWNWARD, SIDEWAYS = 2.2, 0.7, 0.2, -2.0
FACING_WEIGHT, SHORTNESS_WEIGHT, BELOW_WEIGHT = 3.0, 1.5, 4.0
HEIGHT_M, HEIGHT_SPREAD = 2.6, 0.35  # The middle and the spread of rooms' heights (logarithm).
RARITY = {"m": 0.0, "cm": 1.0, "mm": 1.0, "foot": 3.0, "inch": 3.0}
SIDES_M, HEIGHTS_M = (1.2, 40.0), (1.5, 12.0)
STATED_MARGIN = 3.0  # A format's unit is doubted only where another fits so much better.


@dataclass(frozen=True, eq=False)
class Orientation:
    """The up axis of a mesh or point cloud.

    Attributes:
        turn: Rotation from the file's axes to z up, float64 [3, 3].
        description: A note that names the up axis and how it was found.
    """

    turn: np.ndarray
    description: str


def find_orientation(
    samples: SurfaceSamples, usual_up: str, stated: bool, chosen: str | None
) -> Orientation:
    """Determine the orientation of a mesh or point cloud.

    Args:
        samples: Samples of the surface, in the axes of the file.
        usual_up: The up axis by convention of the file format.
        stated: Whether the file itself states the up axis.
        chosen: The up axis given by the user, or None.
    """
    if chosen is not None:
        return Orientation(rotation_to_up(np.array(AXES[chosen])), f"up axis {chosen}, as set")
    if stated:
        return Orientation(
            rotation_to_up(np.array(AXES[usual_up])), f"up axis {usual_up}, from the file"
        )
    frame = _dominant_frame(samples.normals)
    ups = [sign * axis for axis in frame for sign in (1.0, -1.0)]
    scores = [_up_score(samples, up, usual_up) for up in ups]
    best = ups[int(np.argmax(scores))]
    name = max(AXES, key=lambda axis: float(best @ AXES[axis]))
    if best @ AXES[name] > ALIGNED:
        return Orientation(rotation_to_up(np.array(AXES[name])), f"up axis {name} (estimated)")
    tilt = np.degrees(np.arccos(np.clip(best @ AXES[name], -1, 1)))
    return Orientation(rotation_to_up(best), f"up axis {tilt:.0f} degrees from {name} (estimated)")


def rotation_to_up(up: np.ndarray) -> np.ndarray:
    """Return the shortest rotation, float64 [3, 3], that maps ``up`` to +z.

    Example:
        >>> (rotation_to_up(np.array([0.0, 1.0, 0.0])) @ [0, 0, 1]).tolist()
        [0.0, -1.0, 0.0]
    """
    x, y, z = up
    if z < -1 + 1e-9:
        return np.diag([1.0, -1.0, -1.0])
    return np.array(
        [
            [1 - x * x / (1 + z), -x * y / (1 + z), -x],
            [-x * y / (1 + z), 1 - y * y / (1 + z), -y],
            [x, y, z],
        ]
    )


def _dominant_frame(normals: np.ndarray) -> np.ndarray:
    """Return the three orthogonal directions that most surface faces, as rows of float64 [3, 3]."""
    known = normals[np.abs(normals).sum(axis=1) > 0]
    known = known[:: max(1, len(known) // MAX_VOTERS)]
    if len(known) < 20:
        return np.eye(3)
    index = np.arange(DIRECTIONS) + 0.5
    height = index / DIRECTIONS
    angle, flat = index * np.pi * (1 + 5**0.5), np.sqrt(1 - height * height)
    ways = np.stack([flat * np.cos(angle), flat * np.sin(angle), height], axis=1)
    ways = np.concatenate([np.eye(3), ways])
    votes = (np.abs(ways @ known.T) > np.cos(np.radians(6))).sum(axis=1)
    first = refine_direction(known, ways[int(np.argmax(votes))], REFINING_CONES_DEG, 5)
    across = np.abs(ways @ first) < np.sin(np.radians(5))
    start = ways[int(np.argmax(np.where(across, votes, -1)))]
    second = refine_direction(known, start, REFINING_CONES_DEG, 5)
    second -= first * (first @ second)
    second /= np.linalg.norm(second)
    return np.stack([first, second, np.cross(first, second)])


def _up_score(samples: SurfaceSamples, up: np.ndarray, usual_up: str) -> float:
    """Return a score for how likely a direction is up."""
    score = 0.0
    if up @ AXES[usual_up] > FACING:
        score += FORMAT_AXIS
    elif max(up[1], up[2]) > FACING:
        score += UPRIGHT_AXIS
    elif min(up[1], up[2]) < -FACING:
        score += DOWNWARD
    elif abs(up[0]) > FACING:
        score += SIDEWAYS
    turned = samples.points @ rotation_to_up(up).T
    low, high = np.quantile(turned, [0.005, 0.995], axis=0)
    length = np.maximum(high - low, 1e-9)
    score -= SHORTNESS_WEIGHT * float(np.log(length[2] / length.min()))
    facing = np.abs(samples.normals @ up) > FACING
    score += FACING_WEIGHT * float(facing.mean())
    place = (turned - low) / length
    within = ((place > OUTER) & (place < 1 - OUTER)).all(axis=1)
    if within.sum() > 50:
        score += BELOW_WEIGHT * float((place[within, 2] < 0.5).mean() - 0.5) * 2
    return score


def find_unit(size: np.ndarray, stated_m: float | None, chosen: str | None) -> tuple[float, str]:
    """Determine the unit of a mesh or point cloud.

    Args:
        size: Size of the upright bounding box in file units, float64 [3].
        stated_m: Metres per unit as stated by the format or the file, or None.
        chosen: The unit given by the user, or None.

    Returns:
        The number of metres per unit, and a note on how it was determined.
    """
    if chosen is not None:
        return MESH_UNITS_M[chosen], f"unit {chosen}, as set"
    scores = {
        name: _size_log_likelihood(size * MESH_UNITS_M[name]) - RARITY[name] for name in RARITY
    }
    best = max(scores, key=lambda name: scores[name])
    if (
        stated_m is not None
        and _size_log_likelihood(size * stated_m) > scores[best] - STATED_MARGIN
    ):
        name = next((n for n in RARITY if MESH_UNITS_M[n] == stated_m), f"{stated_m:g} m")
        return stated_m, f"unit {name}, from the file format"
    return MESH_UNITS_M[best], f"unit {best} (estimated from the size)"


def _size_log_likelihood(size_m: np.ndarray) -> float:
    """Return the log likelihood that a room has this size."""
    off = (np.log(max(float(size_m[2]), 1e-9)) - np.log(HEIGHT_M)) / HEIGHT_SPREAD
    score = -off * off / 2
    for length, (least, most) in zip(size_m, (SIDES_M, SIDES_M, HEIGHTS_M), strict=True):
        score -= 10.0 * (not least <= length <= most)
    return score
