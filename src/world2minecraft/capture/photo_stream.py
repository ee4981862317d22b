"""The photos of a capture as a stream, at the size that poses and depth are computed at.

Input are validated frames, output is a ``PhotoStream``. Each photo is decoded when its turn comes
and again the next time, so that a capture is never in memory as a whole.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from PIL import Image

from world2minecraft.capture.images import ImagePlace, read_colour
from world2minecraft.capture.source_types import FrameFiles
from world2minecraft.capture.validation import ValidatedCapture
from world2minecraft.core.errors import DamagedFileError, InputError
from world2minecraft.core.types import Photo

# Features of a 12-megapixel photo are found as well at this size, 16 times faster.
MAX_SIDE_PX = 1024


@dataclass(eq=False, repr=False)
class CapturePhotos:
    """Photos read from disk one at a time, in the order of the frames.

    ``frames`` all have a colour image. ``lens`` is that of the ``Capture``. ``damaged`` maps the
    names of frames that could not be decoded to the reason; they are left out while iterating,
    and listed here.
    """

    frames: tuple[FrameFiles, ...]
    lens: str = "stated"
    longest_px: int = MAX_SIDE_PX
    damaged: dict[str, str] = field(default_factory=dict)

    def __len__(self) -> int:
        """The number of frames, those that turn out damaged while decoding included."""
        return len(self.frames)

    def __iter__(self) -> Iterator[Photo]:
        """Read the photos from the first."""
        for frame in self.frames:
            try:
                photo = read_photo(frame, self.lens, self.longest_px)
            except InputError as error:
                self.damaged[frame.name] = str(error)
                continue
            yield photo


def photos_of_capture(validated: ValidatedCapture, longest_px: int = MAX_SIDE_PX) -> CapturePhotos:
    """Return the photos of a validated capture: its usable frames that have a colour image."""
    frames = tuple(frame for frame in validated.frames if frame.colour_path is not None)
    return CapturePhotos(frames, validated.capture.lens, longest_px)


def read_photo(frame: FrameFiles, lens: str = "stated", longest_px: int = MAX_SIDE_PX) -> Photo:
    """Decode the colour image of a frame, and make it and its camera smaller where it is large.

    Args:
        frame: with a colour image.
        lens: whether its camera is ``stated`` or a ``guess``.
        longest_px: the longer side that it has at most.

    Raises:
        InputError: the image cannot be decoded, or its camera speaks of another one.
    """
    place: ImagePlace | None = frame.colour_path
    if place is None:
        raise DamagedFileError(frame.name, "has no colour image")
    colour = downscale(read_colour(place), longest_px)
    camera = frame.colour_camera
    try:
        if camera is not None:
            camera = camera.resized(colour.shape[1], colour.shape[0])
        return Photo(
            frame.name,
            colour,
            camera,
            camera is not None and lens == "guess",
            frame.camera_to_world,
        )
    except ValueError as error:
        raise DamagedFileError(place, str(error)) from error


def downscale(colour: np.ndarray, longest_px: int) -> np.ndarray:
    """Return a picture of at most ``longest_px`` on its longer side.

    Args:
        colour: uint8 [H, W, 3].
        longest_px: above 0. Smaller pictures stay as they are.

    Returns:
        uint8 [h, w, 3]; each pixel is the mean over its own footprint, so that nothing aliases.
    """
    height, width = colour.shape[:2]
    share = longest_px / max(height, width)
    if share >= 1:
        return colour
    size = (max(1, round(width * share)), max(1, round(height * share)))
    return np.array(Image.fromarray(colour).resize(size, Image.Resampling.BOX), np.uint8)
