"""Grids of networks in the map: laws of order, softness and size."""

from dataclasses import replace
from itertools import permutations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from world2minecraft.core.coordinates import rotation_about_z
from world2minecraft.core.types import GridEvidence, PointEvidence
from world2minecraft.reconstruction.fusion import EvidenceMap, FusionParameters, extract_grid
from world2minecraft.reconstruction.fusion.network_grids import EDGE, grid_gains

SURE = float(np.log((1 - EDGE) / EDGE))


def grid(seed: int, shape=(6, 5, 4), voxel_m=0.08, pose=None, free: float | None = None):
    rng = np.random.default_rng(seed)
    odds = rng.gamma(0.4, 1, (*shape, 12)) + 1e-3
    probabilities = odds / odds.sum(axis=-1, keepdims=True)
    if free is not None:
        probabilities[...] = (1 - free) / 11
        probabilities[..., 0] = free
    colour = rng.integers(0, 256, (*shape, 3), dtype=np.uint8)
    pose = np.eye(4) if pose is None else pose
    seen = rng.random(shape) < (0.8 if free is None else 2.0)
    return GridEvidence(f"v{seed}", probabilities.astype(np.float16), seen, voxel_m, pose, colour)


def moved(seed: int) -> np.ndarray:
    pose = rotation_about_z(90.0 * (seed % 4))
    pose[:3, 3] = np.random.default_rng(seed).integers(-3, 4, 3) * 0.08
    return pose


def fused(*items):
    map_ = EvidenceMap(np.eye(4))
    for item in items:
        map_.add(item)
    return map_.fused()


def wall(z_m: float = 1.0) -> PointEvidence:
    """A sheet of points that a camera at the origin sees across its z."""
    across = np.arange(-0.3, 0.3, 0.01)
    x, y = np.meshgrid(across, across)
    points = np.stack([x, y, np.full_like(x, z_m)], axis=-1).reshape(-1, 3).astype(np.float32)
    weight = np.full(len(points), 1e-4, np.float32)
    return PointEvidence("wall", np.zeros(3), points, weight)


@settings(max_examples=20, deadline=None)
@given(st.lists(st.integers(0, 10_000), min_size=3, max_size=3, unique=True))
def test_the_order_of_views_plays_no_part(seeds):
    """Forty looks of each would be over the limit if sums were bounded on the way."""
    views = [grid(seed, pose=moved(seed)) for seed in seeds]
    sides = [grid(1, free=0.99), grid(1, free=0.01)]
    found = [fused(*[views[i] for i in order]) for order in permutations(range(3))]
    found += [fused(*views)]
    for other in found[1:]:
        for name in ("log_odds", "votes", "colour_sum", "hits"):
            a, b = getattr(found[0], name), getattr(other, name)
            np.testing.assert_allclose(a.astype(float), b.astype(float), rtol=2e-3, atol=2e-3)
    one = fused(*[sides[0]] * 40, *[sides[1]] * 41)
    other = fused(*[sides[1]] * 41, *[sides[0]] * 40)
    np.testing.assert_allclose(one.log_odds, other.log_odds, atol=1e-3)
    assert (one.log_odds[one.log_odds != 0] > 0).all()


def test_sure_view_carves_as_one_ray_never_through_depth():
    rules = FusionParameters()
    for free in (0.99, 1.0):
        gains = grid_gains(grid(2, free=free), np.eye(4), rules).gains
        np.testing.assert_allclose(gains, -rules.network_weight * SURE, rtol=1e-5)
        assert np.abs(gains).max() <= abs(rules.free_log_odds)
    pose = np.eye(4)
    pose[:3, 3] = [-0.4, -0.4, 0.8]
    says_free = grid(3, (10, 10, 5), pose=pose, free=1.0)
    alone, crossed = extract_grid(fused(wall())), extract_grid(fused(wall(), *[says_free] * 4))
    assert crossed.occupied.sum() == alone.occupied.sum() > 0
    assert extract_grid(fused(wall(), *[says_free] * 30)).occupied.sum() == 0


def test_a_sure_view_is_soft_for_surfaces_too():
    says_full = grid(4, free=0.0)
    assert fused(says_full).log_odds.max() == pytest.approx(0.05 * SURE, rel=1e-3)


@pytest.mark.parametrize("side", [1, 2, 3])
def test_a_coarse_cell_speaks_for_all_the_cells_that_it_covers(side):
    coarse = grid(5, voxel_m=0.08 * side)
    found = fused(coarse)
    assert (found.log_odds != 0).sum() == coarse.seen.sum() * side**3
    at = np.argwhere(coarse.seen)[0]
    low = np.round(found.origin_m / 0.08).astype(int)
    block = found.votes[tuple(slice(a, a + side) for a in at * side - low)]
    expected = coarse.probabilities[tuple(at)].astype(float)
    expected[0] = 0
    if expected.sum() > 0.06:
        np.testing.assert_allclose(block.reshape(-1, 12), expected[None].repeat(side**3, 0), 1e-2)


@pytest.mark.parametrize("shape", [(8, 1, 1), (9, 8, 1), (1, 9, 16), (17, 1, 9)])
def test_a_grid_may_end_with_a_block_of_the_map_or_just_after_it(shape):
    """The map's memory comes in blocks of 8 x 8 x 8 cells; a cell outside would be written to."""
    found = fused(grid(8, shape, free=0.9))
    below = 1  # The layer for a floor that was seen a little too high.
    assert found.log_odds.shape == (shape[0], shape[1], shape[2] + below)
    assert not found.log_odds[:, :, 0].any()


def test_fine_cells_are_averaged_in_the_cell_that_holds_them():
    fine = grid(6, (4, 4, 4), 0.04)
    gains = grid_gains(fine, np.eye(4), FusionParameters())
    for cell, gain in zip(gains.cells, gains.gains, strict=True):
        box = tuple(slice(2 * c, 2 * c + 2) for c in cell)
        free = fine.probabilities[box][fine.seen[box]].astype(float)[:, 0].mean()
        full = np.clip(1 - free, EDGE, 1 - EDGE)
        assert gain == pytest.approx(0.05 * np.log(full / (1 - full)), rel=1e-4)


def test_colours_are_those_of_the_view():
    found = fused(grid(7, free=0.1))
    assert (found.hits[found.log_odds > 0] == 1).all()
    assert found.colour_sum[found.log_odds > 0].mean() == pytest.approx(127, abs=25)


def test_nearly_free_cells_have_no_votes_and_no_colour():
    gains = grid_gains(grid(9, free=0.96), np.eye(4), FusionParameters())
    assert not gains.votes.any() and not gains.coloured.any()
    gains = grid_gains(grid(9, free=0.94), np.eye(4), FusionParameters())
    assert (gains.votes[:, 1:].sum(axis=1) > 0.05).all() and gains.coloured.all()
    assert (gains.votes[:, 0] == 0).all()


def test_a_grid_without_colours_colours_nothing():
    gains = grid_gains(replace(grid(9, free=0.1), colour=None), np.eye(4), FusionParameters())
    assert gains.colour.shape == (len(gains.cells), 3)
    assert not gains.colour.any() and not gains.coloured.any()
