"""The verdict on each cell against a slow reading, and what becomes of the points of spill."""

from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

from world2minecraft.reconstruction.fusion.surface_decision import (
    SOLID,
    SPILL_BEFORE,
    SPILL_BEHIND,
    SurfaceRules,
    _joined_plane,
    _spill_share,
    _weight_before,
    decide_surface,
    move_sums,
)

VOXEL_M = 0.08
LEAST, MERGE_M, MERGE_SIGMAS, SURE_M = 4, 0.016, 3.0, 0.003
RULES = SurfaceRules(LEAST, MERGE_M, MERGE_SIGMAS, SURE_M)
SHAPE = (3, 4, 2)
TICKS_M = (np.arange(4) - 1.5) * VOXEL_M / 4
SUB_CELLS_M = np.stack(np.meshgrid(*[TICKS_M] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
seeds = st.integers(0, 10_000)


class Scene(NamedTuple):
    log_odds: np.ndarray
    record: np.ndarray
    faces: np.ndarray


def scene(seed: int, shape=SHAPE) -> Scene:
    """Cells of which most have a record, with planes on one or two of their six faces."""
    random = np.random.default_rng(seed)
    record = np.zeros(shape, np.int32)
    held = random.random(shape) < 0.8
    record[held] = random.permutation(held.sum()) + 1
    log_odds = np.where(held, random.uniform(-1, 6, shape), -0.5).astype(np.float32)
    faces = np.zeros((held.sum() + 1, 6, 8), np.float32)
    for row in range(1, len(faces)):
        for face in random.choice(6, random.integers(0, 3), replace=False):
            depth_m = random.choice([0.0, 0.035, -0.035]) + random.normal(0, 0.01)
            weight = random.choice([1.0, 3.0, 30.0])
            faces[row, face] = plane(random, face, depth_m, weight)
    known = Scene(log_odds, record, faces)
    for _ in range(5):
        spill_behind(random, known)
    return known


def spill_behind(random: np.random.Generator, known: Scene) -> None:
    """Give a cell a few points over its edge, of a surface of many in the cell before it."""
    cell, face = tuple(random.integers(0, known.record.shape)), random.integers(6)
    before = at(cell, face // 2, 1 if face % 2 else -1)
    if held(known.record, before) and known.record[cell] and known.record[before]:
        known.faces[known.record[cell]] = 0
        few, many = random.choice([1.0, 3.0]), random.choice([10.0, 30.0])
        known.faces[known.record[cell], face] = plane(random, face, 0.037, few)
        known.faces[known.record[before], face] = plane(
            random, face, random.uniform(-0.03, 0), many
        )
        known.log_odds[cell] = 2.5


def plane(random: np.random.Generator, face: int, depth_m: float, weight: float) -> np.ndarray:
    """A face's sums: weight; weighted offset, normal and sigma. ``depth_m`` is the way it looks."""
    looks = 1 if face % 2 else -1
    normal, offset_m = random.normal(0, 0.1, 3), random.uniform(-0.03, 0.03, 3)
    normal[face // 2], offset_m[face // 2] = looks, looks * depth_m
    sigma_m = random.uniform(0.001, 0.02)
    return 1e4 * weight * np.array([1, *offset_m, *normal / np.linalg.norm(normal), sigma_m])


def at(cell, axis: int, step: int) -> tuple[int, ...]:
    return tuple(c + step * (a == axis) for a, c in enumerate(cell))


def held(values: np.ndarray, cell) -> bool:
    return all(0 <= c < size for c, size in zip(cell, values.shape, strict=True))


def face_of(known: Scene, cell, face: int) -> np.ndarray:
    """The sums of a cell's face, zeros where there is no cell."""
    return known.faces[known.record[cell], face] if held(known.record, cell) else np.zeros(8)


def joined(known: Scene, cell, face: int) -> tuple[np.ndarray, np.ndarray]:
    """The plane of a face, joined with those of both neighbours that may be of the same surface."""
    own, axis = face_of(known, cell, face).astype(float), face // 2
    weights, points, normals = [own[0]], [own[1:4] / own[0]], [own[4:7]]
    for step in (-1, 1):
        other = face_of(known, at(cell, axis, step), face).astype(float)
        if other[0] == 0:
            continue
        point = other[1:4] / other[0] + step * VOXEL_M * np.eye(3)[axis]
        common = own[4:7] + other[4:7]
        apart_m = abs((point - points[0]) @ common) / np.linalg.norm(common)
        if apart_m < MERGE_M + MERGE_SIGMAS * max(own[7] / own[0], other[7] / other[0]):
            weights.append(other[0])
            points.append(point)
            normals.append(other[4:7])
    normal = np.sum(normals, axis=0)
    return np.average(points, axis=0, weights=weights), normal / np.linalg.norm(normal)


def slow_verdict(known: Scene, cell) -> tuple[int, float, int]:
    """The rule of the module's text, face by face: what a cell is, its margin, and by which."""
    told = []
    for face in range(6):
        own, axis = face_of(known, cell, face), face // 2
        if own[0] == 0:
            continue
        point, normal = joined(known, cell, face)
        depths_m = np.sort((point - SUB_CELLS_M) @ normal)[::-1]
        depth_m = depths_m[LEAST - 1]
        beyond_m = depth_m - abs(normal[axis]) * VOXEL_M  # As deep in the cell before this one.
        before = face_of(known, at(cell, axis, 1 if face % 2 else -1), face)[0]
        by_noise = stats.norm.sf(beyond_m / max(own[7] / own[0], 1e-6))
        share = min(by_noise + 0.05, 0.2)
        behind = depths_m[-1] > 0 and beyond_m > 0 and own[0] < (own[0] + before) * share
        told.append((float(own[0]), depth_m, behind, face))
    solid = [(depth_m, face) for _, depth_m, behind, face in told if depth_m > 0 and not behind]
    if solid:
        return SOLID, *max(solid, key=lambda one: one[0])
    if not told:
        return 0, 0.0, 0
    _, depth_m, behind, face = max(told, key=lambda one: one[0])
    return (SPILL_BEHIND if behind else SPILL_BEFORE), depth_m, face


def slow_settle(known: Scene) -> tuple[np.ndarray, np.ndarray, dict]:
    verdicts = {
        cell: slow_verdict(known, cell)
        for cell in np.ndindex(known.record.shape)
        if known.record[cell] and known.log_odds[cell] > 0
    }
    settled, heir = known.log_odds.copy(), known.record.copy()
    for cell, (said, margin_m, face) in verdicts.items():
        if said == SOLID:
            settled[cell] = min(known.log_odds[cell], margin_m / SURE_M)
        elif said == SPILL_BEFORE:
            settled[cell] = max(-known.log_odds[cell], margin_m / SURE_M)
        elif said == SPILL_BEHIND:
            settled[cell] = 0
        if said in (SPILL_BEFORE, SPILL_BEHIND):
            looks = 1 if face % 2 else -1
            beside = [at(cell, face // 2, -looks), at(cell, face // 2, looks)]
            solid = [c for c in beside if verdicts.get(c, (0,))[0] == SOLID]
            heir[cell] = known.record[solid[0]] if solid else 0
    return settled, heir, verdicts


@settings(max_examples=4)
@given(seeds)
def test_every_cell_is_settled_as_the_slow_reading_says(seed):
    known = scene(seed)
    settled, heir = decide_surface(*known, VOXEL_M, RULES)
    expected, expected_heir, _ = slow_settle(known)
    np.testing.assert_allclose(settled, expected, atol=2e-3)
    np.testing.assert_array_equal(heir, expected_heir)


@settings(max_examples=12)
@given(seeds)
def test_room_around_the_map_changes_nothing(seed):
    """No cell at the map's edge looks for its neighbour beyond it, or at the other end."""
    known = scene(seed, (2, 2, 2))
    settled, heir = decide_surface(*known, VOXEL_M, RULES)
    wide, wide_heir = decide_surface(
        np.pad(known.log_odds, 1), np.pad(known.record, 1), known.faces, VOXEL_M, RULES
    )
    np.testing.assert_array_equal(wide, np.pad(settled, 1))
    np.testing.assert_array_equal(wide_heir, np.pad(heir, 1))


@pytest.mark.parametrize("face", range(6))
def test_a_surface_at_the_edge_of_the_map_has_nothing_before_it(face):
    """Its plane lies beyond the cell; but there is no cell whose points could have spilled."""
    faces = np.zeros((2, 6, 8), np.float32)
    faces[1, face] = plane(np.random.default_rng(0), face, 0.06, 1.0)
    record, log_odds = np.ones((1, 1, 1), np.int32), np.full((1, 1, 1), 2.5, np.float32)
    settled, heir = decide_surface(log_odds, record, faces, VOXEL_M, RULES)
    assert settled.item() == 2.5 and heir.item() == 1


@pytest.mark.parametrize("face", range(6))
def test_the_two_ends_of_the_map_are_no_neighbours(face):
    """Spill in the last cell, and a wall in the first that would fit it if the map were round."""
    axis, looks = face // 2, 1 if face % 2 else -1
    record, faces = np.array([1, 0, 2], np.int32), np.zeros((3, 6, 8), np.float32)
    for row, depth_m in ((1, -0.038), (2, 0.038)):
        along = looks * np.eye(3)[axis]
        faces[row, face] = 1e4 * np.array([1, *(depth_m * along), *along, 0.01])
    line = np.moveaxis(record[::looks].reshape(3, 1, 1), 0, axis)
    log_odds = np.where(line > 0, 6, 0).astype(np.float32)
    settled, heir = decide_surface(log_odds, np.ascontiguousarray(line), faces, VOXEL_M, RULES)
    assert heir[line == 1].item() == 0 and heir[line == 2].item() == 2
    assert settled[line == 1].item() == pytest.approx((-0.038 + 0.03) / SURE_M, abs=1e-3)


@given(st.floats(0, 0.1), st.floats(0.001, 0.05))
def test_spill_share_is_noise_and_a_twentieth_up_to_a_fifth(depth_m, sigma_m):
    expected = min(stats.norm.sf(depth_m / sigma_m) + 0.05, 0.2)
    assert _spill_share(depth_m, sigma_m) == pytest.approx(expected)


def test_the_scenes_of_the_slow_reading_hold_every_verdict():
    said = [one[0] for seed in range(8) for one in slow_settle(scene(seed))[2].values()]
    assert min(np.bincount(said, minlength=4)) >= 5


@pytest.mark.parametrize("axes", [(0, 1, 2), (1, 2, 0), (2, 0, 1), (1, 0, 2)])
@pytest.mark.parametrize("flips", [(1, 1, 1), (-1, 1, 1), (1, -1, -1)])
def test_no_side_of_a_room_is_settled_by_another_rule(axes, flips):
    """A room whose axes are named anew, or that a mirror shows, is settled into its image."""
    known = scene(7)

    def image(values):
        flipped = values[tuple(slice(None, None, flip) for flip in flips)]
        return np.ascontiguousarray(flipped.transpose(axes))

    faces = np.zeros_like(known.faces)
    for face in range(6):
        axis, upper = axes[face // 2], face % 2
        from_face = 2 * axis + (upper if flips[axis] > 0 else 1 - upper)
        sums = known.faces[:, from_face]
        faces[:, face, [0, 7]] = sums[:, [0, 7]]
        for m, source in enumerate(axes):
            faces[:, face, 1 + m] = sums[:, 1 + source] * flips[source]
            faces[:, face, 4 + m] = sums[:, 4 + source] * flips[source]
    settled, heir = decide_surface(*known, VOXEL_M, RULES)
    turned, turned_heir = decide_surface(
        image(known.log_odds), image(known.record), faces, VOXEL_M, RULES
    )
    np.testing.assert_allclose(turned, image(settled), atol=1e-3)
    np.testing.assert_array_equal(turned_heir, image(heir))


@settings(max_examples=6)
@given(seeds)
def test_points_of_spill_keep_their_number_and_their_place(seed):
    """What an heir takes over stands where it stood: an offset is from the heir's centre now."""
    known, random = scene(seed, (2, 4, 3)), np.random.default_rng(seed)
    _, heir = decide_surface(*known, VOXEL_M, RULES)
    rows = len(known.faces)
    votes = random.integers(0, 9, (rows, 12)).astype(np.float32)
    colour_sum = random.integers(0, 999, (rows, 3)).astype(np.float32)
    offset_sum = random.normal(0, 1, (rows, 3)).astype(np.float32)
    hits = random.integers(1, 99, rows)
    for sums in (votes, colour_sum, offset_sum, hits):
        sums[0] = 0

    def of_heirs():
        """The sums that each heir should have, by adding its own to those left to it."""
        expected = {}
        for cell in np.ndindex(heir.shape):
            row, to = known.record[cell], heir[cell]
            if to:
                middle_m = (np.array(cell) + 0.5) * VOXEL_M
                place_m = offset_sum[row] + hits[row] * middle_m
                sums = (hits[row], votes[row], colour_sum[row], place_m)
                old = expected.get(to, (0, 0, 0, 0))
                expected[to] = tuple(a + b for a, b in zip(old, sums, strict=True))
        return expected

    expected = of_heirs()
    move_sums(known.record, heir, VOXEL_M, votes, colour_sum, offset_sum, hits)
    for cell in np.ndindex(heir.shape):
        row = known.record[cell]
        if row not in expected:
            assert hits[row] == 0 and not votes[row].any()
            assert not colour_sum[row].any() and not offset_sum[row].any()
            continue
        middle_m = (np.array(cell) + 0.5) * VOXEL_M
        count, of_votes, of_colour, of_place = expected[row]
        assert hits[row] == count
        np.testing.assert_allclose(votes[row], of_votes)
        np.testing.assert_allclose(colour_sum[row], of_colour)
        np.testing.assert_allclose(offset_sum[row] + hits[row] * middle_m, of_place, atol=1e-3)


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("sigmas_m", [(0.0, 0.0), (0.01, 0.0), (0.0, 0.01)])
@pytest.mark.parametrize("gap_m", [0.01, 0.03, 0.06])
def test_planes_of_neighbours_join_as_near_as_noise_explains(axis, sigmas_m, gap_m):
    """Two cells, one behind the other along each axis; their planes lie ``gap_m`` apart."""
    record = np.zeros((3, 3, 3), np.int64)
    beside = [1, 1, 1]
    beside[axis] = 2
    record[1, 1, 1], record[tuple(beside)] = 1, 2
    faces = np.zeros((3, 6, 8))
    face = 2 * axis + 1
    for number, sigma_m in enumerate(sigmas_m, start=1):
        faces[number, face, 0], faces[number, face, 7] = 1.0, sigma_m
        faces[number, face, 4 + axis] = 1.0
    faces[2, face, 1 + axis] = gap_m - VOXEL_M
    plane = np.zeros(6)
    _joined_plane(1, 1, 1, face, record, faces, VOXEL_M, RULES, plane)
    joined = gap_m < MERGE_M + MERGE_SIGMAS * max(sigmas_m)
    assert plane[axis] == pytest.approx(gap_m / 2 if joined else 0.0)


def test_weight_before_is_that_of_the_cell_a_face_looks_at():
    record = np.arange(27).reshape(3, 3, 3)
    faces = np.random.default_rng(0).random((27, 6, 8))
    for cell in np.ndindex(3, 3, 3):
        for face in range(6):
            before = np.array(cell)
            before[face // 2] += 1 if face % 2 else -1
            inside = (before >= 0).all() and (before < 3).all()
            expected = faces[record[tuple(before)], face, 0] if inside else 0.0
            assert _weight_before(*cell, face, record, faces) == expected
