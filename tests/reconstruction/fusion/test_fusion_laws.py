"""What fusion must keep: unknown apart from free, surfaces from noise, mass, growth."""

import numpy as np
import pytest

from world2minecraft.core.errors import CaptureError
from world2minecraft.core.types import Camera, GridEvidence, OccupancyGrid, PointEvidence, View
from world2minecraft.reconstruction.fusion import (
    CleaningParameters,
    EvidenceMap,
    FusionParameters,
    close_structure,
    extract_grid,
    remove_floaters,
)
from world2minecraft.reconstruction.occupancy.depth_evidence import DepthPredictor

CAMERA = Camera(80, 60, 70.0, 70.0, 40.0, 30.0)


def looking_at_wall(distance_m: float, name: str = "v") -> PointEvidence:
    """A camera at (0, 0, 1.2) that looks along +x at a wall."""
    pose = np.array([[0, 0, 1, 0], [-1, 0, 0, 0], [0, -1, 0, 1.2], [0, 0, 0, 1]], np.float64)
    depth_m = np.full((60, 80), distance_m, np.float32)
    colour = np.full((60, 80, 3), (200, 30, 20), np.uint8)
    shown = View(name, pose, colour, CAMERA, depth_m, CAMERA)
    return DepthPredictor().lift(shown)


def fused(*views, **changes):
    map_ = EvidenceMap(np.eye(4), FusionParameters(**changes))
    for item in views:
        map_.add(item)
    return map_.fused()


def cell(grid, point_m):
    return tuple(np.floor((np.array(point_m) - grid.origin_m) / grid.voxel_m).astype(int))


def test_free_before_occupied_at_unknown_behind_a_wall():
    grid = extract_grid(fused(looking_at_wall(2.0)))
    assert grid.labels[cell(grid, (1.0, 0, 1.2))] == 0
    assert grid.labels[cell(grid, (2.02, 0, 1.2))] == 11
    assert grid.labels.shape[0] * grid.voxel_m + grid.origin_m[0] < 2.2, "nothing lies behind"
    beside = cell(grid, (0.5, 0.6, 1.2))
    assert grid.labels[beside] == 255 and grid.source[beside] == 0


def test_a_noise_free_wall_on_a_cell_edge_is_one_layer():
    grid = extract_grid(fused(looking_at_wall(2.0)))
    assert set(np.argwhere(grid.occupied)[:, 0]) == {cell(grid, (2.02, 0, 1.2))[0]}


def test_offsets_tell_the_surface_finer_than_a_cell():
    for distance_m in (1.97, 2.0, 2.03):
        evidence = fused(looking_at_wall(distance_m))
        at = np.argwhere(evidence.hits > 5)
        middle = evidence.origin_m[0] + (at[:, 0] + 0.5) * 0.08
        mean = middle + evidence.offset_sum[tuple(at.T)][:, 0] / evidence.hits[tuple(at.T)]
        assert np.abs(mean - distance_m).max() < 1e-3


def test_a_ghost_seen_once_is_carved_away_by_later_views():
    ghost = looking_at_wall(1.0)
    later = [looking_at_wall(2.0, f"v{n}") for n in range(8)]
    grid = extract_grid(fused(ghost, *later))
    assert grid.labels[cell(grid, (1.02, 0, 1.2))] == 0
    assert grid.labels[cell(grid, (2.02, 0, 1.2))] == 11


def test_colour_is_the_mean_and_confidence_grows_with_views():
    once, often = extract_grid(fused(looking_at_wall(2.0))), None
    often = extract_grid(fused(*[looking_at_wall(2.0, f"v{n}") for n in range(5)]))
    at = cell(once, (2.02, 0, 1.2))
    assert tuple(once.colour[at]) == (200, 30, 20)
    assert often.confidence[cell(often, (2.02, 0, 1.2))] > once.confidence[at] > 0.6


def test_growing_the_map_changes_nothing():
    near, far = looking_at_wall(1.0), looking_at_wall(5.5)
    grown = fused(near, far)
    fresh = EvidenceMap(np.eye(4))
    fresh.blocks.reserve_box(np.array([-100, -100, -100]), np.array([100, 100, 100]), 0.08)
    fresh.add(near)
    fresh.add(far)
    whole = fresh.fused()
    for name in ("log_odds", "hits", "colour_sum", "offset_sum", "origin_m"):
        assert np.array_equal(getattr(grown, name), getattr(whole, name)), name


def test_a_frame_far_off_is_told_before_memory_runs_out():
    map_ = EvidenceMap(np.eye(4), FusionParameters())
    for away_m in (0.0, 120.0):
        points = np.array([[2.0, y / 50, 1.0] for y in range(20)], np.float32) + away_m
        weight = np.full(20, 1e-3, np.float32)
        map_.add(PointEvidence("v", np.full(3, away_m), points.astype(np.float32), weight))
    with pytest.raises(CaptureError, match=r"spans 12\d x 12\d x 12\d m but .* wrong pose"):
        map_.fused()


def test_a_capture_that_spans_a_town_is_refused():
    far = looking_at_wall(2.0)
    moved = PointEvidence(
        far.view, far.camera_m, far.points_m * np.float32(500), far.weight, far.colour
    )
    with pytest.raises(CaptureError, match="larger cells"):
        fused(moved)


def test_no_evidence_is_an_error_that_says_so():
    with pytest.raises(CaptureError, match="no view contains usable depth"):
        EvidenceMap(np.eye(4)).fused()


def test_grid_evidence_of_a_network_joins_that_of_depth():
    probabilities = np.zeros((4, 4, 4, 12), np.float16)
    probabilities[..., 0] = 0.9
    probabilities[..., 5] = 0.1
    probabilities[1, 2, 3] = 0
    probabilities[1, 2, 3, 8] = 1
    pose = np.eye(4)
    pose[:3, 3] = [0.8, 0.16, 0.4]
    seen = np.ones((4, 4, 4), bool)
    seen[0, 0, 0] = False
    grid = extract_grid(fused(GridEvidence("n", probabilities, seen, 0.08, pose)))
    table = cell(grid, (0.8 + 0.12, 0.16 + 0.2, 0.4 + 0.28))
    assert grid.labels[table] == 8
    assert (grid.labels == 0).sum() == 62 and (grid.labels == 8).sum() == 1


def solid_grid(labels: np.ndarray) -> OccupancyGrid:
    return OccupancyGrid(
        labels=labels,
        confidence=(labels != 255).astype(np.float16),
        colour=np.full((*labels.shape, 3), 90, np.uint8),
        source=(labels != 255).astype(np.uint8),
        instance=np.zeros(labels.shape, np.uint16),
        voxel_m=0.08,
        origin_m=np.zeros(3),
    )


def test_floaters_go_and_thin_legs_stay():
    labels = np.zeros((20, 20, 20), np.uint8)
    labels[:, :, 0] = 2
    labels[5, 5, 1:10] = 8
    labels[15, 15, 12:14] = 11
    cleaned = remove_floaters(solid_grid(labels), CleaningParameters())
    assert (cleaned.labels[5, 5, 1:10] == 8).all()
    assert (cleaned.labels[15, 15, 12:14] == 0).all()


def test_floor_holes_are_closed_and_marked_free_stays_free():
    labels = np.zeros((30, 30, 10), np.uint8)
    labels[:, :, 0] = 2
    labels[10:14, 10:14, 0] = 255
    labels[20:23, 20:23, 0] = 0
    closed = close_structure(solid_grid(labels), CleaningParameters())
    assert (closed.labels[10:14, 10:14, 0] == 2).all()
    assert (closed.source[10:14, 10:14, 0] == 2).all()
    assert (closed.labels[20:23, 20:23, 0] == 0).all()
    assert (closed.colour[10:14, 10:14, 0] == 90).all()


def test_a_hole_as_wide_as_a_door_stays():
    labels = np.zeros((4, 60, 30), np.uint8)
    labels[0] = 3
    labels[0, 20:32, :25] = 255
    closed = close_structure(solid_grid(labels), CleaningParameters())
    assert (closed.labels[0, 22:30, 2:20] == 255).all()
