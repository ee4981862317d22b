"""Templates as cells: against a slow loop, and under quarter turns."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from world2minecraft.core.coordinates import turn_grid
from world2minecraft.furniture import (
    TEMPLATES,
    rasterize,
    size_in_cells,
    surface_cells,
    template,
    template_cells,
)

NAMES = TEMPLATES.names()


def _slow_raster(one, counts, voxel_m):
    """Take each cell whose centre lies in a part; a part that has none takes what it touches."""
    size = np.array(counts) * voxel_m
    solid = np.zeros(counts, bool)
    for piece in one.parts(size):
        low, high = (piece.box_m + np.tile([size[0] / 2, size[1] / 2, 0], 2)).reshape(2, 3)
        chosen = []
        for axis in range(3):
            middles = (np.arange(counts[axis]) + 0.5) * voxel_m
            inside = np.flatnonzero((middles >= low[axis] - 1e-7) & (middles <= high[axis] + 1e-7))
            if not len(inside):
                middle = (low[axis] + high[axis]) / 2 / voxel_m
                held = [i for i in range(counts[axis]) if i - 1e-5 <= middle <= i + 1 + 1e-5]
                inside = np.array(held)
            chosen.append(inside)
        solid[np.ix_(*chosen)] = True
    return solid


@settings(max_examples=60)
@given(st.sampled_from(NAMES), st.tuples(*[st.floats(0, 1)] * 3), st.sampled_from([0.08, 0.05]))
def test_the_fast_raster_is_the_slow_one(name, shares, voxel_m):
    one = template(name)
    size = [a + (b - a) * share for (a, _, b), share in zip(one.size_m, shares, strict=True)]
    counts = size_in_cells(size, voxel_m)
    fast = rasterize(one, counts, tuple(one.complete().items()), voxel_m)
    np.testing.assert_array_equal(fast, _slow_raster(one, counts, voxel_m))


@given(st.sampled_from(NAMES), st.integers(-4, 7))
def test_a_quarter_turn_turns_the_cells(name, turns):
    one = template(name)
    before = template_cells(one, one.typical_m, quarter_turns=turns)
    after = template_cells(one, one.typical_m, quarter_turns=turns + 1)
    solid = np.zeros(before.max(axis=0) + 1, bool)
    solid[tuple(before.T)] = True
    np.testing.assert_array_equal(np.argwhere(turn_grid(solid, 1)), after)


@pytest.mark.parametrize("name", NAMES)
def test_cells_fill_the_box_and_follow_the_shift(name):
    one = template(name)
    cells = template_cells(one, one.typical_m, voxel_m=0.02)
    assert cells.dtype == np.int32
    assert cells.min(axis=0).tolist() == [0, 0, 0]
    assert np.abs((cells.max(axis=0) + 1) * 0.02 - one.typical_m).max() <= 0.02
    shifted = template_cells(one, one.typical_m, shift=(3, -2, 7), voxel_m=0.02)
    np.testing.assert_array_equal(shifted, cells + np.array([3, -2, 7]))


def test_a_thin_top_and_thin_legs_are_never_lost():
    solid = rasterize(template("dining_table"), (10, 10, 6), (("top_thickness", 0.03),), 0.2)
    assert solid[:, :, -1].all()
    assert solid[:, :, 0].sum() == 4


@given(st.integers(0, 2**32 - 1))
def test_the_surface_is_the_cells_with_an_open_face(seed):
    solid = np.random.default_rng(seed).random((5, 6, 4)) < 0.7
    padded = np.pad(solid, 1)
    slow = np.zeros_like(solid)
    for x, y, z in np.argwhere(solid):
        i, j, k = x + 1, y + 1, z + 1
        faces = [(i - 1, j, k), (i + 1, j, k), (i, j - 1, k), (i, j + 1, k)]
        faces += [(i, j, k - 1), (i, j, k + 1)]
        slow[x, y, z] = not all(padded[face] for face in faces)
    np.testing.assert_array_equal(surface_cells(solid), slow)


def test_a_box_beyond_reason_is_refused():
    with pytest.raises(
        ValueError, match="template box has .* cells, the limit is 8000000 in total"
    ):
        template_cells(template("box"), (100.0, 100.0, 100.0), voxel_m=0.02)
