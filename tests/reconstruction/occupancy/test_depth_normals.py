"""Normals of depth: planes at any tilt, edges, holes, and the frame they are told in."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from world2minecraft.core.types import Camera
from world2minecraft.geometry.unprojection import pixel_rays, unproject_depth
from world2minecraft.reconstruction.occupancy.depth_evidence import facing_of_depth

CAMERA = Camera(320, 240, 262.0, 262.0, 160.0, 120.0)
ALL = np.arange(320 * 240, dtype=np.int32)


def plane_depth(normal: np.ndarray, distance_m: float) -> np.ndarray:
    """The z-depth of the plane normal . p = -distance."""
    rays = np.dstack([pixel_rays(CAMERA), np.ones((240, 320), np.float32)])
    return (-distance_m / (rays @ normal)).astype(np.float32)


@settings(max_examples=20)
@given(st.floats(-50, 50), st.floats(0, 360))
def test_a_plane_has_its_normal_everywhere(tilt_deg, turn_deg):
    tilt, turn = np.radians([tilt_deg, turn_deg])
    normal = -np.array([np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.cos(tilt)])
    depth_m = plane_depth(normal, 2.0)
    depth_m[(depth_m < 0.3) | (depth_m > 6)] = 0
    found = facing_of_depth(depth_m, CAMERA, np.eye(4), ALL).reshape(240, 320, 3)
    known = np.abs(found).sum(axis=2) > 0
    assert known[60:180, 80:240].mean() > 0.8
    assert (found[known] @ normal > np.cos(np.radians(2))).all()


def test_normals_look_at_the_camera_and_are_told_in_its_frame():
    turn = np.array([[0, 0, 1, 5], [-1, 0, 0, 6], [0, -1, 0, 7], [0, 0, 0, 1]], np.float64)
    depth_m = np.full((240, 320), 2, np.float32)
    points_m, pixels = unproject_depth(depth_m, CAMERA, turn)
    found = facing_of_depth(depth_m, CAMERA, turn, pixels)
    assert len(found) == len(points_m)
    assert np.allclose(found, [-1, 0, 0], atol=1e-5)


def test_a_jump_and_a_hole_do_not_bend_what_lies_beside_them():
    depth_m = np.full((240, 320), 3, np.float32)
    depth_m[:, :160] = 1.5
    depth_m[100:120, 200:220] = 0
    found = facing_of_depth(depth_m, CAMERA, np.eye(4), ALL)
    known = np.abs(found).sum(axis=1) > 0
    assert known.mean() > 0.95
    assert np.allclose(found[known], [0, 0, -1], atol=1e-4)
