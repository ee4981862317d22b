"""Small things side by side are told apart by colour; one over the other they are one thing."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import OccupancyGrid
from world2minecraft.reconstruction.instances import InstanceParameters
from world2minecraft.reconstruction.instances.split_by_colour import split_by_colour

RULES = InstanceParameters()
SHAPE = (24, 20, 14)
RED, BLUE = (200, 40, 40), (40, 60, 200)


def _grid(*boxes):
    """Return a grid of small things (colour, x0 y0 z0 x1 y1 z1)."""
    labels = np.zeros(SHAPE, np.uint8)
    colour = np.zeros((*SHAPE, 3), np.uint8)
    for tone, x0, y0, z0, x1, y1, z1 in boxes:
        labels[x0:x1, y0:y1, z0:z1] = SemanticClass.OBJS
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


def _parted(grid):
    return split_by_colour((grid.labels == SemanticClass.OBJS).astype(np.int32), grid, RULES)


def test_a_red_box_beside_a_blue_one_is_its_own():
    parted = _parted(_grid((RED, 4, 4, 1, 8, 8, 5), (BLUE, 8, 4, 1, 13, 8, 4)))
    assert len(np.unique(parted[4:8, 4:8, 1:5])) == len(np.unique(parted[8:13, 4:8, 1:4])) == 1
    assert parted[5, 5, 2] != parted[10, 5, 2]


@pytest.mark.parametrize(
    "boxes",
    [
        ((RED, 4, 4, 1, 12, 8, 5), (BLUE, 4, 4, 5, 12, 8, 9)),  # a pot and its plant
        ((RED, 4, 4, 1, 8, 8, 5), (RED, 8, 4, 1, 13, 8, 4)),  # one paint
        ((RED, 4, 4, 1, 12, 8, 5), (BLUE, 12, 5, 2, 13, 7, 4)),  # a handle
        ((RED, 4, 4, 1, 6, 8, 5), (BLUE, 6, 4, 1, 8, 8, 5)),  # as narrow as one thing
    ],
)
def test_what_is_one_thing_stays_one(boxes):
    grid = _grid(*boxes)
    np.testing.assert_array_equal(_parted(grid), grid.labels == SemanticClass.OBJS)


@settings(max_examples=15)
@given(st.integers(0, 2**32 - 1))
def test_no_cell_is_lost(seed):
    rng = np.random.default_rng(seed)
    grid = _grid(*((tuple(rng.integers(0, 256, 3)), *_box(rng)) for _ in range(4)))
    np.testing.assert_array_equal(_parted(grid) > 0, grid.labels == SemanticClass.OBJS)


def _box(rng):
    low = rng.integers(0, (14, 10, 4))
    return (*low, *(low + rng.integers(2, 9, 3)))
