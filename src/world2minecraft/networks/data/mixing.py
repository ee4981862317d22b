"""Which frame is drawn when, of one set or of several.

A draw takes a set with a chance in proportion to its weight, whatever its size, and then the next
frame of that set's own order: each comes once before any comes again. All of it follows from the
seed, and draw number n is the same whether the draws before it were made or not; so a run that was
stopped goes on at its draw.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np


class Draws(NamedTuple):
    """The draws of a run, in their order."""

    source: np.ndarray  # int32 [N], which set
    row: np.ndarray  # int64 [N], which of its training frames


def plan_draws(sizes: Sequence[int], weights: Sequence[float], count: int, seed: int) -> Draws:
    """Return ``count`` draws from sets of the given sizes.

    Example:
        >>> draws = plan_draws([3], [1.0], 6, 0)
        >>> sorted(draws.row[:3].tolist()), sorted(draws.row[3:].tolist())
        ([0, 1, 2], [0, 1, 2])
    """
    chances = np.asarray(weights, np.float64) / np.sum(weights)
    source = np.random.default_rng([seed, 0]).choice(len(sizes), size=count, p=chances)
    row = np.empty(count, np.int64)
    for number, size in enumerate(sizes):
        places = np.flatnonzero(source == number)
        epochs = -(-len(places) // size)
        orders = [
            np.random.default_rng([seed, 1 + number, epoch]).permutation(size)
            for epoch in range(epochs)
        ]
        row[places] = np.concatenate(orders)[: len(places)] if orders else 0
    return Draws(source.astype(np.int32), row)


def draw_rng(seed: int, draw: int) -> np.random.Generator:
    """Return the generator that changes the frame of one draw."""
    return np.random.default_rng([seed, 2**20, draw])
