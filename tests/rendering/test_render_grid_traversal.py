"""The core: distances, bundles of rays, and the fast caster against the slow one."""

import numpy as np
import pytest
from scenes import CAMERA, random_pose, random_volume, slow_picture
from scipy import ndimage

from world2minecraft.core.coordinates import look_at
from world2minecraft.rendering import render_volume
from world2minecraft.rendering.grid_traversal import fill_distances, safe_start, trace_ray
from world2minecraft.rendering.scene_tables import NO_FACE


def test_distances_are_those_of_the_chessboard():
    rng = np.random.default_rng(0)
    filled = rng.random((14, 9, 11)) < 0.02
    cells = np.where(filled, 0, 1).astype(np.uint8)
    fill_distances(cells)
    expected = ndimage.distance_transform_cdt(~filled, "chessboard")
    assert np.array_equal(cells[~filled], expected[~filled])
    assert (cells[filled] == 0).all()


def test_distances_stop_at_what_a_byte_holds():
    cells = np.full((300, 1, 1), 1, np.uint8)
    cells[0] = 0
    fill_distances(cells)
    assert cells.max() == 255
    assert cells[10, 0, 0] == 10


def test_ids_and_depth_agree_with_the_slow_reference():
    rng = np.random.default_rng(1)
    equal = total = 0
    errors = []
    for _ in range(12):
        volume = random_volume(rng)
        pose = random_pose(rng, volume)
        picture = render_volume(volume, CAMERA, pose)
        depth, index = slow_picture(volume, CAMERA, pose)
        same = picture.block_index == index
        equal, total = equal + same.sum(), total + same.size
        errors.append(np.abs(picture.depth_m - depth)[same & (index >= 0)])
    assert equal / total >= 0.9999
    assert np.median(np.concatenate(errors)) < 1e-4
    assert np.concatenate(errors).max() < 1e-3


def test_a_camera_outside_agrees_with_the_slow_reference():
    rng = np.random.default_rng(2)
    volume = random_volume(rng)
    pose = look_at(np.array([-3.0, 4.5, 3.0]), np.array([1.0, 1.0, 0.5]))
    picture = render_volume(volume, CAMERA, pose)
    depth, index = slow_picture(volume, CAMERA, pose)
    same = picture.block_index == index
    assert same.mean() >= 0.9995
    assert np.abs(picture.depth_m - depth)[same].max() < 1e-3
    assert (index >= 0).sum() > 150


def test_no_ray_of_a_bundle_meets_anything_before_its_start():
    rng = np.random.default_rng(3)
    filled = rng.random((30, 30, 30)) < 0.004
    cells = np.where(filled, 0, 1).astype(np.uint8)
    fill_distances(cells)
    moved = 0
    for _ in range(200):
        origin, middle = rng.uniform(2, 28, 3), rng.normal(size=3)
        start = safe_start(cells, *origin, *middle, 0.0, 0.05)
        moved += start > 0
        ray = middle + rng.uniform(-0.05, 0.05, 3)
        t, *_, face = trace_ray(cells, *origin, *ray, 0.0)
        assert face == NO_FACE or t >= start
    assert moved > 150


@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("sign", [1, -1])
def test_rays_along_an_axis_hit_squarely(axis, sign):
    cells = np.full((7, 7, 7), 1, np.uint8)
    cells[0], cells[6], cells[:, 0], cells[:, 6], cells[:, :, 0], cells[:, :, 6] = (0,) * 6
    fill_distances(cells)
    direction = np.zeros(3)
    direction[axis] = sign
    t, *cell, face = trace_ray(cells, 3.5, 3.5, 3.5, *direction, 0.0)
    assert t == pytest.approx(2.5)
    assert cell[axis] == (6 if sign > 0 else 0)
    assert face == 2 * axis + (0 if sign > 0 else 1)  # The face that looks back at the ray.
