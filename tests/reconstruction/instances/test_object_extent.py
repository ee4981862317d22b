"""A box reaches what holds the object: floor, table or ceiling, however little of it was seen."""

import numpy as np
import pytest

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import OccupancyGrid
from world2minecraft.reconstruction.instances import InstanceParameters, find_objects
from world2minecraft.reconstruction.instances.object_extent import vertical_extent

TOP = (slice(10, 26), slice(8, 20), slice(9, 11))


def _found(class_id, at=TOP, **changed):
    labels = np.zeros((36, 30, 24), np.uint8)
    labels[:, :, 0] = SemanticClass.FLOOR
    labels[at] = class_id
    grid = OccupancyGrid(
        labels=labels,
        confidence=np.full(labels.shape, 0.5, np.float16),
        colour=np.zeros((*labels.shape, 3), np.uint8),
        source=np.ones(labels.shape, np.uint8),
        instance=np.zeros(labels.shape, np.uint16),
        voxel_m=0.08,
        origin_m=np.array([0.0, 0.0, -0.08]),
    )
    (instance,) = find_objects(grid, InstanceParameters(**changed)).instances
    return instance


@pytest.mark.parametrize("class_id", [SemanticClass.TABLE, SemanticClass.CHAIR])
def test_a_table_top_without_legs_is_a_table_of_full_height(class_id):
    found = _found(class_id)
    np.testing.assert_allclose([found.center_m[2], found.size_m[2]], [0.4, 0.8])
    assert len(found.cells) == 16 * 12 * 2


def test_a_screen_and_a_hung_cupboard_stay_where_they_are():
    for class_id in (SemanticClass.FURN, SemanticClass.TVS):
        np.testing.assert_allclose(_found(class_id).size_m[2], 0.16)


def _lamp(first, *, beside=None, below=0, ceiling=False):
    """Return the box's bottom and top, in cells above the floor, of a shade in the air."""
    labels = np.zeros((36, 30, 28), np.uint8)
    labels[:, :, 0] = SemanticClass.FLOOR
    labels[:, :, 27] = SemanticClass.CEILING if ceiling else 0
    labels[10:15, 10:15, 1:below] = SemanticClass.TABLE
    if beside is not None:
        labels[15:17, :, :] = beside
    labels[10:15, 10:15, first : first + 3] = SemanticClass.OBJS
    grid = OccupancyGrid(
        labels=labels,
        confidence=np.full(labels.shape, 0.5, np.float16),
        colour=np.zeros((*labels.shape, 3), np.uint8),
        source=np.ones(labels.shape, np.uint8),
        instance=np.zeros(labels.shape, np.uint16),
        voxel_m=0.08,
        origin_m=np.array([0.0, 0.0, -0.08]),
    )
    (lamp,) = (one for one in find_objects(grid).instances if one.class_id == SemanticClass.OBJS)
    ends = lamp.center_m[2] + np.array([-0.5, 0.5]) * lamp.size_m[2]
    return np.round(ends / 0.08).astype(int).tolist()


def test_a_shade_low_in_the_air_stands_on_an_unseen_post():
    assert _lamp(12) == [0, 14]


def test_high_shade_or_one_over_a_table_hangs_from_ceiling():
    assert _lamp(20, ceiling=True) == [19, 26]
    assert _lamp(14, below=8, ceiling=True) == [13, 26]
    assert _lamp(20) == [19, 22]


def test_a_pendant_hangs_from_the_ceiling_of_its_own_storey():
    labels = np.zeros((20, 20, 60), np.uint8)
    labels[:, :, 0] = labels[:, :, 29] = SemanticClass.FLOOR
    labels[:, :, 56] = SemanticClass.CEILING
    labels[:5, :, 27] = SemanticClass.CEILING  # Beside the lamp alone it was seen.
    labels[10:13, 10:13, 20:23] = SemanticClass.OBJS
    grid = OccupancyGrid(
        labels=labels,
        confidence=np.full(labels.shape, 0.5, np.float16),
        colour=np.zeros((*labels.shape, 3), np.uint8),
        source=np.ones(labels.shape, np.uint8),
        instance=np.zeros(labels.shape, np.uint16),
        voxel_m=0.08,
        origin_m=np.array([0.0, 0.0, -0.08]),
    )
    cells = np.argwhere(labels == SemanticClass.OBJS)
    assert vertical_extent(cells, grid, SemanticClass.OBJS) == (20, 27)


def test_things_on_tables_or_walls_reach_no_farther():
    assert _lamp(8, below=8) == [7, 10]
    assert _lamp(20, beside=SemanticClass.WALL, ceiling=True) == [19, 22]


def test_what_begins_above_a_metre_stands_on_something_else():
    found = _found(SemanticClass.CHAIR, (slice(10, 16), slice(8, 14), slice(15, 20)))
    np.testing.assert_allclose(found.size_m[2], 0.4)


def test_the_papers_steps_alone_add_nothing():
    np.testing.assert_allclose(_found(SemanticClass.TABLE, paper_compat=True).size_m[2], 0.16)
