"""Cupboards in a row are told apart: what hangs, what is tall, the arms of an L, other fronts."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import OccupancyGrid
from world2minecraft.furniture import surface_cells
from world2minecraft.reconstruction.instances import InstanceParameters
from world2minecraft.reconstruction.instances.cabinet_runs import split_cabinet_runs

RULES = InstanceParameters()


def _room(*boxes):
    labels = np.zeros((40, 36, 28), np.uint8)
    for x0, y0, z0, x1, y1, z1 in boxes:
        labels[x0:x1, y0:y1, z0:z1] = SemanticClass.FURN
    solid = labels > 0
    labels[solid & ~surface_cells(solid)] = 255
    return labels


def _grid(labels, colour=None):
    return OccupancyGrid(
        labels=labels,
        confidence=np.full(labels.shape, 0.5, np.float16),
        colour=np.full((*labels.shape, 3), 120, np.uint8) if colour is None else colour,
        source=(labels != 255).astype(np.uint8),
        instance=np.zeros(labels.shape, np.uint16),
        voxel_m=0.08,
        origin_m=np.array([0.0, 0.0, -0.08]),
    )


def _parted(labels, colour=None):
    furniture = labels == SemanticClass.FURN
    return split_cabinet_runs(furniture.astype(np.int32), _grid(labels, colour), RULES)


def _numbers(parted):
    return np.unique(parted[parted > 0]).tolist()


def test_a_wardrobe_beside_a_board_is_its_own():
    parted = _parted(_room((2, 2, 1, 8, 20, 7), (2, 20, 1, 8, 30, 25)))
    assert len(np.unique(parted[parted > 0])) == 2
    assert len(np.unique(parted[:, 2:19][parted[:, 2:19] > 0])) == 1
    assert parted[2, 5, 5] != parted[2, 25, 24]


def test_what_hangs_over_a_counter_by_a_strip_is_its_own():
    parted = _parted(_room((2, 2, 1, 10, 30, 12), (2, 2, 12, 3, 30, 17), (2, 2, 17, 6, 30, 26)))
    assert parted[9, 10, 5] != parted[5, 10, 22]


def test_longer_arm_of_an_l_of_counters_keeps_the_corner():
    parted = _parted(_room((2, 2, 1, 10, 24, 12), (10, 2, 1, 38, 10, 12)))
    assert len(_numbers(parted)) == 2
    assert parted[3, 3, 11] == parted[30, 3, 11] != parted[3, 20, 11]


def _glossy_l():
    """Return an L of counters whose top was seen at its rim only."""
    labels = _room((2, 2, 1, 10, 24, 12), (10, 2, 1, 38, 10, 12))
    labels[3:9, 3:23] = labels[3:37, 3:9] = 255
    return labels


def test_an_l_of_counters_with_an_unseen_top_is_one_object():
    labels = _glossy_l()
    assert len(_numbers(_parted(labels))) == 1
    colour = np.full((*labels.shape, 3), 120, np.uint8)
    colour[:, 10:] = (150, 40, 40)
    assert len(_numbers(_parted(labels, colour))) == 2


def test_a_cooker_between_two_counters_parts_them():
    labels = _room((2, 2, 1, 10, 34, 12))
    colour = np.full((*labels.shape, 3), 200, np.uint8)
    colour[:, 15:23] = 60
    parted = _parted(labels, colour)
    assert len(_numbers(parted)) == 3
    assert [len(np.unique(parted[9, y0:y1, 5])) for y0, y1 in ((2, 15), (15, 23), (23, 34))] == [
        1
    ] * 3


def test_a_short_piece_a_plain_run_and_other_classes_stay_one():
    short = _room((2, 2, 1, 8, 7, 7), (2, 7, 1, 8, 12, 25))
    np.testing.assert_array_equal(_parted(short), short == SemanticClass.FURN)
    plain = _room((2, 2, 1, 10, 34, 12))
    np.testing.assert_array_equal(_parted(plain), plain == SemanticClass.FURN)
    corner = _room((2, 2, 1, 10, 34, 12), (10, 2, 1, 36, 10, 12))
    table = np.where(corner == SemanticClass.FURN, SemanticClass.TABLE, corner).astype(np.uint8)
    owners = (table == SemanticClass.TABLE).astype(np.int32)
    np.testing.assert_array_equal(split_cabinet_runs(owners, _grid(table), RULES), owners)


def test_an_open_bookcase_is_one():
    labels = np.zeros((40, 36, 28), np.uint8)
    labels[2:6, 2:16, 1:25] = SemanticClass.FURN
    for board in range(2, 20, 5):
        labels[3:6, 3:15, board : board + 4] = 0
    np.testing.assert_array_equal(_parted(labels), labels == SemanticClass.FURN)


def test_things_on_a_counter_are_no_cupboards():
    labels = _room((2, 2, 1, 10, 30, 12), (4, 5, 12, 7, 8, 15), (4, 20, 12, 6, 23, 16))
    np.testing.assert_array_equal(_parted(labels), labels == SemanticClass.FURN)


@settings(max_examples=15)
@given(st.integers(0, 2**32 - 1))
def test_no_cell_is_lost(seed):
    rng = np.random.default_rng(seed)
    labels = _room((2, 2, 1, 8, 20, 7), (2, 20, 1, 8, 30, 25))
    labels[rng.random(labels.shape) < 0.02] = SemanticClass.FURN
    labels[rng.random(labels.shape) < 0.2] = 0
    np.testing.assert_array_equal(_parted(labels) > 0, labels == SemanticClass.FURN)
