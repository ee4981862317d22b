"""The photos of a capture as a stream, at the resolution used to compute poses and depth.

Photos are decoded on each access, so that a capture is never completely in memory.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field

from world2minecraft.capture.images import ImagePlace, downscale, read_colour
from world2minecraft.capture.source_types import FrameFiles
from world2minecraft.capture.validation import ValidatedCapture
from world2minecraft.core.errors import DamagedFileError, InputError
from world2minecraft.core.types import Photo

# Features of a 12-megapixel photo are found as well at this size, 16 times faster.
MAX_SIDE_PX = 1024


@dataclass(eq=False, repr=False)
class CapturePhotos:
    """The photos of a capture, read from disk one at a time in frame order.

    Attributes:
        frames: The frames; all have a colour image.
        lens: Whether the intrinsics are ``stated`` or a ``guess``, as in ``Capture``.
        longest_px: Maximum length of the longer image side in pixels.
        damaged: Reasons by name of the frames that could not be decoded, which iteration skips.
    """

    frames: tuple[FrameFiles, ...]
    lens: str = "stated"
    longest_px: int = MAX_SIDE_PX
    damaged: dict[str, str] = field(default_factory=dict)

    def __len__(self) -> int:
        """Return the number of frames, including frames that may fail to decode."""
        return len(self.frames)

    def __iter__(self) -> Iterator[Photo]:
        """Read the photos from the start."""
        for frame in self.frames:
            try:
                photo = read_photo(frame, self.lens, self.longest_px)
            except InputError as error:
                self.damaged[frame.name] = str(error)
                continue
            yield photo


def photos_of_capture(validated: ValidatedCapture, longest_px: int = MAX_SIDE_PX) -> CapturePhotos:
    """Return the photos of a validated capture: the usable frames that have a colour image."""
    frames = tuple(frame for frame in validated.frames if frame.colour_path is not None)
    return CapturePhotos(frames, validated.capture.lens, longest_px)


def read_photo(frame: FrameFiles, lens: str = "stated", longest_px: int = MAX_SIDE_PX) -> Photo:
    """Decode the colour image of a frame, and downscale the image and its camera if necessary.

    Args:
        frame: A frame with a colour image.
        lens: Whether its intrinsics are ``stated`` or a ``guess``.
        longest_px: Maximum length of the longer image side in pixels.

    Raises:
        InputError: If the image cannot be decoded, or does not match its intrinsics.
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
            frame.rig,
        )
    except ValueError as error:
        raise DamagedFileError(place, str(error)) from error
