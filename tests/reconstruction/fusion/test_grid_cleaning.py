"""Cleaning and reading out, cell by cell on grids that were drawn by hand."""

import numpy as np
import pytest

from world2minecraft.core.errors import UsageError
from world2minecraft.core.types import FusedEvidence, OccupancyGrid
from world2minecraft.reconstruction.fusion import (
    CleaningParameters,
    close_structure,
    extract_grid,
    remove_floaters,
)
from world2minecraft.reconstruction.fusion.grid_cleaning import structure_layers


def grid_of(labels: np.ndarray) -> OccupancyGrid:
    shape = labels.shape
    colour = np.zeros((*shape, 3), np.uint8)
    colour[..., 0], colour[..., 1] = (
        np.arange(shape[0])[:, None, None],
        np.arange(shape[1])[:, None],
    )
    known = labels != 255
    return OccupancyGrid(
        labels=labels,
        confidence=known.astype(np.float16),
        colour=colour,
        source=known.astype(np.uint8),
        instance=np.zeros(shape, np.uint16),
        voxel_m=0.08,
        origin_m=np.zeros(3),
    )


@pytest.mark.parametrize(("cells", "stays"), [(5, False), (6, True)])
def test_five_cells_are_noise_and_six_are_not(cells, stays):
    labels = np.zeros((9, 9, 9), np.uint8)
    labels[2, 2, 1 : 1 + cells] = 11
    cleaned = remove_floaters(grid_of(labels), CleaningParameters())
    assert (cleaned.labels == 11).sum() == (cells if stays else 0)
    assert (cleaned.labels != 255).all()


def test_parts_that_meet_at_a_corner_are_one():
    labels = np.zeros((9, 9, 9), np.uint8)
    labels[2, 2, 1:4], labels[3, 3, 4:7] = 11, 8
    cleaned = remove_floaters(grid_of(labels), CleaningParameters())
    np.testing.assert_array_equal(cleaned.labels, labels)


@pytest.mark.parametrize("label", [0, 11, 255])
def test_a_grid_of_one_kind_stays_as_it_is(label):
    grid = grid_of(np.full((3, 3, 3), label, np.uint8))
    cleaned = remove_floaters(grid, CleaningParameters())
    np.testing.assert_array_equal(cleaned.labels, grid.labels)


def test_many_cells_that_are_free_or_unknown_are_no_part():
    labels = np.full((9, 9, 9), 255, np.uint8)
    labels[:, :, 5:] = 0
    labels[4, 4, 4] = 7
    cleaned = remove_floaters(grid_of(labels), CleaningParameters())
    assert cleaned.labels[4, 4, 4] == 0
    assert (cleaned.labels[:, :, :4] == 255).all() and (cleaned.labels[:, :, 5:] == 0).all()


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_layer_of_a_hundred_flat_cells_is_a_surface(axis):
    """A square of 10 x 10 is flat all over; with a corner off, its neighbours are flat still."""
    mask = np.zeros((12, 12, 12), bool)
    layer = [slice(1, 11)] * 3
    layer[axis] = 5
    mask[tuple(layer)] = True
    assert structure_layers(mask, axis) == [5]
    assert [structure_layers(mask, other) for other in range(3) if other != axis] == [[], []]
    corner = [1, 1, 1]
    corner[axis] = 5
    mask[tuple(corner)] = False
    assert structure_layers(mask, axis) == []


# Which cells of a class close a hole, by the axis across them.
SURFACES = [(2, 2, "the floor"), (1, 2, "the ceiling"), (3, 0, "a wall"), (3, 1, "another wall")]


@pytest.mark.parametrize(("class_id", "axis", "_what"), SURFACES)
@pytest.mark.parametrize(("width", "closed"), [(4, True), (5, False)])
def test_a_hole_of_32_cm_is_closed_and_a_wider_one_is_not(class_id, axis, _what, width, closed):
    """Both surfaces reach the grid's edge, where nothing may be filled in beyond them."""
    labels = np.zeros((24, 24, 24), np.uint8)
    layer, hole = [slice(None)] * 3, [slice(9, 9 + width)] * 3
    layer[axis] = hole[axis] = 7
    labels[tuple(layer)] = class_id
    labels[tuple(hole)] = 255
    found = close_structure(grid_of(labels), CleaningParameters())
    filled = np.zeros(labels.shape, bool)
    filled[tuple(hole)] = closed
    np.testing.assert_array_equal(found.labels, np.where(filled, class_id, labels))
    np.testing.assert_array_equal(found.source == 2, filled)
    assert (found.confidence[filled] == 0.5).all()
    np.testing.assert_array_equal(found.confidence[labels != 255], 1)


def test_only_unknown_cells_are_filled_by_adjacent_colour():
    labels = np.zeros((24, 24, 3), np.uint8)
    labels[:, :, 1] = 2
    labels[8:12, 8:12, 1] = 255
    labels[9, 9, 1], labels[10, 10, 1] = 0, 8
    found = close_structure(grid_of(labels), CleaningParameters())
    assert found.labels[9, 9, 1] == 0 and found.labels[10, 10, 1] == 8
    assert (found.source == 2).sum() == 14
    assert found.colour[8, 10, 1, 0] == 7 and found.colour[11, 10, 1, 0] == 12
    assert found.colour[10, 8, 1, 1] == 7 and found.colour[10, 11, 1, 1] == 12
    assert (found.colour[9, 9, 1] == [9, 9, 0]).all(), "what is free keeps its own"


def evidence_of(log_odds, votes=None, hits=None, colour_sum=None) -> FusedEvidence:
    log_odds = np.array(log_odds, np.float16).reshape(-1, 1, 1)
    shape = log_odds.shape
    return FusedEvidence(
        log_odds=log_odds,
        votes=np.zeros((*shape, 12), np.float16) if votes is None else votes,
        colour_sum=np.zeros((*shape, 3), np.float32) if colour_sum is None else colour_sum,
        offset_sum=np.zeros((*shape, 3), np.float32),
        hits=np.ones(shape, np.uint16) if hits is None else hits,
        voxel_m=0.08,
        origin_m=np.zeros(3),
        scan_to_room=np.eye(4),
    )


def test_log_odds_say_what_a_cell_is_and_how_surely():
    grid = extract_grid(evidence_of([2.0, -2.0, 0.0, 0.001, -0.001]))
    assert grid.labels.ravel().tolist() == [11, 0, 255, 11, 0]
    assert grid.source.ravel().tolist() == [1, 1, 0, 1, 1]
    assert not grid.instance.any()
    chance = 1 / (1 + np.exp(-2.0))
    assert grid.confidence.ravel()[:3] == pytest.approx([chance, chance, 0.0], abs=1e-3)
    assert grid.confidence.ravel()[3:] == pytest.approx([0.5, 0.5], abs=1e-3)


def test_most_votes_name_a_cell_and_empty_has_no_vote():
    votes = np.zeros((4, 1, 1, 12), np.float16)
    votes[0, 0, 0, [0, 3, 8]] = 9, 1, 2
    votes[1, 0, 0, 0] = 9
    votes[2, 0, 0, 1] = 0.01
    votes[3, 0, 0, 8] = 5
    grid = extract_grid(evidence_of([1.0, 1.0, 1.0, -1.0], votes))
    assert grid.labels.ravel().tolist() == [8, 11, 1, 0]


def test_a_colour_is_the_rounded_mean_of_the_points():
    hits = np.array([2, 0, 3], np.uint16).reshape(-1, 1, 1)
    colour_sum = np.array([[3, 511, 0], [7, 7, 7], [2, 1, 900]], np.float32).reshape(3, 1, 1, 3)
    grid = extract_grid(evidence_of([1.0, 1.0, 1.0], hits=hits, colour_sum=colour_sum))
    assert grid.colour.reshape(3, 3).tolist() == [[2, 255, 0], [7, 7, 7], [1, 0, 255]]


@pytest.mark.parametrize(("width", "flat"), [(2, False), (3, True)])
def test_a_strip_of_three_cells_is_flat_and_one_of_two_is_not(width, flat):
    mask = np.zeros((5, 8, 60), bool)
    mask[2, 2 : 2 + width, 2:58] = True
    assert structure_layers(mask, 0) == ([2] if flat else [])


def test_what_cannot_be_cleaned_is_refused():
    CleaningParameters(floater_cells=0, hole_m=0.0), CleaningParameters(hole_m=10.0)
    for wrong in ({"floater_cells": -1}, {"hole_m": -0.01}, {"hole_m": 10.01}):
        with pytest.raises(UsageError, match="must be"):
            CleaningParameters(**wrong)
