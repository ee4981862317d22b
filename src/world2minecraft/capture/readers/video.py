"""Reader of a video of a walk through a room, which selects sharp and well-separated frames.

One pass over the video at low resolution measures motion and sharpness. Motion is the shift of
image blocks against a reference frame, by phase correlation. It responds to walking, turning and
approaching alike, and camera shake does not accumulate. Sharpness is the strength of fine edges.
The selected frames are decoded on access, upright and in the order of the video.
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
from world2minecraft.core.archives import AnyPath, file_stamp
from world2minecraft.core.errors import (
    CaptureError,
    DamagedFileError,
    InputError,
    LimitError,
    MissingExtraError,
    reason_of,
)
from world2minecraft.core.types import Camera

SMALL_PX = 192  # Longer side of the reduced images.
BLOCK = 48  # Side of the blocks that are correlated; shifts of up to half of it are detected.
MIN_PEAK = 0.045  # Correlation under it is chance: a bare wall, or another scene.
MIN_MOTION = 0.04  # Share of the longer side; less motion is camera shake.
FRAME_STEP = 0.12  # Motion between chosen frames / longer side; 7/8 of them overlap.
SEARCH_STEPS = 0.4  # Search radius for the sharpest frame, in steps.
MAX_SECONDS = 3600.0
SHARP_ROWS = 6  # Sharpness is measured in every sixth row.
SUFFIXES = (".mov", ".mp4", ".m4v", ".webm", ".avi", ".mkv")
DEFAULT_FRAMES = 100  # Frames for one room; more take longer and add little.
FOCAL_KEYS = ("com.apple.quicktime.camera.focal_length.35mm_equivalent",)
_IMAGE_SUFFIXES = (".jpg", ".jpeg", ".png", ".heic", ".heif", ".webp", ".npy", ".tif", ".tiff")


@dataclass(frozen=True, eq=False)
class VideoAnalysis:
    """The result of one pass over a video with N frames.

    Attributes:
        size: Width and height in pixels.
        times: Frame times in ticks of ``tick_s``, ascending, int64 [N].
        tick_s: Seconds per tick.
        path: Accumulated motion since the start as a share of the longer image side, float64 [N].
        sharpness: Sharpness of each frame, float64 [N].
        stated_s: Duration stated by the file in seconds; 0 if it is not stated.
        quarter_turns: Counter-clockwise quarter turns that rotate the frames upright.
        metadata: Metadata of the container and the stream.
        whole: Whether the video was decoded to the end.
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
        """The duration in seconds from the first to the last frame, plus one frame."""
        count = len(self.times)
        if count < 2:
            return 0.0
        return float((self.times[-1] - self.times[0]) * self.tick_s * count / (count - 1))


def analyse_video(path: AnyPath) -> VideoAnalysis:
    """Decode a video once at low resolution; the result is cached until the file changes.

    Raises:
        DamagedFileError: If the file is not a video or contains no frames.
        LimitError: If the frames are too large or the video is longer than an hour.
        InputError: If the file is missing.
        MissingExtraError: If ``av`` is not installed.
    """
    return _analyse(path, file_stamp(path))


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
        raise DamagedFileError(
            path, f"is not a complete video ({reason}); copy the file again"
        ) from error


def _analyse_container(
    path: AnyPath, container: Any, failures: tuple[type[Exception], ...]
) -> VideoAnalysis:
    if not container.streams.video:
        kind = "sound only" if container.streams.audio else "no video"
        raise DamagedFileError(path, f"contains {kind}; choose a video of the room")
    stream = container.streams.video[0]
    size = (stream.codec_context.width, stream.codec_context.height)
    if not 0 < size[0] * size[1] <= MAX_PIXELS:
        raise LimitError(
            path,
            f"has frames of {size[0]}x{size[1]} px, the limit is 64 megapixels; reduce the "
            "resolution",
        )
    stated_s = (container.duration or 0) / 1e6  # Some containers state it for the whole alone.
    if stream.duration:
        stated_s = float(stream.duration * stream.time_base)
    if stated_s > MAX_SECONDS:
        raise LimitError(
            path, f"is {stated_s / 60:.0f} minutes long, the limit is 60; shorten the video"
        )
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
    """Return the luma plane as uint8 [H, W], without a copy if possible."""
    kind = frame.format
    if not kind.name.startswith(("yuv", "gray", "nv12", "nv21")) or kind.components[0].bits > 8:
        frame = frame.reformat(format="gray")
    plane = frame.planes[0]
    rows = np.frombuffer(plane, np.uint8).reshape(-1, plane.line_size)
    return rows[: frame.height, : frame.width]


def _sharpness(light: np.ndarray) -> float:
    """Return the mean square of second differences along some of the rows."""
    rows = light[::SHARP_ROWS].astype(np.int16)
    bent = (rows[:, 2:] - 2 * rows[:, 1:-1] + rows[:, :-2]).astype(np.float32)
    return float((bent * bent).mean()) if bent.size else 0.0


def _downscale(light: np.ndarray) -> np.ndarray:
    """Return an image of about ``SMALL_PX``, averaged along rows and subsampled between rows."""
    step = max(1, max(light.shape) // SMALL_PX)
    height, width = (side // step * step for side in light.shape)
    rows = light[step // 2 : height : step, :width]
    return rows.reshape(len(rows), -1, step).mean(axis=2, dtype=np.float32)


class _MotionTracker:
    """An accumulator of camera motion."""

    def __init__(self) -> None:
        self.path: list[float] = []
        self._gone = 0.0
        self._reference: np.ndarray | None = None

    def add(self, small: np.ndarray) -> None:
        """Add the next frame."""
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
    """Return the spectra of B blocks of a small image, complex [B, BLOCK, BLOCK // 2 + 1]."""
    high, wide = (min(BLOCK, side) for side in small.shape)
    window = np.outer(np.hanning(high), np.hanning(wide)).astype(np.float32)
    tops = np.linspace(0, small.shape[0] - high, 3).astype(int)
    lefts = np.linspace(0, small.shape[1] - wide, 4).astype(int)
    blocks = np.stack([small[a : a + high, b : b + wide] for a in tops for b in lefts])
    blocks = (blocks - blocks.mean(axis=(1, 2), keepdims=True)) * window
    return np.asarray(fft.rfft2(blocks, (BLOCK, BLOCK)))


def block_shift(first: np.ndarray, second: np.ndarray) -> float:
    """Return the mean shift of image blocks between two frames, in pixels.

    Args:
        first: Spectra of the blocks of one frame.
        second: Spectra of the blocks of the other frame, with the same shape.

    Returns:
        The mean length over blocks with a reliable match, or half a block if there is none.
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
    """Select sharp frames with regular motion between them, in ascending order.

    Args:
        analysis: Motion and sharpness of the video.
        wanted: Maximum number of frames; less motion gives fewer frames.
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
    """A reader of videos, and of folders that contain one video and no images."""

    layout = "a video (.mov, .mp4, .m4v, .webm, .avi, .mkv)"

    def recognise(self, folder: AnyPath) -> bool:
        """Return whether the path is a video or a folder with exactly one video."""
        return _video_in(folder) is not None

    def read(self, folder: AnyPath) -> Capture:
        """Select frames of a video with default options.

        Raises:
            CaptureError: If the video shows too little motion.
            DamagedFileError: If the video is damaged.
            LimitError: If the video is too large.
        """
        return self.read_with(folder, ScanOptions())

    def read_with(self, folder: AnyPath, options: ScanOptions) -> Capture:
        """Select at most ``options.frames`` frames of a video.

        Raises:
            CaptureError: If the video shows too little motion.
            DamagedFileError: If the video is damaged.
            LimitError: If the video is too large.
        """
        path = _video_in(folder)
        if path is None:
            raise CaptureError(
                folder, "contains no video or several videos; give the path of one video"
            )
        if path.stat().st_size == 0:
            raise DamagedFileError(path, "is empty; copy the file again")
        analysis = analyse_video(path)
        _check_complete(path, analysis)
        wanted = DEFAULT_FRAMES if options.frames is None else options.frames
        chosen = select_frames(analysis, wanted)
        if len(chosen) < MIN_FRAMES:
            places = f"{len(chosen)} place" + "s" * (len(chosen) != 1)
            raise CaptureError(
                path,
                f"shows the room from only {places}: the camera hardly moves in "
                f"{analysis.duration_s:.0f} s; walk sideways through the room while filming",
            )
        frames = _frames(path, analysis, chosen)
        return Capture(
            folder, "video", frames, notes=_notes(analysis, frames), lens="guess", scale="unknown"
        )


def _video_in(place: AnyPath) -> AnyPath | None:
    """Return the video at a path or in a folder; None if there are several videos, or photos."""
    if place.is_file():
        return place if place.suffix.lower() in SUFFIXES else None
    if not place.is_dir():
        return None
    held = [path for path in place.iterdir() if not path.name.startswith(".")]
    if any(path.suffix.lower() in _IMAGE_SUFFIXES and not is_saved_poster(path) for path in held):
        return None
    videos = [path for path in held if path.suffix.lower() in SUFFIXES and path.is_file()]
    return videos[0] if len(videos) == 1 else None


def _check_complete(path: AnyPath, analysis: VideoAnalysis) -> None:
    """Raise DamagedFileError if a video is truncated."""
    if not len(analysis.times):
        raise DamagedFileError(path, "contains no frame that can be decoded; copy the file again")
    # A stated length of seconds more than what is there: the copy broke off.
    if analysis.stated_s > analysis.duration_s + 2.0 + 0.1 * analysis.stated_s:
        raise DamagedFileError(
            path,
            f"is truncated: expected {analysis.stated_s:.1f} s, found "
            f"{analysis.duration_s:.1f} s; copy the file again",
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
    """Return an initial estimate of the intrinsics from the phone's metadata, or None."""
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
        (
            f"selected {len(frames)} of {len(analysis.times):,} frames that are sharp and "
            f"well separated ({analysis.duration_s:.0f} s, "
            f"{analysis.size[0]}x{analysis.size[1]})"
        )
    ]
    if analysis.quarter_turns:
        notes.append("the frames are rotated upright, as stated by the video")
    if not analysis.whole:
        notes.append("the video is truncated; only the part before the damage is used")
    return tuple(notes)
