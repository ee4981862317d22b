"""A video of a walk through a room becomes photos: sharp ones, well apart.

``motion`` looks through the video once at low resolution; here pictures are chosen from what it
found. They are decoded when they are read, upright, in the order of the video.
"""

from typing import Any

from world2minecraft.capture.alignment.image_rotation import TurnedImage
from world2minecraft.capture.frames import Capture, FrameFiles
from world2minecraft.capture.images import MAX_PIXELS, ImagePlace
from world2minecraft.capture.options import LEAST_FRAMES, ScanOptions
from world2minecraft.capture.poster_marker import lies_about
from world2minecraft.capture.readers.apps.video_frames import MoviePicture, open_movie
from world2minecraft.capture.readers.motion import VideoLook, look_through, picked
from world2minecraft.capture.readers.photo_orientation import DIAGONAL_MM
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.errors import CaptureError, DamagedFileError, LimitError
from world2minecraft.core.types import Camera

SUFFIXES = (".mov", ".mp4", ".m4v", ".webm", ".avi", ".mkv")
DEFAULT_FRAMES = 100  # Of one room; more cost time and tell little new.
FOCAL_KEYS = ("com.apple.quicktime.camera.focal_length.35mm_equivalent",)
_IMAGES = (".jpg", ".jpeg", ".png", ".heic", ".heif", ".webp", ".npy", ".tif", ".tiff")


class VideoSource:
    """Reads a video, or a folder with one video and no pictures."""

    layout = "a video (.mov, .mp4, .m4v, .webm, .avi, .mkv)"

    def recognise(self, folder: AnyPath) -> bool:
        """Return whether it is a video or a folder with just one."""
        return _video_in(folder) is not None

    def read(self, folder: AnyPath) -> Capture:
        """Choose pictures of the video. Raises CaptureError as ``Source.read`` says."""
        return self.read_with(folder, ScanOptions())

    def read_with(self, folder: AnyPath, options: ScanOptions) -> Capture:
        """Choose as many pictures as are wanted at most."""
        path = _video_in(folder)
        if path is None:
            raise CaptureError(folder, "holds no video, or several; give one by its own name")
        if path.stat().st_size == 0:
            raise DamagedFileError(path, "is empty; copy it again")
        look = look_through(path)
        _check(path, look)
        wanted = DEFAULT_FRAMES if options.frames is None else options.frames
        chosen = picked(look, wanted)
        if len(chosen) < LEAST_FRAMES:
            places = f"{len(chosen)} place" + "s" * (len(chosen) != 1)
            raise CaptureError(
                path,
                f"shows only {places}: the camera hardly moves "
                f"in its {look.duration_s:.0f} s; film while walking sideways through the room",
            )
        frames = _frames(path, look, chosen)
        return Capture(
            folder, "video", frames, notes=_notes(look, frames), lens="guess", scale="unknown"
        )


def _video_in(place: AnyPath) -> AnyPath | None:
    """Return the video that a place is or holds; None where there are several or photos."""
    if place.is_file():
        return place if place.suffix.lower() in SUFFIXES else None
    if not place.is_dir():
        return None
    held = [path for path in place.iterdir() if not path.name.startswith(".")]
    if any(path.suffix.lower() in _IMAGES and not lies_about(path) for path in held):
        return None
    videos = [path for path in held if path.suffix.lower() in SUFFIXES and path.is_file()]
    return videos[0] if len(videos) == 1 else None


def _check(path: AnyPath, look: VideoLook) -> None:
    """Refuse a video that cannot be used.

    Raises:
        LimitError: its pictures are too large. DamagedFileError: it ends early.
    """
    width, height = look.size
    if width * height > MAX_PIXELS:
        raise LimitError(
            path,
            f"has pictures of {width}x{height}; at most 64 megapixels are read: make it smaller",
        )
    if not len(look.times):
        raise DamagedFileError(path, "has no picture that can be decoded; copy it again")
    # A stated length of seconds more than what is there: the copy broke off.
    if look.stated_s > look.duration_s + 2.0 + 0.1 * look.stated_s:
        raise DamagedFileError(
            path,
            f"is cut short: {look.duration_s:.1f} s of its {look.stated_s:.1f} s are there; "
            "copy it again",
        )


def _frames(path: AnyPath, look: VideoLook, chosen: list[int]) -> tuple[FrameFiles, ...]:
    numbers = {time: number for number, time in enumerate(open_movie(path).times)}
    camera = _camera(look)
    frames = []
    for index in chosen:
        number = numbers.get(int(look.times[index]))
        if number is None:
            continue
        image: ImagePlace = MoviePicture(path, number)
        if look.quarter_turns:
            image = TurnedImage(image, look.quarter_turns)
        time_s = float(look.times[index] * look.tick_s)
        frames.append(
            FrameFiles(f"frame-{number:06d}", None, image, camera, time_s=round(time_s, 6))
        )
    return tuple(frames)


def _camera(look: VideoLook) -> Camera | None:
    """Return a first guess of the lens where the phone wrote it down."""
    width, height = look.size if look.quarter_turns % 2 == 0 else look.size[::-1]
    focal_mm = _focal_35mm(look.metadata)
    if focal_mm is None:
        return None
    focal_px = focal_mm / DIAGONAL_MM * (width**2 + height**2) ** 0.5
    return Camera(width, height, focal_px, focal_px, width / 2, height / 2)


def _focal_35mm(metadata: dict[str, Any]) -> float | None:
    for key in FOCAL_KEYS:
        try:
            value = float(metadata.get(key, "nan"))
        except ValueError:
            continue
        if 8 <= value <= 600:
            return value
    return None


def _notes(look: VideoLook, frames: tuple[FrameFiles, ...]) -> tuple[str, ...]:
    notes = [
        f"{len(frames)} of the video's {len(look.times):,} pictures are taken: sharp ones, well "
        f"apart ({look.duration_s:.0f} s, {look.size[0]}x{look.size[1]})"
    ]
    if look.quarter_turns:
        notes.append("the pictures are turned upright, as the video says")
    if not look.whole:
        notes.append("the video breaks off; what comes before is used")
    return tuple(notes)
