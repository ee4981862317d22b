"""Memory grows with what was seen, and numbers stay where they are."""

import numpy as np
import pytest

from world2minecraft.core.classes import CLASS_COUNT
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.files import MAX_ARRAY_BYTES
from world2minecraft.core.types import PointEvidence
from world2minecraft.reconstruction.fusion import EvidenceMap
from world2minecraft.reconstruction.fusion.integration import place_of
from world2minecraft.reconstruction.fusion.voxel_blocks import BLOCK_CELLS, MAX_CELLS, SIDE, Blocks


def test_a_cell_keeps_its_place_while_the_table_grows():
    blocks = Blocks()
    blocks.reserve_box(np.array([0, 0, 0]), np.array([9, 9, 9]), 0.08)
    place = place_of(3, 8, 1, blocks.by_cell)
    blocks.log_odds[place] = 2.5
    blocks.reserve_box(np.array([-400, -9, -100]), np.array([50, 50, 50]), 0.08)
    assert place_of(3, 8, 1, blocks.by_cell) == place
    assert blocks.log_odds[place] == 2.5 and blocks.used[0] == 1


def test_every_cell_of_a_block_has_a_place_of_its_own():
    blocks = Blocks()
    blocks.reserve_box(np.array([-SIDE] * 3), np.array([SIDE] * 3), 0.08)
    ticks = range(-SIDE, SIDE)
    places = {
        place_of(i, j, k, blocks.by_cell)
        for i in ticks for j in ticks for k in ticks
    }  # fmt: skip
    assert places == set(range(BLOCK_CELLS, 9 * BLOCK_CELLS))


def test_a_long_thin_look_fills_few_blocks_of_its_box():
    points_m = np.array([[5.0, 5.0, 5.0], [5.001, 5.0, 5.0], [5.0, 5.001, 5.0]], np.float32)
    map_ = EvidenceMap(np.eye(4))
    map_.add(PointEvidence("v", np.zeros(3), points_m, np.full(3, 0.01, np.float32)))
    assert map_.blocks.used[0] <= 3 * (5.0 / 0.64 + 2)
    assert map_.blocks.table.size > 400
    assert map_.fused().log_odds.shape == (63, 63, 64)  # And the layer below z = 0.


def test_a_box_of_a_town_is_refused_before_memory_is_taken():
    blocks = Blocks()
    with pytest.raises(
        CaptureError,
        match="spans 8000 x 8000 x 800 m, too large for the grid",
    ):
        blocks.reserve_box(np.array([0, 0, 0]), np.array([10**5, 10**5, 10**4]), 0.08)
    assert blocks.table.size == 0


def test_cells_are_found_after_growth_on_every_side():
    blocks = Blocks()
    blocks.reserve_box(np.array([0, 0, 0]), np.array([9, 9, 9]), 0.08)
    corners = [(0, 0, 0), (-9, -17, -25), (25, 33, 41)]
    places = []
    blocks.reserve_box(np.array(corners[1]), np.array(corners[2]) + 1, 0.08)
    for corner in corners:
        places.append(place_of(*corner, blocks.by_cell))
    numbers, first = blocks.cells_of_blocks()
    assert sorted(place // BLOCK_CELLS for place in places) == sorted(numbers) == [1, 2, 3]
    for corner, place in zip(corners, places, strict=True):
        at = first[list(numbers).index(place // BLOCK_CELLS)]
        assert (at == np.array(corner) // SIDE * SIDE).all()
    blocks.reserve_box(np.array([0, 0, 0]), np.array([8, 8, 24]), 0.08)  # Two of them are new.
    assert len(blocks.log_odds) >= (3 + 2 + 1) * BLOCK_CELLS


def test_memory_is_reserved_once_for_what_is_used():
    blocks = Blocks()
    blocks.used[:] = 1000, 50
    blocks.reserve_box(np.zeros(3, np.int64), np.array([8, 8, 8]), 0.08)
    assert len(blocks.log_odds) == len(blocks.record) == (1000 + 1 + 1) * BLOCK_CELLS
    blocks.reserve_records(7)
    assert len(blocks.hits) == len(blocks.votes) == 50 + 7 + 1
    hits = blocks.hits
    blocks.reserve_records(7)
    assert blocks.hits is hits


def test_a_capture_that_fills_too_many_cells_is_refused():
    blocks = Blocks()
    blocks.used[0] = MAX_CELLS // BLOCK_CELLS
    blocks.reserve_box(np.zeros(3, np.int64), np.array([8, 8, 8]), 0.08)
    blocks.used[0] += 1
    with pytest.raises(CaptureError, match="needs too many cells; use larger cells"):
        blocks.reserve_box(np.zeros(3, np.int64), np.array([8, 8, 8]), 0.08)


@pytest.mark.parametrize(("share", "fits"), [(0.98, True), (1.02, False)])
def test_maps_whose_votes_cannot_be_read_back_are_refused(share, fits):
    """Of evidence.npz, in which they are halves, twelve a cell; zeros take no memory here."""
    map_ = EvidenceMap(np.eye(4))
    side = round((share * MAX_ARRAY_BYTES / (2 * CLASS_COUNT)) ** (1 / 3) / SIDE) * SIDE
    for corner in (np.zeros(3, np.int64), np.full(3, side - 1)):
        map_.blocks.reserve_box(corner, corner + 1, 0.08)
        place_of(*corner, map_.blocks.by_cell)
    if fits:
        assert map_._dense()[0].shape == (side,) * 3
    else:
        extent = " x ".join([f"{side * 0.08:.0f}"] * 3)
        with pytest.raises(CaptureError, match=f"spans {extent} m but most of that is empty"):
            map_._dense()
