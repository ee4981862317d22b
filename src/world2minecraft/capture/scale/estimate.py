"""Estimation of the factor from a scan's unit to metres, with its uncertainty and sources.

Without known lengths, the estimate is the main mode of a posterior over the logarithm of the scale,
which combines the densities in ``priors`` with the measurements of the room.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from world2minecraft.capture.alignment.room_frame import MIN_POINTS, ImplausibleRoomError
from world2minecraft.capture.scale import priors
from world2minecraft.capture.scale.known_lengths import (
    LEVEL_HEIGHTS,
    KnownLength,
    candidate_lengths,
)
from world2minecraft.capture.scale.measurements import LevelFace, RoomMeasurements, measure_room
from world2minecraft.geometry.oriented_points import OrientedPoints

# Of the natural logarithm, both ways from the guess by the camera: a factor of 3.3.
LOG_RANGE = 1.2
STEPS = 961
MIN_SIGMA = 0.03  # No prior of furniture is better than that.
OUTLIER_PROBABILITY = 0.02  # Probability that a known length is wrong.
MAX_LOG_DIFFERENCE = 0.05  # Two known lengths that differ by more are reported.
PRIOR_WEIGHT = 0.5  # A known length outweighs habits, but these say which table was meant.
MAX_NAMED_LEVELS = 2  # More would make the sentence long.


@dataclass(frozen=True, eq=False)
class Posterior:
    """A posterior density over the logarithm of the scale.

    Attributes:
        log_scale: Logarithms of the scale, [N].
        log_density: Logarithms of the density, up to a constant, [N].
    """

    log_scale: np.ndarray
    log_density: np.ndarray

    @property
    def weight(self) -> np.ndarray:
        """The probability of each step; the sum is 1."""
        weight = np.exp(self.log_density - self.log_density.max())
        return weight / weight.sum()


@dataclass(frozen=True)
class ScaleMode:
    """The main mode of a scale posterior.

    Attributes:
        scale: Scale of the mode with the largest probability.
        sigma: Relative standard deviation of the whole posterior.
        rival: Scale and probability of the second mode, or None if its probability is below 0.2.
    """

    scale: float
    sigma: float
    rival: tuple[float, float] | None


def scale_posterior(measures: RoomMeasurements) -> Posterior:
    """Return the posterior of the scale for the measurements of a room."""
    log_scale = np.log(measures.rough) + np.linspace(-LOG_RANGE, LOG_RANGE, STEPS)
    return Posterior(log_scale, log_density(measures, np.exp(log_scale)))


def log_density(measures: RoomMeasurements, scale: np.ndarray) -> np.ndarray:
    """Return the log-density of scales, float64 [N], up to a constant."""
    total = priors.camera_likelihood(scale * measures.camera, measures.floor_seen)
    if measures.ceiling is not None:
        total = total + priors.ceiling_likelihood(scale * measures.ceiling)
    elif measures.top is not None:
        total = total + priors.top_likelihood(scale * measures.top)
    if measures.length is not None and measures.width is not None:
        side = np.sqrt(measures.length * measures.width)
        total = total + priors.side_likelihood(scale * side)
    for level in measures.levels:
        total = total + priors.level_likelihood(scale * level.height, scale**2 * level.area)
    return total


def main_mode(posterior: Posterior) -> ScaleMode:
    """Return the mode with the largest probability, with its uncertainty."""
    weight = posterior.weight
    modes = _mode_ranges(weight)
    shares = [float(weight[a:b].sum()) for a, b in modes]
    order = sorted(range(len(modes)), key=lambda n: -shares[n])
    means = [_mode_mean(posterior, weight, *modes[n]) for n in order]
    off = posterior.log_scale - means[0]
    sigma = max(float(np.sqrt((weight * off * off).sum())), MIN_SIGMA)
    rival = None
    if len(order) > 1 and shares[order[1]] > 0.2:
        rival = (float(np.exp(means[1])), shares[order[1]])
    return ScaleMode(float(np.exp(means[0])), sigma, rival)


def _mode_mean(posterior: Posterior, weight: np.ndarray, first: int, last: int) -> float:
    part = weight[first:last]
    return float((part * posterior.log_scale[first:last]).sum() / part.sum())


def _mode_ranges(weight: np.ndarray) -> list[tuple[int, int]]:
    """Return the ranges of the modes, separated where the density falls to half of both sides."""
    bounds, low, high = [0], 0, 0
    for n in range(1, len(weight)):
        if weight[n] > weight[high]:
            high = n
            low = n
        elif weight[n] < weight[low] or low < high:
            low = n
        if weight[low] < 0.5 * weight[high] and weight[n] > 2 * weight[low]:
            bounds.append(low)
            high = low = n
    bounds.append(len(weight))
    return list(pairwise(bounds))


@dataclass(frozen=True)
class ScaleEstimate:
    """An estimate of the scale of a scan.

    Attributes:
        scale: Factor from the scan's unit to metres.
        sigma: Relative standard deviation of the scale.
        notes: Sentences for the report.
        sources: Names of the lengths used for the estimate.
    """

    scale: float
    sigma: float
    notes: tuple[str, ...]
    sources: tuple[str, ...]

    def __post_init__(self):
        if not (0 < self.scale < np.inf and 0 < self.sigma < np.inf):
            raise ValueError(f"scale and sigma must be above 0, got {self.scale} and {self.sigma}")


def estimate_scale(surface: OrientedPoints, knowns: Sequence[KnownLength] = ()) -> ScaleEstimate:
    """Estimate the scale of a scan whose unit is unknown.

    Args:
        surface: Oriented points and cameras in the unit and frame of the scan; see
            ``collect_unscaled``.
        knowns: Lengths known to the user. Without them, the scale is estimated from typical heights
            of cameras, ceilings, tables, worktops, seats and beds.

    Raises:
        ImplausibleRoomError: If there is too little surface.
        UsageError: If the scan does not show the object of a known length.
    """
    if len(surface.points_m) < MIN_POINTS:
        raise ImplausibleRoomError(
            f"the depth contains only {len(surface.points_m)} patches of smooth surface, at "
            f"least {MIN_POINTS} are required to estimate the scale; take more photos of "
            "floor and walls"
        )
    measures = measure_room(surface)
    return _from_known_lengths(measures, knowns) if knowns else _from_priors(measures)


def _from_priors(measures: RoomMeasurements) -> ScaleEstimate:
    found = main_mode(scale_posterior(measures))
    sources = [("the camera height", measures.camera * found.scale)]
    if measures.ceiling is not None:
        sources.append(("the ceiling", measures.ceiling * found.scale))
    sources += _named_levels(measures, found.scale)
    notes = [
        f"scale estimated from {_listed(sources)}: {found.scale:.3g} +- {100 * found.sigma:.0f} %"
    ]
    if found.rival is not None:
        notes.append(
            f"the scale may also be {found.rival[0]:.3g} (probability "
            f"{100 * found.rival[1]:.0f} %); a known length, such as a table height, would "
            "decide"
        )
    if not measures.floor_seen:
        notes.append("no floor was seen; heights are measured from the lowest points")
    return ScaleEstimate(found.scale, found.sigma, tuple(notes), tuple(name for name, _ in sources))


def _named_levels(measures: RoomMeasurements, scale: float) -> list[tuple[str, float]]:
    """Return the largest level faces at typical heights, with their names."""
    named: list[tuple[str, float]] = []
    for level in sorted(measures.levels, key=lambda level: -level.area):
        kind = priors.likeliest_level(level.height * scale)
        name = None if kind is None else f"a {kind.name}"
        if name is not None and name not in dict(named):
            named.append((name, level.height * scale))
    return named[:MAX_NAMED_LEVELS]


def _listed(sources: list[tuple[str, float]]) -> str:
    words = [f"{name} ({length_m:.2f} m)" for name, length_m in sources]
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"


def _from_known_lengths(measures: RoomMeasurements, knowns: Sequence[KnownLength]) -> ScaleEstimate:
    """Return the scale at which the known lengths and the room agree best."""
    choices = [
        [(known.length_m / length, weight) for length, weight in candidate_lengths(known, measures)]
        for known in knowns
    ]
    tried = np.array([scale for each in choices for scale, _ in each])
    fit = PRIOR_WEIGHT * log_density(measures, tried)
    for known, each in zip(knowns, choices, strict=True):
        fit = fit + _fit(known, each, tried)
    best = float(tried[int(np.argmax(fit))])
    nearest = [min((abs(np.log(s / best)), s) for s, _ in each)[1] for each in choices]
    agreeing = [n for n, s in enumerate(nearest) if abs(np.log(s / best)) < MAX_LOG_DIFFERENCE]
    trust = np.array([knowns[n].sigma ** -2.0 for n in agreeing])
    logs = np.log([nearest[n] for n in agreeing])
    scale = float(np.exp((trust * logs).sum() / trust.sum()))
    sigma = max(float(trust.sum() ** -0.5), float(np.std(logs)))
    notes = [
        (
            "scale computed from "
            f"{_describe_match(known, known.length_m / near, measures, scale)}: {scale:.3g} "
            f"+- {100 * sigma:.1f} %"
        )
        if n in agreeing
        else (
            f"{known.name} ({known.length_m:g} m) contradicts the other lengths by "
            f"{100 * abs(near / scale - 1):.0f} % and is ignored"
        )
        for n, (known, near) in enumerate(zip(knowns, nearest, strict=True))
    ]
    notes += _contradictions(measures, knowns, tried, fit, best)
    return ScaleEstimate(scale, sigma, tuple(notes), tuple(knowns[n].name for n in agreeing))


def _fit(known: KnownLength, choices: list[tuple[float, float]], tried: np.ndarray) -> np.ndarray:
    """Return the log-likelihood of each candidate scale for a known length."""
    total = sum(weight for _, weight in choices)
    parts = [
        np.log(weight / total) - 0.5 * (np.log(tried / scale) / known.sigma) ** 2
        for scale, weight in choices
    ]
    return np.logaddexp(np.logaddexp.reduce(parts, axis=0), np.log(OUTLIER_PROBABILITY))


def _describe_match(
    known: KnownLength, length: float, measures: RoomMeasurements, scale: float
) -> str:
    """Return a known length and the matching face in words."""
    words = f"the given {known.name} ({known.length_m:g} m)"
    if known.name not in LEVEL_HEIGHTS:
        return words
    level: LevelFace = min(measures.levels, key=lambda at: abs(at.height - length))
    return f"{words}, a level face of {level.area * scale**2:.1f} m2"


def _contradictions(
    measures: RoomMeasurements,
    knowns: Sequence[KnownLength],
    tried: np.ndarray,
    fit: np.ndarray,
    best: float,
) -> list[str]:
    """Return notes about other plausible matches of the known lengths, or implausible results."""
    contradictions = []
    others = np.abs(np.log(tried / best)) > MAX_LOG_DIFFERENCE
    if others.any() and fit[others].max() > fit.max() - 1.5:
        other = float(tried[others][int(np.argmax(fit[others]))])
        contradictions.append(
            f"if the {knowns[0].name} refers to another face, the scale is {other:.3g}; "
            "another known length would decide"
        )
    camera_m = best * measures.camera
    if measures.floor_seen and not 0.8 <= camera_m <= 2.2:
        contradictions.append(
            f"at this scale, the cameras were {camera_m:.2f} m above the floor, which is unusual"
        )
    return contradictions
