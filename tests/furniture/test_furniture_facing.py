"""Which way objects look: from their backs and from their walls."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.coordinates import turn_grid
from world2minecraft.furniture import estimate_facing, read_surroundings, template, template_cells


def _labels(name, quarter_turns, wall_cells=0):
    """Return a room with a template that looks to +x before a wall, all turned together."""
    one = template(name)
    cells = template_cells(one, one.typical_m, shift=(8, 12, 12 if one.mount == "wall" else 1))
    labels = np.zeros((50, 50, 32), np.uint8)
    labels[:, :, 0] = SemanticClass.FLOOR
    if wall_cells:
        labels[8 - wall_cells, :, :] = SemanticClass.WALL
    labels[tuple(cells.T)] = one.class_id
    return turn_grid(labels, quarter_turns), one.class_id


@pytest.mark.parametrize("turns", range(4))
@pytest.mark.parametrize("name", ["chair", "armchair", "office_chair", "sofa", "double_bed"])
def test_seats_and_beds_look_away_from_their_backs(name, turns):
    labels, class_id = _labels(name, turns)
    cells = np.argwhere(labels == class_id).astype(np.int32)
    assert estimate_facing(cells, class_id, read_surroundings(labels)).quarter_turns == turns


@pytest.mark.parametrize("turns", range(4))
@pytest.mark.parametrize("wall_cells", [1, 3])
@pytest.mark.parametrize("name", ["cabinet", "wardrobe", "wall_tv", "wall_cabinet", "counter"])
def test_what_stands_at_a_wall_looks_away_from_it(name, wall_cells, turns):
    labels, class_id = _labels(name, turns, wall_cells)
    cells = np.argwhere(labels == class_id).astype(np.int32)
    found = estimate_facing(cells, class_id, read_surroundings(labels))
    assert found.quarter_turns == turns
    assert found.confidence > 0.5


@pytest.mark.parametrize("turns", range(2))
def test_the_long_side_of_a_table_is_its_side(turns):
    labels, class_id = _labels("dining_table", turns)
    cells = np.argwhere(labels == class_id).astype(np.int32)
    assert estimate_facing(cells, class_id, read_surroundings(labels)).quarter_turns % 2 == turns


def test_a_cube_far_from_walls_is_not_sure():
    labels = np.zeros((41, 41, 20), np.uint8)
    labels[18:23, 18:23, 0:5] = SemanticClass.FURN
    cells = np.argwhere(labels).astype(np.int32)
    assert estimate_facing(cells, SemanticClass.FURN, read_surroundings(labels)).confidence < 0.1


TABLE = np.s_[20:34, 16:36, 8:10]  # Its long edge, x = 20, before chairs that look to +x.


def _at_table(*boxes, turns=0):
    """Return a room with a table and boxes of chair cells, all turned together."""
    labels = np.zeros((50, 50, 32), np.uint8)
    labels[:, :, 0] = SemanticClass.FLOOR
    labels[TABLE] = SemanticClass.TABLE
    for box in boxes:
        labels[box] = SemanticClass.CHAIR
    return turn_grid(labels, turns)


def _front(labels):
    cells = np.argwhere(labels == SemanticClass.CHAIR).astype(np.int32)
    return estimate_facing(cells, SemanticClass.CHAIR, read_surroundings(labels))


SEAT = np.s_[17:23, 22:28, 5:6]
STOOL = np.s_[14:18, 22:26, 1:6]
BACK = np.s_[16:18, 22:28, 5:12]


@pytest.mark.parametrize("turns", range(4))
@pytest.mark.parametrize("boxes", [(SEAT,), (STOOL,), (BACK,), (BACK, SEAT)])
def test_a_chair_without_visible_back_faces_its_table(boxes, turns):
    front = _front(_at_table(*boxes, turns=turns))
    assert front.quarter_turns == turns
    assert front.confidence > 0.5


@pytest.mark.parametrize("turns", range(4))
def test_a_clear_back_wins_over_the_table(turns):
    seat, back = np.s_[11:17, 22:28, 5:6], np.s_[16:17, 22:28, 5:12]
    assert _front(_at_table(seat, back, turns=turns)).quarter_turns == (turns + 2) % 4


def test_a_low_table_turns_no_chair():
    seat, back = np.s_[14:19, 22:28, 1:6], np.s_[14:19, 26:28, 5:12]
    labels = _at_table(seat, back)
    labels[labels == SemanticClass.TABLE] = SemanticClass.EMPTY
    labels[20:28, 20:30, 4:5] = SemanticClass.TABLE
    assert _front(labels).quarter_turns == 3


def test_a_table_out_of_reach_says_nothing():
    labels = _at_table(np.s_[2:6, 22:26, 1:6])
    far = _front(labels)
    labels[labels == SemanticClass.TABLE] = SemanticClass.EMPTY
    near_nothing = _front(labels)
    assert far.confidence < 0.2
    assert near_nothing.confidence < 0.2


@given(st.integers(0, 2**32 - 1), st.integers(1, 3))
@settings(max_examples=40, deadline=None)
def test_turning_the_grid_turns_the_front(seed, turns):
    rng = np.random.default_rng(seed)
    x, y = rng.integers(8, 30, 2)
    labels = _at_table()
    box = labels[x : x + 7, y : y + 7, 1:12]
    box[rng.random(box.shape) < 0.3] = SemanticClass.CHAIR
    plain, turned = _front(labels), _front(turn_grid(labels, turns))
    if plain.confidence > 1e-6:
        assert turned.quarter_turns == (plain.quarter_turns + turns) % 4
    assert turned.confidence == pytest.approx(plain.confidence)
