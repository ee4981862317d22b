"""Preparation of photos for stereo: downscaling, undistortion, poses and sparse depths."""

from dataclasses import dataclass

import numpy as np

from world2minecraft.core.coordinates import invert_rigid
from world2minecraft.core.errors import CaptureError
from world2minecraft.core.parallel import read_ahead
from world2minecraft.core.progress import Progress
from world2minecraft.core.types import Camera
from world2minecraft.core.types.photos import PhotoStream, SparseScene
from world2minecraft.geometry.undistort import pinhole_camera, undistort_image
from world2minecraft.geometry.unprojection import project

MIN_SIDE_PX = 16  # Minimum side length, so that matching windows fit.


@dataclass(frozen=True, eq=False)
class StereoPhoto:
    """A downscaled photo without distortion, with its pose and sparse depths.

    Attributes:
        name: Name of the photo.
        camera: Intrinsics without distortion.
        camera_to_scan: Camera pose, float64 [4, 4].
        colour: Image, uint8 [h, w, 3].
        guide_px: Pixel positions of the visible sparse points, float64 [G, 2].
        guide_m: z-depth of the sparse points, float64 [G].
        guide_point: Indices of the sparse points, ascending, int64 [G].
    """

    name: str
    camera: Camera
    camera_to_scan: np.ndarray
    colour: np.ndarray
    guide_px: np.ndarray
    guide_m: np.ndarray
    guide_point: np.ndarray

    @property
    def grey(self) -> np.ndarray:
        """The brightest channel, uint8 [h, w], which separates red from black."""
        return self.colour.max(axis=2)


def prepare_stereo_photos(
    photos: PhotoStream, scene: SparseScene, width_px: int, progress: Progress
) -> list[StereoPhoto]:
    """Return the photos of a scene in its order, downscaled one after the other.

    Raises:
        CaptureError: If a photo of the scene is missing, or its size differs from that of its
            camera.
    """
    order = {name: frame for frame, name in enumerate(scene.names)}
    found: dict[str, StereoPhoto] = {}
    for photo in read_ahead(photos):
        if photo.name not in order or photo.name in found:
            continue
        found[photo.name] = _prepare_photo(
            photo.name, photo.colour, scene, order[photo.name], width_px
        )
        progress("shrink", len(found), len(order), photo.name)
    missing = [name for name in scene.names if name not in found]
    if missing:
        raise CaptureError(missing[0], "is part of the scene but missing in the photos")
    return [found[name] for name in scene.names]


def _prepare_photo(name, colour, scene: SparseScene, frame: int, width_px: int) -> StereoPhoto:
    camera, pose = scene.cameras[frame], scene.camera_to_scan[frame]
    if colour.shape[:2] != (camera.height_px, camera.width_px):
        raise CaptureError(
            name,
            f"the photo is {colour.shape[1]}x{colour.shape[0]} px, but its camera is "
            f"{camera.width_px}x{camera.height_px} px",
        )
    target = pinhole_camera(camera, min(width_px, camera.width_px))
    if min(target.width_px, target.height_px) < MIN_SIDE_PX:
        raise CaptureError(
            name,
            f"the sides of the photo must have at least {MIN_SIDE_PX} pixels; use larger photos",
        )
    seen = np.unique(scene.track_point[scene.track_frame == frame])
    points_m = _to_camera(scene.points_m[seen], pose)
    ahead = points_m[:, 2] > 0
    points_m, seen = points_m[ahead], seen[ahead]
    at_px = project(points_m, target)
    inside = ((at_px >= 0) & (at_px < (target.width_px, target.height_px))).all(axis=1)
    return StereoPhoto(
        name, target, pose, undistort_image(colour, camera, target),
        at_px[inside], points_m[inside, 2], seen[inside],
    )  # fmt: skip


def _to_camera(points_m: np.ndarray, camera_to_scan: np.ndarray) -> np.ndarray:
    scan_to_camera = invert_rigid(camera_to_scan)
    return points_m.astype(np.float64) @ scan_to_camera[:3, :3].T + scan_to_camera[:3, 3]
