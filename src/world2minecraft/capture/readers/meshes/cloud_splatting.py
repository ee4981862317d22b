"""Splatting of point clouds: renders each point of a cloud as a small disc (surfel).

The disc radius follows the spacing of the points (``surfels``), so that walls have no holes. The
renderer first finds the nearest disc at each pixel. It then blends all discs within ``BLEND_M`` of
that depth, weighted by their distance from the pixel's ray, which reduces noise and excludes hidden
surfaces. Pixels that see the background through a gap between discs are set to 0.
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
    """The discs (surfels) of a point cloud.

    Attributes:
        cloud: Point at the centre of each disc.
        normals: Unit normals, float32 [N, 3]; 0 if unknown.
        radius_m: Disc radii in metres, float32 [N].
    """

    cloud: PointCloud
    normals: np.ndarray
    radius_m: np.ndarray


def render_surfels(
    surfels: Surfels, camera: Camera, world_to_camera: np.ndarray, runs: np.ndarray | None = None
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Render depth, colour and labels of a point cloud for one camera pose.

    Args:
        surfels: The discs to render, in metres of the world frame.
        camera: Camera intrinsics without distortion.
        world_to_camera: Rigid transform, float64 [4, 4].
        runs: Ranges of points to render, int64 [R, 2] with exclusive ends; None for all points.

    Returns:
        The z-depth in metres as float32 [H, W] (0 for empty pixels), the colour as uint8 [H, W, 3]
        and the class ids as uint8 [H, W] (255 if unknown).
    """
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
    """Return the discs that may be visible to a camera, in its frame, with their point indices.

    The discs are float32 [D, 8]: position, normal, radius (at least ``MIN_RADIUS_PX``) and true
    radius.
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
    """Return the pixel bounds u0, u1, v0, v1 of a disc, with exclusive ends."""
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
    """Return the depth at which the ray (x, y, 1) meets a disc, and the squared relative radius.

    The depth is clipped to one radius around the centre of the disc, for discs seen edge-on.
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
    """Compute the smallest disc depth at each pixel."""
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
    """Accumulate depth, colour and weight of the discs close to each pixel's nearest disc.

    A pixel gets the label of the disc with the largest weight, which is stored in ``sums[4]``.
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
    """Remove pixels that see through gaps, and silhouette pixels covered only by disc rims.

    A pixel sees through a gap if most of the 24 pixels around it are clearly nearer. ``rim`` marks
    the pixels that only the rims of discs cover; they are removed beside clearly farther pixels.
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
