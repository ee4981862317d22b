"""How likely each scale of a scan is, and what that comes to: the best mode and its sigma."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from world2minecraft.capture.scale import priors
from world2minecraft.capture.scale.measurements import Measures

REACH = 1.2  # Of the natural logarithm, both ways from the guess by the camera: a factor of 3.3.
STEPS = 961
LEAST_SIGMA = 0.03  # No prior of furniture is better than that.


@dataclass(frozen=True, eq=False)
class Posterior:
    """Log-density over the logarithm of the scale: ``log_scale`` and ``log_density`` [N]."""

    log_scale: np.ndarray
    log_density: np.ndarray

    @property
    def weight(self) -> np.ndarray:
        """The probability of each step; sums to 1."""
        weight = np.exp(self.log_density - self.log_density.max())
        return weight / weight.sum()


@dataclass(frozen=True)
class Summary:
    """The scale of the heaviest mode, the relative sigma of the whole, and a rival mode.

    ``rival`` is the scale of the next mode and its share, None where it has under a fifth.
    """

    scale: float
    sigma: float
    rival: tuple[float, float] | None


def posterior_of(measures: Measures) -> Posterior:
    """Return how likely each scale is by all that was measured."""
    log_scale = np.log(measures.rough) + np.linspace(-REACH, REACH, STEPS)
    return Posterior(log_scale, log_density(measures, np.exp(log_scale)))


def log_density(measures: Measures, scale: np.ndarray) -> np.ndarray:
    """Return how likely scales are, float64 [N], up to one constant."""
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


def summed(posterior: Posterior) -> Summary:
    """Return the heaviest mode of a posterior, and how far the truth may be from it."""
    weight = posterior.weight
    modes = _modes(weight)
    shares = [float(weight[a:b].sum()) for a, b in modes]
    order = sorted(range(len(modes)), key=lambda n: -shares[n])
    means = [_mean(posterior, weight, *modes[n]) for n in order]
    off = posterior.log_scale - means[0]
    sigma = max(float(np.sqrt((weight * off * off).sum())), LEAST_SIGMA)
    rival = None
    if len(order) > 1 and shares[order[1]] > 0.2:
        rival = (float(np.exp(means[1])), shares[order[1]])
    return Summary(float(np.exp(means[0])), sigma, rival)


def _mean(posterior: Posterior, weight: np.ndarray, first: int, last: int) -> float:
    part = weight[first:last]
    return float((part * posterior.log_scale[first:last]).sum() / part.sum())


def _modes(weight: np.ndarray) -> list[tuple[int, int]]:
    """Return the ranges of the modes: parted where the density falls to half of both sides."""
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
