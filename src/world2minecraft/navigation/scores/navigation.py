"""The scores of walked episodes, as R2R, RxR and VLN-CE define them.

Distances to the goal are those on foot (geodesic), the way that was walked is a sum of straight
lines, and success needs STOP and a distance *under* the radius, as in Habitat's code. The usual
radius of 3 m is as large as many rooms: so success is told at four radii, and the rows of agents
that stop at once or walk at random belong beside any other.
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
    """What an agent did in an episode: T poses, the first where it began.

    ``distance_m`` is the way on foot from each pose to the goal, inf where none leads there.
    """

    positions_m: np.ndarray  # float64 [T, 3], metres of the room
    distance_m: np.ndarray  # float64 [T]
    stopped: bool  # by its own word, not because it ran out of steps
    steps: int  # actions, STOP among them
    collisions: int = 0

    def __post_init__(self):
        positions = np.asarray(self.positions_m, np.float64)
        distance = np.asarray(self.distance_m, np.float64)
        if positions.ndim != 2 or positions.shape[1] != 3 or not len(positions):
            raise ValueError(f"positions_m must be [T, 3], not {positions.shape}")
        if distance.shape != (len(positions),) or np.isnan(distance).any() or distance.min() < 0:
            raise ValueError(f"distance_m must be {len(positions)} numbers of 0 or more")
        if min(self.steps, self.collisions) < 0:
            raise ValueError("steps and collisions must be 0 or more")
        object.__setattr__(self, "positions_m", positions)
        object.__setattr__(self, "distance_m", distance)


@dataclass(frozen=True)
class EpisodeScore:
    """The scores of one episode. ``success`` and ``oracle`` have an entry a radius of RADII_M."""

    ne_m: float  # navigation error: how far the goal still was
    one_m: float  # the least that it ever was
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
        walked: what the agent did; its first ``distance_m`` is the shortest way.
        reference_m: float64 [M, 3], the dense path that should have been walked.
        radius_m: success in SPL and SDTW; papers take 3 m.

    Raises:
        ValueError: no way leads from the start to the goal.
    """
    shortest = float(walked.distance_m[0])
    if not np.isfinite(shortest):
        raise ValueError("no way leads from the start to the goal; such an episode has no score")
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
    """Return means over episodes by name, and success rates with their intervals.

    An episode whose end no way leads from has an infinite NE; the mean is over the others, and
    ``unreachable_ends`` tells how many there were.

    Raises:
        ValueError: there is no episode.
    """
    if not scores:
        raise ValueError("scores of no episode have no mean")
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
