"""Votes of training samples: made of true labels, wrong as votes are, the same for a seed."""

from dataclasses import replace

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.networks.completion import simulated_votes
from world2minecraft.networks.completion.augmentation import prepare_evaluation
from world2minecraft.networks.completion.samples import Sample
from world2minecraft.networks.completion.simulated_votes import (
    group_votes,
    segmenter_votes,
    simulate_votes,
)
from world2minecraft.reconstruction.semantics.completion_channels import Sight

SHAPE = (24, 24, 16)


def labelled_box(seed=0):
    """Two halves of different classes, seen everywhere, with the true labels as votes."""
    kinds = np.zeros(SHAPE, np.int64)
    kinds[12:] = 1 + seed % 10
    votes = np.zeros((kinds.size, 11), np.uint8)
    votes[np.arange(kinds.size), kinds.reshape(-1)] = 255
    at = np.arange(kinds.size, dtype=np.int32)
    return Sight(np.full(SHAPE, 60, np.int8), at, np.full(len(at), 40, np.uint8), 0.08, votes=votes)


def test_the_stored_votes_are_shares_for_every_class():
    known = segmenter_votes()
    assert known.shape[::2] == (11, 11)
    assert np.allclose(known.sum(axis=2), 1, atol=1e-5)
    right = [(rows.argmax(axis=1) == kind).mean() for kind, rows in enumerate(known)]
    assert min(right) > 0.1
    assert right[1] > 0.9  # Floors.
    assert np.mean(right) < 0.9


@given(st.integers(0, 1 << 30))
def test_votes_are_shares_and_the_same_for_a_seed(seed):
    sight = labelled_box(seed)
    one, other = (simulate_votes(sight, np.random.default_rng(seed)) for _ in range(2))
    assert np.array_equal(one.votes, other.votes)
    sums = one.votes.astype(int).sum(axis=1)
    assert ((sums == 0) | (np.abs(sums - 255) <= 11)).all()
    assert not np.array_equal(one.votes, sight.votes)


def test_neighbours_of_one_class_share_their_errors(monkeypatch):
    monkeypatch.setattr(simulated_votes, "NETWORK_SHARE", 1.0)
    votes = simulate_votes(labelled_box(), np.random.default_rng(4)).votes.reshape(*SHAPE, 11)
    same = (votes[:, :, 1:] == votes[:, :, :-1]).all(axis=-1)
    assert same.mean() > 0.5
    assert len(np.unique(votes.reshape(-1, 11), axis=0)) > 20


def test_cells_without_true_votes_get_none():
    sight = labelled_box()
    silent = sight.votes.copy()
    silent[::2] = 0
    found = simulate_votes(replace(sight, votes=silent), np.random.default_rng(1))
    assert not found.votes[::2].any()
    assert found.votes[1::2].any(axis=1).mean() > 0.7
    assert simulate_votes(replace(sight, votes=None), np.random.default_rng(1)).votes is None


def test_votes_are_grouped_by_class_and_place():
    cells = np.array([[0, 0, 0], [1, 1, 1], [0, 1, 0], [9, 9, 9]])
    votes = np.eye(11)[[3, 4, 5, 6]]
    grouped = group_votes(votes, np.array([2, 2, 7, 2]), cells)
    assert [len(rows) for rows in grouped] == [0, 0, 2, 0, 0, 0, 0, 1, 0, 0, 0]
    assert sorted(map(tuple, grouped[2])) == sorted(
        [tuple(np.eye(11)[[3, 4]].mean(axis=0)), tuple(np.eye(11)[6])]
    )


def test_every_second_sample_is_scored_with_votes():
    sample = Sample(labelled_box(), np.zeros(SHAPE, np.uint8), "walk", False, 0.0)
    first, second = prepare_evaluation([sample, sample], 5)
    assert second.sight.votes is None
    again, _ = prepare_evaluation([sample, sample], 5)
    assert np.array_equal(first.sight.votes, again.sight.votes)
    assert not np.array_equal(first.sight.votes, sample.sight.votes)
    assert not np.array_equal(first.sight.votes, prepare_evaluation([sample], 6)[0].sight.votes)
