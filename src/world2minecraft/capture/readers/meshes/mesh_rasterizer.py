"""Rasterizer of triangle meshes: the face, depth and colour at each pixel of a pinhole camera.

The ray of each pixel is intersected with each triangle by the inverse of the 3x3 matrix of the
triangle's corners (Olano and Greer, "Triangle scan conversion using 2D homogeneous coordinates",
1997). Triangles therefore need no clipping, corners may be behind the camera, and adjacent
triangles have no gaps between them. Triangles are visible from both sides.
"""

from typing import NamedTuple

import numpy as np

from world2minecraft.capture.readers.meshes.mesh_and_cloud import Mesh
from world2minecraft.core.jit import njit
from world2minecraft.core.types import Camera

NEAR_M = 0.01
NO_FACE = -1
GREY = 178  # Grey value of surfaces without colour.


class Pinhole(NamedTuple):
    """The focal lengths and principal point of a camera in pixels, as used by the kernels."""

    fx: float
    fy: float
    cx: float
    cy: float


class FaceColours(NamedTuple):
    """The colours of a mesh. Arrays are empty if the mesh lacks that kind of colour.

    Attributes:
        vertex: Vertex colours, uint8 [V, 3].
        uv: Texture coordinates of the vertices, float32 [V, 2].
        image: Texture index of each face, int16 [F].
    """

    vertex: np.ndarray
    uv: np.ndarray
    image: np.ndarray


class Textures(NamedTuple):
    """The textures of a mesh in one array of pixels.

    Attributes:
        pixels: Pixels of all textures, uint8 [T, 3].
        starts: Index of the first pixel of each texture.
        sizes: Width and height of each texture.
    """

    pixels: np.ndarray
    starts: np.ndarray
    sizes: np.ndarray


def render_mesh(
    mesh: Mesh, camera: Camera, world_to_camera: np.ndarray, runs: np.ndarray | None = None
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Render depth, colour and labels of a mesh for one camera pose.

    Args:
        mesh: The mesh, in metres of the world frame.
        camera: Camera intrinsics without distortion.
        world_to_camera: Rigid transform, float64 [4, 4].
        runs: Ranges of triangles to render, int64 [R, 2] with exclusive ends; None for all
            triangles.

    Returns:
        The z-depth in metres as float32 [H, W] (0 for empty pixels), the colour as uint8 [H, W, 3]
        (black for empty pixels) and the class ids as uint8 [H, W] (255 if unknown).
    """
    depth, face = _draw_mesh(mesh, camera, world_to_camera, runs)
    colour = np.zeros((*depth.shape, 3), np.uint8)
    pose = np.ascontiguousarray(world_to_camera, np.float64)
    colours, textures = _mesh_colours(mesh)
    _shade(mesh.vertices, mesh.faces, pose, pinhole_of(camera), face, colours, textures, colour)
    labels = np.full(depth.shape, 255, np.uint8)
    if mesh.labels is not None:
        labels[face != NO_FACE] = mesh.labels[face[face != NO_FACE]]
    return depth, colour, labels


def render_face_ids(mesh: Mesh, camera: Camera, world_to_camera: np.ndarray) -> np.ndarray:
    """Return the index of the face visible at each pixel as int32 [H, W], or -1 for no face."""
    return _draw_mesh(mesh, camera, world_to_camera, None)[1]


def pinhole_of(camera: Camera) -> Pinhole:
    """Return the focal lengths and principal point of a camera without distortion."""
    return Pinhole(camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px)


def _draw_mesh(
    mesh: Mesh, camera: Camera, world_to_camera: np.ndarray, runs: np.ndarray | None
) -> tuple[np.ndarray, np.ndarray]:
    depth = np.full((camera.height_px, camera.width_px), np.inf, np.float32)
    face = np.full(depth.shape, NO_FACE, np.int32)
    pose = np.ascontiguousarray(world_to_camera, np.float64)
    runs = np.array([[0, len(mesh.faces)]], np.int64) if runs is None else runs
    _draw(mesh.vertices, mesh.faces, pose, pinhole_of(camera), runs, depth, face)
    depth[face == NO_FACE] = 0
    return depth, face


def _mesh_colours(mesh: Mesh) -> tuple[FaceColours, Textures]:
    """Return the colours and textures of a mesh in the form that the kernels require."""
    colour = np.zeros((0, 3), np.uint8) if mesh.colour is None else mesh.colour
    uv = np.zeros((0, 2), np.float32) if mesh.uv is None else mesh.uv
    image = np.zeros(0, np.int16) if mesh.face_image is None else mesh.face_image
    starts = np.concatenate([[0], np.cumsum(mesh.image_sizes.prod(axis=1))]).astype(np.int64)
    return FaceColours(colour, uv, image), Textures(mesh.pixels, starts, mesh.image_sizes)


@njit
def _transform_corners(vertices, face, pose, triangle):
    """Transform a triangle's corners to the camera frame, and return the largest z."""
    max_z = -np.inf
    for k in range(3):
        place = vertices[face[k]]
        for a in range(3):
            moved = pose[a, 0] * place[0] + pose[a, 1] * place[1] + pose[a, 2] * place[2]
            triangle[k, a] = moved + pose[a, 3]
        max_z = max(max_z, triangle[k, 2])
    return max_z


@njit
def _pixel_bounds(triangle, pinhole, width, height):
    """Return the pixel bounds u0, u1, v0, v1 of a triangle, with exclusive ends."""
    low_u, high_u, low_v, high_v = np.inf, -np.inf, np.inf, -np.inf
    for k in range(3):
        one, other = triangle[k], triangle[(k + 1) % 3]
        for step in range(2):
            x, y, z = one[0], one[1], one[2]
            if step == 1:  # Where the edge goes through the plane just before the camera.
                far_z = other[2]
                if (z >= NEAR_M) == (far_z >= NEAR_M):
                    continue
                share = (NEAR_M - z) / (far_z - z)
                x += share * (other[0] - x)
                y += share * (other[1] - y)
                z = NEAR_M
            if z < NEAR_M:
                continue
            u, v = x / z * pinhole.fx + pinhole.cx, y / z * pinhole.fy + pinhole.cy
            low_u, high_u = min(low_u, u), max(high_u, u)
            low_v, high_v = min(low_v, v), max(high_v, v)
    if not (high_u > 0 and high_v > 0 and low_u < width and low_v < height):
        return 0, 0, 0, 0
    u0, u1 = max(0.0, np.ceil(low_u - 0.5001)), min(width * 1.0, np.floor(high_u - 0.4999) + 1)
    v0, v1 = max(0.0, np.ceil(low_v - 0.5001)), min(height * 1.0, np.floor(high_v - 0.4999) + 1)
    return int(u0), int(u1), int(v0), int(v1)


@njit
def _edge(edges, k, one, other):
    """Store the cross product of two corners; swapped corners give exactly the negated result."""
    edges[k, 0] = one[1] * other[2] - one[2] * other[1]
    edges[k, 1] = one[2] * other[0] - one[0] * other[2]
    edges[k, 2] = one[0] * other[1] - one[1] * other[0]


@njit
def _edge_functions(triangle, edges):
    """Fill ``edges`` so that edge k over the result, met with a ray, is the share of corner k."""
    _edge(edges, 0, triangle[1], triangle[2])
    _edge(edges, 1, triangle[2], triangle[0])
    _edge(edges, 2, triangle[0], triangle[1])
    volume = 0.0
    for axis in range(3):
        volume += triangle[0, axis] * edges[0, axis]
    return volume


@njit
def _draw(vertices, faces, pose, pinhole, runs, depth, face_ids):
    """Render each triangle of the runs into ``depth`` and ``face_ids`` where it is the nearest."""
    edges, triangle = np.empty((3, 3)), np.empty((3, 3))
    for r in range(len(runs)):
        for f in range(runs[r, 0], runs[r, 1]):
            if _transform_corners(vertices, faces[f], pose, triangle) >= NEAR_M:
                _draw_triangle(f, triangle, edges, pinhole, depth, face_ids)


@njit
def _draw_triangle(f, triangle, edges, pinhole, depth, face_ids):
    height, width = depth.shape
    u0, u1, v0, v1 = _pixel_bounds(triangle, pinhole, width, height)
    if u0 >= u1 or v0 >= v1:
        return
    volume = _edge_functions(triangle, edges)
    if volume == 0.0:
        return
    sign = 1.0 if volume > 0 else -1.0
    for v in range(v0, v1):
        y = (v + 0.5 - pinhole.cy) / pinhole.fy
        for u in range(u0, u1):
            x = (u + 0.5 - pinhole.cx) / pinhole.fx
            a = sign * (edges[0, 0] * x + edges[0, 1] * y + edges[0, 2])
            b = sign * (edges[1, 0] * x + edges[1, 1] * y + edges[1, 2])
            c = sign * (edges[2, 0] * x + edges[2, 1] * y + edges[2, 2])
            total = a + b + c
            if a < 0 or b < 0 or c < 0 or total <= 0:
                continue
            z = sign * volume / total
            if NEAR_M <= z < depth[v, u]:
                depth[v, u] = z
                face_ids[v, u] = f


@njit
def _shade(vertices, faces, pose, pinhole, face_ids, colours, textures, picture):
    """Set each pixel to the colour of the visible face at that point."""
    colour, uv, face_image = colours.vertex, colours.uv, colours.image
    pixels, starts, sizes = textures.pixels, textures.starts, textures.sizes
    edges, triangle = np.empty((3, 3)), np.empty((3, 3))
    share = np.empty(3)
    for v in range(face_ids.shape[0]):
        for u in range(face_ids.shape[1]):
            f = face_ids[v, u]
            if f < 0:
                continue
            face = faces[f]
            _transform_corners(vertices, face, pose, triangle)
            _edge_functions(triangle, edges)
            x, y = (u + 0.5 - pinhole.cx) / pinhole.fx, (v + 0.5 - pinhole.cy) / pinhole.fy
            for k in range(3):
                share[k] = edges[k, 0] * x + edges[k, 1] * y + edges[k, 2]
            share /= share.sum()
            if len(face_image) and face_image[f] >= 0:
                m = face_image[f]
                a = (
                    share[0] * uv[face[0], 0]
                    + share[1] * uv[face[1], 0]
                    + share[2] * uv[face[2], 0]
                )
                b = (
                    share[0] * uv[face[0], 1]
                    + share[1] * uv[face[1], 1]
                    + share[2] * uv[face[2], 1]
                )
                column = min(int((a - np.floor(a)) * sizes[m, 0]), sizes[m, 0] - 1)
                row = min(int((b - np.floor(b)) * sizes[m, 1]), sizes[m, 1] - 1)
                for c in range(3):
                    picture[v, u, c] = pixels[starts[m] + row * sizes[m, 0] + column, c]
            elif len(colour):
                for c in range(3):
                    mixed = 0.5
                    for k in range(3):
                        mixed += share[k] * colour[face[k], c]
                    picture[v, u, c] = np.uint8(min(max(mixed, 0.0), 255.0))
            else:
                for c in range(3):
                    picture[v, u, c] = GREY
