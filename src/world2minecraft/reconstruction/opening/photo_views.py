"""Combine photos, camera poses and depth into views."""

from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np

from world2minecraft.capture.images import ImagePlace, read_header
from world2minecraft.capture.photo_stream import CapturePhotos
from world2minecraft.capture.source_types import FrameFiles
from world2minecraft.capture.validation import ValidatedCapture
from world2minecraft.capture.view_stream import read_view
from world2minecraft.core.errors import CaptureError, InputError
from world2minecraft.core.parallel import read_ahead
from world2minecraft.core.types import Camera, DepthMap, Photo, PhotoStream, SparseScene, View
from world2minecraft.geometry.undistort import pinhole_camera, undistort_image

DEPTH_UNIT = "0.0002"  # Metres a step: a scene of median depth 2.5 is kept to 13.


def stereo_views(
    photos: PhotoStream, scene: SparseScene, maps: Iterable[DepthMap]
) -> Iterator[View]:
    """Yield a view for each depth map with its undistorted photo, in the order of the photos."""
    found = _photos_of(photos, scene)
    for made in maps:
        photo, index = next((pair for pair in found if pair[0].name == made.name), (None, 0))
        if photo is None:
            raise ValueError(f"depth map {made.name} does not follow the order of the photos")
        yield replace(
            _coloured(photo, scene, index),
            depth_m=made.depth_m,
            depth_camera=made.camera,
            trust=made.trust,
        )


def depth_views(
    judged: ValidatedCapture, photos: CapturePhotos, scene: SparseScene
) -> Iterator[View]:
    """Yield a view for each posed photo with measured depth."""
    frames = {frame.name: frame for frame in judged.frames}
    for photo, index in _photos_of(photos, scene):
        frame = frames[photo.name]
        if frame.depth_path is None:
            continue
        try:
            own = read_view(
                posed_frame(frame, scene, index), judged.encoding, judged.capture.full_trust
            )
        except InputError as error:
            photos.damaged[photo.name] = str(error)
            continue
        yield replace(
            _coloured(photo, scene, index),
            depth_m=own.depth_m,
            depth_camera=own.depth_camera,
            depth_to_colour=own.depth_to_colour,
            trust=own.trust,
        )


def posed_frame(frame: FrameFiles, scene: SparseScene, index: int) -> FrameFiles:
    """Return a frame with a computed pose, without colour, to read its depth.

    If the intrinsics of the depth camera are not stated, those of the colour camera are scaled to
    the size of the depth image.

    Raises:
        CaptureError: If depth image and colour image have different aspect ratios.
    """
    camera = frame.depth_camera
    if camera is None and frame.depth_path is not None:
        camera = _resized(frame.depth_path, scene.cameras[index])
    return replace(
        frame,
        camera_to_world=scene.camera_to_scan[index],
        colour_path=None,
        colour_camera=None,
        labels_path=None,
        depth_camera=camera,
    )


def _resized(depth_path: ImagePlace, camera: Camera) -> Camera:
    size = read_header(depth_path).size
    try:
        return camera.resized(*size)
    except ValueError as error:
        raise CaptureError(
            depth_path,
            f"its aspect ratio differs from that of the colour image: {error}; add the depth "
            "intrinsics to a capture.json (docs/reference/plain-layout.md)",
        ) from error


def _photos_of(photos: PhotoStream, scene: SparseScene) -> Iterator[tuple[Photo, int]]:
    """Yield the posed photos with their indices in the scene."""
    places = {name: index for index, name in enumerate(scene.names)}
    for photo in read_ahead(photos):
        if photo.name in places:
            yield photo, places[photo.name]


def _coloured(photo: Photo, scene: SparseScene, index: int) -> View:
    pose = np.round(scene.camera_to_scan[index], 12)
    return View(photo.name, pose, *undistorted(photo.colour, scene.cameras[index]))


def undistorted(colour: np.ndarray, camera: Camera) -> tuple[np.ndarray, Camera]:
    """Return an image of the same size without lens distortion, and its camera."""
    flat = pinhole_camera(camera, camera.width_px)
    if any(camera.distortion):
        colour = undistort_image(colour, camera, flat)
    return np.ascontiguousarray(colour), flat
