"""Splatting of point clouds: a pinhole view of each point as a small disc (surfel).

Discs are as large as the points lie apart (``surfels``), so that walls are closed. First the
nearest disc of each pixel is found, then the discs within ``BLEND_M`` of it are blended, the
nearer to the pixel's ray the more: that takes the noise out, and what lies behind does not show. A
pixel that still looks through a gap is one that most pixels around it stand before; it becomes a
hole.
"""

from dataclasses import dataclass

import numpy as np

from world2minecraft.capture.readers.meshes.mesh_and_cloud import PointCloud
from world2minecraft.capture.readers.meshes.mesh_rasterizer import GREY, NEAR_M, pinhole_of
from world2minecraft.core.jit import njit
from world2minecraft.core.types import Camera

BLEND_M = 0.02  # Twice the noise of good scanners and thrice that of a phone's cleaned cloud.
RIM_WEIGHT = 0.3  # What a pixel has that no disc's middle is nearer to than 2/3 of the radius.
MIN_RADIUS_PX = 0.75  # A disc covers the centre of at least one pixel, however far it is.
GAP_SHARE, GAP_M = 0.08, 0.06  # A pixel this much farther than most around it looks through a gap.


@dataclass(frozen=True, eq=False)
class Surfels:
    """The discs of a cloud: unit ``normals`` float32 [N, 3] (0 where unknown), ``radius_m`` [N]."""

    cloud: PointCloud
    normals: np.ndarray
    radius_m: np.ndarray


def render_surfels(
    surfels: Surfels, camera: Camera, world_to_camera: np.ndarray, runs: np.ndarray | None = None
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return z-depth, colour and labels as ``see_triangles`` does, for a cloud."""
    cloud = surfels.cloud
    runs = np.array([[0, len(cloud.points)]], np.int64) if runs is None else runs
    shape = (camera.height_px, camera.width_px)
    discs, owner = _transform_surfels(
        cloud.points,
        surfels.normals,
        surfels.radius_m,
        np.ascontiguousarray(world_to_camera, np.float64),
        pinhole_of(camera),
        shape,
        runs,
    )
    nearest = np.full(shape, np.inf, np.float32)
    _depth_pass(discs, pinhole_of(camera), nearest)
    colour = np.full((1, 3), GREY, np.uint8) if cloud.colour is None else cloud.colour
    labels = np.full(1, 255, np.uint8) if cloud.labels is None else cloud.labels
    sums = np.zeros((*shape, 6), np.float32)
    picture_labels = np.full(shape, 255, np.uint8)
    _blend_pass(discs, owner, pinhole_of(camera), nearest, colour, labels, sums, picture_labels)
    weight = sums[..., 5]
    held = weight > 0
    mean = sums / np.where(held, weight, 1)[..., None]
    depth = np.where(held, mean[..., 0], np.float32(0))
    depth = _remove_gaps(depth, sums[..., 4] < RIM_WEIGHT)
    colours = np.where((depth > 0)[..., None], np.clip(mean[..., 1:4] + 0.5, 0, 255), 0)
    picture_labels[depth == 0] = 255
    return depth, colours.astype(np.uint8), picture_labels


@njit
def _transform_surfels(points, normals, radii, pose, pinhole, shape, runs):
    """Return the discs that a camera may see, in its frame, and which point each is of.

    float64 [D, 8]: place, normal, radius (grown where it is smaller than a pixel), and radius.
    """
    capacity = 0
    for r in range(len(runs)):
        capacity += runs[r, 1] - runs[r, 0]
    discs, owner, count = np.empty((capacity, 8), np.float32), np.empty(capacity, np.int32), 0
    for r in range(len(runs)):
        for i in range(runs[r, 0], runs[r, 1]):
            disc = discs[count]
            for a in range(3):
                place, way = pose[a, 3], 0.0
                for b in range(3):
                    place += pose[a, b] * points[i, b]
                    way += pose[a, b] * normals[i, b]
                disc[a], disc[3 + a] = place, way
            z = disc[2]
            if z < NEAR_M:
                continue
            disc[6] = max(radii[i], MIN_RADIUS_PX * z / min(pinhole.fx, pinhole.fy))
            disc[7] = radii[i]
            u, v = disc[0] / z * pinhole.fx + pinhole.cx, disc[1] / z * pinhole.fy + pinhole.cy
            across, down = disc[6] / z * pinhole.fx, disc[6] / z * pinhole.fy
            if -across < u < shape[1] + across and -down < v < shape[0] + down:
                owner[count] = i
                count += 1
    return discs[:count], owner[:count]


@njit
def _window(disc, pinhole, shape):
    """Return the pixels u0, u1, v0, v1 (ends not included) around a disc."""
    z, radius = disc[2], disc[6]
    u, v = disc[0] / z * pinhole.fx + pinhole.cx, disc[1] / z * pinhole.fy + pinhole.cy
    u0, u1 = _span(u, radius / z * pinhole.fx, shape[1])
    v0, v1 = _span(v, radius / z * pinhole.fy, shape[0])
    return u0, u1, v0, v1


@njit
def _span(middle, half, size):
    first = max(0.0, np.ceil(middle - half - 0.5))
    last = min(size * 1.0, np.floor(middle + half - 0.5) + 1)
    return int(first), int(last)


@njit
def _intersect_disc(disc, x, y):
    """Return how far along the ray (x, y, 1) it meets a disc, and the share of the radius there.

    A disc seen so obliquely that its plane runs off is met near its middle's depth.
    """
    level, radius = disc[2], disc[6]
    facing = disc[3] * x + disc[4] * y + disc[5]
    along = disc[3] * disc[0] + disc[4] * disc[1] + disc[5] * level
    z = level
    if abs(facing) > 0.05 and along / facing > 0:
        z = min(max(along / facing, level - radius), level + radius)
    dx, dy, dz = x * z - disc[0], y * z - disc[1], z - level
    return z, (dx * dx + dy * dy + dz * dz) / (radius * radius)


@njit
def _depth_pass(discs, pinhole, nearest):
    """Find the least depth of the discs at each pixel."""
    for i in range(len(discs)):
        u0, u1, v0, v1 = _window(discs[i], pinhole, nearest.shape)
        for v in range(v0, v1):
            y = (v + 0.5 - pinhole.cy) / pinhole.fy
            for u in range(u0, u1):
                if discs[i, 2] - discs[i, 6] > nearest[v, u]:
                    continue
                z, share = _intersect_disc(discs[i], (u + 0.5 - pinhole.cx) / pinhole.fx, y)
                if share <= 1.0 and NEAR_M <= z < nearest[v, u]:
                    nearest[v, u] = z


@njit
def _blend_pass(discs, owner, pinhole, nearest, colour, labels, sums, picture_labels):
    """Add up depth, colour and weight of the discs near each pixel's nearest one.

    The label is that of the disc whose middle the ray meets best; its weight is in ``sums[4]``.
    """
    for i in range(len(discs)):
        u0, u1, v0, v1 = _window(discs[i], pinhole, nearest.shape)
        band = max(BLEND_M, discs[i, 7])
        own, own_label = owner[i] % len(colour), labels[owner[i] % len(labels)]
        for v in range(v0, v1):
            y = (v + 0.5 - pinhole.cy) / pinhole.fy
            for u in range(u0, u1):
                if discs[i, 2] - discs[i, 6] > nearest[v, u] + band:
                    continue
                z, share = _intersect_disc(discs[i], (u + 0.5 - pinhole.cx) / pinhole.fx, y)
                if share > 1.0 or z < NEAR_M or z > nearest[v, u] + band:
                    continue
                weight = (1.0 - share) * (1.0 - share) + 1e-3
                total = sums[v, u]
                total[0] += weight * z
                for c in range(3):
                    total[1 + c] += weight * colour[own, c]
                total[5] += weight
                if weight > total[4]:
                    total[4] = weight
                    picture_labels[v, u] = own_label


@njit
def _remove_gaps(depth, rim):
    """Return the depth without pixels in gaps, and without the outermost ones of things.

    In a gap are those that most of the 24 around them stand clearly before. Outermost are those
    that only the rims of discs meet (``rim``), with something clearly farther next to them.
    """
    height, width = depth.shape
    result = depth.copy()
    for v in range(height):
        for u in range(width):
            z = depth[v, u]
            if z == 0:
                continue
            clear = GAP_M + GAP_SHARE * z
            before, behind, count = 0, 0, 0
            for other_v in range(max(0, v - 2), min(height, v + 3)):
                for other_u in range(max(0, u - 2), min(width, u + 3)):
                    near = depth[other_v, other_u]
                    count += 1
                    if 0 < near < z - clear:
                        before += 1
                    if near == 0 or near > z + clear:
                        behind += 1
            if 10 * before > 6 * count or (rim[v, u] and behind > 0):
                result[v, u] = 0
    return result
