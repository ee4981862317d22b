"""Reader of a video of a walk through a room: selects sharp, well separated frames.

One pass over the video at low resolution measures motion and sharpness. Motion is the shift of
blocks of the picture against the last reference picture, by phase correlation: it sees walking,
turning and coming nearer alike, and a hand's shake does not add up. Sharpness is the strength of
fine edges. Selected frames are decoded when they are read, upright, in the order of the video.
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from scipy import fft

from world2minecraft.capture.alignment.image_rotation import RotatedImage
from world2minecraft.capture.images import MAX_PIXELS, ImagePlace
from world2minecraft.capture.options import MIN_FRAMES, ScanOptions
from world2minecraft.capture.poster_detection import is_saved_poster
from world2minecraft.capture.readers.apps.video_frames import VideoFrame, open_video
from world2minecraft.capture.readers.photo_exif import DIAGONAL_MM
from world2minecraft.capture.source_types import Capture, FrameFiles
from world2minecraft.core.archives import AnyPath, ArchivePath
from world2minecraft.core.errors import (
    CaptureError,
    DamagedFileError,
    InputError,
    LimitError,
    MissingExtraError,
    reason_of,
)
from world2minecraft.core.types import Camera

SMALL_PX = 192  # The longer side of the small pictures.
BLOCK = 48  # The side of a block of them; shifts of up to half of it are seen.
MIN_PEAK = 0.045  # Correlation under it is chance: a bare wall, or another scene.
MIN_MOTION = 0.04  # Of the longer side: less than this is a shaking hand.
FRAME_STEP = 0.12  # Of the longer side, from one picture taken to the next: seven eighths overlap.
SEARCH_STEPS = 0.4  # How far from its place, in steps, the sharpest picture is looked for.
MAX_SECONDS = 3600.0
SHARP_ROWS = 6  # Each sixth row tells the sharpness.
SUFFIXES = (".mov", ".mp4", ".m4v", ".webm", ".avi", ".mkv")
DEFAULT_FRAMES = 100  # Of one room; more cost time and tell little new.
FOCAL_KEYS = ("com.apple.quicktime.camera.focal_length.35mm_equivalent",)
_IMAGE_SUFFIXES = (".jpg", ".jpeg", ".png", ".heic", ".heif", ".webp", ".npy", ".tif", ".tiff")


@dataclass(frozen=True, eq=False)
class VideoAnalysis:
    """What one pass over a video found, a value for each of its N pictures.

    ``times`` int64 [N] in ticks of ``tick_s``, ascending; ``path`` float64 [N] is how far the view
    has moved since the start, in shares of the longer side; ``sharpness`` float64 [N]. ``stated_s``
    is the length that the file states, 0 where it does not; ``whole`` is false where decoding
    broke off. ``quarter_turns`` turn its pictures upright, counter-clockwise.
    """

    size: tuple[int, int]
    times: np.ndarray
    tick_s: float
    path: np.ndarray
    sharpness: np.ndarray
    stated_s: float
    quarter_turns: int
    metadata: dict[str, Any]
    whole: bool

    @property
    def duration_s(self) -> float:
        """From the first picture to the last, and one more."""
        count = len(self.times)
        if count < 2:
            return 0.0
        return float((self.times[-1] - self.times[0]) * self.tick_s * count / (count - 1))


def analyse_video(path: AnyPath) -> VideoAnalysis:
    """Decode a video once, at low resolution; what was found is kept until its file changes.

    Raises:
        DamagedFileError: it is no video, holds no pictures or only sound. LimitError: its pictures
            are too large, or it is over an hour long. InputError: it is missing.
        MissingExtraError: ``av`` is not installed.
    """
    try:
        found = (path.path if isinstance(path, ArchivePath) else path).stat()
    except OSError as error:
        raise InputError(path, f"cannot be read: {error.strerror or error}") from error
    return _analyse(path, (found.st_size, found.st_mtime_ns))


@lru_cache(maxsize=4)
def _analyse(path: AnyPath, stamp: tuple[int, int]) -> VideoAnalysis:
    try:
        import av  # noqa: PLC0415
        from av.error import FFmpegError  # noqa: PLC0415
    except ImportError as error:
        raise MissingExtraError("reading videos", "capture") from error
    failures = (FFmpegError, ValueError, IndexError, OSError)
    try:
        with path.open("rb") as file, av.open(file, "r") as container:
            return _analyse_container(path, container, failures)
    except InputError:
        raise
    except failures as error:
        reason = reason_of(error, 80)
        raise DamagedFileError(path, f"is no whole video ({reason}); copy it again") from error


def _analyse_container(
    path: AnyPath, container: Any, failures: tuple[type[Exception], ...]
) -> VideoAnalysis:
    if not container.streams.video:
        kind = "sound only" if container.streams.audio else "no video"
        raise DamagedFileError(path, f"holds {kind}; give a video of the room")
    stream = container.streams.video[0]
    size = (stream.codec_context.width, stream.codec_context.height)
    if not 0 < size[0] * size[1] <= MAX_PIXELS:
        raise LimitError(
            path,
            f"has pictures of {size[0]}x{size[1]}; at most 64 megapixels are read: make it smaller",
        )
    stated_s = (container.duration or 0) / 1e6  # Some containers state it for the whole alone.
    if stream.duration:
        stated_s = float(stream.duration * stream.time_base)
    if stated_s > MAX_SECONDS:
        raise LimitError(path, f"is {stated_s / 60:.0f} minutes long; at most 60 are read: cut it")
    stream.thread_type = "AUTO"  # The pictures are the same on any number of threads.
    times: list[int] = []
    sharpness: list[float] = []
    follower, turns, whole = _MotionTracker(), 0, True
    try:
        for frame in container.decode(stream):
            if frame.pts is None or (times and frame.pts <= times[-1]):
                continue
            light = _luma(frame)
            turns = turns if times else round(getattr(frame, "rotation", 0) / 90) % 4
            times.append(frame.pts)
            sharpness.append(_sharpness(light))
            follower.add(_downscale(light))
    except failures:
        if not times:
            raise
        whole = False
    metadata = {**container.metadata, **stream.metadata}
    return VideoAnalysis(
        size, np.array(times, np.int64), float(stream.time_base), np.array(follower.path),
        np.array(sharpness), stated_s, turns, metadata, whole,
    )  # fmt: skip


def _luma(frame: Any) -> np.ndarray:
    """Return the brightness plane as it lies in memory, uint8 [H, W], without a copy if it can."""
    kind = frame.format
    if not kind.name.startswith(("yuv", "gray", "nv12", "nv21")) or kind.components[0].bits > 8:
        frame = frame.reformat(format="gray")
    plane = frame.planes[0]
    rows = np.frombuffer(plane, np.uint8).reshape(-1, plane.line_size)
    return rows[: frame.height, : frame.width]


def _sharpness(light: np.ndarray) -> float:
    """Return the mean square of the second differences along some rows."""
    rows = light[::SHARP_ROWS].astype(np.int16)
    bent = (rows[:, 2:] - 2 * rows[:, 1:-1] + rows[:, :-2]).astype(np.float32)
    return float((bent * bent).mean()) if bent.size else 0.0


def _downscale(light: np.ndarray) -> np.ndarray:
    """Return a picture of about ``SMALL_PX``: means along the rows, each n-th row."""
    step = max(1, max(light.shape) // SMALL_PX)
    height, width = (side // step * step for side in light.shape)
    rows = light[step // 2 : height : step, :width]
    return rows.reshape(len(rows), -1, step).mean(axis=2, dtype=np.float32)


class _MotionTracker:
    """Adds up how far the view has moved."""

    def __init__(self) -> None:
        self.path: list[float] = []
        self._gone = 0.0
        self._reference: np.ndarray | None = None

    def add(self, small: np.ndarray) -> None:
        """Take the next picture."""
        blocks = _block_spectra(small)
        if self._reference is None:
            self._reference = blocks
            self.path.append(0.0)
            return
        moved = block_shift(self._reference, blocks) / max(small.shape)
        last = self.path[-1]
        if moved > MIN_MOTION:
            self._gone = max(last, self._gone + moved)
            self._reference = blocks
            moved = 0.0
        self.path.append(max(last, self._gone + moved))


def _block_spectra(small: np.ndarray) -> np.ndarray:
    """Return the spectra of B blocks of a small picture, complex [B, BLOCK, BLOCK // 2 + 1]."""
    high, wide = (min(BLOCK, side) for side in small.shape)
    window = np.outer(np.hanning(high), np.hanning(wide)).astype(np.float32)
    tops = np.linspace(0, small.shape[0] - high, 3).astype(int)
    lefts = np.linspace(0, small.shape[1] - wide, 4).astype(int)
    blocks = np.stack([small[a : a + high, b : b + wide] for a in tops for b in lefts])
    blocks = (blocks - blocks.mean(axis=(1, 2), keepdims=True)) * window
    return np.asarray(fft.rfft2(blocks, (BLOCK, BLOCK)))


def block_shift(first: np.ndarray, second: np.ndarray) -> float:
    """Return by how many pixels blocks have moved between two pictures, the mean of those sure.

    Args:
        first: spectra of the blocks of one picture.
        second: of the other, of the same shape.

    Returns:
        The mean length of the shifts; half a block where no block is found again.
    """
    cross = second * np.conj(first)
    cross /= np.maximum(np.abs(cross), 1e-3)
    peaks = np.asarray(fft.irfft2(cross, (BLOCK, BLOCK))).reshape(len(first), -1)
    best = peaks.argmax(axis=1)
    sure = peaks[np.arange(len(peaks)), best] > MIN_PEAK
    marked = np.abs(first[:, 1:4, 1:4]).mean(axis=(1, 2)) > 40.0
    if not marked.any():
        return 0.0  # Nothing to see: a covered lens, a bare wall.
    if not (sure & marked).any():
        return BLOCK / 2
    v, u = np.divmod(best[sure & marked], BLOCK)
    v, u = ((axis + BLOCK // 2) % BLOCK - BLOCK // 2 for axis in (v, u))
    return float(np.hypot(v, u).mean())


def select_frames(analysis: VideoAnalysis, wanted: int) -> list[int]:
    """Return which pictures to take, ascending: a steady way apart, each the sharpest near by.

    Args:
        analysis: of the video.
        wanted: how many at most; a camera that moves little gives fewer.
    """
    way = float(analysis.path[-1]) if len(analysis.path) else 0.0
    count = min(wanted, int(way / FRAME_STEP) + 1, len(analysis.path))
    if count < 2:
        return [int(analysis.sharpness.argmax())] if len(analysis.path) else []
    step = way / (count - 1)
    chosen: list[int] = []
    for place in np.arange(count) * step:
        low = int(np.searchsorted(analysis.path, place - SEARCH_STEPS * step))
        high = int(np.searchsorted(analysis.path, place + SEARCH_STEPS * step, side="right"))
        near = np.arange(max(low, chosen[-1] + 1 if chosen else 0), high)
        if len(near):
            off = np.abs(analysis.path[near] - place) / step
            chosen.append(int(near[(analysis.sharpness[near] * (1 - 0.5 * off)).argmax()]))
    return chosen


class VideoSource:
    """Reads a video, or a folder with one video and no pictures."""

    layout = "a video (.mov, .mp4, .m4v, .webm, .avi, .mkv)"

    def recognise(self, folder: AnyPath) -> bool:
        """Return whether it is a video or a folder with just one."""
        return _video_in(folder) is not None

    def read(self, folder: AnyPath) -> Capture:
        """Choose pictures of the video. Raises CaptureError as ``Source.read`` does."""
        return self.read_with(folder, ScanOptions())

    def read_with(self, folder: AnyPath, options: ScanOptions) -> Capture:
        """Choose as many pictures as are wanted at most."""
        path = _video_in(folder)
        if path is None:
            raise CaptureError(folder, "holds no video, or several; give one by its own name")
        if path.stat().st_size == 0:
            raise DamagedFileError(path, "is empty; copy it again")
        analysis = analyse_video(path)
        _check_video(path, analysis)
        wanted = DEFAULT_FRAMES if options.frames is None else options.frames
        chosen = select_frames(analysis, wanted)
        if len(chosen) < MIN_FRAMES:
            places = f"{len(chosen)} place" + "s" * (len(chosen) != 1)
            raise CaptureError(
                path,
                f"shows only {places}: the camera hardly moves "
                f"in its {analysis.duration_s:.0f} s; film while walking sideways through the room",
            )
        frames = _frames(path, analysis, chosen)
        return Capture(
            folder, "video", frames, notes=_notes(analysis, frames), lens="guess", scale="unknown"
        )


def _video_in(place: AnyPath) -> AnyPath | None:
    """Return the video that a place is or holds; None where there are several or photos."""
    if place.is_file():
        return place if place.suffix.lower() in SUFFIXES else None
    if not place.is_dir():
        return None
    held = [path for path in place.iterdir() if not path.name.startswith(".")]
    if any(path.suffix.lower() in _IMAGE_SUFFIXES and not is_saved_poster(path) for path in held):
        return None
    videos = [path for path in held if path.suffix.lower() in SUFFIXES and path.is_file()]
    return videos[0] if len(videos) == 1 else None


def _check_video(path: AnyPath, analysis: VideoAnalysis) -> None:
    """Refuse a video that cannot be used.

    Raises:
        LimitError: its pictures are too large. DamagedFileError: it ends early.
    """
    width, height = analysis.size
    if width * height > MAX_PIXELS:
        raise LimitError(
            path,
            f"has pictures of {width}x{height}; at most 64 megapixels are read: make it smaller",
        )
    if not len(analysis.times):
        raise DamagedFileError(path, "has no picture that can be decoded; copy it again")
    # A stated length of seconds more than what is there: the copy broke off.
    if analysis.stated_s > analysis.duration_s + 2.0 + 0.1 * analysis.stated_s:
        raise DamagedFileError(
            path,
            f"is cut short: {analysis.duration_s:.1f} s of its {analysis.stated_s:.1f} s are "
            "there; copy it again",
        )


def _frames(path: AnyPath, analysis: VideoAnalysis, chosen: list[int]) -> tuple[FrameFiles, ...]:
    numbers = {time: number for number, time in enumerate(open_video(path).times)}
    camera = _camera(analysis)
    frames = []
    for index in chosen:
        number = numbers.get(int(analysis.times[index]))
        if number is None:
            continue
        image: ImagePlace = VideoFrame(path, number)
        if analysis.quarter_turns:
            image = RotatedImage(image, analysis.quarter_turns)
        time_s = float(analysis.times[index] * analysis.tick_s)
        frames.append(
            FrameFiles(f"frame-{number:06d}", None, image, camera, time_s=round(time_s, 6))
        )
    return tuple(frames)


def _camera(analysis: VideoAnalysis) -> Camera | None:
    """Return a first guess of the lens where the phone wrote it down."""
    width, height = analysis.size if analysis.quarter_turns % 2 == 0 else analysis.size[::-1]
    focal_mm = _focal_35mm(analysis.metadata)
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


def _notes(analysis: VideoAnalysis, frames: tuple[FrameFiles, ...]) -> tuple[str, ...]:
    notes = [
        f"{len(frames)} of the video's {len(analysis.times):,} pictures are taken: sharp "
        f"ones, well apart ({analysis.duration_s:.0f} s, {analysis.size[0]}x{analysis.size[1]})"
    ]
    if analysis.quarter_turns:
        notes.append("the pictures are turned upright, as the video says")
    if not analysis.whole:
        notes.append("the video breaks off; what comes before is used")
    return tuple(notes)
