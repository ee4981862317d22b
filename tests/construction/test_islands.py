"""Parts far from the room, which are not built."""

import numpy as np
from build_samples import FURN, VOXEL_M, Sketch
from hypothesis import given, settings
from hypothesis import strategies as st

from world2minecraft.construction import build_volume
from world2minecraft.construction.islands import GAP_M, remove_islands
from world2minecraft.core.types import Placement

GAP_CELLS = int(GAP_M / VOXEL_M)


def seen_through_a_door(gap_cells, side=4):
    """A room and a cube of object 7 behind its wall, and the cube's placement."""
    sketch = Sketch((40, 30, 20), ceiling=False)
    far = Sketch((40 + gap_cells + side, 30, 20), walls=False, ceiling=False)
    far.labels[:] = 255
    far.labels[: sketch.labels.shape[0]] = sketch.labels
    far.colour[: sketch.labels.shape[0]] = sketch.colour
    first = sketch.size[0] + 1 + gap_cells
    far.put((first, first + side), (10, 10 + side), (5, 5 + side), FURN, (90, 60, 30), 7)
    center_m = np.array([first + side / 2, 12.0, 7.0]) * VOXEL_M
    placement = Placement(7, FURN, "cells", center_m, np.full(3, side * VOXEL_M), 0, 0.9)
    return far.grid(), placement


@settings(max_examples=20, deadline=None)
@given(st.integers(1, 2 * GAP_CELLS))
def test_only_parts_beyond_the_gap_are_removed(gap_cells):
    grid, placement = seen_through_a_door(gap_cells)
    left, placements = remove_islands(grid, [placement])
    removed = not (left.instance == 7).any()
    assert removed == (gap_cells > 2 * (GAP_CELLS // 2))
    assert placements == ([] if removed else [placement])
    same = grid.instance != 7
    assert np.array_equal(left.labels[same], grid.labels[same])


def test_a_second_room_far_away_is_kept():
    grid, placement = seen_through_a_door(3 * GAP_CELLS, side=18)
    left, placements = remove_islands(grid, [placement])
    assert left is not grid or placements == [placement]
    assert np.array_equal(left.labels, grid.labels)


def test_an_island_is_not_built():
    grid, placement = seen_through_a_door(3 * GAP_CELLS)
    volume = build_volume(grid, [placement], [], blocks_per_metre=4)
    assert not (volume.instance == 7).any()
    near, placement = seen_through_a_door(0)
    volume = build_volume(near, [placement], [], blocks_per_metre=4)
    assert (volume.instance == 7).any()
