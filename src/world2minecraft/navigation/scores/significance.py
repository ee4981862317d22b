"""Confidence intervals of success rates, and significance tests between two agents."""

from typing import NamedTuple

import numpy as np
from scipy.stats import binomtest

CONFIDENCE = 0.95


class Rate(NamedTuple):
    """A success rate with its 95 percent Wilson interval.

    Attributes:
        hits: The number of successes.
        total: The number of trials.
        low: The lower bound of the interval.
        high: The upper bound of the interval.
    """

    hits: int
    total: int
    low: float
    high: float

    @property
    def share(self) -> float:
        """The share of hits, or 0 without trials."""
        return self.hits / self.total if self.total else 0.0


def rate(hits: int, count: int) -> Rate:
    """Return a rate with its confidence interval.

    Raises:
        ValueError: If there are more hits than trials.

    Example:
        >>> found = rate(23, 41)
        >>> round(found.low, 2), round(found.share, 4), round(found.high, 2)
        (0.41, 0.561, 0.7)
    """
    if not 0 <= hits <= count:
        raise ValueError(f"hits must be 0 to {count}, got {hits}")
    if count == 0:
        return Rate(0, 0, 0.0, 1.0)
    interval = binomtest(hits, count).proportion_ci(CONFIDENCE, method="wilson")
    return Rate(hits, count, float(interval.low), float(interval.high))


def paired_p(one: np.ndarray, other: np.ndarray) -> float:
    """Return the p-value of McNemar's exact test for a difference between two agents.

    Args:
        one: Whether the first agent was correct on each item, as bool [N].
        other: Whether the second agent was correct on the same items, as bool [N].

    Raises:
        ValueError: If the arrays differ in length.

    Example:
        >>> paired_p(np.array([True] * 6), np.array([False] * 6))
        0.03125
    """
    first, second = np.asarray(one, bool), np.asarray(other, bool)
    if first.shape != second.shape or first.ndim != 1:
        raise ValueError(
            f"both methods must be scored on the same items, got shapes {first.shape} and "
            f"{second.shape}"
        )
    better, worse = int((first & ~second).sum()), int((second & ~first).sum())
    if better + worse == 0:
        return 1.0
    return float(binomtest(better, better + worse).pvalue)
