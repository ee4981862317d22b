"""Writing of animations frame by frame: GIF, APNG and WebP by Pillow, MP4 and WebM by ffmpeg.

Files are written to a temporary folder and then moved into place, so that they are complete or
absent.
"""

import os
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO

import numpy as np
from PIL import Image

from world2minecraft.core.errors import LimitError, MissingExtraError, OutputError, UsageError

PILLOW_KINDS = {".gif": "GIF", ".apng": "PNG", ".webp": "WEBP"}
VIDEO_SUFFIXES = (".mp4", ".webm")
ANIMATION_SUFFIXES = (*PILLOW_KINDS, *VIDEO_SUFFIXES)
MAX_BUFFERED_BYTES = 1 << 30  # Pillow's kinds are held in memory until they are whole.
GIF_COLOURS = 256
GIF_SAMPLES = 12  # Frames that its colours are chosen from.
WEBP_QUALITY = 88
# Constant quality: 18 of H.264 and 30 of VP9 look like the pictures themselves.
CODECS = {
    ".mp4": ["-c:v", "libx264", "-crf", "18", "-preset", "medium", "-pix_fmt", "yuv420p",
             "-movflags", "+faststart"],
    ".webm": ["-c:v", "libvpx-vp9", "-crf", "30", "-b:v", "0", "-row-mt", "1",
              "-pix_fmt", "yuv420p"],
}  # fmt: skip
FrameWriter = Callable[[np.ndarray], None]  # Takes a frame, uint8 [H, W, 3], all of one size.


@contextmanager
def animation_writer(path: str | Path, rate_hz: float) -> Iterator[FrameWriter]:
    """Write an animation; the ``with`` block receives a function that adds a frame.

    Args:
        path: Output file, with a suffix from ``ANIMATION_SUFFIXES``.
        rate_hz: Frames per second. GIF rounds frame durations to hundredths of a second.

    Raises:
        UsageError: If the suffix is not supported, or if no frame was written.
        MissingExtraError: If ffmpeg is not installed.
        LimitError: If the frames need too much memory.
        OutputError: If the file cannot be written.
    """
    target = Path(path)
    suffix = target.suffix.lower()
    if suffix in VIDEO_SUFFIXES:
        with _atomic_file(target) as draft, _ffmpeg(draft, suffix, rate_hz, target) as write:
            yield write
    elif suffix in PILLOW_KINDS:
        held: list[np.ndarray] = []
        yield _frame_collector(held, target)
        if not held:
            raise UsageError(f"{target}: an animation needs at least one frame")
        with _atomic_file(target) as draft:
            _save(held, draft, PILLOW_KINDS[suffix], rate_hz)
    else:
        known = ", ".join(ANIMATION_SUFFIXES)
        raise UsageError(f"{target}: an animation must end in {known}, got {suffix!r}")


def ffmpeg_program() -> str:
    """Return the path of ffmpeg, from the extra ``video`` or from ``PATH``.

    ffmpeg runs as a separate program and is not linked.

    Raises:
        MissingExtraError: If ffmpeg is not found.
    """
    try:
        from imageio_ffmpeg import get_ffmpeg_exe  # noqa: PLC0415  # An extra.

        return get_ffmpeg_exe()
    except (ImportError, RuntimeError):
        found = shutil.which("ffmpeg")
        if found is None:
            raise MissingExtraError("writing MP4 or WebM (GIF works without it)", "video") from None
        return found


def _frame_collector(held: list[np.ndarray], target: Path) -> FrameWriter:
    def take(colour: np.ndarray) -> None:
        """Hold a frame in memory, up to the memory limit."""
        if sum(one.nbytes for one in held[:1]) * (len(held) + 1) > MAX_BUFFERED_BYTES:
            raise LimitError(
                target,
                f"too many frames for memory (more than {len(held)}); use fewer or smaller frames, "
                "or .mp4",
            )
        held.append(colour)

    return take


def _save(held: list[np.ndarray], draft: Path, kind: str, rate_hz: float) -> None:
    images = [Image.fromarray(colour) for colour in held]
    if kind == "GIF":
        images = _with_shared_palette(images)
    first, rest = images[0], images[1:]
    options = {
        "GIF": {"duration": max(round(100 / rate_hz), 1) * 10, "optimize": False, "disposal": 1},
        "PNG": {"duration": 1000 / rate_hz, "default_image": False},
        "WEBP": {"duration": round(1000 / rate_hz), "quality": WEBP_QUALITY, "method": 4},
    }[kind]
    first.save(draft, kind, save_all=True, append_images=rest, loop=0, **options)


def _with_shared_palette(images: list[Image.Image]) -> list[Image.Image]:
    """Return the images in one palette of their own, so that colours do not flicker."""
    some = images[:: -(-len(images) // GIF_SAMPLES)]
    strip = Image.new("RGB", (some[0].width, some[0].height * len(some)))
    for n, image in enumerate(some):
        strip.paste(image, (0, n * image.height))
    palette = strip.quantize(GIF_COLOURS, Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
    return [image.quantize(palette=palette, dither=Image.Dither.FLOYDSTEINBERG) for image in images]


@contextmanager
def _atomic_file(target: Path) -> Iterator[Path]:
    """Yield a temporary file that replaces the target if the block ends without an error."""
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        folder = tempfile.mkdtemp(dir=target.parent, prefix=f".{target.name}.")
    except OSError as error:
        raise OutputError(target, f"cannot be written: {error.strerror or error}") from error
    try:
        draft = Path(folder) / target.name
        yield draft
        os.replace(draft, target)
    except OSError as error:
        raise OutputError(target, f"cannot be written: {error.strerror or error}") from error
    finally:
        shutil.rmtree(folder, ignore_errors=True)


@contextmanager
def _ffmpeg(draft: Path, suffix: str, rate_hz: float, target: Path) -> Iterator[FrameWriter]:
    """Run ffmpeg for a block, and yield the function that sends it a frame."""
    program = ffmpeg_program()
    running: list[subprocess.Popen[bytes]] = []
    with tempfile.TemporaryFile() as messages:
        try:
            yield _frame_sender(running, program, draft, suffix, rate_hz, messages)
            if not running:
                raise UsageError(f"{target}: an animation needs at least one frame")
            running[0].communicate()
            if running[0].returncode:
                raise OutputError(target, f"ffmpeg cannot write the file: {_last_line(messages)}")
        except BrokenPipeError as error:
            raise OutputError(target, f"ffmpeg has failed: {_last_line(messages)}") from error
        finally:
            for process in running:
                process.kill()
                process.wait()


def _frame_sender(
    running: list[subprocess.Popen[bytes]],
    program: str,
    draft: Path,
    suffix: str,
    rate_hz: float,
    messages: IO[bytes],
) -> FrameWriter:
    def send(colour: np.ndarray) -> None:
        """Write a frame to the encoder, which the first frame starts."""
        height, width = colour.shape[0] // 2 * 2, colour.shape[1] // 2 * 2  # Codecs want even.
        if not running:
            words = [program, "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24",
                     "-s", f"{width}x{height}", "-r", f"{rate_hz:g}", "-i", "-", "-an",
                     "-map_metadata", "-1", "-fflags", "+bitexact",
                     *CODECS[suffix], str(draft)]  # fmt: skip
            running.append(subprocess.Popen(words, stdin=subprocess.PIPE, stderr=messages))
        pipe = running[0].stdin
        if pipe is not None:
            pipe.write(np.ascontiguousarray(colour[:height, :width]))

    return send


def _last_line(messages: IO[bytes]) -> str:
    messages.seek(0)
    lines = messages.read().decode(errors="replace").strip().splitlines()
    return lines[-1] if lines else "no error message"
