"""Kernels against plain numpy, the joint step against a dense least-squares solution."""

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from world2minecraft.reconstruction.registration.gauss_newton import (
    Observations,
    jacobian_rows,
    multiply,
    normal_equations,
    offsets,
    pair_starts,
    solve,
)
from world2minecraft.reconstruction.registration.patch_correspondences import find_surfels

FRAMES, SURFELS, COUNT = 4, 30, 400


@pytest.fixture
def seen() -> Observations:
    rng = np.random.default_rng(3)
    surfel, frame = rng.integers(0, SURFELS, COUNT), rng.integers(0, FRAMES, COUNT)
    order = np.lexsort((frame, surfel))
    return Observations(
        rng.standard_normal((COUNT, 7)), rng.standard_normal(COUNT) * 0.01,
        rng.uniform(1e4, 1e5, COUNT), frame[order].astype(np.int32), surfel[order], FRAMES,
    )  # fmt: skip


def dense(seen: Observations) -> tuple[np.ndarray, np.ndarray]:
    """Return the rows of all unknowns [N, 7 F] and those of the surfels' offsets [N, K]."""
    rows, offsets = np.zeros((COUNT, 7 * FRAMES)), np.zeros((COUNT, SURFELS))
    for i in range(COUNT):
        rows[i, 7 * seen.frame[i] : 7 * seen.frame[i] + 7] = seen.rows[i]
        offsets[i, seen.surfel[i]] = 1
    return rows, offsets


@pytest.mark.parametrize("width_m", [1e6, 0.02])
def test_normal_equations_are_those_of_plain_numpy(seen, width_m):
    rows, offset = dense(seen)
    change = np.random.default_rng(1).standard_normal((FRAMES, 7)) * 0.01
    left = seen.residual + rows @ change.reshape(-1)
    weight = seen.weight
    for _ in range(2):
        means = offset.T @ (weight * left) / (offset.T @ weight)
        weight = seen.weight / (1 + ((left - offset @ means) / width_m) ** 2) ** 2
    mass = offset.T @ weight
    means = offset.T @ (weight * left) / mass
    pairs, groups = pair_starts(seen.frame, seen.surfel)
    pair_frame, found_weight = seen.frame[pairs[:-1]], np.empty(COUNT)
    slope, whole, blocks, gathered, found_mass = normal_equations(
        seen.rows, seen.residual, seen.weight, pair_frame, pairs, groups, change, width_m,
        found_weight,
    )  # fmt: skip
    np.testing.assert_allclose(found_weight, weight)
    np.testing.assert_allclose(found_mass, mass)
    np.testing.assert_allclose(slope.reshape(-1), rows.T @ (weight * (left - offset @ means)))
    share = weight * (1 - weight / mass[seen.surfel])
    for frame in range(FRAMES):
        own = seen.rows[seen.frame == frame]
        plain = own.T @ (own * share[seen.frame == frame, None])
        np.testing.assert_allclose(blocks[frame], plain)
    matrix = rows.T @ (weight[:, None] * rows)
    sums = offset.T @ (weight[:, None] * rows)
    matrix -= sums.T @ (sums / mass[:, None])
    vector = np.random.default_rng(2).standard_normal((FRAMES, 7))
    product = multiply(whole, gathered, found_mass, pair_frame, groups, vector)
    np.testing.assert_allclose(product.reshape(-1), matrix @ vector.reshape(-1), rtol=1e-6)
    off = offsets(seen.rows, seen.residual, weight, pair_frame, pairs, groups, change)
    np.testing.assert_allclose(off, left - offset @ means, atol=1e-12)


def test_rows_are_the_derivatives_of_the_residuals():
    """A small motion of a frame changes its residuals as its rows say, but for the scale's term."""
    rng = np.random.default_rng(5)
    points, cameras = rng.uniform(-1, 1, (40, 3)), np.tile(np.eye(4), (2, 1, 1))
    cameras[:, :3, 3] = rng.uniform(-3, 3, (2, 3))
    normals = rng.standard_normal((4, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    centers, weight = rng.uniform(-1, 1, (4, 3)), rng.uniform(1, 2, 40)
    surfel, frame = np.repeat(np.arange(4), 10), np.tile(np.repeat([0, 1], 5), 4).astype(np.int32)
    index = rng.permutation(40)

    def residuals(change):
        turn = Rotation.from_rotvec(change[:3]).as_matrix()
        eyes = cameras[frame, :3, 3]
        at = (points[index] - eyes) @ turn.T * np.exp(change[6]) + eyes + change[3:6]
        return np.einsum("ia,ia->i", normals[surfel], at - centers[surfel])

    rows, found = jacobian_rows(points, cameras, frame, surfel, index, weight, centers, normals)
    np.testing.assert_allclose(found, residuals(np.zeros(7)))
    for number in range(6):
        step = np.zeros(7)
        step[number] = 1e-6
        slope = (residuals(step) - residuals(-step)) / 2e-6
        np.testing.assert_allclose(rows[:, number], slope, atol=1e-8)
    means = np.bincount(surfel, weight * found) / np.bincount(surfel, weight)
    step = np.array([0, 0, 0, 0, 0, 0, 1e-6])
    slope = (residuals(step) - residuals(-step)) / 2e-6
    np.testing.assert_allclose(rows[:, 6], slope - (found - means[surfel]), atol=1e-8)


def test_a_step_is_the_least_squares_solution(seen):
    """With a width far beyond all residuals nothing is robust, and offsets solved for agree."""
    rows, offset = dense(seen)
    prior = np.array([0.1, 0.2, 0.3, 0.1, 0.2, 0.3, 0.4])
    found = solve(seen, np.zeros((FRAMES, 7)), prior, width_m=1e6).change
    both = np.hstack([rows, -offset]) * np.sqrt(seen.weight)[:, None]
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
    frame, surfel = np.zeros(0, np.int32), np.zeros(0, np.int64)
    none = Observations(np.zeros((0, 7)), np.zeros(0), np.zeros(0), frame, surfel, 3)
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
    frame = np.repeat(np.int32([0, 1]), 60)
    found = find_surfels(points, normals, np.ones(120), frame, cell_m=0.1, gap_m=0.04)
    np.testing.assert_array_equal(found.owner[:60], found.owner[60:])
    assert (found.frames[found.owner] == 2).all()
    np.testing.assert_allclose(found.centers_m[found.owner, 0], 0.1, atol=1e-9)


def test_surfaces_apart_and_backs_are_other_surfels():
    points = np.concatenate([wall(0.10)[0], wall(0.20)[0], wall(0.10)[0]])
    points[60:120, 1:] = points[120:, 1:] = points[:60, 1:]
    normals = np.concatenate([wall(0.1)[1], wall(0.1)[1], -wall(0.1)[1]])
    frame = np.repeat(np.int32([0, 1, 2]), 60)
    found = find_surfels(points, normals, np.ones(180), frame, cell_m=0.1, gap_m=0.04)
    sets = [set(found.owner[start : start + 60]) for start in (0, 60, 120)]
    assert not sets[0] & sets[1]
    assert not sets[0] & sets[2]
    assert (found.frames == 1).all()


@given(st.integers(0, 10**6), st.integers(1, 60))
def test_surfels_are_those_of_a_slow_search(seed, count):
    """Two patches share a surfel if no gap parts the patches between them in their column."""
    rng = np.random.default_rng(seed)
    points = rng.uniform(-0.3, 0.3, (count, 3))
    normals = np.eye(3)[rng.integers(0, 2, count)] * rng.choice([-1.0, 1.0], (count, 1))
    frame = np.sort(rng.integers(0, 4, count)).astype(np.int32)
    weight = rng.uniform(1, 2, count)
    found = find_surfels(points, normals, weight, frame, cell_m=0.2, gap_m=0.05)
    columns = {}
    for i in range(count):
        axis = int(np.abs(normals[i]).argmax())
        cells = np.floor(np.delete(points[i], axis) / 0.2)
        columns.setdefault((axis, normals[i, axis] > 0, *cells), []).append((points[i, axis], i))
    expected = set()
    for column in columns.values():
        group, last = [], 0.0
        for along, i in sorted(column):
            if group and along - last > 0.05:
                expected.add(frozenset(group))
                group = []
            group.append(i)
            last = along
        expected.add(frozenset(group))
    of_each = [found.order[a:b] for a, b in itertools.pairwise(found.start)]
    assert {frozenset(one.tolist()) for one in of_each} == expected
    for k, members in enumerate(of_each):
        assert (found.owner[members] == k).all()
        assert (np.diff(members) > 0).all()
        assert found.frames[k] == len(set(frame[members]))
        center = np.average(points[members], axis=0, weights=weight[members])
        np.testing.assert_allclose(found.centers_m[k], center, atol=1e-12)


def test_no_patches_give_no_surfels():
    none = np.zeros((0, 3))
    found = find_surfels(none, none, np.zeros(0), np.zeros(0, np.int32), cell_m=0.1, gap_m=0.04)
    assert len(found.centers_m) == len(found.owner) == len(found.frames) == 0
