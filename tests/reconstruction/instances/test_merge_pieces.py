"""Pieces of an object's colour that lie against it are part of it; other things on it are not."""

from dataclasses import replace

import numpy as np
import pytest
from tests.reconstruction.instances.test_instances import grid_of

from world2minecraft.core.classes import SemanticClass
from world2minecraft.reconstruction.instances import InstanceParameters, find_objects

SOFA, OBJS, FURN = SemanticClass.SOFA, SemanticClass.OBJS, SemanticClass.FURN
GREY, GREEN = (120, 118, 116), (40, 140, 60)
SEAT, CUSHION = np.s_[6:16, 6:26, 1:6], np.s_[7:9, 8:14, 6:8]

IN_THE_SEAT = np.s_[6:9, 12:15, 3:6]


def _sofa_with(piece, rgb, label=OBJS):
    labels = np.zeros((30, 34, 16), np.uint8)
    labels[:, :, 0] = SemanticClass.FLOOR
    labels[SEAT] = SOFA
    colour = np.full((*labels.shape, 3), GREY, np.uint8)
    labels[piece], colour[piece] = label, rgb
    return replace(grid_of(labels), colour=colour)


@pytest.mark.parametrize("label", [OBJS, FURN])
def test_a_piece_of_the_same_colour_is_of_its_host(label):
    found = find_objects(_sofa_with(CUSHION, GREY, label))
    assert [one.class_id for one in found.instances] == [SOFA]
    assert (found.grid.labels[CUSHION] == SOFA).all()
    assert (found.grid.instance[CUSHION] == found.instances[0].id).all()


@pytest.mark.parametrize(
    ("piece", "rgb"),
    [
        (CUSHION, GREEN),
        (np.s_[7:9, 8:10, 6:14], GREY),  # A lamp, which touches it with its foot.
        (np.s_[20:24, 8:14, 1:5], GREY),  # A stool beside it.
    ],
)
def test_other_things_are_objects(piece, rgb):
    grid = _sofa_with(piece, rgb)
    found = find_objects(grid)
    assert sorted(one.class_id for one in found.instances) == [SOFA, OBJS]
    np.testing.assert_array_equal(found.grid.labels, grid.labels)


def test_pieces_on_pieces_go_to_the_same_host():
    grid = _sofa_with(CUSHION, GREY)
    labels = grid.labels.copy()
    labels[7:9, 9:12, 8:10] = FURN
    found = find_objects(replace(grid, labels=labels))
    assert [one.class_id for one in found.instances] == [SOFA]


def test_an_object_surrounded_by_another_is_part_of_it():
    """Three of its sides and its bottom: a gap between cushions, not a thing on a seat."""
    found = find_objects(_sofa_with(IN_THE_SEAT, GREEN))
    assert [one.class_id for one in found.instances] == [SOFA]
    assert (found.grid.labels[IN_THE_SEAT] == SOFA).all()
    oven = find_objects(_sofa_with(IN_THE_SEAT, GREEN, FURN))
    assert len(oven.instances) == 2


def test_a_cushion_that_label_images_state_is_kept():
    grid = _sofa_with(CUSHION, GREY)
    stated = np.ones(grid.shape, bool)
    found = find_objects(grid, stated=stated)
    assert sorted(one.class_id for one in found.instances) == [SOFA, OBJS]


def test_the_method_of_the_paper_keeps_pieces():
    grid = _sofa_with(CUSHION, GREY)
    found = find_objects(grid, InstanceParameters(paper_compat=True))
    np.testing.assert_array_equal(found.grid.labels, grid.labels)
