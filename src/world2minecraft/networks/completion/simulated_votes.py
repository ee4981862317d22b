"""Simulated votes for training samples: the true labels with realistic errors.

Votes of a segmentation network are wrong for whole parts of objects, not for single cells, and it
confuses similar classes. They are simulated with votes that the network of the program gave on real
frames kept from its training: ``segmenter_votes.npz`` has some of its votes for each true class,
each the mean over neighbouring cells. Neighbouring cells of one class in a sample get the same one.
Label images have errors in small patches.
"""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np

from world2minecraft.core.files import read_npz
from world2minecraft.reconstruction.semantics.completion_channels import KINDS, Sight

VOTES_FILE = Path(__file__).with_name("segmenter_votes.npz")
PART_CELLS, PATCH_CELLS, UNSEEN_CELLS = (10, 3), 2, 8  # Sides of blocks with one error.
MAX_LABEL_ERROR = 0.35
UNSEEN_SHARE = 0.1  # Of blocks without votes.
NETWORK_SHARE = 0.7  # Of samples with votes of a network; the others have votes of label images.


@cache
def segmenter_votes() -> np.ndarray:
    """Return votes on real frames by true class, float32 [11, N, 11]; each sums to 1."""
    stored = read_npz(VOTES_FILE, ("votes",))["votes"].astype(np.float32)
    return stored / stored.sum(axis=2, keepdims=True)


def group_votes(votes: np.ndarray, kinds: np.ndarray, cells: np.ndarray) -> list[np.ndarray]:
    """Return the mean votes of the cells of each class in each block, for ``segmenter_votes``.

    Args:
        votes: Shares of the network's votes, float [N, 11].
        kinds: True class of each cell minus 1, int [N].
        cells: Cells, int [N, 3].

    Returns:
        For each class, float [K, 11].
    """
    groups = _segments(cells, kinds, PART_CELLS[1], np.zeros(3, np.int64))
    counts = np.bincount(groups)
    sums = np.stack([np.bincount(groups, column) for column in votes.T], axis=1)
    of_group = np.zeros(len(counts), np.int64)
    of_group[groups] = kinds
    means = sums / counts[:, None]
    return [means[of_group == kind] for kind in range(KINDS)]


def simulate_votes(sight: Sight, rng: np.random.Generator) -> Sight:
    """Replace the votes of the true labels in a network input by votes with errors."""
    if sight.votes is None:
        return sight
    voted = sight.votes.any(axis=1)
    kinds = sight.votes.argmax(axis=1)
    cells = np.stack(np.unravel_index(sight.at, sight.log_odds.shape), axis=1)
    if rng.random() < NETWORK_SHARE:
        votes = _network_votes(kinds, cells, rng)
    else:
        votes = _label_votes(kinds, cells, rng)
    blocks = _segments(cells, np.zeros_like(kinds), UNSEEN_CELLS, rng.integers(0, 99, 3))
    voted &= rng.random(blocks.max(initial=0) + 1)[blocks] >= UNSEEN_SHARE
    stored = (votes * 255).round().astype(np.uint8) * voted[:, None]
    return replace(sight, votes=stored.astype(np.uint8))


def _network_votes(kinds: np.ndarray, cells: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Return votes of a network, a mixture of one of a larger and one of a smaller block."""
    known, result = segmenter_votes(), np.zeros((len(kinds), KINDS), np.float32)
    share = rng.random()
    for side, weight in zip(PART_CELLS, (share, 1 - share), strict=True):
        groups = _segments(cells, kinds, side, rng.integers(0, 99, 3))
        chosen = rng.integers(0, known.shape[1], groups.max(initial=0) + 1)
        result += np.float32(weight) * known[kinds, chosen[groups]]
    return result


def _label_votes(kinds: np.ndarray, cells: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Return votes of label images in which patches have a wrong class."""
    groups = _segments(cells, kinds, PATCH_CELLS, rng.integers(0, 99, 3))
    count = groups.max(initial=0) + 1
    share = rng.random(count) * (rng.random(count) < 2 * rng.uniform(0, MAX_LABEL_ERROR))
    other = (kinds + rng.integers(1, KINDS, count)[groups]) % KINDS
    result = np.zeros((len(kinds), KINDS), np.float32)
    rows = np.arange(len(kinds))
    result[rows, other] = share[groups]
    result[rows, kinds] = 1 - share[groups]
    return result


def _segments(cells: np.ndarray, kinds: np.ndarray, side: int, offset: np.ndarray) -> np.ndarray:
    """Return numbers from 0 for the cells of one class in one block, int [N]."""
    rows = np.column_stack([(cells + offset) // side, kinds])
    return np.unique(rows, axis=0, return_inverse=True)[1].reshape(-1)
