"""Which cells are solid: the rule that truth is made by, read slowly and held against walls."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from world2minecraft.core.types import Camera, PointEvidence, View
from world2minecraft.reconstruction.fusion import EvidenceMap, FusionParameters
from world2minecraft.reconstruction.fusion.surface_decision import _depth_of_solid
from world2minecraft.reconstruction.occupancy.depth_evidence import DepthPredictor

CELL_M = 0.08
CAMERA = Camera(160, 120, 140.0, 140.0, 80.0, 60.0)


def fused(*views, **changes):
    map_ = EvidenceMap(np.eye(4), FusionParameters(**changes))
    for item in views:
        map_.add(item)
    return map_.fused()


def pose(eye, right, down, ahead) -> np.ndarray:
    result = np.eye(4)
    result[:3, :3] = np.stack([right, down, ahead], axis=1)
    result[:3, 3] = eye
    return result


def look_x(depth_m: np.ndarray, eye=(0, 0, 1.2)) -> PointEvidence:
    """What a camera says that looks along +x."""
    camera_to_scan = pose(eye, (0, -1, 0), (0, 0, -1), (1, 0, 0))
    shown = View("v", camera_to_scan, None, None, depth_m.astype(np.float32), CAMERA)
    return DepthPredictor().lift(shown)


def occupied_layers(evidence) -> set[int]:
    low = int(np.round(evidence.origin_m[0] / CELL_M))
    return set((np.argwhere(evidence.log_odds > 0)[:, 0] + low).tolist())


@settings(max_examples=30)
@given(st.integers(1900, 2100))
def test_a_wall_is_the_cell_that_a_centimetre_of_it_lies_in(distance_mm):
    wall_m = distance_mm / 1000
    into_cell = (-wall_m) % CELL_M  # How deep the wall reaches into the cell of its face.
    if abs(into_cell - 0.01) < 0.0015:  # Within float32 and the mean of slanted rays of the edge.
        return
    found = occupied_layers(fused(look_x(np.full((120, 160), wall_m))))
    assert found == {int(np.floor((wall_m + 0.01) / CELL_M))}


@settings(max_examples=6)
@given(st.integers(0, 1000), st.integers(1, 4))
def test_noise_does_not_make_a_wall_two_cells_thick(seed, place):
    random = np.random.default_rng(seed)
    wall_m = 2.40 + 0.01 * place  # It reaches 7 to 4 cm into its cell; noise is 1.2 cm.
    views = [
        look_x(wall_m + random.normal(0, 0.012, (120, 160)), (0, 0.03 * n, 1.2)) for n in range(6)
    ]
    inner = fused(*views).log_odds[:, 4:-4, 4:-4]  # The picture's edge sees parts of cells.
    assert ((inner > 0).sum(axis=0) == 1).mean() > 0.97


def test_a_board_seen_from_both_sides_is_one_cell():
    front = look_x(np.full((120, 160), 2.01))
    back_pose = pose((4.0, 0, 1.2), (0, 1, 0), (0, 0, -1), (-1, 0, 0))
    depth_m = np.full((120, 160), 4.0 - 2.05, np.float32)
    back = DepthPredictor().lift(View("b", back_pose, None, None, depth_m, CAMERA))
    evidence = fused(front, back)
    assert occupied_layers(evidence) == {25}
    assert evidence.hits[evidence.log_odds > 0].min() > 0


def test_a_chair_leg_of_four_centimetres_stays():
    depth_m = np.full((120, 160), 3.0)
    across = np.abs((np.arange(160) + 0.5 - 80) / 140 * 1.5 - 0.04) < 0.02
    depth_m[:, across] = 1.5
    evidence = fused(*[look_x(depth_m) for _ in range(3)])
    low = np.round(evidence.origin_m / CELL_M).astype(int)
    leg = evidence.log_odds[int(1.5 / CELL_M) - low[0]]
    heights = (leg > 0).any(axis=0)
    assert heights[np.flatnonzero(heights).min() :].sum() >= 12


def test_spill_leaves_its_points_to_the_cell_that_is_solid():
    random = np.random.default_rng(5)
    colour = np.full((120, 160, 3), (10, 200, 30), np.uint8)
    camera_to_scan = pose((0, 0, 1.2), (0, -1, 0), (0, 0, -1), (1, 0, 0))
    depth_m = (2.0 + random.normal(0, 0.01, (120, 160))).astype(np.float32)
    shown = View("v", camera_to_scan, colour, CAMERA, depth_m, CAMERA)
    map_ = EvidenceMap(np.eye(4))
    map_.add(DepthPredictor().lift(shown))
    before = int(map_.blocks.hits.sum())
    evidence = map_.fused()
    solid = evidence.log_odds > 0
    assert int(evidence.hits.astype(int).sum()) >= 0.98 * before
    assert evidence.hits[~solid].sum() < 0.01 * before
    mean = evidence.colour_sum[solid] / evidence.hits[solid][:, None]
    assert np.allclose(mean, (10, 200, 30), atol=0.01)
    at = np.argwhere(solid & (evidence.hits > 20))
    assert len(at) > 100
    x = evidence.origin_m[0] + (at[:, 0] + 0.5) * CELL_M
    x += evidence.offset_sum[tuple(at.T)][:, 0] / evidence.hits[tuple(at.T)]
    assert abs(x.mean() - 2.0) < 0.001, "both halves of the noise are in the mean"
    assert np.abs(x - 2.0).max() < 0.012


@given(
    st.tuples(*[st.floats(-0.05, 0.05)] * 3),
    st.tuples(*[st.floats(-1, 1)] * 3).filter(lambda n: np.linalg.norm(n) > 0.1),
    st.integers(1, 64),
)
def test_the_depth_of_the_solid_equals_sorting_all_sub_cells(point, normal, least):
    normal = np.array(normal) / np.linalg.norm(normal)
    ticks = (np.arange(4) - 1.5) * 0.02
    sub_cells = np.stack(np.meshgrid(ticks, ticks, ticks, indexing="ij"), axis=-1).reshape(-1, 3)
    depths = np.sort((np.array(point) - sub_cells) @ normal)[::-1]
    found, whole = _depth_of_solid(np.array([*point, *normal]), CELL_M, least)
    assert abs(found - depths[least - 1]) < 1e-9
    assert abs(depths).min() < 1e-9 or whole == bool((depths > 0).all())
