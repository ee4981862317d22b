"""Points: the exact box room found again in its noisy cloud, and a slow reference of mixing."""

import numpy as np
from mesh_rooms import CAMERA, SMALL, rays_of, room_quads

from world2minecraft.capture.readers.meshes.cloud_splatting import (
    BLEND_M,
    RIM_WEIGHT,
    Surfels,
    render_surfels,
)
from world2minecraft.capture.readers.meshes.frustum_culling import sort_surfels_into_blocks
from world2minecraft.capture.readers.meshes.mesh_and_cloud import PointCloud
from world2minecraft.capture.readers.meshes.surfels import estimate_surfels
from world2minecraft.core.coordinates import invert_rigid


def cloud_of(quads, **how):
    points, colour, labels = quads.points(**how)
    return PointCloud(points.astype(np.float32), colour, labels)


def test_a_noisy_cloud_renders_as_its_room(box_room, quads):
    surfels, blocks = sort_surfels_into_blocks(
        estimate_surfels(cloud_of(quads, apart_m=0.015, noise_m=0.005))
    )
    camera = CAMERA.resized(320, 240)
    for pose in box_room.poses(3):
        world_to_camera = invert_rigid(pose)
        runs = blocks.runs(camera, world_to_camera)
        depth, colour, labels = render_surfels(surfels, camera, world_to_camera, runs)
        expected = box_room.render(pose, camera)[0]
        seen = depth > 0
        off = np.abs(depth - expected)[seen]
        assert seen.mean() > 0.97
        assert np.median(off) < 0.004
        assert np.mean(off > 0.05) < 0.06  # Rims of things, two points wide.
        assert np.mean((depth - expected)[seen] > 0.05) < 0.001  # Nothing hidden shows.
        assert (labels[seen] != 255).all()
        whole = render_surfels(surfels, camera, world_to_camera)
        assert all((a == b).all() for a, b in zip(whole, (depth, colour, labels), strict=True))


def mixed_slowly(surfels, camera):
    """The definition of mixing, pixel by pixel, for discs that face the camera."""
    points = surfels.cloud.points.astype(float)
    radius = np.maximum(surfels.radius_m, 0.75 * points[:, 2] / camera.fx_px)
    depth = np.zeros((camera.height_px, camera.width_px))
    for (v, u), _ in np.ndenumerate(depth):
        place = rays_of(camera)[v, u] * points[:, 2:]
        share = ((place - points) ** 2).sum(axis=1) / radius**2
        hit = share <= 1
        if hit.any():
            near = points[hit, 2].min()
            hit &= points[:, 2] <= near + np.maximum(BLEND_M, surfels.radius_m)
            weight = (1 - share[hit]) ** 2 + 1e-3
            depth[v, u] = np.sum(weight * points[hit, 2]) / weight.sum()
    return depth


def test_blending_follows_its_definition():
    rng = np.random.default_rng(1)
    points = np.stack(
        [rng.uniform(-2, 2, 300), rng.uniform(-1.5, 1.5, 300), rng.uniform(2, 2.04, 300)], axis=1
    )
    cloud = PointCloud(points.astype(np.float32))
    surfels = Surfels(cloud, np.zeros((300, 3), np.float32), np.full(300, 0.3, np.float32))
    depth, expected = render_surfels(surfels, SMALL, np.eye(4))[0], mixed_slowly(surfels, SMALL)
    seen = depth > 0  # The rims of the outermost discs are left out.
    assert seen.sum() > 0.95 * (expected > 0).sum()
    np.testing.assert_allclose(depth[seen], expected[seen], rtol=1e-4)


def test_surfel_radius_follows_point_spacing(quads):
    fine = estimate_surfels(cloud_of(quads, apart_m=0.02)).radius_m
    coarse = estimate_surfels(cloud_of(quads, apart_m=0.04)).radius_m
    assert 0.02 < np.median(fine) < 0.04
    assert 0.04 < np.median(coarse) < 0.08


def test_a_wall_cut_by_a_cell_border_is_flattened():
    rng = np.random.default_rng(0)
    points = np.column_stack([rng.random((40_000, 2)), 0.004 * rng.standard_normal(40_000)])
    surfels = estimate_surfels(
        PointCloud(points.astype(np.float32))
    )  # z = 0 is the side of a cell.
    assert np.abs(surfels.cloud.points[:, 2]).std() < 0.002
    assert np.median(np.abs(surfels.normals[:, 2])) > 0.95


def test_rims_end_near_the_last_points():
    size_m = (6.0, 6.0, 3.0)
    board = ((2.0, 3.0, 0.5, 4.0, 3.02, 2.0), (90, 90, 90))
    cloud = cloud_of(room_quads(size_m, (board,)), apart_m=0.02)
    camera_to_world = np.array([[1.0, 0, 0, 3], [0, 0, 1, 1], [0, -1, 0, 1.2], [0, 0, 0, 1]])
    depth = render_surfels(estimate_surfels(cloud), CAMERA, invert_rigid(camera_to_world))[0]
    near = (depth > 0) & (depth < 2.3)
    place = rays_of(CAMERA)[near] * depth[near][:, None]
    board_only = near.copy()
    board_only[near] = np.abs(place[:, 2] - 2.0) < 0.05
    across = (rays_of(CAMERA)[board_only][:, 0] * depth[board_only]).min()
    assert -1.0 - 0.035 < across < -0.95
    assert RIM_WEIGHT > 0
