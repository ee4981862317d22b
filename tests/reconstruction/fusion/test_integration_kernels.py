"""The fast kernels against a slow reading of the same rules."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from world2minecraft.core.coordinates import rotation_about_z
from world2minecraft.core.types import PointEvidence, Scan
from world2minecraft.reconstruction.fusion import EvidenceMap, FusionParameters, fuse_views
from world2minecraft.reconstruction.fusion.integration import (
    FIRST_CELLS,
    ViewPlace,
    ViewPoints,
    sum_cells,
    to_cells,
)
from world2minecraft.reconstruction.fusion.voxel_blocks import Blocks

PARAMETERS = FusionParameters(min_share=0.2)


def view(seed: int, count: int = 60, trusted: bool = True) -> PointEvidence:
    """Points of a wall at x = 1, some of them noisy, seen from a camera before it."""
    random = np.random.default_rng(seed)
    points = np.stack(
        [
            1.003 + random.normal(0, 0.02, count),
            random.uniform(-0.5, 0.5, count),
            random.uniform(0.1, 0.9, count),
        ],
        axis=1,
    )
    votes = np.zeros((count, 12), np.float16)
    votes[np.arange(count), random.integers(1, 12, count)] = 1
    return PointEvidence(
        view=f"v{seed}",
        camera_m=np.array([-1.013, random.uniform(-0.3, 0.3), 0.57]),
        points_m=points.astype(np.float32),
        weight=np.full(count, 0.0009, np.float32),
        colour=random.integers(0, 256, (count, 3)).astype(np.uint8),
        votes=votes,
        trust=None if trusted else random.uniform(0, 1, count).astype(np.float32),
    )


def slow_fusion(views, parameters):
    """The rules word by word, cells as dictionary keys."""
    voxel_m = parameters.voxel_m
    log_odds, hits, colour, offset, votes = {}, {}, {}, {}, {}
    for item in views:
        camera = item.camera_m / voxel_m
        touched = {}
        for n, point_m in enumerate(item.points_m.astype(np.float64)):
            point = (point_m / voxel_m).astype(np.float32).astype(np.float64)
            ray = point - camera
            behind = point + ray / np.linalg.norm(ray) * parameters.nudge_m / voxel_m
            touched.setdefault(tuple(np.floor(behind).astype(int)), []).append((n, point))
        for cell, members in touched.items():
            if len(members) < parameters.min_points:
                continue
            area = sum(item.weight[n] for n, _ in members)
            sure = 1.0 if item.trust is None else np.mean([item.trust[n] for n, _ in members])
            if area >= parameters.min_share * voxel_m**2:
                raised = log_odds.get(cell, 0) + sure * parameters.hit_log_odds
                log_odds[cell] = min(parameters.limit_log_odds, raised)
                hits[cell] = hits.get(cell, 0) + len(members)
                for n, point in members:
                    middle = np.array(cell) + 0.5
                    colour[cell] = colour.get(cell, 0) + item.colour[n].astype(float)
                    offset[cell] = offset.get(cell, 0) + (point - middle) * voxel_m
                    votes[cell] = votes.get(cell, 0) + item.votes[n].astype(float)
        freed = set()
        for members in touched.values():
            sure = 1.0 if item.trust is None else np.mean([item.trust[n] for n, _ in members])
            if len(members) >= parameters.min_points and sure >= 0.5:
                target = np.mean([point for _, point in members], axis=0)
                far = parameters.clear_growth * np.linalg.norm(target - camera)
                freed |= crossed(camera, target, parameters.clear_m / voxel_m + far)
        for cell in freed - set(touched):
            lowered = log_odds.get(cell, 0) + parameters.free_log_odds
            log_odds[cell] = max(-parameters.limit_log_odds, lowered)
    return log_odds, hits, colour, offset, votes


def crossed(camera, target, clear):
    """The cells on a ray whose way's middle lies before the clearance, by cutting all planes."""
    way = target - camera
    length = np.linalg.norm(way)
    way = way / length
    cuts = [0.0, length]
    for axis in range(3):
        low, high = sorted((camera[axis], target[axis]))
        for plane in range(int(np.ceil(low)), int(np.floor(high)) + 1):
            if way[axis] != 0:
                cuts.append((plane - camera[axis]) / way[axis])
    # The walk goes on past the target's cell edge; one more cut stands for the cell it ends in.
    cells = set()
    cuts = sorted(t for t in cuts if 0 <= t <= length)
    for near, far in itertools.pairwise(cuts):
        if far - near > 1e-12 and (near + far) / 2 < length - clear:
            cells.add(tuple(np.floor(camera + way * (near + far) / 2).astype(int)))
    return cells


@settings(max_examples=15, deadline=None)
@given(
    st.lists(st.integers(0, 10_000), min_size=1, max_size=4, unique=True),
    st.booleans(),
    st.sampled_from([0.0, 0.03]),
)
def test_the_map_equals_the_slow_reading(seeds, trusted, growth):
    views = [view(seed, trusted=trusted) for seed in seeds]
    parameters = replace(PARAMETERS, clear_growth=growth)
    fast = EvidenceMap(np.eye(4), parameters)
    for item in views:
        fast.add(item)
    fused = fast.fused()
    log_odds, hits, colour, offset, votes = slow_fusion(views, parameters)
    low = np.round(fused.origin_m / PARAMETERS.voxel_m).astype(int)
    found = {tuple(cell + low) for cell in np.argwhere(fused.log_odds != 0)}
    expected = {cell for cell, value in log_odds.items() if value != 0}
    # A ray that grazes an edge may fall to either side in float32: two cells of hundreds.
    assert len(found ^ expected) <= 2
    for cell in found & expected:
        at = tuple(np.array(cell) - low)
        assert abs(float(fused.log_odds[at]) - log_odds[cell]) <= 0.21
        assert int(fused.hits[at]) == hits.get(cell, 0)
        assert np.allclose(fused.colour_sum[at], colour.get(cell, 0), atol=0.5)
        assert np.allclose(fused.offset_sum[at], offset.get(cell, 0), atol=1e-3)
        assert np.allclose(fused.votes[at], votes.get(cell, 0), atol=0.01)


def test_the_order_of_views_hardly_matters():
    views = [view(seed) for seed in range(6)]
    one, other = EvidenceMap(np.eye(4)), EvidenceMap(np.eye(4))
    for item in views:
        one.add(item)
    for item in views[::-1]:
        other.add(item)
    a, b = one.fused(), other.fused()
    assert np.array_equal(a.hits, b.hits)
    assert np.allclose(a.offset_sum, b.offset_sum, atol=1e-4)
    # Only clipping depends on order, and six views never reach the limit.
    assert np.allclose(a.log_odds.astype(float), b.log_odds.astype(float), atol=0.02)


def test_fusion_is_the_same_in_a_turned_frame():
    turn = np.array([[0, -1, 0, 0.8], [1, 0, 0, -0.4], [0, 0, 1, 0.16], [0, 0, 0, 1]], np.float64)
    views = [view(seed) for seed in range(4)]
    plain, turned = EvidenceMap(np.eye(4)), EvidenceMap(turn)
    for item in views:
        plain.add(item)
        turned.add(item)
    a, b = plain.fused(), turned.fused()
    assert abs(int((a.log_odds > 0).sum()) - int((b.log_odds > 0).sum())) <= 2
    assert int(a.hits.sum()) == int(b.hits.sum())


@pytest.mark.parametrize(("items", "told"), [(3, [1, 2, 3]), (2, [1, 2, 3]), (4, [1, 2, 3, 3])])
def test_fuse_views_reports_progress_to_the_end(items, told):
    """Each view that gave something, and the end where some gave nothing; never beyond it."""
    calls = []
    scan = Scan([1, 2, 3], np.eye(4), np.ones(3), ("a", "b", "c"))
    views = (view(n) for n in range(items))
    fuse_views(views, scan, progress=lambda *call: calls.append(call[:3]))
    assert calls == [("fuse", done, 3) for done in told]


def test_points_are_carried_by_the_transform_and_bounded():
    points_m = np.random.default_rng(0).normal(size=(9, 3)).astype(np.float32)
    carry = np.random.default_rng(1).normal(size=(3, 4))
    cells, low, high = to_cells(points_m, carry)
    np.testing.assert_allclose(cells, points_m @ carry[:, :3].T + carry[:, 3], rtol=1e-5, atol=1e-5)
    np.testing.assert_allclose([low, high], [cells.min(axis=0), cells.max(axis=0)], rtol=1e-6)


def summed(points: ViewPoints, place: ViewPlace):
    """The sums of points in the first 256 cells of each axis, with the cells by number."""
    blocks = Blocks()
    blocks.reserve_box(np.zeros(3, np.int64), np.full(3, 256), place.voxel_m)
    owner, places, sums = sum_cells(points, place, blocks.by_cell, blocks.mark, 1)
    return owner, places, sums


@pytest.mark.parametrize("count", [1, 4])
def test_normals_are_turned_and_default_to_the_camera(count):
    normals = np.array([[1, 0, 0], [0, -1, 0], [0, 0, 1], [0, 0, 0]], np.float32)[:count]
    turn = np.ascontiguousarray(rotation_about_z(90)[:3, :3])
    place = ViewPlace(np.array([9.5, 9.5, 99.0]), turn, 0.1, 0.08)
    expected = np.array([[0, 1, 0], [1, 0, 0], [0, 0, 1], [0, 0, 1]])[:count]
    for given_normals, wanted in ((normals, expected), (normals[:0], [[0, 0, 1]] * count)):
        cells = np.full((count, 3), 9.5, np.float32)
        weight, nothing = np.ones(count, np.float32), np.zeros(0, np.float32)
        points = ViewPoints(cells, given_normals, weight, nothing, np.zeros((0, 3), np.uint8))
        _, _, sums = summed(points, place)
        np.testing.assert_allclose(sums.faces[0, :, 4:7].sum(axis=0), np.sum(wanted, 0), atol=1e-6)


def walk(seed: int, count: int, spread: float) -> ViewPoints:
    """Points along a random walk that share normals for a while, some of them without one."""
    random = np.random.default_rng(seed)
    steps = random.normal(0, spread, (count, 3)).cumsum(axis=0)
    normals = np.repeat(random.normal(size=(-(-count // 4), 3)), 4, axis=0)[:count]
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    normals[random.random(count) < 0.1] = 0
    return ViewPoints(
        (8 + (steps + 120) % 240).astype(np.float32),
        normals.astype(np.float32),
        random.uniform(1e-4, 1e-3, count).astype(np.float32),
        random.uniform(0, 1, count).astype(np.float32),
        random.integers(0, 256, (count, 3)).astype(np.uint8),
    )


def slow_sums(points: ViewPoints, place: ViewPlace):
    """The sums of each cell, point by point, and the cell of each point."""
    sums, owner = {}, []
    for n, at in enumerate(points.cells.astype(float)):
        normal = place.turn @ points.normals[n]
        if not normal.any():
            normal = (place.camera - at) / np.linalg.norm(place.camera - at)
        cell = tuple(np.floor(at - normal * place.nudge).astype(int))
        side = np.abs(normal).argmax()
        face = 2 * side + (normal[side] > 0)
        sums.setdefault(cell, []).append((n, face, at, normal))
        owner.append(sums[cell][0][0])
    first = {members[0][0]: s for s, members in enumerate(sums.values())}
    return sums, [first[n] for n in owner]


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 10_000), st.sampled_from([(3, 0.02), (200, 0.05), (200, 0.4), (1300, 60.0)]))
def test_the_sums_of_a_view_equal_the_slow_reading(seed, size):
    """Also for more cells than there is memory for at first."""
    points = walk(seed, *size)
    turn, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    place = ViewPlace(np.array([3.0, 5.0, 7.0]), np.ascontiguousarray(turn), 0.125, 0.08)
    owner, places, sums = summed(points, place)
    expected, expected_owner = slow_sums(points, place)
    assert len(places) == len(expected) == len(set(places.tolist()))
    assert len(expected) > FIRST_CELLS or size[0] < 1000
    np.testing.assert_array_equal(owner, expected_owner)
    for s, (cell, members) in enumerate(expected.items()):
        rows = [n for n, *_ in members]
        assert sums.hits[s] == len(rows)
        np.testing.assert_array_equal(sums.colour[s], points.colour[rows].astype(int).sum(axis=0))
        np.testing.assert_allclose(sums.area[s], points.weight[rows].sum(), rtol=1e-5)
        np.testing.assert_allclose(sums.trust[s], points.trust[rows].mean(), rtol=1e-5)
        np.testing.assert_allclose(sums.target[s], points.cells[rows].sum(axis=0), rtol=1e-5)
        faces = np.zeros((6, 8))
        for _, face, at, normal in members:
            away_m = np.linalg.norm(at - place.camera) * place.voxel_m
            offset_m = (at - np.array(cell) - 0.5) * place.voxel_m
            faces[face] += [1, *offset_m, *normal, away_m]
        np.testing.assert_allclose(sums.faces[s], faces, rtol=1e-5, atol=1e-5)
