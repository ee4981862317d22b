"""Simulation of a phone camera: photos with or without poses, and videos, but no depth.

Surfaces have textures (``surface_textures``), and images have the soft edges, exposure and noise of
a phone (``photo_rendering``). Because photos are matched with each other, neighbouring photos must
overlap: the viewing direction is chosen only at intervals and interpolated in between.
"""

import io
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image
from scipy import ndimage

from world2minecraft.core.coordinates import look_at
from world2minecraft.core.errors import MissingExtraError
from world2minecraft.core.files import image_bytes, write_bytes
from world2minecraft.core.types import Camera, View
from world2minecraft.procgen.rooms.room import Room
from world2minecraft.procgen.sensors.photo_rendering import (
    TexturedScene,
    develop,
    expose,
    prepare_textured,
)
from world2minecraft.procgen.sensors.scan_frames import FrameTruth, ScanSettings, Shot, room_to_scan
from world2minecraft.procgen.sensors.trajectory import camera_positions_m, plan_walk
from world2minecraft.procgen.sensors.view_planning import ViewPlanner
from world2minecraft.rendering.voxel_camera import VoxelScene

LOOK_TURN = np.radians([56.0, 24.0])  # Maximum yaw and pitch from one look to the next.
LOOK_PHOTOS = 4  # One decides where to look every fourth photo,
LOOK_PICTURES = 14  # and every fourteenth picture of a video: half a second.
SMOOTH_PICTURES = 3.0  # A hand that films sways, but does not jerk.
PHOTO_QUALITY = 92  # JPEG quality of phones.
RATE_HZ = 24
VIDEO_BITS_PER_PIXEL = 1.6  # A picture; phones spend 0.3 with better codecs.
KEY_EVERY = 12  # Pictures; any of them is reached after decoding half a second at most.
SHUTTER = 0.1  # Exposure time as a share of the frame interval.
MOMENTS = 4  # Rays of a pixel, each at its own moment.


@dataclass(frozen=True, eq=False)
class CameraTrack:
    """The position and viewing direction of the camera at F moments, interpolated in between."""

    eyes_m: np.ndarray  # float64 [F, 3]
    angles: np.ndarray  # float64 [F, 2], yaw (it may exceed a full turn) and pitch in radians

    def pose(self, moment: float) -> np.ndarray:
        """Return ``camera_to_room``, float64 [4, 4], at a moment, clipped to the ends of the track.

        Args:
            moment: Index of the moment, starting from 0. Fractions are interpolated.
        """
        low = int(np.clip(np.floor(moment), 0, max(len(self.eyes_m) - 2, 0)))
        high = min(low + 1, len(self.eyes_m) - 1)
        part = float(np.clip(moment - low, 0, 1))
        eye = (1 - part) * self.eyes_m[low] + part * self.eyes_m[high]
        yaw, pitch = (1 - part) * self.angles[low] + part * self.angles[high]
        ahead = [np.cos(yaw) * np.cos(pitch), np.sin(yaw) * np.cos(pitch), np.sin(pitch)]
        return look_at(eye, eye + np.array(ahead))


def plan_camera_track(
    room: Room,
    scene: VoxelScene,
    camera: Camera,
    pictures: int,
    rng: np.random.Generator,
    *,
    smooth: bool,
) -> CameraTrack:
    """Plan the camera track of a tour through a room.

    Args:
        room: The room or house.
        scene: The result of ``prepare_voxels`` for the labels of the room.
        camera: The camera, whose field of view is used.
        pictures: Number of images, spread evenly over the duration of the tour.
        rng: Random generator for the entrance door and the eye height.
        smooth: Whether to smooth the track for a video. Photos are taken one by one.
    """
    walk = plan_walk(room, pictures, rng)
    eyes = camera_positions_m(walk.feet_m, rng)
    every = LOOK_PICTURES if smooth else LOOK_PHOTOS
    looks = np.unique(np.append(np.arange(0, pictures, every), pictures - 1))
    planner = ViewPlanner(scene, camera, walk.pace_m * every, (LOOK_TURN[0], LOOK_TURN[1]))
    seen = np.array([planner.next_direction(eyes[n]) for n in looks])
    seen[:, 0] = np.unwrap(seen[:, 0])
    angles = np.column_stack([np.interp(np.arange(pictures), looks, seen[:, n]) for n in (0, 1)])
    if smooth:
        eyes, angles = (
            ndimage.gaussian_filter1d(track, SMOOTH_PICTURES, axis=0, mode="nearest")
            for track in (eyes, angles)
        )
    return CameraTrack(eyes, angles)


def phone_shots(room: Room, how: ScanSettings) -> Iterator[Shot]:
    """Yield the images of a phone's scan one at a time, in the order of the tour."""
    scene = prepare_textured(room)
    rng = np.random.default_rng([how.seed, 1])
    video = how.sensor == "video"
    film = plan_camera_track(room, scene.photos.scene, how.camera, how.planned, rng, smooth=video)
    to_scan = room_to_scan(how.seed)
    return (_shot(scene, how, film, to_scan, number) for number in range(how.taken))


def _shot(
    scene: TexturedScene, how: ScanSettings, film: CameraTrack, to_scan: np.ndarray, number: int
) -> Shot:
    video = how.sensor == "video"
    true = film.pose(number)
    during = true[None]
    if video:  # The shutter is open for a while, and the pose is that of its middle.
        off = (np.arange(MOMENTS) - (MOMENTS - 1) / 2) * SHUTTER / MOMENTS
        during = np.array([film.pose(number + part) for part in off])
    rng = np.random.default_rng([how.seed, 3, number])
    light = expose(scene, how.camera, during)
    colour = develop(light, rng, drift=0.0 if video else 1.0)
    name = f"frame-{number:06d}"
    view = View(name, to_scan @ true, colour=colour, colour_camera=how.camera)
    return Shot(view, FrameTruth(name, true, 1.0))


def write_photos(folder: str | Path, views: Iterable[View]) -> None:
    """Write the colour images of views as JPEG photos without camera metadata.

    Raises:
        OutputError: If the folder cannot be written.
    """
    for view in views:
        photo = image_bytes(Image.fromarray(_colour(view)), "JPEG", quality=PHOTO_QUALITY)
        write_bytes(Path(folder) / f"{view.name}.jpg", photo)


def write_video(path: str | Path, views: Iterable[View]) -> None:
    """Write the colour images of views as a video with 24 frames per second.

    The same views always give the same bytes.

    Args:
        path: The ``.mp4`` file to write. Its folder is created if it does not exist.
        views: One or more views of the same size, with an even width and height.

    Raises:
        OutputError: If the file cannot be written.
        MissingExtraError: If ``av`` is not installed.
    """
    try:
        import av  # noqa: PLC0415
    except ImportError as error:
        raise MissingExtraError("writing videos", "capture") from error
    buffer = io.BytesIO()
    options = {"fflags": "+bitexact"}  # No version of the writer in the file.
    with av.open(buffer, "w", format="mp4", options=options) as container:
        stream: Any = None
        for view in views:
            colour = _colour(view)
            if stream is None:
                stream = _stream(container, colour.shape[1], colour.shape[0])
            frame = av.VideoFrame.from_ndarray(colour, format="rgb24")
            container.mux(stream.encode(frame))
        container.mux(stream.encode(None))
    write_bytes(Path(path), buffer.getvalue())


def _stream(container: Any, width: int, height: int) -> Any:
    stream = container.add_stream("mpeg4", rate=RATE_HZ)
    stream.width, stream.height, stream.pix_fmt = width, height, "yuv420p"
    stream.codec_context.thread_count = 1  # Slices would depend on the number of threads.
    stream.codec_context.gop_size = KEY_EVERY
    stream.codec_context.max_b_frames = 0
    stream.bit_rate = int(VIDEO_BITS_PER_PIXEL * width * height * RATE_HZ)
    stream.codec_context.flags |= 1 << 23  # bitexact
    return stream


def _colour(view: View) -> np.ndarray:
    if view.colour is None:
        raise ValueError(f"view {view.name} has no colour image")
    return np.ascontiguousarray(view.colour)
