"""How sure a share of successes is, and whether two agents differ on the same items."""

from typing import NamedTuple

import numpy as np
from scipy.stats import binomtest

CONFIDENCE = 0.95


class Rate(NamedTuple):
    """``hits`` of ``total``, and the interval (Wilson, 95 %) in which the true share lies."""

    hits: int
    total: int
    low: float
    high: float

    @property
    def share(self) -> float:
        """The share of hits, 0 where nothing was counted."""
        return self.hits / self.total if self.total else 0.0


def rate(hits: int, count: int) -> Rate:
    """Return a rate with its interval.

    Raises:
        ValueError: more hits than were counted.

    Example:
        >>> found = rate(23, 41)
        >>> round(found.low, 2), round(found.share, 4), round(found.high, 2)
        (0.41, 0.561, 0.7)
    """
    if not 0 <= hits <= count:
        raise ValueError(f"hits must be 0 to {count}, not {hits}")
    if count == 0:
        return Rate(0, 0, 0.0, 1.0)
    interval = binomtest(hits, count).proportion_ci(CONFIDENCE, method="wilson")
    return Rate(hits, count, float(interval.low), float(interval.high))


def paired_p(one: np.ndarray, other: np.ndarray) -> float:
    """Return how likely it is that two agents differ so much by chance (McNemar's exact test).

    Args:
        one: bool [N], whether the first agent was right on each item.
        other: bool [N], the second agent on the same items.

    Raises:
        ValueError: the two did not answer the same number of items.

    Example:
        >>> paired_p(np.array([True] * 6), np.array([False] * 6))
        0.03125
    """
    first, second = np.asarray(one, bool), np.asarray(other, bool)
    if first.shape != second.shape or first.ndim != 1:
        raise ValueError(f"answers must be of the same items, not {first.shape}, {second.shape}")
    better, worse = int((first & ~second).sum()), int((second & ~first).sum())
    if better + worse == 0:
        return 1.0
    return float(binomtest(better, better + worse).pvalue)
