"""The classes in the photos of a run, predicted on demand and drawn over the photos."""

import threading
from collections import OrderedDict

import numpy as np
from PIL import Image

from world2minecraft.capture.depth_images import read_depth
from world2minecraft.capture.images import read_colour
from world2minecraft.core.errors import InputError
from world2minecraft.core.files import image_bytes
from world2minecraft.core.types import View
from world2minecraft.geometry.undistort import undistort_image
from world2minecraft.reconstruction.recognition.label_images import (
    PixelClassifier,
    blend_classes,
    segment_view,
    write_class_names,
)
from world2minecraft.reconstruction.recognition.segmentation import SegmentationModel
from world2minecraft.sceneforge.run_photos import QUALITY, PlacedPhoto, RunPhotos

MAX_CACHED = 24  # Images of about 200 kB.


class PhotoClasses:
    """The photos of one run in the colours of their classes, with the names of the classes.

    Any thread may request images, and one image is predicted at a time.
    """

    def __init__(self, photos: RunPhotos, model: PixelClassifier | None = None):
        self.photos = photos
        self.model = model or SegmentationModel()
        self._made: OrderedDict[int, bytes] = OrderedDict()
        self._lock = threading.Lock()

    def jpeg(self, number: int) -> bytes:
        """Return an undistorted photo in the colours of its classes as JPEG.

        Raises:
            UnknownNameError: If no photo has this number.
            InputError: If the photo has no colours or cannot be decoded.
        """
        photo = self.photos.photo(number)
        with self._lock:
            if number not in self._made:
                self._made[number] = self._draw(photo)
                if len(self._made) > MAX_CACHED:
                    self._made.popitem(last=False)
            self._made.move_to_end(number)
            return self._made[number]

    def _draw(self, photo: PlacedPhoto) -> bytes:
        view = self._view(photo)
        up, height_m = photo.camera_to_room[2, :3], float(photo.camera_to_room[2, 3])
        ids = segment_view(self.model, view, up=up, camera_height_m=height_m)
        image = Image.fromarray(blend_classes(np.asarray(view.colour), ids))
        write_class_names(image, ids)
        return image_bytes(image, "JPEG", quality=QUALITY)

    def _view(self, photo: PlacedPhoto) -> View:
        """Return the undistorted photo with the depth of its frame as a view."""
        frame = photo.frame
        if frame.colour_path is None:
            raise InputError(frame.name, "frame has no colour image, so its classes are not shown")
        colour = undistort_image(read_colour(frame.colour_path), photo.camera, photo.ideal)
        depth_m = None
        if frame.depth_path is not None and frame.depth_camera is not None:
            depth_m = read_depth(frame.depth_path, self.photos.encoding)
        return View(
            frame.name,
            photo.camera_to_room,
            colour,
            photo.ideal,
            depth_m,
            None if depth_m is None else frame.depth_camera,
            frame.depth_to_colour,
        )
