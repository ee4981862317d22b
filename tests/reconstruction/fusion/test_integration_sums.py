"""What a view adds to the map's sums, against a slow reading of each rule on its own."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from world2minecraft.core.coordinates import apply, rotation_about_z
from world2minecraft.core.types import PointEvidence
from world2minecraft.reconstruction.fusion import EvidenceMap, FusionParameters
from world2minecraft.reconstruction.fusion.integration import place_of

RULES = FusionParameters(min_points=3, min_share=0.1, nudge_m=0.01)
seeds = st.integers(0, 10_000)


def tumbled(yaw_deg: float, shift_m) -> np.ndarray:
    """A frame that is turned about every axis and shifted."""
    tumble = np.eye(4)
    tumble[:3, :3] = [[0, 1, 0], [0, 0, 1], [1, 0, 0]]
    scan_to_room = rotation_about_z(yaw_deg) @ tumble @ rotation_about_z(20.0)
    scan_to_room[:3, 3] = shift_m
    return scan_to_room


def cloud(seed: int, count: int = 60, spread_m: float = 0.1) -> PointEvidence:
    """Points that face every way; a third has no normal, and each is trusted by chance."""
    random = np.random.default_rng(seed)
    normals = random.normal(0, 1, (count, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    normals[random.random(count) < 0.3] = 0
    return PointEvidence(
        view="v",
        camera_m=np.array([0.71, -0.53, 0.47]),
        points_m=random.uniform(-spread_m, spread_m, (count, 3)).astype(np.float32),
        weight=random.uniform(1e-4, 9e-4, count).astype(np.float32),
        colour=random.integers(0, 256, (count, 3)).astype(np.uint8),
        normals=normals.astype(np.float32),
        trust=random.uniform(0.2, 1, count).astype(np.float32),
    )


def by_cell(item: PointEvidence, scan_to_room: np.ndarray, rules: FusionParameters):
    """Each cell's points and normals in the room: a point belongs to the matter behind it."""
    points_m = apply(scan_to_room, item.points_m.astype(float))
    to_camera = apply(scan_to_room, item.camera_m) - points_m
    to_camera /= np.linalg.norm(to_camera, axis=1, keepdims=True)
    given_normals = item.normals.astype(float) @ scan_to_room[:3, :3].T
    normals = np.where(item.normals.any(axis=1)[:, None], given_normals, to_camera)
    cells = np.floor((points_m - normals * rules.nudge_m) / rules.voxel_m).astype(int)
    groups = {}
    for n, cell in enumerate(map(tuple, cells.tolist())):
        groups.setdefault(cell, []).append(n)
    return points_m, normals, groups


def is_taken(item: PointEvidence, members, rules: FusionParameters) -> bool:
    seen_m2 = item.weight[members].sum()
    return len(members) >= rules.min_points and seen_m2 >= rules.min_share * rules.voxel_m**2


def slow_faces(cell, members, points_m, normals, item, camera_m, rules) -> np.ndarray:
    """Of each face one measurement of its plane, weighed by one over its variance."""
    faces = np.zeros((6, 8))
    middle_m = (np.array(cell) + 0.5) * rules.voxel_m
    trust, area_m2 = item.trust[members].mean(), item.weight[members].sum()
    for face in range(6):
        axis, sign = face // 2, 1 if face % 2 else -1
        own = [
            n for n in members
            if np.abs(normals[n]).argmax() == axis and np.sign(normals[n, axis]) == sign
        ]  # fmt: skip
        if not own:
            continue
        z_m = np.linalg.norm(points_m[own] - camera_m, axis=1).mean()
        sigma_m = rules.sigma_m + rules.sigma_growth * (z_m - 0.4) ** 2
        pose_m = rules.pose_m + rules.pose_growth * z_m
        share = min(area_m2 * len(own) / len(members) / rules.voxel_m**2, 1)
        weight = trust * share / (pose_m**2 + sigma_m**2 / len(own))
        offset_m, normal = points_m[own].mean(axis=0) - middle_m, normals[own].mean(axis=0)
        faces[face] = weight * np.array([1, *offset_m, *normal, sigma_m])
    return faces


def row_of(map_: EvidenceMap, cell) -> tuple[int, int]:
    """Where a cell's log-odds lie, and its record."""
    place = place_of(*cell, map_.blocks.by_cell)
    return place, map_.blocks.record[place]


@settings(max_examples=5)
@given(seeds, st.floats(-180, 180), st.tuples(*[st.floats(-2, 2)] * 3))
def test_planes_hits_and_colours_follow_their_definition(seed, yaw_deg, shift_m):
    scan_to_room, item = tumbled(yaw_deg, shift_m), cloud(seed)
    map_ = EvidenceMap(scan_to_room, RULES)
    map_.add(item)
    points_m, normals, groups = by_cell(item, scan_to_room, RULES)
    camera_m = apply(scan_to_room, item.camera_m)
    taken = 0
    for cell, members in groups.items():
        place, row = row_of(map_, cell)
        if not is_taken(item, members, RULES):
            assert row == 0
            continue
        taken += 1
        assert map_.blocks.hits[row] == len(members)
        raised = RULES.hit_log_odds * item.trust[members].mean()
        assert map_.blocks.log_odds[place] == pytest.approx(raised, rel=1e-5)
        found = map_.blocks.colour_sum[row]
        np.testing.assert_array_equal(found, item.colour[members].astype(int).sum(axis=0))
        middle_m = (np.array(cell) + 0.5) * RULES.voxel_m
        offset_m = (points_m[members] - middle_m).sum(axis=0)
        np.testing.assert_allclose(map_.blocks.offset_sum[row], offset_m, atol=1e-4)
        expected = slow_faces(cell, members, points_m, normals, item, camera_m, RULES)
        np.testing.assert_allclose(map_.blocks.faces[row], expected, rtol=1e-3, atol=0.3)
    assert taken == map_.blocks.used[1] > 0


def test_measurements_add_up_and_log_odds_have_a_limit():
    rules = FusionParameters(min_points=1, min_share=0.0, limit_log_odds=1.5)
    one, other, both = (EvidenceMap(np.eye(4), rules) for _ in range(3))
    first, second = cloud(1), cloud(2)
    one.add(first), other.add(second)
    both.add(first), both.add(second)
    cells = {cell for item in (first, second) for cell in by_cell(item, np.eye(4), rules)[2]}
    rows = [[row_of(map_, cell)[1] for cell in cells] for map_ in (one, other, both)]
    assert len(set(rows[2])) == len(cells) == both.blocks.used[1] < sum(map(len, rows[:2]))
    for name in ("faces", "hits", "offset_sum", "colour_sum"):
        held = [getattr(map_.blocks, name) for map_ in (one, other, both)]
        sums = [values[at] for values, at in zip(held, rows, strict=True)]
        np.testing.assert_allclose(sums[0] + sums[1], sums[2], rtol=1e-4, atol=1e-2)
    assert both.blocks.log_odds.max() == 1.5
    assert one.blocks.log_odds[one.blocks.log_odds > 0].min() >= 0.2 * 0.9


@pytest.mark.parametrize("count", [1, 2])
def test_a_single_point_is_noise_and_carves_nothing(count):
    """Two points make a hit and carve the way to it; one does neither."""
    points_m = np.array([[1.02, 0.03, 0.03], [1.02, 0.04, 0.03]], np.float32)[:count]
    map_ = EvidenceMap(np.eye(4), FusionParameters(min_points=2))
    map_.add(PointEvidence("v", np.array([0.02, 0.02, 0.02]), points_m, np.full(count, 0.01, "f4")))
    assert (map_.blocks.log_odds > 0).sum() == (1 if count == 2 else 0)
    carved = (map_.blocks.log_odds < 0).sum()
    assert carved == (12 if count == 2 else 0), "all but the surface's own cell, the 13th"


def test_a_label_is_one_vote_and_no_class_is_none():
    points_m = np.tile(np.array([[1.02, 0.03, 0.03]], np.float32), (6, 1))
    labels = np.array([0, 1, 11, 11, 12, 255], np.uint8)
    weight = np.full(6, 0.01, np.float32)
    map_ = EvidenceMap(np.eye(4))
    map_.add(PointEvidence("v", np.zeros(3), points_m, weight, labels=labels))
    votes = map_.blocks.votes[1]
    assert votes[1] == 1 and votes[11] == 2 and votes.sum() == 3


def test_ray_carves_cells_once_and_stops_before_surface():
    """Along +x through cells of 0.08 m, to a surface at 1.00 m of which 0.3 m are kept clear."""
    rules = FusionParameters(min_points=1, min_share=0.0, clear_m=0.3, clear_growth=0.0)
    points_m = np.array([[1.0, 0.04, 0.04], [1.0, 0.05, 0.04]], np.float32)
    map_ = EvidenceMap(np.eye(4), rules)
    item = PointEvidence("v", np.array([0.0, 0.04, 0.04]), points_m, np.full(2, 0.01, "f4"))
    map_.add(item)
    expected = [i for i in range(12) if (i + 0.5) * 0.08 < 0.7]
    carved = [i for i in range(13) if map_.blocks.log_odds[row_of(map_, (i, 0, 0))[0]] < 0]
    assert carved == expected
    assert map_.blocks.log_odds.min() == pytest.approx(-0.2)
    for _ in range(40):
        map_.add(item)
    assert map_.blocks.log_odds.min() == -rules.limit_log_odds


@pytest.mark.parametrize(("trust", "carved"), [(0.5, True), (0.49, False)])
def test_only_surfaces_trusted_by_half_carve(trust, carved):
    points_m = np.array([[1.0, 0.04, 0.04], [1.0, 0.05, 0.04]], np.float32)
    map_ = EvidenceMap(np.eye(4))
    weight, sure = np.full(2, 0.01, np.float32), np.full(2, trust, np.float32)
    map_.add(PointEvidence("v", np.array([0.0, 0.04, 0.04]), points_m, weight, trust=sure))
    assert (map_.blocks.log_odds < 0).any() == carved


def test_means_survive_hit_counts_beyond_their_type():
    points_m = np.array([[1.02, 0.03, 0.03], [1.02, 0.04, 0.03]], np.float32)
    colour = np.full((2, 3), (10, 200, 30), np.uint8)
    map_ = EvidenceMap(np.eye(4))
    map_.add(PointEvidence("v", np.zeros(3), points_m, np.full(2, 0.01, "f4"), colour))
    mean_m = map_.blocks.offset_sum[1] / 2
    for name in ("hits", "colour_sum", "offset_sum"):
        getattr(map_.blocks, name)[1] *= 65535
    map_.blocks.votes[1, 5] = 1e6
    found = map_.fused()
    at = tuple(np.argwhere(found.hits)[0])
    assert found.hits[at] == 65535
    np.testing.assert_allclose(found.colour_sum[at] / 65535, (10, 200, 30), rtol=1e-5)
    np.testing.assert_allclose(found.offset_sum[at] / 65535, mean_m, rtol=1e-4)
    assert np.isfinite(found.votes[at][5]) and found.votes[at][5] >= 50_000


@pytest.mark.parametrize(
    ("share", "least"), [(0.0, 1), (0.0625, 4), (0.063, 5), (0.5, 32), (0.99, 64), (1.0, 64)]
)
def test_a_share_of_a_cell_is_so_many_of_its_64_sub_cells(share, least):
    map_ = EvidenceMap(np.eye(4), FusionParameters(solid_share=share))
    assert map_._surface_rules.min_sub_cells == least


def test_the_map_tells_the_memory_of_its_arrays():
    map_ = EvidenceMap(np.eye(4))
    before = map_.memory_mb
    assert before * (1 << 20) == (3 + 2) * 8, "a fresh map has a corner and two counters"
    map_.blocks.reserve_records(1 << 20)
    per_record = (12 + 3 + 3 + 48) * 4 + 8  # Votes, colour, offsets, faces as float32; hits.
    assert map_.memory_mb - before == pytest.approx(per_record, rel=1e-3)


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize(("edge_m", "side", "cell"), [(0.0, 1, -1), (0.64, -1, 8)])
def test_matter_behind_the_last_point_reaches_the_next_block(axis, edge_m, side, cell):
    """The points lie a millimetre before a block's edge, their matter behind it."""
    points_m = np.full((4, 3), 0.25, np.float32)
    points_m[:, axis] = edge_m + 0.001 * side
    points_m[:, (axis + 1) % 3] += np.arange(4) * 0.01
    normals = np.zeros((4, 3), np.float32)
    normals[:, axis] = side
    map_ = EvidenceMap(np.eye(4), RULES)
    map_.add(
        PointEvidence("v", np.full(3, 0.25), points_m, np.full(4, 0.01, "f4"), normals=normals)
    )
    _, record, low = map_._dense()
    (met,) = np.argwhere(record) + low
    expected = np.full(3, 3)
    expected[axis] = cell
    np.testing.assert_array_equal(met, expected)


def test_a_cell_that_one_view_met_last_is_carved_by_the_next():
    """In either order: two views down one row, the second through the first's surface."""
    rules = FusionParameters(min_points=1, min_share=0.0, clear_m=0.0, clear_growth=0.0)
    views = [
        PointEvidence(
            "v", np.array([0.0, 0.04, 0.04]), np.array([[x, 0.04, 0.04]] * 2, np.float32),
            np.full(2, 0.01, np.float32),
        )
        for x in (1.0, 2.0)
    ]  # fmt: skip
    found = []
    for order in (views, views[::-1]):
        map_ = EvidenceMap(np.eye(4), rules)
        for one in order:
            map_.add(one)
        found.append(map_.fused().log_odds)
    np.testing.assert_array_equal(*found)


def test_a_map_of_nothing_is_one_cell_of_which_nothing_is_known():
    log_odds, record, low = EvidenceMap(np.eye(4))._dense()
    assert log_odds.shape == record.shape == (1, 1, 1)
    assert log_odds.item() == record.item() == 0 and low.tolist() == [0, 0, 0]


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize(("side", "way", "carved"), [(1, 12.0, 12), (-1, 12.0, 12), (1, 0.9, 1)])
def test_axis_aligned_ray_carves_every_cell_before_surface(axis, side, way, carved):
    """From the middle of a cell, ``way`` cells far; the surface's own cell is left alone."""
    rules = FusionParameters(min_points=1, min_share=0.0, clear_m=0.0, clear_growth=0.0)
    camera_m = np.full(3, 0.04)
    point_m = camera_m.copy()
    point_m[axis] += side * way * rules.voxel_m
    map_ = EvidenceMap(np.eye(4), rules)
    points_m = np.array([point_m] * 2, np.float32)
    map_.add(PointEvidence("v", camera_m, points_m, np.full(2, 0.01, np.float32)))
    log_odds, _, low = map_._dense()
    found = np.argwhere(log_odds < 0) + low
    assert sorted(side * found[:, axis]) == list(range(carved))
    assert not np.delete(found, axis, axis=1).any()


def test_votes_of_pixels_count_like_votes_of_points():
    rng = np.random.default_rng(3)
    points_m = rng.uniform(0.4, 0.6, (2000, 3)).astype(np.float32)
    weight = np.full(2000, 0.01, np.float32)
    votes = rng.random((7, 12)).astype(np.float16)
    rows = rng.integers(0, 7, 2000).astype(np.int32)
    compact = PointEvidence("v", np.zeros(3), points_m, weight, votes=votes, vote_rows=rows)
    assert np.array_equal(compact.point_votes, votes[rows])
    maps = [EvidenceMap(np.eye(4)) for _ in range(2)]
    maps[0].add(compact)
    maps[1].add(replace(compact, votes=votes[rows], vote_rows=None))
    sums = [one.fused().votes for one in maps]
    assert sums[0].any() and np.array_equal(*sums)


@pytest.mark.parametrize("row", [-1, 7])
def test_rows_of_votes_must_exist(row):
    votes, rows = np.zeros((7, 12), np.float16), np.array([0, row], np.int32)
    points_m, weight = np.zeros((2, 3), np.float32), np.ones(2, np.float32)
    with pytest.raises(ValueError, match="below the number of votes, 7"):
        PointEvidence("v", np.zeros(3), points_m, weight, votes=votes, vote_rows=rows)
