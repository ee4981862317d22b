"""Convert depth to evidence: surface points with normal, colour and label.

If colour and depth come from two cameras, a depth point takes the colour and the label of the pixel
it projects to, or of the nearest border pixel if it is outside the colour image. For normals, depth
is averaged in squares of pixels; the normal of a square is that of the plane through the means of
its neighbours, as far as the surface has no jump. Squares at jumps have no normal.
"""

from collections.abc import Iterator, Sequence
from functools import lru_cache
from typing import NamedTuple, Protocol

import numpy as np

from world2minecraft.core.coordinates import apply, invert_rigid
from world2minecraft.core.jit import inlined, lean, njit
from world2minecraft.core.parallel import read_ahead
from world2minecraft.core.types import Camera, PointEvidence, Scan, View
from world2minecraft.geometry.unprojection import pixel_rays, project
from world2minecraft.reconstruction.naming.name_votes import NameVoteMap

SQUARES_WIDE = 160  # 4 px at 640: the mean of 16 pixels, and 16 px from side to side.
REACH = 2  # Squares to either side.
JUMP_SHARE = 0.04  # Of the depth: neighbouring squares of one surface differ by less.

MAX_DEPTH_M = 6.0  # Consumer depth cameras err by over 6 cm beyond; a room rarely needs more.
# What one frame shows far away, no other frame shows from nearer. On 58 training frames of NYUv2,
# 20 % of the labelled surface is beyond 6 m.
ALONE_MAX_DEPTH_M = 10.0


class SurfacePoints(NamedTuple):
    """The surface points of a depth image."""

    points_m: np.ndarray  # float32 [N, 3]
    normals: np.ndarray  # float32 [N, 3], unit vectors towards the camera; (0, 0, 0) if unknown
    weight: np.ndarray  # float32 [N], the area of each pixel in square metres
    pixels: np.ndarray  # int32 [N], increasing indices of the flattened image


def lift_depth(
    depth_m: np.ndarray, camera: Camera, camera_to_frame: np.ndarray, limit_m: float
) -> SurfacePoints:
    """Return the surface points of a depth image in the target frame of a pose.

    Args:
        depth_m: Depth along the optical axis in metres, float32 [H, W]; 0 is missing.
        camera: Intrinsics of the depth camera.
        camera_to_frame: 4x4 pose of the depth camera.
        limit_m: Depth in metres beyond which pixels are ignored.
    """
    side = max(1, round(camera.width_px / SQUARES_WIDE))
    rays, pose = pixel_rays(camera), camera_to_frame.astype(np.float64)
    limit = np.float32(limit_m)
    normals = _normals(_square_means(depth_m, rays, side, limit), pose)
    pixel_area = np.float32(camera.fx_px * camera.fy_px)
    return SurfacePoints(*_lift(depth_m, rays, pose, normals, side, limit, pixel_area))


@njit
def _square_means(depth_m, rays, side, limit):
    """Return the mean point of each square, float32 [h, w, 3]; z is 0 at surface jumps."""
    high, wide = -(-depth_m.shape[0] // side), -(-depth_m.shape[1] // side)
    means = np.zeros((high, wide, 3), np.float32)
    for i in range(high):
        for j in range(wide):
            count, x, y, total = 0, 0.0, 0.0, 0.0
            near, far = np.float32(np.inf), np.float32(0)
            for v in range(i * side, min((i + 1) * side, depth_m.shape[0])):
                for u in range(j * side, min((j + 1) * side, depth_m.shape[1])):
                    z = depth_m[v, u]
                    if 0 < z <= limit:
                        count += 1
                        x += rays[v, u, 0] * z
                        y += rays[v, u, 1] * z
                        total += z
                        near, far = min(near, z), max(far, z)
            is_whole = np.float64(far) - near < 2.5 * JUMP_SHARE * near
            if 2 * count >= side * side and is_whole:
                means[i, j, 0], means[i, j, 1] = x / count, y / count
                means[i, j, 2] = total / count
    return means


@inlined
def _reach(means, i, j, down, across):
    """Return the number of squares, at most REACH, over which the surface continues."""
    steps = 0
    while steps < REACH:
        a, b = i + (steps + 1) * down, j + (steps + 1) * across
        if a < 0 or b < 0 or a >= means.shape[0] or b >= means.shape[1]:
            break
        here, there = means[a - down, b - across, 2], means[a, b, 2]
        if there == 0 or abs(there - here) > JUMP_SHARE * here:
            break
        steps += 1
    return steps


@njit
def _normals(means, pose):
    """Return the unit normal of each square, turned by a pose, float32 [h, w, 3]."""
    result = np.zeros(means.shape, np.float32)
    _fill_normals(means, pose, result)
    return result


@lean
def _fill_normals(means, pose, result):
    """Write the normals of the squares that have one, towards the camera and then turned."""
    for i in range(means.shape[0]):
        for j in range(means.shape[1]):
            if means[i, j, 2] == 0:
                continue
            up, down = _reach(means, i, j, -1, 0), _reach(means, i, j, 1, 0)
            left, right = _reach(means, i, j, 0, -1), _reach(means, i, j, 0, 1)
            if up + down == 0 or left + right == 0:
                continue
            x, y, z = _cross(
                _between(means, i - up, j, i + down, j), _between(means, i, j - left, i, j + right)
            )
            length = np.sqrt(x * x + y * y + z * z)
            if length < 1e-12:
                continue
            if x * means[i, j, 0] + y * means[i, j, 1] + z * means[i, j, 2] > 0:
                length = -length
            x, y, z = np.float32(x / length), np.float32(y / length), np.float32(z / length)
            for axis in range(3):
                result[i, j, axis] = pose[axis, 0] * x + pose[axis, 1] * y + pose[axis, 2] * z


@inlined
def _between(means, i, j, k, m):
    """Return the vector from the mean point of square (i, j) to that of square (k, m)."""
    return (
        means[k, m, 0] - means[i, j, 0],
        means[k, m, 1] - means[i, j, 1],
        means[k, m, 2] - means[i, j, 2],
    )


@inlined
def _cross(a, b):
    """Return the cross product of two vectors."""
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


@njit
def _lift(depth_m, rays, pose, normals, side, limit, pixel_area):
    """Return the points, normals, weights and pixels of ``SurfacePoints``."""
    count = depth_m.size
    points, facing = np.empty((count, 3), np.float32), np.empty((count, 3), np.float32)
    weight, pixels = np.empty(count, np.float32), np.empty(count, np.int32)
    found = _lift_pixels(
        depth_m, rays, pose, normals, side, (limit, pixel_area), points, facing, weight, pixels
    )
    return points[:found], facing[:found], weight[:found], pixels[:found]


@lean
def _lift_pixels(depth_m, rays, pose, normals, side, values, points, facing, weight, pixels):
    """Fill the arrays of ``SurfacePoints`` and return the number of points."""
    limit, pixel_area = values
    n = 0
    for v in range(depth_m.shape[0]):
        i = v // side
        for j in range(normals.shape[1]):
            a, b, c = normals[i, j, 0], normals[i, j, 1], normals[i, j, 2]
            for u in range(j * side, min((j + 1) * side, depth_m.shape[1])):
                z = depth_m[v, u]
                if not 0 < z <= limit:
                    continue
                x, y = rays[v, u, 0] * z, rays[v, u, 1] * z
                for axis in range(3):
                    points[n, axis] = (
                        pose[axis, 0] * x + pose[axis, 1] * y + pose[axis, 2] * z + pose[axis, 3]
                    )
                facing[n, 0], facing[n, 1], facing[n, 2] = a, b, c
                weight[n] = z * z / pixel_area
                pixels[n] = v * depth_m.shape[1] + u
                n += 1
    return n


class PointVotes(NamedTuple):
    """Votes of a view's points, with a sum of at most 1 per point.

    Attributes:
        shares: Votes, float32 [P, 12].
        rows: Row of each point in ``shares``, int32 [N], or None if each point has its own.
    """

    shares: np.ndarray
    rows: np.ndarray | None = None

    @property
    def dense(self) -> np.ndarray:
        """The votes of each point, float32 [N, 12]."""
        return self.shares if self.rows is None else self.shares[self.rows]


class Voter(Protocol):
    """An object that votes for the classes of a view's surface points, such as a network.

    Attributes:
        notes: Notes for the report.
        photos_only: Whether views that are rendered from a mesh or a point cloud get no votes.
    """

    notes: tuple[str, ...]
    photos_only: bool

    def votes(
        self, view: View, scan_to_room: np.ndarray, points_m: np.ndarray, colour_px: np.ndarray
    ) -> PointVotes | None:
        """Return the votes of N points, or None if the voter does not vote on this view.

        Args:
            view: View with a colour image.
            scan_to_room: 4x4 transform from the scan to the room.
            points_m: Points in the scan's frame in metres, [N, 3].
            colour_px: Flat index of the colour pixel that shows each point, int [N].
        """
        ...


class DepthPredictor:
    """Yields a PointEvidence for each view with depth; ``voters`` vote on its points.

    Args:
        max_depth_m: Depth in metres beyond which points are ignored; None for 6 m, or 10 m if a
            sensor's scan has only one view.
        voters: Objects that vote for the classes of points.

    Attributes:
        names: Votes of label images for fine names so far.
    """

    def __init__(self, max_depth_m: float | None = None, *, voters: Sequence[Voter] = ()):
        self.max_depth_m = max_depth_m
        self.voters = tuple(voters)
        self.names = NameVoteMap()

    @property
    def notes(self) -> tuple[str, ...]:
        """The notes of the voters."""
        return tuple(note for voter in self.voters for note in voter.notes)

    def predict(self, scan: Scan) -> Iterator[PointEvidence]:
        """Yield the surface points of each view, in the frame and the order of the scan."""
        alone = len(scan.views) == 1 and scan.depth_kind == "sensor"
        is_rendered = scan.depth_kind == "exact"
        voters = [voter for voter in self.voters if not (is_rendered and voter.photos_only)]
        for view in read_ahead(scan.views):
            if view.depth_m is not None:
                yield self.lift(view, scan.scan_to_room, alone=alone, voters=voters)

    def lift(
        self,
        view: View,
        scan_to_room: np.ndarray | None = None,
        *,
        alone: bool = False,
        voters: Sequence[Voter] | None = None,
    ) -> PointEvidence:
        """Return the points of a view, without those beyond the maximum depth.

        Args:
            view: View with depth.
            scan_to_room: 4x4 transform from the scan to the room, for the voters.
            alone: Whether the scan of a sensor has no other view.
            voters: Voters that vote on this view. Defaults to all.
        """
        camera, depth_m = view.depth_camera, view.depth_m
        if camera is None or depth_m is None:
            raise ValueError(f"view {view.name} has no depth map")
        limit_m = self.max_depth_m or (ALONE_MAX_DEPTH_M if alone else MAX_DEPTH_M)
        camera_to_scan = view.depth_camera_to_scan
        points_m, normals, weight, pixels = lift_depth(depth_m, camera, camera_to_scan, limit_m)
        colour_px = _colour_pixels(view, points_m, pixels)
        colour, labels = _look_up(view, colour_px)
        if view.label_ids is not None and colour_px is not None and scan_to_room is not None:
            in_room_m = apply(scan_to_room, points_m.astype(np.float64))
            self.names.add_labels(in_room_m, colour_px, view.label_ids.reshape(-1))
        votes = _votes(
            self.voters if voters is None else voters, view, scan_to_room, points_m, colour_px
        )
        return PointEvidence(
            view=view.name,
            camera_m=camera_to_scan[:3, 3],
            points_m=points_m,
            weight=weight,
            colour=colour,
            normals=normals,
            labels=labels,
            trust=_trust(view, pixels),
            votes=None if votes is None else votes.shares.astype(np.float16),
            vote_rows=None if votes is None else votes.rows,
        )


def _votes(
    voters: Sequence[Voter], view: View, scan_to_room, points_m, colour_px
) -> PointVotes | None:
    """Return the sum of the votes for the points of a view, or None without votes."""
    if not voters or colour_px is None:
        return None
    to_room = np.eye(4) if scan_to_room is None else scan_to_room
    every = [voter.votes(view, to_room, points_m, colour_px) for voter in voters]
    found = [votes for votes in every if votes is not None]
    if len(found) < 2:
        return found[0] if found else None
    total = found[0].dense.copy()
    for votes in found[1:]:
        total += votes.dense
    return PointVotes(total)


def _trust(view: View, pixels: np.ndarray) -> np.ndarray | None:
    """Return the confidence of each point, 0 to 1, or None if all are fully trusted."""
    if view.trust is None:
        return None
    return view.trust.reshape(-1)[pixels].astype(np.float32) / np.float32(255)


def _colour_pixels(view: View, points_m: np.ndarray, pixels: np.ndarray) -> np.ndarray | None:
    """Return the flat colour pixel of each of a view's points, or None without colour."""
    if view.colour is None or view.colour_camera is None or view.depth_camera is None:
        return None
    if np.array_equal(view.depth_to_colour, np.eye(4)):
        return _taken(_shared_place_map(view.depth_camera, view.colour_camera), pixels)
    in_camera_m = apply(invert_rigid(view.camera_to_scan), points_m.astype(np.float64))
    return _nearest_pixels(project(in_camera_m, view.colour_camera), view.colour_camera)


def _look_up(view: View, colour_px: np.ndarray | None):
    """Return the colours and the labels of a view's points, each None if the view has none."""
    if colour_px is None or view.colour is None:
        return None, None
    colour = _gather(view.colour.reshape(-1, 3), colour_px)
    return colour, None if view.labels is None else view.labels.reshape(-1)[colour_px]


@njit
def _taken(values, rows):
    """Return the rows of an array [P], which numpy copies slower."""
    result = np.empty(len(rows), values.dtype)
    for n in range(len(rows)):
        result[n] = values[rows[n]]
    return result


@njit
def _gather(values, rows):
    """Return the rows of an array [P, 3], which numpy copies slower."""
    result = np.empty((len(rows), 3), values.dtype)
    for n in range(len(rows)):
        row = rows[n]
        result[n, 0], result[n, 1], result[n, 2] = values[row, 0], values[row, 1], values[row, 2]
    return result


@lru_cache(maxsize=8)
def _shared_place_map(depth_camera: Camera, colour_camera: Camera) -> np.ndarray:
    """Return the colour pixel of each depth pixel, int32 [H*W], for cameras at one position.

    The ray of a pixel then meets the other image at the same position for any depth.
    """
    rays = pixel_rays(depth_camera).reshape(-1, 2)
    ahead = np.concatenate([rays, np.ones((len(rays), 1), np.float32)], axis=1)
    return _nearest_pixels(project(ahead, colour_camera), colour_camera)


def _nearest_pixels(at_px: np.ndarray, camera: Camera) -> np.ndarray:
    """Return the flat indices of the pixels at image points [N, 2], clipped to the image."""
    u = np.clip(np.floor(at_px[:, 0]), 0, camera.width_px - 1)
    v = np.clip(np.floor(at_px[:, 1]), 0, camera.height_px - 1)
    return (v * camera.width_px + u).astype(np.int32)
