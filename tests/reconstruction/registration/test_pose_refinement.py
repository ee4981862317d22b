"""Frames are moved back onto each other, depth is touched only where it must be."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from world2minecraft.core.coordinates import look_at
from world2minecraft.core.types import Camera, Corrections, Scan, View
from world2minecraft.geometry.oriented_points import OrientedPoints, collect_oriented_points
from world2minecraft.reconstruction.registration import (
    RegistrationParameters,
    apply_corrections,
    register,
    with_registration_note,
)
from world2minecraft.reconstruction.registration.pose_refinement import register_surface

CAMERA = Camera(160, 120, 130.0, 130.0, 80.0, 60.0)
SIZE_M = np.array([4.2, 3.1, 2.6])
BOX_M = np.array([[1.4, 1.2, 0.0], [2.2, 1.9, 0.72]])
FRAMES = 18


def depth_of(camera_to_room: np.ndarray) -> np.ndarray:
    """Return the exact z-depth, float32 [H, W], of a room with one box in it."""
    v, u = np.mgrid[: CAMERA.height_px, : CAMERA.width_px] + 0.5
    rays = np.stack([(u - CAMERA.cx_px) / CAMERA.fx_px, (v - CAMERA.cy_px) / CAMERA.fy_px], -1)
    rays = np.dstack([rays, np.ones(u.shape)]) @ camera_to_room[:3, :3].T
    eye = camera_to_room[:3, 3]
    with np.errstate(divide="ignore"):
        room = np.maximum((0 - eye) / rays, (SIZE_M - eye) / rays).min(axis=-1)
        ends = np.sort((BOX_M[:, None, None] - eye) / rays, axis=0)
    enter, leave = ends[0].max(axis=-1), ends[1].min(axis=-1)
    hits = (enter < leave) & (enter > 0)
    return np.where(hits, np.minimum(enter, room), room).astype(np.float32)


def true_poses() -> np.ndarray:
    """Return camera_to_room of a walk that looks at everything, float64 [F, 4, 4]."""
    poses = []
    for index in range(FRAMES):
        angle = 2 * np.pi * index / FRAMES
        away = np.array([np.cos(angle), np.sin(angle), 0.0])
        eye = np.array([*SIZE_M[:2] / 2, 1.5]) - 0.28 * SIZE_M * away
        poses.append(look_at(eye, eye + away + [0, 0, (-0.9, -0.3, 0.45)[index % 3]]))
    return np.array(poses)


@pytest.fixture(scope="module")
def true_surface() -> OrientedPoints:
    """The patches of the walk with a depth camera's noise, where they truly are."""
    rng = np.random.default_rng(0)
    views = []
    for index, pose in enumerate(true_poses()):
        depth = depth_of(pose)
        depth += (rng.standard_normal(depth.shape) * 0.002 * depth).astype(np.float32)
        views.append(View(f"{index:04d}", pose, depth_m=depth, depth_camera=CAMERA))
    return collect_oriented_points(views)


def disturbed(surface: OrientedPoints, shift_m=0.006, turn_deg=0.25, scale=0.0, seed=1):
    """Return the surface as stated poses and stretched depth show it, and the stretches."""
    rng = np.random.default_rng(seed)
    frames = len(surface.cameras)
    turn = Rotation.from_rotvec(np.radians(rng.standard_normal((frames, 3)) * turn_deg)).as_matrix()
    stretch = np.exp(rng.standard_normal(frames) * scale)
    cameras = surface.cameras.copy()
    cameras[:, :3, :3] = turn @ cameras[:, :3, :3]
    cameras[:, :3, 3] += rng.standard_normal((frames, 3)) * shift_m
    owner = surface.owner
    from_eye = (surface.points_m - surface.cameras[owner, :3, 3]) * stretch[owner, None]
    points = np.einsum("iab,ib->ia", turn[owner], from_eye) + cameras[owner, :3, 3]
    normals = np.einsum("iab,ib->ia", turn[owner], surface.normals)
    return replace(surface, points_m=points, normals=normals, cameras=cameras), stretch


def apart(cameras: np.ndarray, true: np.ndarray) -> tuple[float, float]:
    """Return the median error in metres and degrees, one common move taken away."""
    turns = Rotation.from_matrix((cameras @ np.linalg.inv(true))[:, :3, :3])
    common = turns.mean()
    moved = cameras[:, :3, 3] - common.apply(true[:, :3, 3])
    off = np.linalg.norm(moved - moved.mean(axis=0), axis=1)
    return float(np.median(off)), float(np.degrees(np.median((common.inv() * turns).magnitude())))


def refined(given: OrientedPoints, scan_to_room=None, **chosen):
    place = np.eye(4) if scan_to_room is None else scan_to_room
    return register_surface(given, place, RegistrationParameters(**chosen))


def test_jitter_of_poses_is_taken_away(true_surface):
    given, _ = disturbed(true_surface)
    found = refined(given).corrections
    before = apart(given.cameras, true_surface.cameras)
    after = apart(found.pose_change @ given.cameras, true_surface.cameras)
    assert after[0] < 0.35 * before[0]
    assert after[1] < 0.25 * before[1]
    assert found.facts["kept"]
    assert found.facts["misfit_after_mm"] < 0.5 * found.facts["misfit_before_mm"]


def test_depth_that_does_not_vary_is_left_alone(true_surface):
    found = refined(disturbed(true_surface)[0]).corrections
    assert (found.depth_scale == 1).all()
    assert not found.facts["depth_scaled"]


@pytest.mark.parametrize("sigma", [0.03, 0.05])
def test_depth_scales_that_vary_are_found(true_surface, sigma):
    given, stretch = disturbed(true_surface, scale=sigma)
    found = refined(given).corrections
    left = stretch * found.depth_scale
    assert left.std() < 0.1 * stretch.std()
    assert abs(left.mean() - 1) < 0.004
    assert found.facts["depth_scale_spread"] == pytest.approx(stretch.std(), rel=0.4)


def test_right_poses_stay_where_they_are(true_surface):
    found = refined(true_surface).corrections
    moved = found.pose_change @ true_surface.cameras
    assert np.abs(moved - true_surface.cameras).max() < 0.002


def test_the_room_does_not_shrink_nor_drift(true_surface):
    """A smaller room would have smaller residuals; that must not make it one."""
    given, _ = disturbed(true_surface, scale=0.04, seed=2)
    found = refined(given)
    size = np.ptp(np.quantile(found.surface.points_m, [0.02, 0.98], axis=0), axis=0)
    true = np.ptp(np.quantile(true_surface.points_m, [0.02, 0.98], axis=0), axis=0)
    np.testing.assert_allclose(size, true, rtol=0.006)
    move = found.corrections.pose_change @ given.cameras - given.cameras
    assert np.abs(move[:, :3, 3].mean(axis=0)).max() < 0.005


def test_the_frame_of_the_scan_does_not_matter(true_surface):
    given, _ = disturbed(true_surface)
    here = refined(given).corrections
    room_to_scan = np.eye(4)
    room_to_scan[:3, :3] = Rotation.from_euler("xyz", [20, 7, 110], degrees=True).as_matrix()
    room_to_scan[:3, 3] = [3, -8, 1]
    there = refined(given.transformed(room_to_scan), np.linalg.inv(room_to_scan)).corrections
    carried = np.linalg.inv(room_to_scan) @ there.pose_change @ room_to_scan
    np.testing.assert_allclose(carried, here.pose_change, atol=1e-4)


def test_the_same_bytes_again(true_surface):
    given, _ = disturbed(true_surface, scale=0.03)
    first, second = refined(given).corrections, refined(given).corrections
    assert first.pose_change.tobytes() == second.pose_change.tobytes()
    assert first.depth_scale.tobytes() == second.depth_scale.tobytes()
    assert first.facts == second.facts


def test_frames_that_share_nothing_stay(true_surface):
    """Two frames that look away from each other: nothing can be known, nothing is moved."""
    given, _ = disturbed(true_surface)
    lone = np.isin(given.owner, [1, 10])
    index = np.searchsorted([1, 10], given.owner[lone]).astype(np.int32)
    pair = replace(
        given.subset(lone), owner=index, cameras=given.cameras[[1, 10]], names=("a", "b")
    )
    found = refined(pair).corrections
    np.testing.assert_array_equal(found.pose_change, np.stack([np.eye(4)] * 2))
    assert not found.facts["kept"]


@pytest.mark.parametrize("frames", [0, 1])
def test_no_frame_or_one_is_no_trouble(true_surface, frames):
    few = replace(
        true_surface.subset(true_surface.owner < frames),
        cameras=true_surface.cameras[:frames], names=true_surface.names[:frames],
    )  # fmt: skip
    found = refined(few).corrections
    assert found.pose_change.shape == (frames, 4, 4)
    assert not found.facts["kept"]


def test_no_passes_change_nothing(true_surface):
    given, _ = disturbed(true_surface)
    found = refined(given, passes=0)
    np.testing.assert_array_equal(found.corrections.depth_scale, 1)
    np.testing.assert_allclose(
        found.corrections.pose_change, np.stack([np.eye(4)] * FRAMES), atol=1e-9
    )


class Views(list):
    """Views in memory."""


def scan_of(count: int = 6) -> Scan:
    views = Views(
        View(f"{i:04d}", pose, depth_m=depth_of(pose), depth_camera=CAMERA)
        for i, pose in enumerate(true_poses()[:count])
    )
    return Scan(views, np.eye(4), SIZE_M, tuple(view.name for view in views))


def test_a_corrected_scan_has_moved_poses_and_stretched_depth():
    scan = scan_of(2)
    change = np.eye(4)
    change[:3, 3] = [0.1, 0, 0]
    fixed = apply_corrections(scan, Corrections(("0001",), change[None], np.array([1.5])))
    first, second = list(fixed.views)
    raw = list(scan.views)
    assert len(fixed.views) == 2
    np.testing.assert_array_equal(first.camera_to_scan, raw[0].camera_to_scan)
    np.testing.assert_array_equal(second.camera_to_scan, change @ raw[1].camera_to_scan)
    np.testing.assert_array_equal(second.depth_m, np.float32(1.5) * np.asarray(raw[1].depth_m))


def test_the_surface_is_that_of_the_corrected_views():
    scan = scan_of(6)
    found = register(scan, RegistrationParameters())
    again = collect_oriented_points(apply_corrections(scan, found.corrections).views)
    np.testing.assert_allclose(again.cameras, found.surface.cameras, atol=1e-6)
    np.testing.assert_allclose(again.points_m, found.surface.points_m, atol=1e-4)


def test_progress_never_falls_and_ends():
    steps = []
    register(scan_of(3), progress=lambda stage, done, total, note="": steps.append((done, total)))
    assert [done for done, _ in steps] == sorted(done for done, _ in steps)
    assert steps[-1][0] == steps[-1][1]


def test_what_is_told():
    facts = {
        "kept": True, "moved_median_mm": 7.13, "turned_median_deg": 0.33, "depth_scaled": True,
        "depth_scale_spread": 0.0288, "misfit_before_mm": 18.7, "misfit_after_mm": 0.5,
    }  # fmt: skip
    assert with_registration_note(scan_of(1), facts).notes == (
        "camera poses were refined: moved by 7.1 mm and 0.33 degrees (median over all frames); "
        "depth scales with a spread of 2.9% were equalized; misfit of held-out surfaces reduced "
        "from 18.7 mm to 0.5 mm",
    )
    assert with_registration_note(scan_of(1), {"kept": False}).notes == ()


@pytest.mark.parametrize(
    ("wrong", "text"),
    [
        ({"passes": -1}, "passes must be 0 to 20"),
        ({"jitter_m": 0.0}, "jitter_m must be above 0"),
        ({"scale_sigma": 0.9}, "scale_sigma must be 0 to 0.5"),
    ],
)
def test_wrong_parameters_are_refused(wrong, text):
    with pytest.raises(ValueError, match=text):
        RegistrationParameters(**wrong)
