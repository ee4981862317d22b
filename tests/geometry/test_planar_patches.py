"""A flat patch is a plane's point and normal; what is not flat gives none."""

import numpy as np
import pytest

from world2minecraft.core.types import Camera, View
from world2minecraft.geometry.oriented_points import collect_oriented_points
from world2minecraft.geometry.planar_patches import extract_patches
from world2minecraft.geometry.unprojection import pixel_rays

CAMERA = Camera(320, 240, 260.0, 260.0, 160.0, 120.0)


def plane_depth(normal: np.ndarray, off_m: float, camera: Camera = CAMERA) -> np.ndarray:
    """Return the depth of the plane ``normal . p = off_m``."""
    rays = np.dstack([pixel_rays(camera), np.ones((camera.height_px, camera.width_px))])
    return (off_m / (rays @ normal)).astype(np.float32)


def unit(*vector: float) -> np.ndarray:
    return np.array(vector) / np.linalg.norm(vector)


@pytest.mark.parametrize("normal", [unit(0, 0, 1), unit(0.5, 0, 1), unit(-0.3, 0.8, 1)])
@pytest.mark.parametrize("distortion", [(0.0,) * 5, (0.1, -0.2, 0.001, 0.002, 0.0)])
def test_a_plane_gives_its_points_and_its_normal(normal, distortion):
    camera = Camera(320, 240, 260.0, 260.0, 160.0, 120.0, distortion)
    found = extract_patches(plane_depth(normal, 2.0, camera), camera)
    assert len(found.points_m) > 200
    np.testing.assert_allclose(found.points_m @ normal, 2.0, atol=1e-4)
    np.testing.assert_allclose(found.normals, np.tile(-normal, (len(found.normals), 1)), atol=2e-3)


def test_sigma_is_how_far_points_are_off():
    depth = plane_depth(unit(0.3, 0.2, 1), 2.0)
    noise = np.random.default_rng(0).standard_normal(depth.shape) * 0.003
    found = extract_patches((depth + noise).astype(np.float32), CAMERA)
    off = (found.points_m @ unit(0.3, 0.2, 1) - 2.0) / found.sigma_m
    assert 0.8 < off.std() < 1.25
    assert abs(off.mean()) < 0.3


def test_wide_patches_stand_on_planes_and_small_ones_at_a_fold():
    flat = extract_patches(np.full((240, 320), 2.0, np.float32), CAMERA)
    left, right = plane_depth(unit(0.7, 0, 1), 1.95), plane_depth(unit(-0.7, 0, 1), 2.0)
    fold = extract_patches(np.minimum(left, right), CAMERA)
    assert len(fold.points_m) > len(flat.points_m)


def test_thinning_keeps_some_of_all_parts_of_the_image():
    found = extract_patches(np.full((240, 320), 2.0, np.float32), CAMERA)
    few = found.subsample(100)
    assert len(few.points_m) == len(few.normals) == len(few.sigma_m) == 100
    np.testing.assert_allclose(
        np.ptp(few.points_m, axis=0), np.ptp(found.points_m, axis=0), atol=0.1
    )
    assert found.subsample(10**6) is found


def test_holes_and_steps_give_none():
    depth = np.zeros((240, 320), np.float32)
    assert len(extract_patches(depth, CAMERA).points_m) == 0
    depth[:] = np.where(np.arange(320) % 2, 1.0, 3.0)
    assert len(extract_patches(depth, CAMERA).points_m) == 0
    assert len(extract_patches(np.full((240, 320), 9.0, np.float32), CAMERA).points_m) == 0


def test_oriented_points_are_in_the_scan_frame_and_subsettable():
    pose = np.eye(4)
    pose[:3, 3] = [1, 2, 3]
    depth = np.full((240, 320), 2.0, np.float32)
    views = [
        View("a", np.eye(4), depth_m=depth, depth_camera=CAMERA),
        View("b", pose),
        View("c", pose, depth_m=depth, depth_camera=CAMERA),
    ]
    surface = collect_oriented_points(views)
    assert surface.names == ("a", "c")
    np.testing.assert_allclose(surface.points_m[surface.owner == 0, 2], 2.0, atol=1e-6)
    np.testing.assert_allclose(surface.points_m[surface.owner == 1, 2], 5.0, atol=1e-6)
    part = surface.subset(surface.owner == 1)
    assert len(part.points_m) == len(part.sigma_m) == (surface.owner == 1).sum()
    back = surface.transformed(pose).transformed(np.linalg.inv(pose))
    np.testing.assert_allclose(back.points_m, surface.points_m, atol=1e-12)
