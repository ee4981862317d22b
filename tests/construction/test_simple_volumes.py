"""Uncertain objects become a few boxes of one material."""

import numpy as np
import pytest
from tests.construction.build_samples import FURN, RED, WOOD, Sketch

from world2minecraft.construction import build_volume
from world2minecraft.construction.simple_volumes import fill_boxes, simple_boxes
from world2minecraft.core.coordinates import turn_grid
from world2minecraft.core.types import ObjectInstance, Placement

SHAPE = (40, 40, 24)
BOX = np.s_[10:20, 10:18, 1:9]
SEAT = (np.s_[10:24, 10:20, 1:6], np.s_[10:14, 10:20, 6:12])


def _grid(mask):
    sketch = Sketch((36, 36, 20))
    cells = np.argwhere(mask)
    sketch.labels[mask] = FURN
    sketch.instance[mask] = 1
    sketch.colour[mask] = RED
    return cells, sketch.grid()


def _volume_of(mask):
    cells, grid = _grid(mask)
    result = np.zeros(grid.shape, bool)
    result[tuple(fill_boxes(simple_boxes(cells, grid, 1), grid.shape).T)] = True
    return result


def _mask(*boxes):
    mask = np.zeros((40, 40, 23), bool)
    for box in boxes:
        mask[box] = True
    return mask


@pytest.mark.parametrize("boxes", [(BOX,), SEAT])
def test_one_box_or_two_stay_as_they_are(boxes):
    np.testing.assert_array_equal(_volume_of(_mask(*boxes)), _mask(*boxes))


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("boxes", [(BOX,), SEAT])
def test_noise_and_strays_do_not_show(boxes, seed):
    rng = np.random.default_rng(seed)
    clean = _mask(*boxes)
    noisy = clean & (rng.random(clean.shape) < 0.8)
    noisy[30, 30, 3] = True
    np.testing.assert_array_equal(_volume_of(noisy), clean)


@pytest.mark.parametrize("turns", [1, 2, 3])
def test_turning_an_object_turns_its_volume(turns):
    mask = _mask(*SEAT)
    turned = np.ascontiguousarray(turn_grid(mask, turns))
    np.testing.assert_array_equal(_volume_of(turned), turn_grid(_volume_of(mask), turns))


def test_what_hangs_in_seen_air_does_not_reach_the_floor():
    shelf = _mask(np.s_[10:20, 10:18, 4:6])
    np.testing.assert_array_equal(_volume_of(shelf), shelf)


def test_cells_outside_the_grid_are_left_out():
    cells, grid = _grid(_mask(np.s_[0:6, 0:6, 1:5]))
    boxes = simple_boxes(cells, grid, 1)
    assert fill_boxes(boxes, (4, 4, 4)).max() == 3


@pytest.mark.parametrize(("confidence", "blocks"), [(0.2, 1), (0.9, 2)])
def test_an_uncertain_object_has_one_material(confidence, blocks):
    sketch = Sketch((50, 25, 30))
    sketch.put((10, 25), (2, 8), (0, 6), FURN, RED, 1)
    sketch.put((10, 25), (2, 8), (6, 11), FURN, WOOD, 1)
    grid = sketch.grid()
    cells = np.argwhere(grid.instance == 1).astype(np.int32)
    middle, size = np.array([1.4, 0.4, 0.44]), np.array([1.2, 0.48, 0.88])
    thing = ObjectInstance(1, FURN, middle, size, 0.0, cells, confidence)
    placed = Placement(1, FURN, "cells", middle, size, 0, 0.0, {}, ())
    volume = build_volume(grid, [placed], [thing], corner_m=sketch.corner_m)
    states = np.unique(volume.states[volume.instance == 1])
    names = {volume.palette[int(one)].partition("[")[0] for one in states}
    assert len({name.removesuffix("_slab").removesuffix("_planks") for name in names}) == blocks
