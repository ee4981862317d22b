"""Reader of a single photo, for example from a phone or a property listing.

The field of view is set by the user, or read from EXIF data, or a common default. The photo has no
pose. The camera height is derived from estimated depth or assumed to be eye level.
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
DEFAULT_FOCAL = 0.8  # Focal length / longer side; phones have 0.7 to 0.9.


class SinglePhotoSource:
    """A reader of single photos."""

    layout = "one photo (.jpg, .png, .heic, .webp)"

    def recognise(self, folder: AnyPath) -> bool:
        """Return whether the path is a file with the suffix of a photo."""
        return folder.is_file() and folder.suffix.lower() in PHOTO_SUFFIXES

    def read(self, folder: AnyPath) -> Capture:
        """Read a photo with default options.

        Raises:
            InputError: If the photo cannot be read.
        """
        return self.read_with(folder, ScanOptions())

    def read_with(self, folder: AnyPath, options: ScanOptions) -> Capture:
        """Read a photo, with the field of view in ``options`` if it is set.

        Raises:
            InputError: If the photo cannot be read.
        """
        camera, note = _lens(read_photo_metadata(folder), options.fov_deg)
        name = re.sub(r"[^A-Za-z0-9_.-]+", "_", folder.stem).lstrip(".-")[:80] or "photo"
        frame = FrameFiles(name, None, UprightPhoto(folder), camera)
        return Capture(folder, SOURCE, (frame,), notes=(note,), lens="guess", scale="unknown")


def _lens(facts: PhotoMetadata, fov_deg: float | None) -> tuple[Camera, str]:
    wide, high = facts.width_px, facts.height_px
    if fov_deg is not None:
        focal_px = focal_px_of_fov(high, fov_deg)
        note = f"the vertical field of view is {fov_deg:g} degrees, as set"
    elif facts.camera is not None:
        return facts.camera, "the intrinsics are estimated from EXIF data"
    else:
        focal_px = DEFAULT_FOCAL * max(wide, high)
        note = (
            "the photo contains no lens data; using a common field of view, set --fov to change it"
        )
    return Camera(wide, high, focal_px, focal_px, wide / 2, high / 2), note
