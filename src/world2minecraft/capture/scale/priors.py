"""Prior densities of sizes in rooms: log-densities of heights and sides in metres.

The values are from standards and common practice, not from the project's generated rooms: dining
tables and desks 0.70 to 0.78 m (EN 527: 0.74), worktops 0.85 to 0.95, seats 0.42 to 0.48, beds 0.40
to 0.65, ceilings of homes 2.3 to 3.0. A standing person holds the camera 1.2 to 1.7 m above the
floor but may also sit, kneel or reach up, so each density has a narrow and a wide component.
"""

from dataclasses import dataclass

import numpy as np
from scipy.special import log_ndtr


@dataclass(frozen=True)
class HeightPrior:
    """The prior for the height of a kind of furniture.

    Attributes:
        name: Name of the furniture.
        height_m: Typical height in metres.
        spread: Relative standard deviation of the height.
        share: Prior probability of this kind of furniture.
    """

    name: str
    height_m: float
    spread: float
    share: float


LEVEL_PRIORS = (
    HeightPrior("table", 0.74, 0.030, 0.30),
    HeightPrior("counter", 0.90, 0.030, 0.14),
    HeightPrior("seat", 0.46, 0.050, 0.20),
    HeightPrior("bed", 0.53, 0.120, 0.08),
    HeightPrior("low table", 0.42, 0.100, 0.06),
    HeightPrior("sideboard", 0.83, 0.070, 0.07),
)
BACKGROUND = 0.15 / 1.65  # Density of other objects, uniform in log height from 0.25 to 1.3 m.
LEVEL_TRUST = 0.7  # Faces of one room are not independent, such as the two leaves of a table.
FULL_AREA_M2 = 0.4  # A smaller face counts less: a stack of books has a top as well.
MIN_LEVEL_TRUST = 0.15


def camera_likelihood(height_m: np.ndarray, floor_seen: bool) -> np.ndarray:
    """Return the log-density of the cameras' median height above the floor."""
    wide = 0.16 if floor_seen else 0.22
    return _mixture_log_density(
        height_m, ((0.80, 1.45, 0.105), (0.15, 1.40, wide * 1.5), (0.05, 1.3, 0.5))
    )


def ceiling_likelihood(height_m: np.ndarray) -> np.ndarray:
    """Return the log-density of a ceiling height."""
    return _mixture_log_density(
        height_m, ((0.70, 2.50, 0.055), (0.25, 2.70, 0.13), (0.05, 3.2, 0.35))
    )


def top_likelihood(height_m: np.ndarray) -> np.ndarray:
    """Return the log-likelihood of the height of the highest points if no ceiling was seen."""
    return np.logaddexp(log_ndtr(np.log(3.0 / height_m) / 0.12), np.log(0.02))


def side_likelihood(side_m: np.ndarray) -> np.ndarray:
    """Return the log-density of a room's mean side: rooms of 2 to 8 m, and whole flats."""
    return _mixture_log_density(side_m, ((0.7, 4.0, 0.40), (0.3, 9.0, 0.60)))


def level_likelihood(height_m: np.ndarray, area_m2: np.ndarray) -> np.ndarray:
    """Return the log-density of the height of a level face; small faces have a lower weight."""
    parts = [(kind.share, kind.height_m, kind.spread) for kind in LEVEL_PRIORS]
    density = np.logaddexp(_mixture_log_density(height_m, parts), np.log(BACKGROUND))
    return density * np.clip(area_m2 / FULL_AREA_M2, MIN_LEVEL_TRUST, 1.0) * LEVEL_TRUST


def likeliest_level(height_m: float) -> HeightPrior | None:
    """Return the most likely furniture for a level face at a height, or None if none is likely."""
    density = {
        kind: kind.share
        * np.exp(_normal_log_density(np.array(height_m), kind.height_m, kind.spread))
        for kind in LEVEL_PRIORS
    }
    best = max(density, key=lambda kind: density[kind])
    return best if density[best] > BACKGROUND else None


def _mixture_log_density(values: np.ndarray, parts: tuple | list) -> np.ndarray:
    terms = [
        np.log(share) + _normal_log_density(values, middle, spread)
        for share, middle, spread in parts
    ]
    return np.logaddexp.reduce(terms, axis=0)


def _normal_log_density(values: np.ndarray, middle: float, spread: float) -> np.ndarray:
    """Return the log-density of a normal distribution over the logarithm of a length."""
    off = np.log(values / middle) / spread
    return -0.5 * off * off - np.log(spread * np.sqrt(2 * np.pi))
