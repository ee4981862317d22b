"""Normals of depth: planes at any tilt, edges, holes, and the frame they are told in."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from world2minecraft.core.types import Camera
from world2minecraft.geometry.unprojection import pixel_rays, unproject_depth
from world2minecraft.reconstruction.occupancy.depth_evidence import (
    JUMP_SHARE,
    REACH,
    lift_depth,
)

CAMERA = Camera(320, 240, 262.0, 262.0, 160.0, 120.0)


def normals_of(depth_m: np.ndarray, pose: np.ndarray) -> np.ndarray:
    """The normal of each pixel, (0, 0, 0) also where there is no depth."""
    lifted = lift_depth(depth_m, CAMERA, pose, 10.0)
    normals = np.zeros((depth_m.size, 3), np.float32)
    normals[lifted.pixels] = lifted.normals
    return normals


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
    found = normals_of(depth_m, np.eye(4)).reshape(240, 320, 3)
    known = np.abs(found).sum(axis=2) > 0
    assert known[60:180, 80:240].mean() > 0.8
    assert (found[known] @ normal > np.cos(np.radians(2))).all()


def test_normals_look_at_the_camera_and_are_told_in_its_frame():
    turn = np.array([[0, 0, 1, 5], [-1, 0, 0, 6], [0, -1, 0, 7], [0, 0, 0, 1]], np.float64)
    depth_m = np.full((240, 320), 2, np.float32)
    points_m, pixels = unproject_depth(depth_m, CAMERA, turn)
    lifted = lift_depth(depth_m, CAMERA, turn, 10.0)
    assert np.array_equal(lifted.points_m, points_m) and np.array_equal(lifted.pixels, pixels)
    assert np.allclose(lifted.normals, [-1, 0, 0], atol=1e-5)


def test_a_jump_and_a_hole_do_not_bend_what_lies_beside_them():
    depth_m = np.full((240, 320), 3, np.float32)
    depth_m[:, :160] = 1.5
    depth_m[100:120, 200:220] = 0
    found = normals_of(depth_m, np.eye(4))
    known = np.abs(found).sum(axis=1) > 0
    assert known.mean() > 0.95
    assert np.allclose(found[known], [0, 0, -1], atol=1e-4)


def slow_means(depth_m, rays, side):
    """The mean point of each square of pixels that shows one surface, NaN elsewhere."""
    high, wide = -(-depth_m.shape[0] // side), -(-depth_m.shape[1] // side)
    means = np.full((high, wide, 3), np.nan)
    for i in range(high):
        for j in range(wide):
            box = slice(i * side, (i + 1) * side), slice(j * side, (j + 1) * side)
            z = depth_m[box].astype(float)
            is_known = z > 0
            if 2 * is_known.sum() < side * side:
                continue
            z_known = z[is_known]
            if z_known.max() - z_known.min() < 2.5 * JUMP_SHARE * z_known.min():
                points = np.dstack([rays[box] * z[..., None], z])
                means[i, j] = points[is_known].mean(axis=0)
    return means


def slow_ends(means, i, j, axis):
    """The squares at both ends of the surface around a square, along an axis of the image."""
    ends = []
    for step in (-1, 1):
        at = np.array([i, j])
        for _ in range(REACH):
            there = at.copy()
            there[axis] += step
            if (there < 0).any() or (there >= means.shape[:2]).any():
                break
            z, other = means[tuple(at)][2], means[tuple(there)][2]
            if not abs(other - z) <= JUMP_SHARE * z:
                break
            at = there
        ends.append(at)
    return ends


def slow_normal(means, i, j):
    """The normal of a square towards the camera, or None."""
    sides = []
    for axis in range(2):
        first, last = slow_ends(means, i, j, axis)
        if (first == last).all():
            return None
        sides.append(means[tuple(last)] - means[tuple(first)])
    normal = np.cross(*sides)
    length = np.linalg.norm(normal)
    if length < 1e-12:
        return None
    return -np.sign(normal @ means[i, j]) * normal / length


@settings(max_examples=10, deadline=None)
@given(st.integers(0, 10_000), st.sampled_from([(12, 10), (325, 9)]))
def test_lifted_points_follow_the_slow_reading(seed, size):
    """Stepped, noisy depth with holes; squares of 1 and of 2 pixels, cut off at the border."""
    random = np.random.default_rng(seed)
    wide, high = size
    camera = Camera(wide, high, 30.0, 31.0, wide / 2.2, high / 1.8)
    depth_m = 2 + 0.01 * random.normal(size=(high, wide)) + 0.3 * (np.arange(wide) > wide // 2)
    depth_m[random.random(depth_m.shape) < 0.1] = 0
    depth_m[random.random(depth_m.shape) < 0.1] = 7
    depth_m = depth_m.astype(np.float32)
    turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = turn, random.normal(size=3)
    lifted = lift_depth(depth_m, camera, pose, 6.0)
    near_m = np.where(depth_m <= 6, depth_m, 0)
    rays = pixel_rays(camera)
    np.testing.assert_array_equal(lifted.pixels, np.flatnonzero(near_m))
    z = near_m.reshape(-1)[lifted.pixels].astype(float)
    ahead = np.concatenate([rays.reshape(-1, 2)[lifted.pixels] * z[:, None], z[:, None]], axis=1)
    np.testing.assert_allclose(lifted.points_m, ahead @ turn.T + pose[:3, 3], atol=1e-5)
    np.testing.assert_allclose(lifted.weight, z * z / (30 * 31), rtol=1e-5)
    side = max(1, round(wide / 160))
    means = slow_means(near_m, rays, side)
    expected = np.zeros((len(z), 3))
    for n, pixel in enumerate(lifted.pixels):
        i, j = pixel // wide // side, pixel % wide // side
        normal = slow_normal(means, i, j) if np.isfinite(means[i, j, 2]) else None
        expected[n] = 0 if normal is None else turn @ normal
    assert expected.any()
    np.testing.assert_allclose(lifted.normals, expected, atol=2e-4)
