"""The photos of a run, with their camera poses in the room, undistorted for a pinhole camera.

The page receives images of a camera without distortion, with square pixels and a centred principal
point, so that a view of the room from the same pose and with the same vertical field of view
matches the photo exactly. Images are decoded on demand.
"""

import threading
from collections import OrderedDict
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from world2minecraft.capture.depth_images import DepthEncoding, read_depth
from world2minecraft.capture.images import read_colour, read_small
from world2minecraft.capture.source_types import FrameFiles
from world2minecraft.core.errors import InputError, UnknownNameError, UsageError
from world2minecraft.core.files import image_bytes
from world2minecraft.core.types import Camera
from world2minecraft.evaluation.report.placed_frames import judge_capture_of, placed_frames, used_by
from world2minecraft.evaluation.scoring.used_frames import computed
from world2minecraft.geometry.undistort import undistort_image

MAX_SIDE_PX, SMALL_PX = 1280, 200
CACHE_BYTES = 48 << 20  # Cache of a few hundred decoded images.
QUALITY = 84


@dataclass(frozen=True, eq=False)
class PlacedPhoto:
    """A photo with its ``camera_to_room`` float64 [4, 4] (OpenCV axes) and its pinhole camera."""

    frame: FrameFiles
    camera_to_room: np.ndarray
    camera: Camera
    ideal: Camera

    def as_json(self, number: int) -> dict[str, Any]:
        """Return the description of the photo for the page."""
        height = self.ideal.height_px
        return {
            "n": number,
            "name": self.frame.name,
            "camera_to_room": self.camera_to_room.tolist(),
            "vertical_fov_deg": float(np.degrees(2 * np.arctan(height / 2 / self.ideal.fy_px))),
            "aspect": self.ideal.width_px / height,
            "is_depth": self.frame.colour_path is None,
        }


@dataclass(eq=False)
class RunPhotos:
    """The photos of one run. Any thread may request images, and one image is decoded at a time."""

    photos: tuple[PlacedPhoto, ...]
    encoding: DepthEncoding
    _made: "OrderedDict[tuple[int, bool], bytes]" = field(default_factory=OrderedDict)
    _lock: threading.Lock = field(default_factory=threading.Lock)

    def as_json(self) -> list[dict[str, Any]]:
        """Return the descriptions of all photos for the page, in order."""
        return [photo.as_json(number) for number, photo in enumerate(self.photos)]

    def photo(self, number: int) -> PlacedPhoto:
        """Return a photo by its number.

        Raises:
            UnknownNameError: If no photo has this number.
        """
        if not 0 <= number < len(self.photos):
            raise UnknownNameError("photo", str(number), map(str, range(min(3, len(self.photos)))))
        return self.photos[number]

    def jpeg(self, number: int, small: bool) -> bytes:
        """Return the undistorted photo or its thumbnail as JPEG.

        Raises:
            UnknownNameError: If no photo has this number.
            InputError: If the photo cannot be decoded.
        """
        photo = self.photo(number)
        with self._lock:
            key = (number, small)
            if key not in self._made:
                image = Image.fromarray(self._pixels(photo, small))
                self._keep(key, image_bytes(image, "JPEG", quality=QUALITY))
            self._made.move_to_end(key)
            return self._made[key]

    def _pixels(self, photo: PlacedPhoto, small: bool) -> np.ndarray:
        place = photo.frame.colour_path
        if place is None:
            return _depth_picture(photo.frame, self.encoding, SMALL_PX if small else MAX_SIDE_PX)
        if small:
            return read_small(place, SMALL_PX)
        return undistort_image(read_colour(place), photo.camera, photo.ideal)

    def _keep(self, key: tuple[int, bool], data: bytes) -> None:
        self._made[key] = data
        while len(self._made) > 1 and sum(map(len, self._made.values())) > CACHE_BYTES:
            self._made.popitem(last=False)


def read_photos(run: Path, capture: Path, scan_to_room: np.ndarray) -> RunPhotos:
    """Return the photos that a run used, with poses in the room's frame.

    Args:
        run: Run folder. Its ``poses.npz`` contains the corrected poses.
        capture: Path of the reconstructed capture.
        scan_to_room: Transform from the scan's frame to the room's frame, float64 [4, 4].

    Raises:
        CaptureError: If the capture cannot be read.
        UsageError: If none of its frames was used by this run.
    """
    judged = judge_capture_of(run, capture)
    photos = tuple(
        PlacedPhoto(one.frame, one.camera_to_room, one.camera, ideal_camera(one.camera))
        for one in placed_frames(run, judged, scan_to_room)
    )
    if not photos:
        raise UsageError(f"{capture.name} contains no photo of this run")
    return RunPhotos(photos, judged.encoding)


def find_capture_of(run: Path, given: Path | None) -> Path:
    """Return the path of the capture with the photos of a run.

    Args:
        run: Run folder.
        given: Path of the capture as given by the user, if any.

    Raises:
        UsageError: If neither the user nor the run folder gives the path of the capture.
    """
    own = computed(run)
    if own is not None:
        return own
    if given is not None:
        return given
    raise UsageError(
        f"{run.name} does not record where its photos are; run w2m forge {run.name} "
        "--capture PATH_OF_THE_CAPTURE"
    )


def count_photos(run: Path, capture: Path | None) -> int:
    """Return the number of photos that a run used, or 0 if the photos cannot be found.

    The images themselves are not read.
    """
    try:
        find_capture_of(run, capture)
    except UsageError:
        return 0
    return len(used_by(run))


def ideal_camera(camera: Camera, longest_px: int = MAX_SIDE_PX) -> Camera:
    """Return the pinhole camera that sees the largest part of an image around its principal point.

    Args:
        camera: Camera of the image, with any distortion.
        longest_px: Maximum length in pixels of the result's longer side. Smaller images are not
            enlarged.

    Returns:
        A camera without distortion, with one focal length and a centred principal point.
    """
    half_x = max(min(camera.cx_px, camera.width_px - camera.cx_px), 1.0)
    half_y = max(min(camera.cy_px, camera.height_px - camera.cy_px), 1.0)
    tall = half_y * camera.fx_px / camera.fy_px  # In pixels as wide as the picture's.
    scale = min(1.0, longest_px / (2 * max(half_x, tall)))
    width, height = max(round(2 * half_x * scale), 2), max(round(2 * tall * scale), 2)
    focal = camera.fx_px * scale
    return Camera(width, height, focal, focal, width / 2, height / 2)


def _depth_picture(frame: FrameFiles, encoding: DepthEncoding, longest_px: int) -> np.ndarray:
    """Return a depth image for captures without colour: near is light, holes are black."""
    if frame.depth_path is None:
        raise InputError(frame.name, "frame has neither a colour image nor a depth image")
    depth = read_depth(frame.depth_path, encoding)
    seen = depth > 0
    far = float(np.percentile(depth[seen], 98)) if seen.any() else 1.0
    grey = np.where(seen, 255 - 215 * np.clip(depth / max(far, 1e-6), 0, 1), 0).astype(np.uint8)
    image = Image.fromarray(grey).convert("RGB")
    image.thumbnail((longest_px, longest_px))
    return np.array(image, np.uint8)
