"""Small things that touch are told apart by what holds them, and lamps keep their feet."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import OccupancyGrid
from world2minecraft.reconstruction.instances import InstanceParameters
from world2minecraft.reconstruction.instances.merge_pieces import merge_lamp_parts
from world2minecraft.reconstruction.instances.split_by_support import split_by_support

RULES = InstanceParameters()
SHAPE = (30, 30, 34)
GREEN, BEIGE = (40, 120, 40), (220, 200, 150)


def _room(*boxes):
    """Return a grid with a floor, a wall at x = 0 and boxes (class, colour, x0 ... z1)."""
    labels = np.zeros(SHAPE, np.uint8)
    labels[:, :, 0] = SemanticClass.FLOOR
    labels[0] = SemanticClass.WALL
    colour = np.full((*SHAPE, 3), 128, np.uint8)
    for class_id, tone, x0, y0, z0, x1, y1, z1 in boxes:
        labels[x0:x1, y0:y1, z0:z1] = class_id
        colour[x0:x1, y0:y1, z0:z1] = tone
    return OccupancyGrid(
        labels=labels,
        confidence=np.full(SHAPE, 0.5, np.float16),
        colour=colour,
        source=np.ones(SHAPE, np.uint8),
        instance=np.zeros(SHAPE, np.uint16),
        voxel_m=0.08,
        origin_m=np.array([0.0, 0.0, -0.08]),
    )


def _owners(grid):
    """Return 1 for all small things and 2 for furniture."""
    owners = (grid.labels == SemanticClass.OBJS).astype(np.int32)
    owners[grid.labels == SemanticClass.FURN] = 2
    return owners


CHEST = (10, 128, 10, 4, 1, 16, 12, 10)
LAMP = (11, BEIGE, 11, 8, 10, 14, 11, 15)
PLANT = (11, GREEN, 11, 12, 1, 15, 16, 14)
CURTAIN = (11, BEIGE, 1, 10, 8, 2, 16, 28)
LEAVES = (11, GREEN, 2, 13, 10, 12, 14, 12)


def test_a_lamp_on_a_chest_and_the_plant_beside_it_are_two():
    grid = _room(CHEST, PLANT, LAMP, (11, GREEN, 12, 11, 11, 13, 12, 13))
    parted = split_by_support(_owners(grid), grid, RULES)
    assert parted[12, 9, 12] != parted[12, 14, 3]
    assert len(np.unique(parted[grid.labels == SemanticClass.OBJS])) == 2


def test_what_stands_on_one_thing_stays_one():
    grid = _room(CHEST, LAMP, (11, GREEN, 11, 5, 10, 14, 8, 12))
    np.testing.assert_array_equal(split_by_support(_owners(grid), grid, RULES), _owners(grid))


def test_a_curtain_is_told_from_the_plant_that_leans_on_it():
    grid = _room(CURTAIN, PLANT, LEAVES)
    parted = split_by_support(_owners(grid), grid, RULES)
    assert parted[1, 11, 20] != parted[12, 14, 5]


def test_leaves_at_a_wall_are_part_of_their_plant():
    grid = _room((11, GREEN, 4, 12, 1, 8, 16, 14), (11, GREEN, 1, 12, 9, 4, 15, 13))
    np.testing.assert_array_equal(split_by_support(_owners(grid), grid, RULES), _owners(grid))


@settings(max_examples=15)
@given(st.integers(0, 2**32 - 1))
def test_no_cell_is_lost_and_furniture_keeps_its_number(seed):
    rng = np.random.default_rng(seed)
    grid = _room(CHEST, PLANT, LAMP, CURTAIN, LEAVES)
    labels = grid.labels.copy()
    labels[rng.random(SHAPE) < 0.02] = SemanticClass.OBJS
    labels[rng.random(SHAPE) < 0.2] = 0
    noisy = OccupancyGrid(
        labels, grid.confidence, grid.colour, grid.source, grid.instance, 0.08, grid.origin_m
    )
    owners = _owners(noisy)
    parted = split_by_support(owners, noisy, RULES)
    np.testing.assert_array_equal(parted > 0, owners > 0)
    np.testing.assert_array_equal(parted == 2, owners == 2)


def test_the_foot_and_the_cord_of_a_lamp_belong_to_its_shade():
    shade, foot, cord = (
        (11, BEIGE, 10, 10, 15, 15, 15, 18),
        (11, BEIGE, 11, 11, 1, 14, 14, 2),
        (11, BEIGE, 12, 12, 22, 13, 13, 28),
    )
    grid = _room(shade, foot, cord)
    owners = np.zeros(SHAPE, np.int32)
    owners[10:15, 10:15, 15:18], owners[11:14, 11:14, 1:2], owners[12, 12, 22:28] = 1, 2, 3
    np.testing.assert_array_equal(merge_lamp_parts(owners, grid, RULES), owners > 0)


def test_box_under_a_table_is_no_foot_of_its_vase():
    grid = _room((8, 128, 8, 8, 9, 18, 18, 10), (11, BEIGE, 11, 11, 10, 14, 14, 14),
                 (11, GREEN, 11, 11, 1, 14, 14, 2))  # fmt: skip
    owners = np.zeros(SHAPE, np.int32)
    owners[11:14, 11:14, 10:14], owners[11:14, 11:14, 1:2] = 1, 2
    np.testing.assert_array_equal(merge_lamp_parts(owners, grid, RULES), owners)


def test_what_lies_within_the_floor_is_nothing():
    grid = _room((11, BEIGE, 10, 10, 0, 20, 11, 1))
    owners = (grid.labels == SemanticClass.OBJS).astype(np.int32)
    assert not merge_lamp_parts(owners, grid, RULES).any()
