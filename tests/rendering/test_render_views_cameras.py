"""Cameras by FOV and intrinsics, and the game's poses in blocks and rooms."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.core.coordinates import apply, block_to_room, invert_rigid
from world2minecraft.core.errors import UsageError
from world2minecraft.rendering.views import GamePose, camera_of, game_pose_of, vertical_fov_deg_of

sizes = st.integers(1, 4000)
fovs = st.floats(1, 170)
places = st.floats(-1000, 1000, width=32)


@given(sizes, sizes, fovs)
def test_the_vertical_fov_is_from_edge_to_edge(width, height, fov):
    camera = camera_of(width, height, vertical_fov_deg=fov)
    upper = np.arctan(camera.cy_px / camera.fy_px)
    lower = np.arctan((height - camera.cy_px) / camera.fy_px)
    assert np.degrees(upper + lower) == pytest.approx(fov)
    assert vertical_fov_deg_of(camera) == pytest.approx(fov)
    assert camera.fx_px == camera.fy_px


@given(sizes, sizes, fovs)
def test_horizontal_fov_is_vertical_fov_rotated(width, height, fov):
    lying = camera_of(width, height, horizontal_fov_deg=fov)
    standing = camera_of(height, width, vertical_fov_deg=fov)
    assert lying.fx_px == standing.fy_px
    assert (lying.cx_px, lying.cy_px) == (standing.cy_px, standing.cx_px)


def test_intrinsics_come_as_four_numbers_or_as_a_matrix():
    four = camera_of(64, 48, intrinsics=(40, 41, 32.5, 24))
    assert four.matrix.tolist() == [[40, 0, 32.5], [0, 41, 24], [0, 0, 1]]
    assert camera_of(64, 48, intrinsics=four.matrix) == four


@pytest.mark.parametrize(
    ("given_", "text"),
    [
        ({}, "give exactly one of vertical_fov_deg, horizontal_fov_deg and intrinsics, "
             "got 0"),
        ({"vertical_fov_deg": 70, "horizontal_fov_deg": 90},
         "give exactly one of vertical_fov_deg, horizontal_fov_deg and intrinsics, "
         "got 2"),
        ({"vertical_fov_deg": 0},
         "the field of view must be above 0 and at most 170 degrees, got 0"),
        ({"horizontal_fov_deg": 171},
         "the field of view must be above 0 and at most 170 degrees, got 171"),
        ({"vertical_fov_deg": float("nan")},
         "the field of view must be above 0 and at most 170 degrees, got nan"),
        ({"intrinsics": [[40, 1, 32], [0, 40, 24], [0, 0, 1]]},
         "invalid camera: the intrinsics matrix must be [[fx, 0, cx], [0, fy, cy], [0, 0, 1]]"),
        ({"intrinsics": [1, 2]},
         "invalid camera: intrinsics must be fx, fy, cx, cy or a 3x3 matrix, got shape [2]"),
    ],
)  # fmt: skip
def test_what_is_no_camera_is_told(given_, text):
    with pytest.raises(UsageError) as told:
        camera_of(64, 48, **given_)
    assert str(told.value) == text


@given(places, places, places, st.floats(-720, 720), st.floats(-90, 90))
def test_a_pose_in_the_room_comes_back(x, y, z, yaw, pitch):
    to_room = block_to_room(np.array([1.0, 3.0]), 4.0)
    pose = GamePose(x, y, z, yaw, pitch, "eye")
    back = game_pose_of(pose.camera_to_room(to_room), to_room)
    assert (back.x, back.y, back.z) == pytest.approx((x, y, z), abs=1e-6)
    assert (back.yaw_deg - yaw + 180) % 360 - 180 == pytest.approx(0, abs=1e-6)
    assert back.pitch_deg == pytest.approx(pitch, abs=1e-6)
    assert back.at == "eye"


def test_the_eye_is_over_the_feet_by_the_players_size():
    feet = GamePose(1, 64, 2, 0, 0)
    assert feet.camera_to_block()[:3, 3].tolist() == [1, 65.62, 2]
    assert feet.camera_to_block(6.48)[:3, 3].tolist() == [1, 70.48, 2]
    assert GamePose(1, 64, 2, 0, 0, "eye").camera_to_block(6.48)[:3, 3].tolist() == [1, 64, 2]


def test_who_looks_to_the_south_sees_the_west_on_the_right():
    to_room = block_to_room(np.array([0.0, 0.0]), 2.0)
    pose = GamePose(0, 64, 0, 0, 0, "eye").camera_to_room(to_room)
    ahead_and_west = apply(to_room, np.array([-1.0, 64.0, 4.0]))
    seen = apply(invert_rigid(pose), ahead_and_west)
    np.testing.assert_allclose(seen, [0.5, 0, 2.0], atol=1e-9)


@pytest.mark.parametrize(
    ("words", "text"),
    [
        ((0, 0, 0, 0, 91), "pitch must be -90 (up) to 90 (down) degrees, got 91"),
        ((0, 0, 0, 0, 0, "head"), "at must be 'feet' or 'eye', got 'head'"),
        ((4e7, 0, 0, 0, 0),
         "a pose must be five finite numbers x, y, z, yaw, pitch within the world, "
         "got (40000000.0, 0, 0, 0, 0)"),
        ((0, float("nan"), 0, 0, 0),
         "a pose must be five finite numbers x, y, z, yaw, pitch within the world, "
         "got (0, nan, 0, 0, 0)"),
    ],
)  # fmt: skip
def test_what_is_no_pose_is_told(words, text):
    with pytest.raises(UsageError) as told:
        GamePose(*words)
    assert str(told.value) == text
