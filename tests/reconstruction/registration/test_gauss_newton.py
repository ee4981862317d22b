"""Kernels against plain numpy, the joint step against a dense least-squares solution."""

import numpy as np
import pytest

from world2minecraft.reconstruction.registration.gauss_newton import (
    Observations,
    apply_rows,
    frame_blocks,
    gather_rows,
    solve,
    surfel_means,
)
from world2minecraft.reconstruction.registration.patch_correspondences import find_surfels

FRAMES, SURFELS, COUNT = 4, 30, 400


@pytest.fixture
def seen() -> Observations:
    rng = np.random.default_rng(3)
    return Observations(
        rng.standard_normal((COUNT, 7)), rng.standard_normal(COUNT) * 0.01,
        rng.uniform(1e4, 1e5, COUNT), rng.integers(0, FRAMES, COUNT).astype(np.int32),
        rng.integers(0, SURFELS, COUNT), FRAMES, SURFELS,
    )  # fmt: skip


def dense(seen: Observations) -> tuple[np.ndarray, np.ndarray]:
    """Return the rows of all unknowns [N, 7 F] and those of the surfels' offsets [N, K]."""
    rows, offsets = np.zeros((COUNT, 7 * FRAMES)), np.zeros((COUNT, SURFELS))
    for i in range(COUNT):
        rows[i, 7 * seen.frame[i] : 7 * seen.frame[i] + 7] = seen.rows[i]
        offsets[i, seen.surfel[i]] = 1
    return rows, offsets


def test_sums_are_those_of_plain_numpy(seen):
    rows, offsets = dense(seen)
    change = np.random.default_rng(1).standard_normal((FRAMES, 7))
    moved = apply_rows(seen.rows, seen.frame, change)
    np.testing.assert_allclose(moved, rows @ change.reshape(-1))
    mass = offsets.T @ seen.weight
    means = surfel_means(moved, seen.weight, seen.surfel, SURFELS)
    np.testing.assert_allclose(means, offsets.T @ (seen.weight * moved) / np.maximum(mass, 1e-9))
    gathered = gather_rows(seen.rows, seen.frame, seen.weight, moved, means, seen.surfel, FRAMES)
    plain = rows.T @ (seen.weight * (moved - offsets @ means))
    np.testing.assert_allclose(gathered.reshape(-1), plain)
    blocks = frame_blocks(seen.rows, seen.frame, seen.weight, seen.surfel, mass, FRAMES)
    share = seen.weight * (1 - seen.weight / mass[seen.surfel])
    for frame in range(FRAMES):
        own = seen.rows[seen.frame == frame]
        plain = own.T @ (own * share[seen.frame == frame, None])
        np.testing.assert_allclose(blocks[frame], plain)


def test_a_step_is_the_least_squares_solution(seen):
    """With a width far beyond all residuals nothing is robust, and offsets solved for agree."""
    rows, offsets = dense(seen)
    prior = np.array([0.1, 0.2, 0.3, 0.1, 0.2, 0.3, 0.4])
    found = solve(seen, np.zeros((FRAMES, 7)), prior, width_m=1e6).change
    both = np.hstack([rows, -offsets]) * np.sqrt(seen.weight)[:, None]
    pull = np.hstack([np.diag(np.tile(1 / prior, FRAMES)), np.zeros((7 * FRAMES, SURFELS))])
    target = np.concatenate([-seen.residual * np.sqrt(seen.weight), np.zeros(7 * FRAMES)])
    plain = np.linalg.lstsq(np.vstack([both, pull]), target, rcond=None)[0]
    np.testing.assert_allclose(found.reshape(-1), plain[: 7 * FRAMES], atol=2e-5)


def test_a_prior_of_zero_keeps_a_number(seen):
    prior = np.array([0.1] * 6 + [0.0])
    step = solve(seen, np.zeros((FRAMES, 7)), prior, width_m=0.1)
    assert (step.change[:, 6] == 0).all()
    assert (step.variance[:, 6] == 0).all()
    assert (step.change[:, :6] != 0).any()


def test_nothing_seen_moves_nothing():
    empty = np.zeros(0, np.int64)
    none = Observations(np.zeros((0, 7)), np.zeros(0), np.zeros(0), empty, empty, 3, 0)
    assert (solve(none, np.zeros((3, 7)), np.ones(7), 0.1).change == 0).all()


def wall(x: float, count: int = 60):
    rng = np.random.default_rng(int(100 * x))
    points = np.column_stack([np.full(count, x), rng.uniform(0, 0.3, (count, 2))])
    return points, np.tile([1.0, 0.0, 0.0], (count, 1))


def test_patches_of_a_wall_at_a_cell_edge_share_a_surfel():
    """0.099 and 0.101 lie in two cells of 10 cm; they are one wall."""
    points = np.concatenate([wall(0.099)[0], wall(0.101)[0]])
    points[60:, 1:] = points[:60, 1:]
    normals = np.concatenate([wall(0.099)[1]] * 2)
    frame = np.repeat([0, 1], 60)
    found = find_surfels(points, normals, np.ones(120), frame, cell_m=0.1, gap_m=0.04)
    np.testing.assert_array_equal(found.owner[:60], found.owner[60:])
    assert (found.frames[found.owner] == 2).all()
    np.testing.assert_allclose(found.centers_m[found.owner, 0], 0.1, atol=1e-9)


def test_surfaces_apart_and_backs_are_other_surfels():
    points = np.concatenate([wall(0.10)[0], wall(0.20)[0], wall(0.10)[0]])
    points[60:120, 1:] = points[120:, 1:] = points[:60, 1:]
    normals = np.concatenate([wall(0.1)[1], wall(0.1)[1], -wall(0.1)[1]])
    frame = np.repeat([0, 1, 2], 60)
    found = find_surfels(points, normals, np.ones(180), frame, cell_m=0.1, gap_m=0.04)
    sets = [set(found.owner[start : start + 60]) for start in (0, 60, 120)]
    assert not sets[0] & sets[1]
    assert not sets[0] & sets[2]
    assert (found.frames == 1).all()


def test_no_patches_give_no_surfels():
    none = np.zeros((0, 3))
    found = find_surfels(none, none, np.zeros(0), np.zeros(0, int), cell_m=0.1, gap_m=0.04)
    assert len(found.centers_m) == len(found.owner) == len(found.frames) == 0
