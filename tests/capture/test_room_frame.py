"""The room is found again however the capture's world is tilted, turned and moved."""

import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from world2minecraft.capture.alignment.axis_profiles import axis_profile
from world2minecraft.capture.alignment.gravity import find_ground, rotation_to_z
from world2minecraft.capture.alignment.room_frame import (
    ImplausibleRoomError,
    align,
    align_surface,
    realign,
)
from world2minecraft.core.coordinates import apply, invert_rigid, rotation_about_z
from world2minecraft.core.types import Scan
from world2minecraft.geometry.oriented_points import collect_oriented_points


@pytest.fixture(scope="module")
def surfaces(box_room):
    """The surfaces of the box room in its own frame, clean and as a depth camera sees it."""
    found = {
        noise: collect_oriented_points(box_room.views(14, noise_seed=noise)) for noise in (None, 1)
    }
    return found, np.array(box_room.size_m)


def _check(scan_to_room, room_to_scan, found_size, size, *, degrees, metres):
    """The true room must come out as the found one, up to a quarter turn."""
    true_to_found = scan_to_room @ room_to_scan
    assert np.degrees(np.arccos(min(1.0, true_to_found[2, 2]))) < degrees
    turn = np.degrees(np.arctan2(true_to_found[1, 0], true_to_found[0, 0]))
    assert abs((turn + 45) % 90 - 45) < degrees
    if round(turn / 90) % 2:
        size = size[[1, 0, 2]]
    np.testing.assert_allclose(found_size, size, atol=metres)
    corners = apply(true_to_found, np.array([[0, 0, 0], [4.2, 3.1, 0.0]]))
    np.testing.assert_allclose(corners.min(axis=0), [0, 0, 0], atol=metres)
    np.testing.assert_allclose(corners.max(axis=0), [*size[:2], 0], atol=metres)


@settings(max_examples=8, deadline=None, derandomize=True)
@given(st.integers(0, 10**6), st.sampled_from([None, 1]))
def test_any_tilt_and_turn_gives_the_same_room(surfaces, seed, noise):
    found, size = surfaces
    room_to_scan = np.eye(4)
    room_to_scan[:3, :3] = Rotation.random(random_state=seed).as_matrix()
    room_to_scan[:3, 3] = np.random.default_rng(seed).uniform(-20, 20, 3)
    aligned = align_surface(found[noise].transformed(room_to_scan))
    _check(aligned.scan_to_room, room_to_scan, aligned.room_size_m, size, degrees=0.3, metres=0.01)


def test_the_result_does_not_depend_on_the_capture_s_frame(surfaces):
    """The first camera chooses the quarter turn, so even that is the same."""
    surface = surfaces[0][None]
    plain = align_surface(surface)
    turn = rotation_about_z(117.0)
    turned = align_surface(surface.transformed(turn))
    np.testing.assert_allclose(turned.scan_to_room @ turn, plain.scan_to_room, atol=2e-3)
    look = plain.scan_to_room[:3, :3] @ surface.cameras[0, :3, 2]
    assert look[1] > abs(look[0]) - 1e-6


def test_alignment_is_rigid_and_repeats_exactly(box_room):
    first, second = (align(box_room.views(8, noise_seed=3)) for _ in range(2))
    assert first.scan_to_room.tobytes() == second.scan_to_room.tobytes()
    assert first.room_size_m.tobytes() == second.room_size_m.tobytes()
    product = first.scan_to_room @ invert_rigid(first.scan_to_room)
    np.testing.assert_allclose(product, np.eye(4), atol=1e-8)
    assert np.linalg.det(first.scan_to_room[:3, :3]) == pytest.approx(1)


def test_a_side_that_no_frame_saw_lies_behind_the_cameras(box_room):
    views = [view for view in box_room.views(12) if view.camera_to_scan[0, 2] > 0.3]
    aligned = align(views)
    side = "(west|east|south|north)"
    told = rf"no wall was seen at the {side}( and {side})* sides?; the room extends to the"
    assert any(re.match(told, note) for note in aligned.notes)
    eyes = np.array([(aligned.scan_to_room @ view.camera_to_scan)[:3, 3] for view in views])
    assert (eyes > 0).all()
    assert (eyes < aligned.room_size_m).all()


@pytest.mark.parametrize(("factor", "size"), [(12.0, r"50\.\d\d"), (0.25, r"0\.65")])
def test_a_room_of_an_impossible_size_is_refused_with_its_size(surfaces, factor, size):
    surface = surfaces[0][None]
    cameras = surface.cameras.copy()
    cameras[:, :3, 3] *= factor
    with pytest.raises(ImplausibleRoomError, match=f"would be .*{size}.* check the depth unit"):
        align_surface(replace(surface, points_m=surface.points_m * factor, cameras=cameras))


def test_depth_without_surface_is_refused(box_room):
    views = [replace(view, depth_m=np.zeros_like(view.depth_m)) for view in box_room.views(3)]
    with pytest.raises(ImplausibleRoomError, match="only 0 patches"):
        align(views)


def test_rotation_to_z_rotates_up_to_z():
    for up in Rotation.random(20, random_state=1).as_matrix()[:, 0]:
        frame = rotation_to_z(up)
        np.testing.assert_allclose(frame @ up, [0, 0, 1], atol=1e-12)
        np.testing.assert_allclose(frame @ frame.T, np.eye(3), atol=1e-12)
        assert np.linalg.det(frame) == pytest.approx(1)


def test_axis_profile_counts_each_patch_once():
    x, y = np.meshgrid(np.arange(0.05, 1.0, 0.1), np.arange(0.05, 2.0, 0.1))
    table = np.column_stack([x.ravel(), y.ravel(), np.full(x.size, 0.72)])
    once, thrice = axis_profile(table, 2), axis_profile(np.repeat(table, 3, axis=0), 2)
    assert once.area_at(0.72) == thrice.area_at(0.72) == pytest.approx(2.0)
    assert len(once.peaks(0.5)) == 1
    assert once.peaks(0.5)[0] == pytest.approx(0.72, abs=0.02)
    assert len(axis_profile(np.zeros((0, 3)), 2).peaks(0.1)) == 0


@pytest.mark.parametrize("off_deg", [0.0, 4.0])
def test_known_up_is_found_from_sideways_cameras(surfaces, off_deg):
    surface = surfaces[0][1]
    side = np.eye(4)
    side[:2, :2] = [[0, -1], [1, 0]]
    lying = replace(surface, cameras=surface.cameras @ side)
    hint = Rotation.from_euler("x", off_deg, degrees=True).apply([0, 0, 1.0])
    aligned = align_surface(lying, hint)
    size = surfaces[1]
    _check(aligned.scan_to_room, np.eye(4), aligned.room_size_m, size, degrees=0.3, metres=0.01)


def test_a_realigned_room_keeps_the_known_up(surfaces):
    """Cameras that lie on their side say another up, which must not win the second time."""
    surface = surfaces[0][1]
    side = np.eye(4)
    side[:2, :2] = [[0, -1], [1, 0]]
    lying = replace(surface, cameras=surface.cameras @ side)
    scan = Scan([], np.eye(4), np.array([4.2, 3.1, 2.6]), (), world_up=np.array([0, 0, 1.0]))
    assert realign(scan, lying).scan_to_room[2, 2] > 0.9999
    assert realign(replace(scan, world_up=None), lying).scan_to_room[2, 2] < 0.5


def test_up_stays_near_what_is_known(surfaces):
    """However much surface faces another way, the hint is left by 10 degrees at most."""
    for tilt_deg in (15.0, 40.0, 75.0):
        hint = Rotation.from_euler("x", tilt_deg, degrees=True).apply([0, 0, 1.0])
        ground = find_ground(surfaces[0][None], hint)
        assert np.degrees(np.arccos(min(1.0, ground.up @ hint))) <= 10


@pytest.mark.parametrize("top_m", [1.2, 0.8])
def test_a_room_without_its_upper_half_gets_a_lower_bound(surfaces, top_m):
    """Without a ceiling the capture ends there; that does not make the unit wrong."""
    surface = surfaces[0][1]
    low = surface.subset(surface.points_m[:, 2] < top_m)
    cameras = low.cameras.copy()
    cameras[:, 2, 3] = np.minimum(cameras[:, 2, 3], top_m)
    found = align_surface(replace(low, cameras=cameras))
    assert (
        f"no ceiling was seen; the room is at least {found.room_size_m[2]:.2f} m high"
        in found.notes
    )
    assert found.room_size_m[2] == pytest.approx(top_m + 0.1, abs=0.15)
    assert sorted(found.room_size_m[:2]) == pytest.approx(sorted(surfaces[1][:2]), abs=0.02)
