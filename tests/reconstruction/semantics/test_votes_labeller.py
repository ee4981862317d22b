"""Votes: the winner of each cell, the geometric label where nothing voted, smoothing."""

from dataclasses import replace

import label_rooms as rooms
import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as stn

from world2minecraft.reconstruction.semantics.geometric_labeller import GeometricLabeller
from world2minecraft.reconstruction.semantics.smoothing import smooth_labels
from world2minecraft.reconstruction.semantics.votes_labeller import (
    ON_WALL_PENALTY,
    VotesLabeller,
    geometric_prior,
    is_from_network,
)


def furnished():
    room = rooms.SmallRoom()
    rooms.table(room, 1.6, 2.0)
    return room


def test_votes_decide():
    grid, evidence, truth = furnished().scanned(votes=True)
    result = VotesLabeller().label(grid, evidence)
    kept = result.occupied & (truth > 0)
    assert (result.labels[kept] == truth[kept]).mean() > 0.99


def test_wrong_votes_are_outvoted():
    grid, evidence, truth = furnished().scanned(votes=True)
    random = np.random.default_rng(0)
    noisy = evidence.votes.astype(np.float32)
    noisy[..., 1:] += random.random(noisy[..., 1:].shape) * 0.9 * noisy.sum(axis=3)[..., None]
    noisy = noisy.astype(np.float16)
    result = VotesLabeller().label(grid, replace(evidence, votes=noisy))
    kept = result.occupied & (truth > 0)
    assert (result.labels[kept] == truth[kept]).mean() > 0.99


def test_shape_counts_less_beside_votes_of_a_network():
    whole = np.zeros((4, 11), np.float32)
    whole[:, 2] = 3
    soft = whole + np.float32(0.25)
    labels = np.array([3, 1, 10, 11])  # Wall, ceiling, furniture, object.
    assert not is_from_network(whole).any()
    assert is_from_network(soft).all()
    beside_labels, beside_network = geometric_prior(labels, whole), geometric_prior(labels, soft)
    at = (np.arange(4), labels - 1)
    assert (beside_labels[at] > beside_network[at]).all()
    assert (beside_network[at] > 0).all()
    assert beside_network[0, 10] == np.float32(-ON_WALL_PENALTY)
    assert (np.delete(beside_network, 10, axis=1) >= 0).all()
    assert (beside_labels >= 0).all()


def test_without_votes_the_geometric_label_stands():
    grid, evidence, _ = furnished().scanned()
    result = VotesLabeller(small_cells=0).label(grid, evidence)
    assert np.array_equal(result.labels, GeometricLabeller().label(grid, evidence).labels)


def test_confidence_is_the_share_of_the_votes():
    grid, evidence, _ = furnished().scanned(votes=True)
    cell = tuple(np.argwhere(grid.occupied)[0])
    votes = np.array(evidence.votes)
    votes[cell] = 0
    votes[(*cell, 3)], votes[(*cell, 10)] = 6, 2
    result = VotesLabeller().label(grid, replace(evidence, votes=votes))
    expected = 6 / 8 * float(grid.confidence[cell])
    assert abs(float(result.confidence[cell]) - expected) < 1e-3


def test_a_vote_for_empty_never_empties_a_cell():
    grid, evidence, _ = furnished().scanned()
    votes = np.zeros(evidence.votes.shape, np.float16)
    votes[..., 0], votes[..., 10] = 9, 1
    result = VotesLabeller().label(grid, replace(evidence, votes=votes))
    table_high = np.zeros(grid.shape, bool)
    table_high[:, :, rooms.MARGIN + 4 :] = True
    assert (result.labels[result.occupied & table_high] == 10).all()


LABELS = stn.arrays(np.uint8, (5, 4, 4), elements=st.sampled_from([0, 0, 2, 3, 11, 255]))


@given(LABELS, st.integers(0, 5))
def test_smoothing_keeps_what_is_occupied_empty_and_unknown(labels, small_cells):
    result = smooth_labels(labels, small_cells)
    occupied = (labels > 0) & (labels < 255)
    assert np.array_equal(result[~occupied], labels[~occupied])
    assert ((result[occupied] >= 1) & (result[occupied] <= 11)).all()


@given(LABELS)
def test_smoothing_of_nothing_small_changes_nothing(labels):
    assert np.array_equal(smooth_labels(labels, 1), labels)


def test_a_single_cell_takes_the_class_around_it():
    labels = np.zeros((5, 5, 3), np.uint8)
    labels[:, :, 1] = 2
    labels[2, 2, 1] = 9
    labels[4, 4, 1] = labels[4, 3, 1] = labels[3, 4, 1] = 8
    result = smooth_labels(labels, 3)
    assert result[2, 2, 1] == 2
    assert (result == 8).sum() == 3


def test_a_part_without_neighbours_keeps_its_class():
    labels = np.zeros((3, 3, 3), np.uint8)
    labels[1, 1, 1] = 5
    assert smooth_labels(labels, 3)[1, 1, 1] == 5
