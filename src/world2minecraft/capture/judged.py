"""A capture judged: its usable frames, the depth's unit and what was found on the way.

This is the part that ``open_scan`` and ``describe_capture`` share; it decodes only a few images.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeVar

import numpy as np

from world2minecraft.capture.alignment.image_rotation import SAID, quarter_turns_of, turned_frame
from world2minecraft.capture.checking import Skipped, check_frames, is_posed
from world2minecraft.capture.depth_images import DepthEncoding, find_encoding, read_depth
from world2minecraft.capture.frames import Capture, FrameFiles
from world2minecraft.capture.images import ImagePlace, read_raw
from world2minecraft.capture.label_images import attach_labels, check_labels
from world2minecraft.capture.options import ScanOptions
from world2minecraft.capture.poses import check_spread
from world2minecraft.capture.sources import find_capture
from world2minecraft.core.errors import CaptureError, DamagedFileError, UnknownNameError

SAMPLED_FRAMES = 12
T = TypeVar("T")


@dataclass(frozen=True, eq=False)
class JudgedCapture:
    """What can be used of a capture; ``typical_depth_m`` is the median over some frames, or 0."""

    capture: Capture
    frames: tuple[FrameFiles, ...]
    skipped: Skipped
    encoding: DepthEncoding
    typical_depth_m: float
    notes: tuple[str, ...]

    @property
    def has_depth(self) -> bool:
        """Whether any usable frame has depth."""
        return any(frame.depth_path for frame in self.frames)

    @property
    def posed(self) -> bool:
        """Whether the frames have poses."""
        return is_posed(self.frames)

    @property
    def complete(self) -> bool:
        """Whether the capture has all that ``open_scan`` needs; else ``prepare`` makes it."""
        return self.has_depth and self.posed


def judge_capture(
    path: str | Path,
    options: ScanOptions,
    labels: Path | None = None,
    step: Callable[[int, int], None] = lambda done, total: None,
) -> JudgedCapture:
    """Find out a capture's layout, check its frames and tell its depth unit.

    Raises:
        CaptureError: it cannot be used. LimitError: an image is too large.
    """
    return judge(find_capture(path, options), options, labels, step)


def judge(
    capture: Capture,
    options: ScanOptions,
    labels: Path | None = None,
    step: Callable[[int, int], None] = lambda done, total: None,
) -> JudgedCapture:
    """Check the frames of a capture that was found. Raises what ``judge_capture`` raises."""
    total = len(capture.frames[:: options.every])
    capture = replace(capture, frames=capture.frames[:: options.every])
    frames, skipped = check_frames(capture, lambda done: step(done, total))
    if labels is not None:
        frames = attach_labels(frames, labels)
    frames, turned = _upright(frames, capture)
    check_labels(frames)
    looked_at = spread_over([frame for frame in frames if frame.depth_path], SAMPLED_FRAMES)
    paths = _decodable([frame.depth_path for frame in looked_at if frame.depth_path])
    encoding = _encoding(paths, options, capture) if paths else DepthEncoding("mm")
    typical_m = _typical_depth(paths, encoding)
    strayed: Skipped = ()
    if is_posed(frames) and capture.scale != "unknown":
        frames, strayed = check_spread(frames, capture.folder, typical_m)
    notes = [*capture.notes, *turned]
    if encoding.guessed:
        notes.append(f"depth is read as {encoding.said}, told from its values")
    return JudgedCapture(
        capture, frames, (*capture.skipped, *skipped, *strayed), encoding, typical_m, tuple(notes)
    )


def _upright(
    frames: tuple[FrameFiles, ...], capture: Capture
) -> tuple[tuple[FrameFiles, ...], tuple[str, ...]]:
    """Return the frames with upright images where the capture knows up, and what to tell."""
    turns = 0 if capture.world_up is None else quarter_turns_of(frames, capture.world_up)
    if turns == 0:
        return frames, ()
    note = f"the images lie on their side or head; they are read with {SAID[turns]}"
    return tuple(turned_frame(frame, turns) for frame in frames), (note,)


def _decodable(paths: list[ImagePlace]) -> list[ImagePlace]:
    """Return the images that can be decoded: one that cannot is left out when its turn comes."""
    found = []
    for path in paths:
        try:
            read_raw(path)
        except DamagedFileError:
            continue
        found.append(path)
    return found or paths


def _encoding(paths: Sequence[ImagePlace], options: ScanOptions, capture: Capture) -> DepthEncoding:
    try:
        return find_encoding(paths, options.depth_unit or capture.depth_unit)
    except UnknownNameError as error:  # The user's own was checked before: the capture states it.
        raise CaptureError(capture.folder, str(error)) from error


def spread_over(items: Sequence[T], count: int) -> list[T]:
    """Return at most ``count`` of the items, evenly spread, the first among them."""
    chosen = np.unique(np.linspace(0, len(items) - 1, min(count, len(items))).round().astype(int))
    return [items[index] for index in chosen]


def _typical_depth(paths: Sequence[ImagePlace], encoding: DepthEncoding) -> float:
    """Return the median depth in metres over some images."""
    medians = []
    for path in paths[:4]:
        depth = read_depth(path, encoding)[::4, ::4]
        if (depth > 0).any():
            medians.append(float(np.median(depth[depth > 0])))
    return float(np.median(medians)) if medians else 0.0
