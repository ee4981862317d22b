"""Scores of walked episodes as defined by R2R, RxR and VLN-CE.

Distances to the goal are walking (geodesic) distances, and path lengths are sums of straight lines.
Success requires STOP at a distance *below* the radius, as in Habitat. The usual radius of 3 m is as
large as many rooms, so success is reported at four radii, and results should be compared with those
of agents that stop at once or walk randomly.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from world2minecraft.navigation.scores.path_similarity import cls, ndtw, path_length_m
from world2minecraft.navigation.scores.significance import rate

RADII_M = (0.5, 1.0, 2.0, 3.0)
USUAL_M = 3.0  # The radius of OSR, SPL and SDTW in the papers.


@dataclass(frozen=True, eq=False)
class WalkedPath:
    """The path of an agent in an episode, with T poses including the start.

    Attributes:
        positions_m: The positions in metres of the room as float64 [T, 3].
        distance_m: The walking distance from each pose to the goal as float64 [T], inf if
            unreachable.
        stopped: Whether the agent ended the walk with STOP.
        steps: The number of actions, including STOP.
        collisions: The number of actions that collided.
    """

    positions_m: np.ndarray
    distance_m: np.ndarray
    stopped: bool
    steps: int
    collisions: int = 0

    def __post_init__(self):
        positions = np.asarray(self.positions_m, np.float64)
        distance = np.asarray(self.distance_m, np.float64)
        if positions.ndim != 2 or positions.shape[1] != 3 or not len(positions):
            raise ValueError(f"positions_m must have shape [T, 3], got {positions.shape}")
        if distance.shape != (len(positions),) or np.isnan(distance).any() or distance.min() < 0:
            raise ValueError(f"distance_m must contain {len(positions)} non-negative numbers")
        if min(self.steps, self.collisions) < 0:
            raise ValueError("steps and collisions must be 0 or more")
        object.__setattr__(self, "positions_m", positions)
        object.__setattr__(self, "distance_m", distance)


@dataclass(frozen=True)
class EpisodeScore:
    """The scores of one episode.

    Attributes:
        ne_m: The navigation error: the final walking distance to the goal in metres.
        one_m: The oracle navigation error: the minimum distance during the walk.
        success: Whether the walk succeeded, for each radius of ``RADII_M``.
        oracle: Whether the walk came close enough at any time, for each radius of ``RADII_M``.
        spl: Success weighted by path length.
        soft_spl: Progress weighted by path length.
        ndtw: Normalised dynamic time warping.
        sdtw: Success weighted by nDTW.
        cls: Coverage weighted by length score.
        length_m: The length of the walked path in metres.
        shortest_m: The length of the shortest path in metres.
        collisions: The number of collisions.
        steps: The number of steps.
    """

    ne_m: float
    one_m: float
    success: tuple[bool, ...]
    oracle: tuple[bool, ...]
    spl: float
    soft_spl: float
    ndtw: float
    sdtw: float
    cls: float
    length_m: float
    shortest_m: float
    collisions: int
    steps: int


def score_episode(
    walked: WalkedPath, reference_m: np.ndarray, *, radius_m: float = USUAL_M
) -> EpisodeScore:
    """Score an episode.

    Args:
        walked: The path of the agent. Its first ``distance_m`` is the length of the shortest path.
        reference_m: The dense reference path as float64 [M, 3].
        radius_m: The success radius for SPL and SDTW in metres. The papers use 3 m.

    Raises:
        ValueError: If no path leads from the start to the goal.
    """
    shortest = float(walked.distance_m[0])
    if not np.isfinite(shortest):
        raise ValueError(
            "no path leads from the start to the goal, so the episode cannot be scored"
        )
    left, least = float(walked.distance_m[-1]), float(walked.distance_m.min())
    length = path_length_m(walked.positions_m)
    success = walked.stopped and left < radius_m
    share = shortest / max(shortest, length) if max(shortest, length) > 0 else 1.0
    nearer = max(0.0, 1 - left / shortest) if shortest > 0 else float(left == 0)
    near = ndtw(walked.positions_m, reference_m)
    return EpisodeScore(
        ne_m=left,
        one_m=least,
        success=tuple(walked.stopped and left < radius for radius in RADII_M),
        oracle=tuple(least < radius for radius in RADII_M),
        spl=success * share,
        soft_spl=nearer * share,
        ndtw=near,
        sdtw=success * near,
        cls=cls(walked.positions_m, reference_m),
        length_m=length,
        shortest_m=shortest,
        collisions=walked.collisions,
        steps=walked.steps,
    )


def summarise(scores: Sequence[EpisodeScore]) -> dict[str, Any]:
    """Return mean scores by name, and success rates with confidence intervals.

    If the goal cannot be reached from an episode's end, its NE is infinite. Such episodes are
    excluded from the mean NE and counted in ``unreachable_ends``.

    Raises:
        ValueError: If there are no episodes.
    """
    if not scores:
        raise ValueError("at least one episode score is required")
    result: dict[str, Any] = {"episodes": len(scores)}
    for entry in fields(EpisodeScore):
        values = [getattr(score, entry.name) for score in scores]
        if entry.name in ("success", "oracle"):
            for radius, column in zip(RADII_M, zip(*values, strict=True), strict=True):
                found = rate(sum(column), len(column))
                interval = {"share": found.share, "low": found.low, "high": found.high}
                result[f"{entry.name}_{radius:g}m"] = interval
            continue
        finite = [float(value) for value in values if np.isfinite(value)]
        result[entry.name] = float(np.mean(finite)) if finite else None
    result["unreachable_ends"] = sum(not np.isfinite(score.ne_m) for score in scores)
    return result
