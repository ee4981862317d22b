"""Chairs that touch are told apart, a back over a table joins its seat, one chair stays one."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.coordinates import turn_grid
from world2minecraft.core.types import OccupancyGrid
from world2minecraft.furniture import template, template_cells
from world2minecraft.reconstruction.instances import InstanceParameters
from world2minecraft.reconstruction.instances.split_chairs import (
    merge_chair_backs,
    split_touching_chairs,
)

RULES = InstanceParameters()
SHAPE = (44, 40, 20)


def _room(*pieces):
    """Return labels with a floor and templates (name, turns, x, y)."""
    labels = np.zeros(SHAPE, np.uint8)
    labels[:, :, 0] = SemanticClass.FLOOR
    for name, turns, x, y in pieces:
        one = template(name)
        cells = template_cells(one, one.typical_m, None, turns, (x, y, 1))
        labels[tuple(cells.T)] = one.class_id
    return labels


def _grid(labels):
    return OccupancyGrid(
        labels=labels,
        confidence=np.full(labels.shape, 0.5, np.float16),
        colour=np.zeros((*labels.shape, 3), np.uint8),
        source=(labels != 255).astype(np.uint8),
        instance=np.zeros(labels.shape, np.uint16),
        voxel_m=0.08,
        origin_m=np.array([0.0, 0.0, -0.08]),
    )


def _parted(labels):
    owners = (labels == SemanticClass.CHAIR).astype(np.int32)
    return split_touching_chairs(owners, _grid(labels), RULES)


@pytest.mark.parametrize(("first", "second"), [(0, 0), (0, 2), (1, 1), (3, 1), (0, 1)])
@pytest.mark.parametrize("turned", [0, 1])
def test_two_chairs_that_touch_are_two(first, second, turned):
    labels = turn_grid(_room(("chair", first, 10, 10), ("chair", second, 16, 12)), turned)
    parted = _parted(np.ascontiguousarray(labels))
    numbers, counts = np.unique(parted[parted > 0], return_counts=True)
    assert len(numbers) == 2
    assert counts.min() >= 0.4 * counts.sum()


def test_three_chairs_in_a_row_are_three():
    parted = _parted(_room(*(("chair", 1, 8 + 6 * n, 10) for n in range(3))))
    assert len(np.unique(parted[parted > 0])) == 3


@pytest.mark.parametrize("name", ["chair", "armchair", "office_chair", "stool"])
@pytest.mark.parametrize("turns", [0, 1])
def test_one_chair_of_any_kind_stays_one(name, turns):
    labels = _room((name, turns, 10, 10))
    np.testing.assert_array_equal(_parted(labels), labels == SemanticClass.CHAIR)


@settings(max_examples=10)
@given(st.integers(0, 2**32 - 1))
def test_no_cell_is_lost_and_none_changes_its_class(seed):
    rng = np.random.default_rng(seed)
    labels = _room(("chair", 0, 10, 10), ("chair", int(rng.integers(4)), 16, 11))
    labels[rng.random(SHAPE) < 0.01] = SemanticClass.CHAIR
    labels[rng.random(SHAPE) < 0.2] = 255
    parted = _parted(labels)
    np.testing.assert_array_equal(parted > 0, labels == SemanticClass.CHAIR)


def _seat_and_back(gap):
    labels = _room()
    labels[10:16, 10:16, 5:7] = SemanticClass.CHAIR
    labels[10:16, 16 + gap : 18 + gap, 8:11] = SemanticClass.CHAIR
    owners = np.zeros(SHAPE, np.int32)
    owners[10:16, 10:16, 5:7] = 1
    owners[10:16, 16 + gap : 18 + gap, 8:11] = 2
    return labels, owners


def test_a_back_joins_the_seat_beside_it_and_none_farther_off():
    labels, owners = _seat_and_back(0)
    np.testing.assert_array_equal(merge_chair_backs(owners, _grid(labels), RULES), owners > 0)
    labels, owners = _seat_and_back(4)
    np.testing.assert_array_equal(merge_chair_backs(owners, _grid(labels), RULES), owners)


def test_a_seat_takes_one_back_alone():
    labels, owners = _seat_and_back(0)
    labels[10:16, 8:10, 8:11] = SemanticClass.CHAIR
    owners[10:16, 8:10, 8:11] = 3
    assert len(np.unique(merge_chair_backs(owners, _grid(labels), RULES))) == 3


def test_the_top_of_a_far_back_is_no_part_of_its_neighbour():
    labels = _room(("chair", 0, 10, 10))
    labels[26:28, 12:18, 9:12] = SemanticClass.CHAIR
    parted = _parted(labels)
    assert len(np.unique(parted[26:28, 12:18, 9:12])) == 1
    assert parted[26, 12, 9] not in parted[10:20, 10:20]


def test_crumbs_of_a_chair_stay_with_it():
    labels = _room(("chair", 0, 10, 10))
    labels[26:28, 12:14, 9] = SemanticClass.CHAIR
    parted = _parted(labels)
    assert parted[26, 12, 9] in parted[10:20, 10:20]
