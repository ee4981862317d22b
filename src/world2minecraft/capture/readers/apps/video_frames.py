"""Random access to the frames of a video by index.

The times of all frames are listed once, without decoding. Frames are decoded in sequence; to reach
another position, decoding restarts at the keyframe before it.
"""

from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from world2minecraft.capture.images import MAX_PIXELS, ImageHeader
from world2minecraft.core.archives import AnyPath, file_stamp
from world2minecraft.core.errors import (
    DamagedFileError,
    LimitError,
    MissingExtraError,
    reason_of,
)

MAX_FRAMES = 1_000_000  # Four hours and a half at 60 Hz.


class VideoDecoder:
    """An open video with the times and size of its frames."""

    def __init__(self, path: AnyPath):
        """Open a video and list its frames.

        Raises:
            DamagedFileError: If the file is not a complete video.
            LimitError: If the frames are too large or too many.
            MissingExtraError: If ``av`` is not installed.
        """
        try:
            import av  # noqa: PLC0415
            from av.error import FFmpegError  # noqa: PLC0415
        except ImportError as error:
            raise MissingExtraError("reading videos", "capture") from error
        self.path = path
        self._errors = (FFmpegError, ValueError, IndexError, OSError)
        try:
            self._container: Any = av.open(path.open("rb"), "r")
            self._stream: Any = self._container.streams.video[0]
            if self._stream.codec_context is None:
                raise ValueError("its codec is unknown")
            self._stream.codec_context.thread_count = 1
            self.size = (self._stream.codec_context.width, self._stream.codec_context.height)
            self.times, self.key_times = self._times()
        except self._errors as error:
            reason = f"is not a complete video ({reason_of(error, 80)}); copy the file again"
            raise DamagedFileError(path, reason) from error
        held = len(self.times)
        if self.size[0] * self.size[1] > MAX_PIXELS or held > MAX_FRAMES:
            raise LimitError(
                path,
                f"contains {held:,} frames of {self.size} pixels, which is too much; "
                "shorten the video",
            )
        self._decoded: Iterator[Any] = iter(())
        self._next = -1

    def _times(self) -> tuple[list[int], list[int]]:
        every, key = [], []
        for packet in self._container.demux(self._stream):
            if packet.pts is not None:
                every.append(packet.pts)
                if packet.is_keyframe:
                    key.append(packet.pts)
        return sorted(every), sorted(key)

    def picture(self, index: int) -> np.ndarray:
        """Return a frame as uint8 [H, W, 3].

        Raises:
            DamagedFileError: If the frame cannot be decoded.
        """
        try:
            return self._picture(index)
        except self._errors as error:
            self._next = -1
            reason = (
                f"frame {index} cannot be decoded ({reason_of(error, 80)}); copy the video again"
            )
            raise DamagedFileError(self.path, reason) from error

    def _picture(self, index: int) -> np.ndarray:
        if 0 <= self._next <= index and not self._key_between(index):
            found = self._decoded_at(index)
            if found is not None:
                return found
        # Pictures that are shown before their key picture need the one before that too.
        before = bisect_right(self.key_times, self.times[index])
        for key in (before - 1, before - 2, 0):
            time = self.key_times[max(key, 0)] if self.key_times else self.times[0]
            self._container.seek(time, stream=self._stream, backward=True, any_frame=False)
            self._decoded = self._container.decode(self._stream)
            found = self._decoded_at(index)
            if found is not None:
                return found
        raise ValueError("the frame is missing")

    def _decoded_at(self, index: int) -> np.ndarray | None:
        """Decode up to a frame and return it, or None if the frame does not occur."""
        time = self.times[index]
        for frame in self._decoded:
            if frame.pts is not None and frame.pts >= time:
                if frame.pts > time or (frame.width, frame.height) != self.size:
                    return None
                self._next = index + 1
                return np.ascontiguousarray(frame.to_ndarray(format="rgb24"))
        return None

    def _key_between(self, index: int) -> bool:
        """Return whether seeking to a keyframe is faster than decoding on to ``index``."""
        here = self.times[min(self._next, len(self.times) - 1)]
        ahead = bisect_right(self.key_times, self.times[index]) > bisect_right(self.key_times, here)
        return ahead and index > self._next


@lru_cache(maxsize=2)
def _open_cached(path: AnyPath, stamp: tuple[int, int]) -> VideoDecoder:
    return VideoDecoder(path)


def open_video(path: AnyPath) -> VideoDecoder:
    """Return an open video, cached until the file changes.

    Raises:
        InputError: If the file is missing.
        DamagedFileError: If the file is not a complete video.
        LimitError: If the frames are too large or too many.
        MissingExtraError: If ``av`` is not installed.
    """
    return _open_cached(path, file_stamp(path))


@dataclass(frozen=True)
class VideoFrame:
    """A frame of a video. It implements ``ImageSource``."""

    path: AnyPath
    index: int

    def __str__(self) -> str:
        """Return the video and the frame number, for messages."""
        return f"{self.path}, frame {self.index}"

    @property
    def stem(self) -> str:
        """The frame number with six digits, as in the names of files that accompany the video."""
        return f"{self.index:06d}"

    @property
    def name(self) -> str:
        """The name of the video and the frame number."""
        return f"{self.path.name} frame {self.index}"

    def header(self) -> ImageHeader:
        """Return the size and mode of the video."""
        return ImageHeader(*open_video(self.path).size, "RGB")

    def check_whole(self) -> None:
        """Check that the video contains this frame."""
        held = len(open_video(self.path).times)
        if self.index >= held:
            raise DamagedFileError(
                self, f"is missing: the video contains {held} frames; copy the video again"
            )

    def colour(self) -> np.ndarray:
        """Return the frame as sRGB, uint8 [H, W, 3]."""
        self.check_whole()
        return open_video(self.path).picture(self.index)

    def raw(self) -> np.ndarray:
        """Raise DamagedFileError, because a video contains colours."""
        raise DamagedFileError(self, "contains colours, not single values")
