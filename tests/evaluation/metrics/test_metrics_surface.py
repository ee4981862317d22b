"""Precision and recall within one cell, against a slow reading."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as stn

from world2minecraft.evaluation.metrics.surface_scores import (
    SurfaceCounts,
    count_surface,
    free_space_recall,
)

SETS = stn.arrays(np.bool_, (4, 3, 5))
HOW = [("chebyshev", 0), ("chebyshev", 1), ("chebyshev", 2)]
HOW += [("euclidean", 0), ("euclidean", 1), ("euclidean", 1.5)]


def slow_near(cells, others, within, distance):
    """How many cells have a cell of the others within a distance."""
    places = np.argwhere(others)
    near = 0
    for cell in np.argwhere(cells):
        steps = np.abs(places - cell)
        apart = steps.max(axis=1) if distance == "chebyshev" else np.sqrt((steps**2).sum(axis=1))
        near += bool(len(places)) and bool((apart <= within).any())
    return near


@given(SETS, SETS, st.sampled_from(HOW))
def test_counts_follow_their_definition(found, true, how):
    distance, within = how
    counts = count_surface(found, true, within_cells=within, distance=distance)
    assert counts == SurfaceCounts(
        int(found.sum()),
        slow_near(found, true, within, distance),
        int(true.sum()),
        slow_near(true, found, within, distance),
    )


@given(SETS, SETS)
def test_precision_and_recall_change_places_with_the_sets(found, true):
    one, other = count_surface(found, true), count_surface(true, found)
    assert (one.precision, one.recall) == (other.recall, other.precision)


@given(SETS)
def test_a_shift_by_one_cell_costs_nothing(cells):
    padded = np.pad(cells, 1)
    counts = count_surface(padded, np.roll(padded, (1, -1, 1), axis=(0, 1, 2)))
    assert counts.precision == counts.recall == 1.0


@given(SETS, SETS, SETS, SETS)
def test_counts_add_up(a, b, c, d):
    gap = np.zeros((2, 3, 5), bool)  # Keeps the two scenes further apart than the tolerance.
    together = count_surface(np.concatenate([a, gap, c]), np.concatenate([b, gap, d]))
    assert count_surface(a, b) + count_surface(c, d) == together


def test_a_mask_chooses_what_counts_but_not_what_is_near():
    found = np.array([[[1, 1, 0, 0]]], bool)
    true = np.array([[[0, 0, 1, 1]]], bool)
    only_last = np.array([[[0, 1, 0, 0]]], bool)
    counts = count_surface(found, true, found_mask=only_last)
    assert (counts.found, counts.found_near, counts.true, counts.true_near) == (1, 1, 2, 1)
    counts = count_surface(found, true, true_mask=np.array([[[1, 0, 0, 1]]], bool))
    assert (counts.found, counts.found_near, counts.true, counts.true_near) == (2, 1, 1, 0)


@given(SETS, SETS)
def test_nothing_counted_adds_nothing(found, true):
    counts = count_surface(found, true)
    assert counts + SurfaceCounts() == counts


def test_figures_by_hand():
    counts = SurfaceCounts(found=10, found_near=9, true=20, true_near=10)
    assert (counts.precision, counts.recall) == (0.9, 0.5)
    assert counts.f_score == pytest.approx(2 * 0.9 * 0.5 / 1.4)


def test_free_space_counts_only_free_cells_of_the_truth():
    free = np.array([[[1, 1, 0, 0]]], bool)
    true_free = np.array([[[1, 0, 1, 0]]], bool)
    assert free_space_recall(free, true_free) == 0.5
    assert free_space_recall(free, np.zeros_like(free)) == 1.0


@pytest.mark.parametrize(
    "wrong",
    [{"within_cells": -1}, {"within_cells": 1.5}, {"distance": "manhattan"}],
)
def test_wrong_distances_are_refused(wrong):
    cells = np.ones((2, 2, 2), bool)
    with pytest.raises(ValueError, match="distance|within_cells"):
        count_surface(cells, cells, **wrong)


def test_different_shapes_are_refused():
    with pytest.raises(ValueError, match="same shape"):
        count_surface(np.ones((2, 2, 2), bool), np.ones((2, 2, 3), bool))


@given(SETS, SETS, SETS)
def test_free_space_is_asked_for_within_the_mask_alone(free, true, mask):
    asked = [tuple(cell) for cell in np.argwhere(true) if mask[tuple(cell)]]
    expected = np.mean([free[cell] for cell in asked]) if asked else 1.0
    assert free_space_recall(free, true, mask) == pytest.approx(expected)
