"""Lifting is the inverse of projection, for any lens."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from world2minecraft.core.types import Camera
from world2minecraft.geometry.unprojection import pixel_rays, project, unproject_depth

LENSES = [(0, 0, 0, 0, 0), (0.1, -0.2, 0.001, -0.002, 0.05), (-0.25, 0.08, 0, 0, 0)]


@pytest.mark.parametrize("distortion", LENSES)
def test_rays_project_back_to_their_pixel_centres(distortion):
    camera = Camera(64, 48, 60.0, 61.0, 31.0, 25.0, distortion)
    rays = pixel_rays(camera).astype(np.float64)
    ahead = np.concatenate([rays, np.ones((48, 64, 1))], axis=2)
    v, u = np.mgrid[:48, :64]
    expected = np.stack([u + 0.5, v + 0.5], axis=2)
    assert np.abs(project(ahead, camera) - expected).max() < 0.02


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_lifted_points_have_their_depth_and_pixel(seed):
    random = np.random.default_rng(seed)
    camera = Camera(16, 12, 15.0, 14.0, 8.2, 5.9)
    depth_m = random.uniform(0.3, 5, (12, 16)).astype(np.float32)
    depth_m[random.random((12, 16)) < 0.3] = 0
    points_m, pixels = unproject_depth(depth_m, camera, np.eye(4))
    assert np.array_equal(pixels, np.flatnonzero(depth_m))
    assert np.allclose(points_m[:, 2], depth_m.reshape(-1)[pixels])
    at_px = project(points_m.astype(np.float64), camera)
    assert np.allclose(at_px, np.stack([pixels % 16 + 0.5, pixels // 16 + 0.5], 1), atol=1e-3)


def test_a_pose_carries_the_points():
    camera = Camera(8, 6, 7.0, 7.0, 4.0, 3.0)
    depth_m = np.full((6, 8), 2.0, np.float32)
    pose = np.array([[0, 0, 1, 5], [-1, 0, 0, 6], [0, -1, 0, 7], [0, 0, 0, 1]], np.float64)
    here, _ = unproject_depth(depth_m, camera, np.eye(4))
    there, _ = unproject_depth(depth_m, camera, pose)
    assert np.allclose(there, here @ pose[:3, :3].T + pose[:3, 3], atol=1e-5)


def test_an_image_of_holes_lifts_to_nothing():
    points_m, pixels = unproject_depth(
        np.zeros((6, 8), np.float32), Camera(8, 6, 7, 7, 4, 3), np.eye(4)
    )
    assert points_m.shape == (0, 3) and pixels.shape == (0,)
