"""Triangles: against rays met one by one, against the exact box room, colours and pictures."""

import numpy as np
import pytest
from mesh_rooms import CAMERA, SMALL, rays_of, room_quads

from world2minecraft.capture.readers.meshes.frustum_culling import sort_mesh_into_blocks
from world2minecraft.capture.readers.meshes.mesh_and_cloud import Mesh
from world2minecraft.capture.readers.meshes.mesh_rasterizer import render_mesh
from world2minecraft.core.coordinates import invert_rigid, look_at


def met_one_by_one(mesh, camera, world_to_camera):
    """Each ray against each triangle, by Moeller and Trumbore's test; the slow reference."""
    corners = mesh.vertices.astype(float) @ world_to_camera[:3, :3].T + world_to_camera[:3, 3]
    a, b, c = (corners[mesh.faces[:, k]] for k in range(3))
    depth = np.zeros((camera.height_px, camera.width_px))
    face = np.full(depth.shape, -1)
    for (v, u), _ in np.ndenumerate(depth):
        ray = rays_of(camera)[v, u]
        one, other = b - a, c - a
        across = np.cross(ray, other)
        volume = np.einsum("fa,fa->f", one, across)
        with np.errstate(divide="ignore", invalid="ignore"):
            s = np.einsum("fa,fa->f", -a, across) / volume
            over = np.cross(-a, one)
            t = over @ ray / volume
            z = np.einsum("fa,fa->f", other, over) / volume
        hit = (s >= 0) & (t >= 0) & (s + t <= 1) & (z >= 0.01)
        if hit.any():
            face[v, u] = np.argmin(np.where(hit, z, np.inf))
            depth[v, u] = z[face[v, u]]
    return depth, face


@pytest.mark.parametrize("seed", range(3))
def test_random_triangles_match_ray_casting(seed):
    rng = np.random.default_rng(seed)
    vertices = rng.uniform(-3, 3, (60, 3)).astype(np.float32)  # Before, behind and around.
    mesh = Mesh(
        vertices,
        np.arange(60, dtype=np.int32).reshape(-1, 3),
        labels=np.arange(20, dtype=np.uint8),
    )
    world_to_camera = invert_rigid(look_at(rng.uniform(-1, 1, 3), rng.uniform(-1, 1, 3)))
    depth, _, labels = render_mesh(mesh, SMALL, world_to_camera)
    expected, face = met_one_by_one(mesh, SMALL, world_to_camera)
    np.testing.assert_allclose(depth, expected, rtol=1e-5, atol=1e-6)
    assert (labels == np.where(face < 0, 255, face)).all()


def test_a_room_is_seen_exactly_and_without_gaps(box_room):
    vertices, faces, colour, _ = room_quads().triangles()
    mesh, blocks = sort_mesh_into_blocks(
        Mesh(vertices.astype(np.float32), faces.astype(np.int32), colour)
    )
    for pose in box_room.poses(6):
        world_to_camera = invert_rigid(pose)
        depth, _, _ = render_mesh(mesh, CAMERA, world_to_camera)
        np.testing.assert_allclose(depth, box_room.render(pose)[0], atol=2e-5)
        runs = blocks.runs(CAMERA, world_to_camera)
        assert (render_mesh(mesh, CAMERA, world_to_camera, runs)[0] == depth).all()


def test_both_sides_are_seen():
    mesh = Mesh(np.float32([[-9, -9, 2], [9, -9, 2], [0, 9, 2]]), np.int32([[0, 1, 2]]))
    turned = Mesh(mesh.vertices, mesh.faces[:, ::-1])
    for own in (mesh, turned):
        assert render_mesh(own, SMALL, np.eye(4))[0][15, 20] == pytest.approx(2)


def test_vertex_colours_are_perspective_correct():
    vertices = np.float32([[-4, -4, 2], [4, -4, 2], [4, 4, 6], [-4, 4, 6]])
    colour = np.uint8([[0, 0, 0], [200, 0, 0], [200, 100, 0], [0, 100, 0]])
    mesh = Mesh(vertices, np.int32([[0, 1, 2], [0, 2, 3]]), colour)
    depth, seen, _ = render_mesh(mesh, SMALL, np.eye(4))
    place = rays_of(SMALL) * depth[..., None]
    held = depth > 0
    expected = np.stack([(place[..., 0] + 4) * 25, (place[..., 1] + 4) * 12.5], axis=-1)
    assert held.sum() > 300
    assert np.abs(seen[held][:, :2] - expected[held]).max() <= 1


def test_a_picture_lies_upright_and_repeats():
    picture = np.zeros((2, 2, 3), np.uint8)
    picture[0, 0], picture[0, 1], picture[1, 0], picture[1, 1] = 10, 20, 30, 40
    mesh = Mesh(
        np.float32([[-2, -2, 2], [2, -2, 2], [2, 2, 2], [-2, 2, 2]]),
        np.int32([[0, 1, 2], [0, 2, 3]]),
        uv=np.float32([[0, 0], [2, 0], [2, 1], [0, 1]]),
        face_image=np.int16([0, 0]),
        pixels=picture.reshape(-1, 3),
        image_sizes=np.array([[2, 2]]),
    )
    seen = render_mesh(mesh, SMALL, np.eye(4))[1][..., 0]
    assert seen[8, [2, 12, 22, 32]].tolist() == [10, 20, 10, 20]
    assert seen[22, [2, 12, 22, 32]].tolist() == [30, 40, 30, 40]


def test_what_has_no_colour_is_grey():
    mesh = Mesh(np.float32([[-9, -9, 2], [9, -9, 2], [0, 9, 2]]), np.int32([[0, 1, 2]]))
    assert render_mesh(mesh, SMALL, np.eye(4))[1][15, 20].tolist() == [178, 178, 178]
