"""Normals of planes whose truth is known."""

import numpy as np
import pytest

from world2minecraft.geometry.normals import normals_of_depth
from world2minecraft.types import Camera

CAMERA = Camera(160, 120, 130.0, 130.0, 80.0, 60.0)


def _plane_depth(normal, offset_m):
    v, u = np.mgrid[:120, :160]
    rays = np.stack([(u + 0.5 - 80) / 130, (v + 0.5 - 60) / 130, np.ones(u.shape)], axis=-1)
    return (offset_m / (rays @ normal)).astype(np.float32)


@pytest.mark.parametrize("normal", [(0, 0, 1), (0.3, 0, 0.95), (0.1, 0.6, 0.8), (-0.5, -0.2, 0.8)])
def test_a_plane_s_normal_looks_at_the_camera(normal):
    unit = np.array(normal) / np.linalg.norm(normal)
    found = normals_of_depth(_plane_depth(unit, 2.0), CAMERA)
    assert len(found.normals) > 200
    np.testing.assert_allclose(
        found.normals, np.broadcast_to(-unit, found.normals.shape), atol=5e-3
    )
    np.testing.assert_allclose(found.points_m @ unit, 2.0, atol=5e-3)


def test_the_areas_add_up_to_the_plane():
    found = normals_of_depth(np.full((120, 160), 2.0, np.float32), CAMERA, step_px=4, reach_px=4)
    seen = len(found.area_m2) * (4 * 2.0 / 130) ** 2
    assert found.area_m2.sum() == pytest.approx(seen, rel=1e-3)


def test_holes_jumps_and_far_depth_have_no_normals():
    depth = np.full((120, 160), 2.0, np.float32)
    depth[:, 80:] = 3.0
    found = normals_of_depth(depth, CAMERA)
    assert not ((found.points_m[:, 2] > 2.001) & (found.points_m[:, 2] < 2.999)).any()
    across = found.points_m[:, 0] / found.points_m[:, 2] * 130 + 80
    assert (np.abs(across - 80) > 5).all()
    assert len(normals_of_depth(np.zeros((120, 160), np.float32), CAMERA).points_m) == 0
    assert len(normals_of_depth(np.full((120, 160), 9.0, np.float32), CAMERA).points_m) == 0
