"""Merging of pieces of one recognised thing."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.reconstruction.instances.test_instances import grid_of

from world2minecraft.core.vocabulary import nyu40_names
from world2minecraft.geometry.connected_components import touching_pairs
from world2minecraft.reconstruction.instances import find_objects
from world2minecraft.reconstruction.instances.merge_named import merge_same_names

OBJS, FURN = 11, 10


def pieces(gap=0, length=5):
    """Return labels and owners of a bowl (1) and the cistern behind it (2)."""
    labels, owners = np.zeros((2, 40, 8, 14), np.uint8)
    owners = owners.astype(np.int32)
    labels[2 : 2 + length, 2:6, :5], owners[2 : 2 + length, 2:6, :5] = OBJS, 1
    labels[7 + gap : 9 + gap, 2:6, :10], owners[7 + gap : 9 + gap, 2:6, :10] = FURN, 2
    return labels, owners


def votes(*names):
    result = np.zeros((len(names) + 1, 40), np.float32)
    for row, name in enumerate(names, 1):
        if name:
            result[row, nyu40_names()[name] - 1] = 5
    return result


def test_a_toilet_and_its_cistern_become_one():
    labels, owners = pieces()
    found, classes = merge_same_names(owners, grid_of(labels), votes("toilet", "toilet"))
    assert (found[owners > 0] == 1).all() and (classes[owners > 0] == OBJS).all()
    assert (classes[owners == 0] == labels[owners == 0]).all()


@pytest.mark.parametrize(
    ("gap", "names"),
    [
        (0, ("toilet", "bathtub")),
        (0, ("toilet", "")),
        (0, ("chair", "chair")),
        (2, ("toilet", "toilet")),
    ],
)
def test_other_pieces_stay_apart(gap, names):
    labels, owners = pieces(gap)
    found, classes = merge_same_names(owners, grid_of(labels), votes(*names))
    assert (found == owners).all() and (classes == labels).all()


def test_two_things_longer_than_one_stay_apart():
    labels, owners = pieces()
    labels[9:20, 2:6, :5], owners[9:20, 2:6, :5] = OBJS, 3
    found, _ = merge_same_names(owners, grid_of(labels), votes("toilet", "toilet", "toilet"))
    assert len(np.unique(found[owners > 0])) == 2 and (found[owners == 3] == 3).all()


def test_the_objects_of_a_room_take_votes_into_account():
    labels, owners = pieces()
    cells = np.argwhere(owners)
    rows = np.repeat(votes("toilet")[1:], len(cells), axis=0)
    apart = find_objects(grid_of(labels))
    joined = find_objects(grid_of(labels), votes=(cells, rows))
    assert len(apart.instances) == 2 and len(joined.instances) == 1
    assert (joined.grid.labels[owners > 0] == OBJS).all()


@given(st.integers(0, 1 << 30))
def test_pairs_that_touch_are_those_of_the_slow_reference(seed):
    owners = np.random.default_rng(seed).integers(0, 5, (4, 3, 3)) * (seed % 2 + 1)
    wanted = set()
    for a in np.argwhere(owners):
        for b in np.argwhere(owners):
            pair = sorted((int(owners[tuple(a)]), int(owners[tuple(b)])))
            if pair[0] != pair[1] and np.abs(a - b).max() <= 1:
                wanted.add(tuple(pair))
    assert touching_pairs(owners) == sorted(wanted)
