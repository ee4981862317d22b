"""Each kernel against what its docstring says, written out slowly."""

import numpy as np
import pytest
from scipy import ndimage

from world2minecraft.capture.stereo.consistency import check_consistency, filter_speckles
from world2minecraft.capture.stereo.plane_sweep import (
    aggregate_costs,
    pack_corners,
    select_planes,
    sweep_costs,
)


def read(picture, x, y):
    """Between pixels, rounded to halves; places outside are moved to the edge."""
    high, wide = picture.shape
    x = np.clip(np.float32(x), 0, np.float32(wide - 1.001))
    y = np.clip(np.float32(y), 0, np.float32(high - 1.001))
    i, j = int(x), int(y)
    a, b = x - i, y - j
    top = picture[j, i] * (1 - a) + picture[j, i + 1] * a
    low = picture[j + 1, i] * (1 - a) + picture[j + 1, i + 1] * a
    return np.floor((top * (1 - b) + low * b) * 2 + 0.5) / 2


def slow_costs(grey, sources, turns, shifts, inverse, best_of, radius, noise):
    grey = grey - 128.0
    high, wide = grey.shape
    costs = np.empty((high, wide, len(inverse)))
    padded = np.pad(grey, radius, mode="edge")
    for d, one_by_z in enumerate(inverse):
        scores = np.full((len(sources), high, wide), -2.0)
        for n, source in enumerate(sources):
            own = source - 128.0
            warped, seen = np.empty((high, wide)), np.empty((high, wide), bool)
            for v in range(high):
                for u in range(wide):
                    x, y, z = turns[n] @ [u + 0.5, v + 0.5, 1] + shifts[n] * one_by_z
                    x, y = x / z - 0.5, y / z - 0.5
                    seen[v, u] = 0 <= x <= own.shape[1] - 1.001 and 0 <= y <= own.shape[0] - 1.001
                    warped[v, u] = read(own, x, y)
            warped = np.pad(warped, radius, mode="edge")
            for v in range(high):
                for u in range(wide):
                    window = np.s_[v : v + 2 * radius + 1, u : u + 2 * radius + 1]
                    here, there = padded[window], warped[window]
                    mixed = ((here - here.mean()) * (there - there.mean())).mean()
                    spread = np.sqrt((here.var() + noise) * (there.var() + noise))
                    scores[n, v, u] = mixed / spread if seen[v, u] else -2
        for v in range(high):
            for u in range(wide):
                best = sorted(scores[:, v, u], reverse=True)[:best_of]
                valid = [score for score in best if score > -1.5]
                mean = np.mean(valid) if len(valid) > 1 else 0
                costs[v, u, d] = 127 * (1 - mean)
    return costs


@pytest.mark.parametrize("radius", [1, 3])
def test_costs_are_window_correlations_over_planes(radius):
    rng = np.random.default_rng(0)
    grey = rng.integers(0, 256, (9, 13), np.uint8)
    sources = [rng.integers(0, 256, size, np.uint8) for size in [(9, 13), (11, 14), (9, 13)]]
    turns = (np.eye(3) + rng.normal(0, 0.01, (3, 3, 3))).astype(np.float32)
    turns[:, 2] = [0, 0, 1]
    shifts = (rng.normal(0, 3, (3, 3)) * [1, 1, 0.05]).astype(np.float32)
    inverse = np.array([0.2, 0.7, 1.0], np.float32)
    rest = (turns, shifts, inverse, 2, radius, 4.0)
    fast = sweep_costs(grey, *pack_corners(sources), *rest).astype(float)
    slow = slow_costs(grey, sources, *rest)
    # A place that float32 rounds to the other side of a half moves a window's sum by a little.
    assert np.abs(fast - slow).max() < 2.5
    assert (np.abs(fast - slow) <= 0.51).mean() > 0.98


def test_corners_are_a_pixel_and_its_next_ones():
    rng = np.random.default_rng(0)
    greys = [rng.integers(0, 256, size, np.uint8) for size in [(3, 5), (4, 2)]]
    packed, sizes = pack_corners(greys)
    np.testing.assert_array_equal(sizes, [[3, 5], [4, 2]])
    for number, grey in enumerate(greys):
        for y in range(grey.shape[0] - 1):
            for x in range(grey.shape[1] - 1):
                four = grey[y : y + 2, x : x + 2].reshape(-1)
                assert int(packed[number, y, x]).to_bytes(4, "little") == four.tobytes()


def slow_paths(costs, small, large):
    high, wide, planes = costs.shape
    total = np.zeros(costs.shape)
    for dy, dx in [(0, 1), (0, -1), (1, 0), (-1, 0), (1, 1), (1, -1), (-1, 1), (-1, -1)]:
        rows = range(high) if dy >= 0 else range(high - 1, -1, -1)
        columns = range(wide) if dx >= 0 else range(wide - 1, -1, -1)
        path = np.zeros(costs.shape)
        for y in rows:
            for x in columns:
                path[y, x] = costs[y, x]
                if not (0 <= y - dy < high and 0 <= x - dx < wide):
                    continue
                before = path[y - dy, x - dx]
                for d in range(planes):
                    ways = [before[d], before.min() + large]
                    ways += [before[e] + small for e in (d - 1, d + 1) if 0 <= e < planes]
                    path[y, x, d] += min(ways) - before.min()
        total += path
    return total


def test_path_costs_match_their_definition():
    rng = np.random.default_rng(1)
    costs = rng.integers(0, 255, (6, 7, 9)).astype(np.uint8)
    np.testing.assert_array_equal(aggregate_costs(costs, 20.0, 90.0), slow_paths(costs, 20, 90))


def test_the_best_plane_is_found_between_planes():
    at = np.arange(12)
    total = np.array([[(at - 4.3) ** 2, (at - 0.2) ** 2, (at - 20.0) ** 2]], np.float32)
    np.testing.assert_allclose(select_planes(total), [[4.3, 0, 11]], atol=1e-5)


def slow_confirm(depth, rays, others, to_others, cameras, tolerance):
    votes, mean = np.zeros(depth.shape, np.uint8), np.zeros(depth.shape)
    for v, u in np.argwhere(depth > 0):
        z = float(depth[v, u])
        point, same = np.append(rays[v, u] * z, [z, 1]), [z]
        for other, pose, (fx, fy, cx, cy) in zip(others, to_others, cameras, strict=True):
            x, y, ahead = (pose @ point)[:3]
            if ahead <= 0.05 * z:
                continue
            column, row = int(np.floor(x / ahead * fx + cx)), int(np.floor(y / ahead * fy + cy))
            if not (0 <= row < other.shape[0] and 0 <= column < other.shape[1]):
                continue
            theirs = float(other[row, column])
            if theirs > 0 and abs(theirs - ahead) <= tolerance * ahead:
                votes[v, u] += 1
                same.append(z * theirs / ahead)
        mean[v, u] = np.mean(same)
    return votes, mean


def test_consistency_counts_equal_depths():
    rng = np.random.default_rng(2)
    depth = rng.uniform(1.8, 2.2, (12, 16)).astype(np.float32)
    depth[rng.random((12, 16)) < 0.2] = 0
    others = rng.uniform(1.8, 2.2, (3, 12, 16)).astype(np.float32)
    rays = rng.uniform(-0.4, 0.4, (12, 16, 2)).astype(np.float32)
    poses = np.tile(np.eye(4), (3, 1, 1))
    poses[:, :3, 3] = rng.normal(0, 0.1, (3, 3))
    cameras = np.tile([15.0, 15.0, 8.0, 6.0], (3, 1))
    votes, mean = check_consistency(depth, rays, others, poses, cameras, 0.05)
    slow_votes, slow_mean = slow_confirm(depth, rays, others, poses, cameras, 0.05)
    np.testing.assert_array_equal(votes, slow_votes)
    np.testing.assert_allclose(mean, slow_mean, rtol=1e-6)
    assert votes.max() > 1


def test_speckles_are_cut_off_by_jumps_and_holes():
    rng = np.random.default_rng(5)
    levels = ndimage.zoom(rng.integers(1, 4, (6, 8)), 4, order=0)
    depth = np.where(rng.random(levels.shape) < 0.35, 0, levels).astype(np.float32)
    expected = depth.copy()
    for level in (1, 2, 3):
        pieces, count = ndimage.label(depth == level)
        for piece in range(1, count + 1):
            if (pieces == piece).sum() < 9:
                expected[pieces == piece] = 0
    assert 0 < (expected > 0).sum() < (depth > 0).sum()
    np.testing.assert_array_equal(filter_speckles(depth, 9, 0.2), expected)
