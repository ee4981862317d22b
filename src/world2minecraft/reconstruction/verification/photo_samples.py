"""Photos of a capture on a coarse raster: colour, measured depth and recognised NYU40 classes.

The raster is that of a pinhole camera at the pose of the colour camera, so that the world can be
rendered for the same pixels. The classes are those for which the segmentation network voted during
the reconstruction, at the place of the measured point; without such votes the network sees the
photo again.
"""

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from PIL import Image

from world2minecraft.capture.view_stream import views_named
from world2minecraft.core.coordinates import apply
from world2minecraft.core.types import Camera, Scan, View, checks
from world2minecraft.geometry.undistort import pinhole_camera, undistort_image
from world2minecraft.geometry.unprojection import pixel_rays, project, unproject_depth
from world2minecraft.reconstruction.naming.name_votes import (
    CUBE_M,
    CubeIndex,
    NameVotes,
    class_votes,
)
from world2minecraft.reconstruction.recognition.segmentation import SegmentationModel, splat_depth
from world2minecraft.reconstruction.recognition.segmentation_channels import (
    sample_nearest,
)

MAX_SAMPLES = 12
RASTER_PX, PICTURE_PX = 160, 480  # Long sides.
DEPTH_PX = 320  # Long side of the depth image that is projected into the raster.
# A cube and its 26 neighbours.
NEAREST_FIRST = np.array(sorted(np.ndindex(3, 3, 3), key=lambda c: (abs(np.array(c) - 1).sum(), c)))
NEAREST_FIRST -= 1


@dataclass(frozen=True, eq=False)
class PhotoSample:
    """A photo on a coarse raster of H x W pixels.

    Attributes:
        name: Name of the view.
        camera: Pinhole camera of the raster.
        camera_to_room: Pose of the camera, float64 [4, 4], OpenCV axes.
        colour: Colours, uint8 [H, W, 3].
        depth_m: Measured depth along the optical axis in metres, float32 [H, W]; 0 is unknown.
        seen: NYU40 class that the segmentation network sees, 1 to 40, or 0 where it saw nothing,
            uint8 [H, W].
        picture: The photo for people, uint8 [h, w, 3], of the same field of view.
    """

    name: str
    camera: Camera
    camera_to_room: np.ndarray
    colour: np.ndarray
    depth_m: np.ndarray
    seen: np.ndarray
    picture: np.ndarray

    def __post_init__(self):
        put = object.__setattr__
        shape = (self.camera.height_px, self.camera.width_px)
        put(self, "colour", checks.array("colour", self.colour, np.uint8, (*shape, 3)))
        put(self, "depth_m", checks.array("depth_m", self.depth_m, np.float32, shape))
        put(self, "seen", checks.array("seen", self.seen, np.uint8, shape))

    @property
    def points_m(self) -> np.ndarray:
        """The measured points in the room, float64 [H, W, 3]; unknown ones are at the camera."""
        return room_points_m(self.camera, self.camera_to_room, self.depth_m)


def room_points_m(camera: Camera, camera_to_room: np.ndarray, depth_m: np.ndarray) -> np.ndarray:
    """Return the points of a depth image [H, W] in the room, float64 [H, W, 3]."""
    return apply(camera_to_room, _on_plane(camera) * depth_m[..., None])


def evenly_spread(names: Sequence[str], count: int) -> list[str]:
    """Return up to ``count`` names, evenly spread.

    Example:
        >>> evenly_spread(["a", "b", "c", "d", "e"], 2)
        ['b', 'd']
    """
    count = min(count, len(names))
    return [names[int((n + 0.5) * len(names) / count)] for n in range(count)]


def sample_photos(
    scan: Scan,
    votes: NameVotes | None = None,
    *,
    count: int = MAX_SAMPLES,
    without: Collection[str] = (),
    model: SegmentationModel | None = None,
) -> tuple[PhotoSample, ...]:
    """Return samples of up to ``count`` views, evenly spread over the used frames.

    Views without colour or without depth give no sample.

    Args:
        scan: The aligned scan.
        votes: Votes of the segmentation network in the room, from the reconstruction.
        count: Maximum number of views.
        without: Frames that are left out.
        model: Segmentation network that is used without votes. None uses the shipped one.
    """
    if votes is not None and len(votes.cubes):
        recognise = partial(_seen_by_votes, _VoteTable(votes))
    else:
        recognise = partial(_seen_by_network, model or SegmentationModel())
    samples = []
    frames = [name for name in scan.frames_used if name not in without]
    for view in views_named(scan.views, evenly_spread(frames, count)):
        colour, camera, measured_m = view.colour, view.colour_camera, _measured_points_m(view)
        if colour is None or camera is None or measured_m is None:
            continue
        raster, large = (_pinhole(camera, side) for side in (RASTER_PX, PICTURE_PX))
        pose = scan.scan_to_room @ view.camera_to_scan
        depth_m = _depth_image(measured_m, raster)
        sample = PhotoSample(
            name=view.name,
            camera=raster,
            camera_to_room=pose,
            colour=_resampled(colour, camera, raster),
            depth_m=depth_m,
            seen=np.zeros(depth_m.shape, np.uint8),
            picture=_resampled(colour, camera, large),
        )
        samples.append(replace(sample, seen=recognise(sample)))
    return tuple(samples)


def _seen_by_network(model: SegmentationModel, sample: PhotoSample) -> np.ndarray:
    """Return the most probable class of each pixel, uint8 [H, W]."""
    pose, camera = sample.camera_to_room, sample.camera
    shares = model.predict(
        sample.picture, sample.depth_m, camera.scaled_to(*sample.picture.shape[1::-1]),
        pose[2, :3], float(pose[2, 3]),
    )  # fmt: skip
    best = (shares.argmax(axis=2) + 1).astype(np.uint8)
    return np.ascontiguousarray(sample_nearest(best, camera.width_px, camera.height_px))


class _VoteTable:
    """The class with the most votes of each cube, for look-up by place."""

    def __init__(self, votes: NameVotes):
        self.index = CubeIndex(votes.cubes)
        self.best = (class_votes(votes.votes).argmax(axis=1) + 1).astype(np.uint8)

    def find(self, cubes: np.ndarray) -> np.ndarray:
        """Return the class of each cube, int64 [N, 3], as uint8 [N], or 0 without votes."""
        rows = self.index.find(cubes)
        return np.where(rows >= 0, self.best[rows], 0).astype(np.uint8)


def _seen_by_votes(table: _VoteTable, sample: PhotoSample) -> np.ndarray:
    """Return the class with the most votes in the nearest cube, uint8 [H, W]."""
    measured = sample.depth_m > 0
    cubes = np.floor(sample.points_m[measured] / CUBE_M).astype(np.int64)
    found = np.zeros(len(cubes), np.uint8)
    for step in NEAREST_FIRST:
        missing = np.flatnonzero(found == 0)
        found[missing] = table.find(cubes[missing] + step)
    seen = np.zeros(measured.shape, np.uint8)
    seen[measured] = found
    return seen


def _pinhole(camera: Camera, long_side_px: int) -> Camera:
    """Return the undistorted camera of an image that is at most ``long_side_px`` long."""
    long_px = max(camera.width_px, camera.height_px)
    return pinhole_camera(camera, max(1, round(camera.width_px * min(1, long_side_px / long_px))))


def _resampled(colour: np.ndarray, camera: Camera, target: Camera) -> np.ndarray:
    if any(camera.distortion):
        return undistort_image(colour, camera, target)
    size = (target.width_px, target.height_px)
    return np.asarray(Image.fromarray(colour).resize(size, Image.Resampling.BOX))


def _measured_points_m(view: View) -> np.ndarray | None:
    """Return the measured points in the frame of the colour camera, float32 [N, 3], or None."""
    depth_m, camera = view.depth_m, view.depth_camera
    if depth_m is None or camera is None:
        return None
    scale = min(1.0, DEPTH_PX / max(depth_m.shape))
    small = camera.scaled_to(
        max(1, round(camera.width_px * scale)), max(1, round(camera.height_px * scale))
    )
    sampled = sample_nearest(depth_m, small.width_px, small.height_px)
    return unproject_depth(np.ascontiguousarray(sampled), small, view.depth_to_colour)[0]


def _depth_image(points_m: np.ndarray, camera: Camera) -> np.ndarray:
    """Return the depth of the nearest point of each pixel, float32 [H, W], 0 without a point."""
    points_m = points_m[points_m[:, 2] > 0]
    at_px = project(points_m.astype(np.float64), camera)
    size = (camera.width_px, camera.height_px)
    inside = ((at_px >= 0) & (at_px < size)).all(axis=1)
    across, down = (at_px[inside] / size).T
    return splat_depth(points_m[inside, 2], down, across, size)


def _on_plane(camera: Camera) -> np.ndarray:
    """Return the points of a camera's pixels at depth 1, float64 [H, W, 3]."""
    rays = pixel_rays(camera).astype(np.float64)
    return np.concatenate([rays, np.ones((*rays.shape[:2], 1))], axis=2)
