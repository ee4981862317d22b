"""Reader of one photo, such as a phone takes or a listing shows.

Its lens is what the user states, else what EXIF states, else a usual one. It has no pose: the
camera's place comes from depth by a network, or is that of a person's eye.
"""

import re

from world2minecraft.capture.options import ScanOptions
from world2minecraft.capture.readers.photo_exif import (
    PhotoMetadata,
    UprightPhoto,
    read_photo_metadata,
)
from world2minecraft.capture.readers.photo_folder import PHOTO_SUFFIXES
from world2minecraft.capture.source_types import Capture, FrameFiles
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.coordinates import focal_px_of_fov
from world2minecraft.core.types import Camera

SOURCE = "photo"
DEFAULT_FOCAL = 0.8  # Of the longer side: phones 0.7 to 0.9.


class SinglePhotoSource:
    """Reads one photo."""

    layout = "one photo (.jpg, .png, .heic, .webp)"

    def recognise(self, folder: AnyPath) -> bool:
        """Return whether it is the file of a photo, by its name."""
        return folder.is_file() and folder.suffix.lower() in PHOTO_SUFFIXES

    def read(self, folder: AnyPath) -> Capture:
        """List the photo. Raises CaptureError as ``Source.read`` does."""
        return self.read_with(folder, ScanOptions())

    def read_with(self, folder: AnyPath, options: ScanOptions) -> Capture:
        """List the photo, its lens as the user states it."""
        camera, note = _lens(read_photo_metadata(folder), options.fov_deg)
        name = re.sub(r"[^A-Za-z0-9_.-]+", "_", folder.stem).lstrip(".-")[:80] or "photo"
        frame = FrameFiles(name, None, UprightPhoto(folder), camera)
        return Capture(folder, SOURCE, (frame,), notes=(note,), lens="guess", scale="unknown")


def _lens(facts: PhotoMetadata, fov_deg: float | None) -> tuple[Camera, str]:
    wide, high = facts.width_px, facts.height_px
    if fov_deg is not None:
        focal_px = focal_px_of_fov(high, fov_deg)
        note = f"the photo's field of view is taken as {fov_deg:g} degrees high, as told"
    elif facts.camera is not None:
        return facts.camera, "the photo's lens is as its EXIF says"
    else:
        focal_px = DEFAULT_FOCAL * max(wide, high)
        note = "the photo says nothing of its lens; a usual one is taken: --fov tells another"
    return Camera(wide, high, focal_px, focal_px, wide / 2, high / 2), note
