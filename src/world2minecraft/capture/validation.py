"""Validation of a capture: usable frames, depth unit and notes.

``open_scan`` and ``describe_capture`` both use this module, which decodes only a few images. A
single bad frame is skipped and listed with its reason. Problems that concern all frames (missing
poses, sizes that contradict the intrinsics, images of mixed sizes) raise an error.
"""

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeVar

import numpy as np

from world2minecraft.capture.alignment.image_rotation import (
    TURN_DESCRIPTIONS,
    find_quarter_turns,
    rotate_frame,
)
from world2minecraft.capture.depth_images import (
    DepthEncoding,
    check_depth_kind,
    find_encoding,
    read_depth,
)
from world2minecraft.capture.format_detection import find_capture
from world2minecraft.capture.images import (
    ImageHeader,
    ImagePlace,
    check_whole,
    read_header,
    read_raw,
)
from world2minecraft.capture.label_images import (
    attach_labels,
    check_labels,
    unknown_names_note,
)
from world2minecraft.capture.options import ScanOptions
from world2minecraft.capture.pose_validation import check_camera_spread, is_lost, repair_pose
from world2minecraft.capture.source_types import Capture, FrameFiles
from world2minecraft.capture.view_selection import select_views
from world2minecraft.core.errors import (
    CaptureError,
    DamagedFileError,
    InputError,
    LimitError,
    UnknownNameError,
)
from world2minecraft.core.types import Camera

MAX_DAMAGED_SHARE = 0.25  # More than one image in four cut short is a broken copy, not a slip.
MAX_WRONG_POSES_SHARE = 0.1  # More is how the capture was exported, not a slip of tracking.
SkippedFrames = tuple[tuple[str, str], ...]
DEPTH_SAMPLE_FRAMES = 12
T = TypeVar("T")


def check_frames(
    capture: Capture, step: Callable[[int], None] = lambda done: None
) -> tuple[tuple[FrameFiles, ...], SkippedFrames]:
    """Return the usable frames, with cameras scaled to the image sizes and rigid poses.

    Args:
        capture: The capture as listed by its source.
        step: Called after each frame with the number of completed frames.

    Returns:
        The usable frames in order, and (name, reason) of the others.

    Raises:
        CaptureError: If no frame can be used, or all frames have the same fault.
        LimitError: If an image is too large to decode.
    """
    if not capture.frames:
        raise CaptureError(
            capture.folder,
            f"has the layout of a {capture.source} capture, but contains none of its frames; "
            "see docs/reference/capture-formats.md for the file names",
        )
    sizes: dict[str, tuple[ImagePlace, ImageHeader]] = {}
    used: list[FrameFiles] = []
    skipped: list[tuple[str, str]] = []
    damaged: list[InputError] = []
    posed = is_posed(capture.frames)
    for done, frame in enumerate(capture.frames, 1):
        reason = frame.problem or (_pose_problem(frame) if posed else "")
        if not reason:
            try:
                used.append(_fit_cameras(_check_images(frame, sizes, posed)))
            except (CaptureError, LimitError):
                raise
            except InputError as error:
                damaged.append(error)
                reason = f"{Path(error.path).name} {error.reason}"
        if reason:
            skipped.append((frame.name, reason))
        step(done)
    _refuse_if_broken(capture, used, skipped, damaged)
    repaired, wrong = _repair_poses(capture, used)
    return repaired, (*skipped, *wrong)


def is_posed(frames: Sequence[FrameFiles]) -> bool:
    """Return whether any frame has a pose."""
    return any(frame.camera_to_world is not None for frame in frames)


def _pose_problem(frame: FrameFiles) -> str:
    if frame.camera_to_world is None:
        return "has no pose"
    return "tracking was lost (the pose is not finite)" if is_lost(frame.camera_to_world) else ""


def _check_images(
    frame: FrameFiles, sizes: dict[str, tuple[ImagePlace, ImageHeader]], posed: bool
) -> FrameFiles:
    """Check the image files of a frame against those of earlier frames, without decoding.

    Photos without poses may have different sizes, such as portrait and landscape.
    """
    for kind, path in _image_paths(frame):
        header = read_header(path)
        if kind == "depth":
            check_depth_kind(path, header)
        check_whole(path)
        first_path, first = sizes.setdefault(kind, (path, header))
        if header.size != first.size and (posed or kind == "depth"):
            raise CaptureError(
                path,
                f"is {header.width_px}x{header.height_px} px, but {first_path.name} is "
                f"{first.width_px}x{first.height_px} px; all {kind} images must have the same "
                "size",
            )
    return frame


def _image_paths(frame: FrameFiles) -> Iterable[tuple[str, ImagePlace]]:
    named = (
        ("colour", frame.colour_path),
        ("depth", frame.depth_path),
        ("labels", frame.labels_path),
        ("trust", frame.trust_path),
    )
    return [(kind, path) for kind, path in named if path is not None]


def _fit_cameras(frame: FrameFiles) -> FrameFiles:
    """Return the frame with its stated cameras scaled to the sizes of its images."""
    colour = _fit_camera(frame.colour_path, frame.colour_camera)
    depth = _fit_camera(frame.depth_path, frame.depth_camera)
    return replace(frame, colour_camera=colour, depth_camera=depth)


def _fit_camera(path: ImagePlace | None, camera: Camera | None) -> Camera | None:
    if path is None or camera is None:
        return None
    size = read_header(path).size
    try:
        fitted = camera.resized(*size)
    except ValueError as error:
        raise CaptureError(
            path, f"does not match its intrinsics: {error}; use the intrinsics for this image size"
        ) from error
    if not (
        0.2 < fitted.cx_px / fitted.width_px < 0.8 and 0.2 < fitted.cy_px / fitted.height_px < 0.8
    ):
        raise CaptureError(
            path,
            f"is {size[0]}x{size[1]} px, but the principal point of its intrinsics is at "
            f"({fitted.cx_px:.0f}, {fitted.cy_px:.0f}); use the intrinsics for this image "
            "size",
        )
    return fitted


def _refuse_if_broken(
    capture: Capture,
    used: list[FrameFiles],
    skipped: list[tuple[str, str]],
    damaged: list[InputError],
) -> None:
    if damaged and (not used or len(damaged) > MAX_DAMAGED_SHARE * len(capture.frames)):
        raise CaptureError(
            damaged[0].path,
            f"{damaged[0].reason} ({len(damaged)} of {len(capture.frames)} frames are damaged)",
        )
    if not used:
        (reason, count), *_ = Counter(reason for _, reason in skipped).most_common(1)
        raise CaptureError(
            capture.folder,
            f"none of {len(capture.frames)} frames can be used; most common reason ({count} "
            f"frames): {reason}",
        )


def _repair_poses(
    capture: Capture, frames: list[FrameFiles]
) -> tuple[tuple[FrameFiles, ...], SkippedFrames]:
    """Return the frames with rigid poses, and the frames with wrong poses if those are few.

    Frames of a capture without poses are returned unchanged.
    """
    repaired: list[FrameFiles] = []
    wrong: list[CaptureError] = []
    skipped: list[tuple[str, str]] = []
    for frame in frames:
        if frame.camera_to_world is None:
            repaired.append(frame)
            continue
        pose = np.asarray(frame.camera_to_world, np.float64)
        try:
            rigid = repair_pose(pose, capture.folder, frame.name)
        except CaptureError as error:
            wrong.append(error)
            skipped.append((frame.name, error.reason))
        else:
            repaired.append(replace(frame, camera_to_world=rigid))
    if len(wrong) > MAX_WRONG_POSES_SHARE * len(frames):
        raise wrong[0]
    return tuple(repaired), tuple(skipped)


@dataclass(frozen=True, eq=False)
class ValidatedCapture:
    """The usable data of a capture.

    Attributes:
        capture: The capture as listed by its source.
        frames: The usable frames.
        skipped: Names of the skipped frames, with reasons.
        encoding: Encoding of the depth images.
        typical_depth_m: Median depth over some frames in metres, or 0.
        notes: Remarks for the user.
    """

    capture: Capture
    frames: tuple[FrameFiles, ...]
    skipped: SkippedFrames
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
        """Whether the capture has depth and poses, which ``open_scan`` requires."""
        return self.has_depth and self.posed


def validate_capture(
    path: str | Path,
    options: ScanOptions,
    labels: Path | None = None,
    step: Callable[[int, int], None] = lambda done, total: None,
) -> ValidatedCapture:
    """Detect the format of a capture, check its frames and infer its depth unit.

    Args:
        path: Path of the capture.
        options: Options of the capture stage.
        labels: Optional folder of label images.
        step: Called with the numbers of completed and of all frames.

    Raises:
        CaptureError: If the capture cannot be used.
        LimitError: If an image is too large.
    """
    return validate(find_capture(path, options), options, labels, step)


def validate(
    capture: Capture,
    options: ScanOptions,
    labels: Path | None = None,
    step: Callable[[int, int], None] = lambda done, total: None,
) -> ValidatedCapture:
    """Check the frames of a detected capture and infer its depth unit.

    Raises:
        CaptureError: If the capture cannot be used.
        LimitError: If an image is too large.
    """
    capture = replace(capture, frames=capture.frames[:: options.every or 1])
    total = len(capture.frames)
    frames, skipped = check_frames(capture, lambda done: step(done, total))
    if labels is not None:
        frames = attach_labels(frames, labels)
    frames, turned = _rotate_upright(frames, capture)
    check_labels(frames)
    sampled = evenly_spaced([frame for frame in frames if frame.depth_path], DEPTH_SAMPLE_FRAMES)
    paths = _drop_undecodable([frame.depth_path for frame in sampled if frame.depth_path])
    encoding = _find_encoding(paths, options, capture) if paths else DepthEncoding("mm")
    typical_m = _median_depth(paths, encoding)
    strayed: SkippedFrames = ()
    if is_posed(frames) and capture.scale != "unknown":
        frames, strayed = check_camera_spread(frames, capture.folder, typical_m)
    notes = [*capture.notes, *turned]
    if options.every is None and sampled and is_posed(frames) and capture.scale != "unknown":
        selected = select_views(frames)
        if len(selected) < len(frames):
            notes.append(
                f"{len(selected)} of {len(frames)} frames are used; the others show the same from "
                "the same places (--set capture.every=1 uses all)"
            )
        frames = selected
    if note := unknown_names_note(frames):
        notes.append(note)
    if encoding.guessed:
        notes.append(f"depth is read as {encoding.description}, inferred from its values")
    return ValidatedCapture(
        capture, frames, (*capture.skipped, *skipped, *strayed), encoding, typical_m, tuple(notes)
    )


def _rotate_upright(
    frames: tuple[FrameFiles, ...], capture: Capture
) -> tuple[tuple[FrameFiles, ...], tuple[str, ...]]:
    """Return the frames with images rotated upright if the up direction is known, and a note."""
    turns = 0 if capture.world_up is None else find_quarter_turns(frames, capture.world_up)
    if turns == 0:
        return frames, ()
    note = f"the images are not upright; they are read with {TURN_DESCRIPTIONS[turns]}"
    return tuple(rotate_frame(frame, turns) for frame in frames), (note,)


def _drop_undecodable(paths: list[ImagePlace]) -> list[ImagePlace]:
    """Return the images that can be decoded; others are skipped later when they are read."""
    found = []
    for path in paths:
        try:
            read_raw(path)
        except DamagedFileError:
            continue
        found.append(path)
    return found or paths


def _find_encoding(
    paths: Sequence[ImagePlace], options: ScanOptions, capture: Capture
) -> DepthEncoding:
    try:
        return find_encoding(paths, options.depth_unit or capture.depth_unit)
    except UnknownNameError as error:  # The user's own was checked before: the capture states it.
        raise CaptureError(capture.folder, str(error)) from error


def evenly_spaced(items: Sequence[T], count: int) -> list[T]:
    """Return at most ``count`` evenly spaced items, including the first."""
    chosen = np.unique(np.linspace(0, len(items) - 1, min(count, len(items))).round().astype(int))
    return [items[index] for index in chosen]


def _median_depth(paths: Sequence[ImagePlace], encoding: DepthEncoding) -> float:
    """Return the median depth of some images in metres."""
    medians = []
    for path in paths[:4]:
        depth = read_depth(path, encoding)[::4, ::4]
        if (depth > 0).any():
            medians.append(float(np.median(depth[depth > 0])))
    return float(np.median(medians)) if medians else 0.0
