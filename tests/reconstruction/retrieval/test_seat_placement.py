"""A chair across the grid or hidden by its table becomes a whole chair that looks to the table."""

import numpy as np
import pytest
from label_grids import grid_of

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.coordinates import turn_grid
from world2minecraft.reconstruction.instances import find_objects
from world2minecraft.reconstruction.retrieval import RetrievalParameters, place_templates


def _table_with_back(steep):
    """Return a table and, over its rim, the back of a chair; all else under the top is unseen.

    ``steep``: how many cells along the rim for one away from it; 0 for a straight back.
    """
    labels = np.zeros((44, 40, 20), np.uint8)
    labels[:, :, 0] = SemanticClass.FLOOR
    labels[10:34, 8:20, 1:9] = 255
    labels[10:34, 20:24, 1:8] = 255
    labels[10:34, 8:20, 9] = SemanticClass.TABLE
    for x in range(6):
        y = 22 + (x // steep if steep else 0)
        labels[18 + x, y, 8:12] = SemanticClass.CHAIR
        labels[18 + x, y, 1:8] = 255
    return labels


def _chairs(labels, **changed):
    found = find_objects(grid_of(labels))
    placed = place_templates(found.grid, found.instances, RetrievalParameters(**changed))
    return [one for one in placed if one.class_id == SemanticClass.CHAIR]


@pytest.mark.parametrize("steep", [0, 2, 3])
@pytest.mark.parametrize("turned", [0, 1, 2, 3])
def test_a_back_over_a_table_is_a_whole_chair_that_looks_to_it(steep, turned):
    labels = np.ascontiguousarray(turn_grid(_table_with_back(steep), turned))
    (chair,) = _chairs(labels)
    assert chair.template == "chair"
    assert chair.quarter_turns == (3 + turned) % 4
    assert chair.center_m[2] - chair.size_m[2] / 2 == pytest.approx(0.0)
    assert chair.size_m.min() >= 0.32 - 1e-9


def test_where_the_seat_was_seen_to_be_free_no_chair_is_put():
    labels = _table_with_back(2)
    labels[:, 20:, 1:8][labels[:, 20:, 1:8] == 255] = 0
    labels[10:34, 8:20, 1:9] = 0
    (heap,) = _chairs(labels, seat_opposed=0.1)
    assert heap.template == "cells"


def test_the_papers_equation_knows_no_whole_chairs():
    assert all(one.iou >= 0 for one in _chairs(_table_with_back(2), paper_compat=True))
    (strict,) = _chairs(_table_with_back(2), paper_compat=True)
    (fair,) = _chairs(_table_with_back(2))
    assert strict.size_m.tolist() != fair.size_m.tolist()
