"""Which way objects look: from their backs and from their walls."""

import numpy as np
import pytest

from world2minecraft.classes import SemanticClass
from world2minecraft.coordinates import turn_grid
from world2minecraft.furniture import cells_of, facing, surroundings, template


def _labels(name, quarter_turns, wall_cells=0):
    """Return a room with a template that looks to +x before a wall, all turned together."""
    one = template(name)
    cells = cells_of(one, one.typical_m, shift=(8, 12, 12 if one.mount == "wall" else 1))
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
    assert facing(cells, class_id, surroundings(labels)).quarter_turns == turns


@pytest.mark.parametrize("turns", range(4))
@pytest.mark.parametrize("wall_cells", [1, 3])
@pytest.mark.parametrize("name", ["cabinet", "wardrobe", "wall_tv", "wall_cabinet", "counter"])
def test_what_stands_at_a_wall_looks_away_from_it(name, wall_cells, turns):
    labels, class_id = _labels(name, turns, wall_cells)
    cells = np.argwhere(labels == class_id).astype(np.int32)
    found = facing(cells, class_id, surroundings(labels))
    assert found.quarter_turns == turns
    assert found.confidence > 0.5


@pytest.mark.parametrize("turns", range(2))
def test_the_long_side_of_a_table_is_its_side(turns):
    labels, class_id = _labels("dining_table", turns)
    cells = np.argwhere(labels == class_id).astype(np.int32)
    assert facing(cells, class_id, surroundings(labels)).quarter_turns % 2 == turns


def test_a_cube_far_from_walls_is_not_sure():
    labels = np.zeros((41, 41, 20), np.uint8)
    labels[18:23, 18:23, 0:5] = SemanticClass.FURN
    cells = np.argwhere(labels).astype(np.int32)
    assert facing(cells, SemanticClass.FURN, surroundings(labels)).confidence < 0.1
