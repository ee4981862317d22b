"""Pose and scale errors of poses that are off by a known way."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from world2minecraft.core.coordinates import look_at, rotation_about_z
from world2minecraft.evaluation.scoring.pose_errors import pose_error, scale_error

EYES = np.array([[1.0, 2, 1.5], [3, 1, 1.4], [2, 3, 1.6], [0.5, 0.5, 1.2]])
TRUE = [look_at(eye, np.array([2.0, 2.0, 1.0])) for eye in EYES]


@given(st.floats(-170, 170), st.floats(-2, 2), st.floats(-2, 2))
def test_a_common_motion_is_the_frames_error_and_not_the_poses(yaw_deg, x_m, z_m):
    common = rotation_about_z(yaw_deg)
    common[:3, 3] = [x_m, 0.3, z_m]
    error = pose_error([common @ pose for pose in TRUE], TRUE)
    assert error["apart_mm"] < 1e-6 and error["apart_deg"] < 1e-5
    assert error["mean_deg"] == pytest.approx(abs(yaw_deg), abs=1e-5)


def test_shifts_in_turn_to_either_side_stay_apart():
    given_poses = [pose.copy() for pose in TRUE]
    for pose, side in zip(given_poses, (1, -1, 1, -1), strict=True):
        pose[2, 3] += side * 0.01
    error = pose_error(given_poses, TRUE)
    assert error["mean_mm"] == pytest.approx(10) and error["apart_mm"] == pytest.approx(10)
    assert max(error["mean_deg"], error["apart_deg"]) < 1e-6


def test_depth_scales_are_told_in_per_cent():
    error = scale_error([1.03, 0.97])
    assert error["scale_rms_percent"] == pytest.approx(3)
    assert error["scale_mean_percent"] == pytest.approx(0)
