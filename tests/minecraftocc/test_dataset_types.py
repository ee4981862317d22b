"""The values of a data set check what they are given."""

import numpy as np
import pytest

from world2minecraft.minecraftocc.types import FineClass, LabelRegion, SceneVoxels

ONE = (FineClass("minecraft:air"),)


def test_a_design_counts_once_whatever_it_is_made_of():
    kinds = {FineClass("minecraft:oak_slab", "desk"), FineClass("minecraft:birch_slab", "desk")}
    assert len(kinds) == 2
    assert {kind.name for kind in kinds} == {"design:desk"}


def test_centres_lie_in_the_middle_of_cells():
    region = LabelRegion((2, 3, 1), 0.5, np.eye(4))
    assert region.centers_m().shape == (2, 3, 1, 3)
    assert region.centers_m()[1, 2, 0].tolist() == [0.75, 1.25, 0.25]


def test_a_region_stays_upright():
    tilted = np.eye(4)
    tilted[1:3, 1:3] = [[0, -1], [1, 0]]
    with pytest.raises(ValueError, match="keep the z axis pointing up"):
        LabelRegion((2, 2, 2), 0.08, tilted)


def test_fine_numbers_have_a_class():
    cells = np.ones((2, 2, 2), np.uint16)
    with pytest.raises(ValueError, match="indices below 1, got 1"):
        SceneVoxels(cells.astype(np.uint8), cells, cells, ONE, 0.08, np.zeros(3))
