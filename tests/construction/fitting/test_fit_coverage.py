"""Resampling keeps what there is, and thin is what no thick cube covers."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.construction.fitting.problem import (
    cover_blocks,
    cover_boxes,
    cover_cells,
    join_blocks,
    split_into_blocks,
    thin_cells,
)
from world2minecraft.construction.fitting.shapes import SUB

SEEDS = st.integers(0, 10_000)


def solid_of_seed(seed: int, fill: float = 0.3) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return rng.random(tuple(rng.integers(1, 9, 3))) < fill


@given(seed=SEEDS, side=st.sampled_from([0.08, 0.16, 0.25, 0.5, 1.0]), start=st.floats(0, 1))
def test_no_mass_is_lost_or_won(seed, side, start):
    solid = solid_of_seed(seed)
    edges = [start + np.arange(n + 1) * side for n in solid.shape]
    counts = [int(np.ceil(edge[-1])) for edge in edges]
    shares = cover_cells(solid, edges, counts)
    assert shares.min() >= -1e-5
    assert shares.max() <= 1 + 1e-5
    assert abs(shares.sum() / SUB**3 - solid.sum() * side**3) < 1e-3


@given(seed=SEEDS)
def test_only_blocks_that_are_met_are_given_and_all_of_those(seed):
    solid = solid_of_seed(seed, 0.05)
    edges = [np.arange(n + 1) * 0.32 for n in solid.shape]
    counts = [int(np.ceil(edge[-1] - 1e-9)) for edge in edges]
    cells, (shares,) = cover_blocks([solid], edges, counts)
    whole = split_into_blocks(cover_cells(solid, edges, counts))
    filled = {tuple(at) for at in np.argwhere(whole.any(3)).tolist()}
    assert filled <= {tuple(at) for at in cells.tolist()}
    assert np.allclose(whole[tuple(cells.T)], shares)


def test_a_cell_that_is_a_block_fills_it_exactly():
    solid = np.zeros((3, 3, 3), bool)
    solid[1, 1, 1] = True
    edges = [np.arange(4) * (12.5 * 0.08) - 0.0 for _ in range(3)]
    assert np.array_equal(split_into_blocks(cover_cells(solid, edges, (3, 3, 3))).mean(3), solid)


@given(seed=SEEDS)
def test_blocks_of_cells_and_back(seed):
    cells = np.random.default_rng(seed).random((16, 8, 24)).astype(np.float32)
    assert np.array_equal(join_blocks(split_into_blocks(cells)), cells)


def test_boxes_cover_as_voxels_do():
    boxes = np.array([[0.0, 0.0, 0.5, 2.0, 1.0, 0.75], [0.25, 0.5, 0.0, 0.5, 0.75, 1.0]])
    fine = np.zeros((32, 16, 16), bool)
    for box in boxes:
        fine[
            tuple(slice(int(a * 16), int(b * 16)) for a, b in zip(box[:3], box[3:], strict=True))
        ] = True
    edges = [np.arange(n + 1) / 16 for n in fine.shape]
    assert np.allclose(cover_boxes(boxes, (2, 1, 1)), cover_cells(fine, edges, (2, 1, 1)))


def slow_thin(solid: np.ndarray, side: int) -> np.ndarray:
    padded = np.pad(solid, side)
    thick = np.zeros_like(padded)
    for at in np.ndindex(*(n - side + 1 for n in padded.shape)):
        box = tuple(slice(a, a + side) for a in at)
        if padded[box].all():
            thick[box] = True
    inner = tuple(slice(side, side + n) for n in solid.shape)
    return solid & ~thick[inner]


@given(seed=SEEDS)
def test_thin_is_what_no_cube_covers(seed):
    solid = solid_of_seed(seed, 0.8)
    assert np.array_equal(thin_cells(solid, 0.05), slow_thin(solid, 2))


def test_a_leg_is_thin_and_a_box_is_not():
    solid = np.zeros((20, 20, 20), bool)
    solid[:10, :10, :10] = True
    solid[15:17, 15:17, :] = True
    thin = thin_cells(solid, 0.02)
    assert thin[15, 15, 3]
    assert not thin[:10].any()
