"""Cupboards in a row: hung and tall ones are told from counters; an L of one height is one."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from world2minecraft.classes import SemanticClass
from world2minecraft.find.rows import part_rows
from world2minecraft.furniture import surface


def _room(*boxes):
    labels = np.zeros((40, 36, 28), np.uint8)
    for x0, y0, z0, x1, y1, z1 in boxes:
        labels[x0:x1, y0:y1, z0:z1] = SemanticClass.FURN
    solid = labels > 0
    labels[solid & ~surface(solid)] = 255
    return labels


def _parted(labels):
    furniture = labels == SemanticClass.FURN
    return part_rows(furniture.astype(np.int32), labels, 0.08)


def test_a_wardrobe_beside_a_board_is_its_own():
    parted = _parted(_room((2, 2, 1, 8, 20, 7), (2, 20, 1, 8, 30, 25)))
    assert len(np.unique(parted[parted > 0])) == 2
    assert len(np.unique(parted[:, 2:19][parted[:, 2:19] > 0])) == 1
    assert parted[2, 5, 5] != parted[2, 25, 24]


def test_what_hangs_over_a_counter_by_a_strip_is_its_own():
    parted = _parted(_room((2, 2, 1, 10, 30, 12), (2, 2, 12, 3, 30, 17), (2, 2, 17, 6, 30, 26)))
    assert parted[9, 10, 5] != parted[5, 10, 22]


def test_an_l_of_counters_a_short_piece_and_other_classes_stay_one():
    corner = _room((2, 2, 1, 10, 34, 12), (10, 2, 1, 36, 10, 12))
    np.testing.assert_array_equal(_parted(corner), corner == SemanticClass.FURN)
    short = _room((2, 2, 1, 8, 8, 7), (2, 8, 1, 8, 14, 25))
    np.testing.assert_array_equal(_parted(short), short == SemanticClass.FURN)
    table = np.where(corner == SemanticClass.FURN, SemanticClass.TABLE, corner)
    owners = (table == SemanticClass.TABLE).astype(np.int32)
    np.testing.assert_array_equal(part_rows(owners, table, 0.08), owners)


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
