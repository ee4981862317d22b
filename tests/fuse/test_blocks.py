"""Memory grows with what was seen, and numbers stay where they are."""

import numpy as np
import pytest

from world2minecraft.errors import CaptureError
from world2minecraft.fuse import EvidenceMap
from world2minecraft.fuse.blocks import BLOCK_CELLS, SIDE, Blocks
from world2minecraft.fuse.kernels import place_of
from world2minecraft.types import PointEvidence


def test_a_cell_keeps_its_place_while_the_table_grows():
    blocks = Blocks()
    blocks.reserve_box(np.array([0, 0, 0]), np.array([9, 9, 9]), 0.08)
    place = place_of(3, 8, 1, blocks.low, blocks.table, blocks.used)
    blocks.log_odds[place] = 2.5
    blocks.reserve_box(np.array([-400, -9, -100]), np.array([50, 50, 50]), 0.08)
    assert place_of(3, 8, 1, blocks.low, blocks.table, blocks.used) == place
    assert blocks.log_odds[place] == 2.5 and blocks.used[0] == 1


def test_every_cell_of_a_block_has_a_place_of_its_own():
    blocks = Blocks()
    blocks.reserve_box(np.array([-SIDE] * 3), np.array([SIDE] * 3), 0.08)
    ticks = range(-SIDE, SIDE)
    places = {
        place_of(i, j, k, blocks.low, blocks.table, blocks.used)
        for i in ticks for j in ticks for k in ticks
    }  # fmt: skip
    assert places == set(range(BLOCK_CELLS, 9 * BLOCK_CELLS))


def test_a_long_thin_look_fills_few_blocks_of_its_box():
    points_m = np.array([[5.0, 5.0, 5.0], [5.001, 5.0, 5.0], [5.0, 5.001, 5.0]], np.float32)
    map_ = EvidenceMap(np.eye(4))
    map_.add(PointEvidence("v", np.zeros(3), points_m, np.full(3, 0.01, np.float32)))
    assert map_.blocks.used[0] <= 3 * (5.0 / 0.64 + 2)
    assert map_.blocks.table.size > 400
    assert map_.fused().log_odds.shape == (63, 63, 63)


def test_a_box_of_a_town_is_refused_before_memory_is_taken():
    blocks = Blocks()
    with pytest.raises(CaptureError, match="larger --voxel"):
        blocks.reserve_box(np.array([0, 0, 0]), np.array([10**5, 10**5, 10**4]), 0.08)
    assert blocks.table.size == 0
