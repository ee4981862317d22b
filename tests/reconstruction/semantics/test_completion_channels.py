"""What the completion network is told: the same numbers, cell by cell, as a plain reading gives."""

from dataclasses import replace

import label_rooms as rooms
import numpy as np
import pytest

from world2minecraft.reconstruction.semantics.completion_channels import (
    CHANNELS,
    COLOUR,
    HINT,
    HITS,
    KINDS,
    OFFSET,
    VOTES,
    network_input,
    sight_of,
)


@pytest.fixture(scope="module")
def scanned():
    room = rooms.SmallRoom()
    rooms.table(room, 1.6, 2.0)
    return room.scanned(votes=True)


def test_a_cell_is_occupied_free_or_unknown(scanned):
    grid, evidence, _ = scanned
    cells = network_input(sight_of(grid, evidence))
    assert cells.shape == (CHANNELS, *grid.shape)
    assert np.array_equal(cells[0] > 0, grid.occupied)
    assert np.array_equal(cells[1] > 0, grid.labels == 0)
    assert (cells[:3].sum(axis=0) == 1).all()
    assert np.abs(cells).max() <= 3


def test_channels_hold_what_a_plain_reading_of_a_cell_gives(scanned):
    grid, evidence, _ = scanned
    hint = np.where(grid.occupied, np.uint8(8), np.uint8(0))
    cells = network_input(sight_of(grid, evidence, hint))
    for i, j, k in np.argwhere(grid.occupied)[::97]:
        told, hits = cells[:, i, j, k], float(evidence.hits[i, j, k])
        votes = evidence.votes[i, j, k, 1:].astype(float)
        height = grid.origin_m[2] + (k + 0.5) * grid.voxel_m
        assert told[3] == pytest.approx(float(evidence.log_odds[i, j, k]) / 6, abs=0.01)
        assert told[4] == pytest.approx(height / 2.5, abs=1e-5)
        assert told[HITS] == pytest.approx(np.log1p(hits) / 8, abs=0.01)
        assert told[COLOUR : COLOUR + 3] == pytest.approx(grid.colour[i, j, k] / 127.5 - 1)
        offset = evidence.offset_sum[i, j, k] / hits / 0.04
        assert told[OFFSET : OFFSET + 3] == pytest.approx(np.clip(offset, -1.27, 1.27), abs=0.01)
        assert told[VOTES : VOTES + KINDS] == pytest.approx(votes / votes.sum(), abs=0.01)
        assert told[HINT + 7] == 1
        assert told[HINT : HINT + KINDS].sum() == 1


def test_what_is_missing_is_zero_and_nothing_else_changes(scanned):
    grid, evidence, _ = scanned
    sight = sight_of(grid, evidence, np.where(grid.occupied, np.uint8(8), np.uint8(0)))
    whole = network_input(sight)
    bare = network_input(
        replace(sight, colour=None, offset=None, votes=None, hint=None, bottom_m=None)
    )
    assert not bare[[4, 5]].any()
    assert not bare[COLOUR:HITS].any()
    assert not bare[VOTES:].any()
    assert np.array_equal(bare[:4], whole[:4])
    assert np.array_equal(bare[HITS], whole[HITS])


def test_a_grid_without_votes_or_colours_says_so(scanned):
    grid, evidence, _ = scanned
    grey = replace(
        evidence,
        votes=np.zeros_like(evidence.votes),
        colour_sum=np.zeros_like(evidence.colour_sum),
    )
    sight = sight_of(grid, grey)
    assert sight.votes is None
    assert sight.colour is None
    assert sight.hint is None


def test_the_floor_is_where_it_is_said_to_be(scanned):
    grid, evidence, _ = scanned
    assert sight_of(grid, evidence, floor_m=1.0).bottom_m == pytest.approx(grid.origin_m[2] - 1)
    assert sight_of(grid, evidence, floor_m=None).bottom_m is None
