"""Opening of a capture on disk as an aligned scan that is read view by view."""

import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from world2minecraft.capture.alignment.room_frame import Alignment, ImplausibleRoomError, align
from world2minecraft.capture.calibration import corrected_camera, estimate_colour_camera
from world2minecraft.capture.options import parse_options
from world2minecraft.capture.validation import ValidatedCapture, evenly_spaced, validate_capture
from world2minecraft.capture.view_stream import CaptureViews, without_colour
from world2minecraft.core.errors import CaptureError, UsageError
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.core.types import Scan
from world2minecraft.formats.scan_record import RecordedAlignment, read_alignment

ALIGNMENT_FRAMES = 24  # With all 40 frames of the kitchen, its floor moved by under 2 mm.
CALIBRATION_FRAMES = 12  # Ten gave the kitchen's focal length to 0.3 %, whichever ten.
MAX_CELLS = 40_000_000  # A grid of 400 x 400 x 250; its evidence takes about 2.5 GB.
NO_CORRECTION = (1.0, 0.0, 0.0)
STAGE = "scan"
PROGRESS_STEPS = 100


def open_scan(
    path: str | Path,
    *,
    voxel_m: float = 0.08,
    labels: Path | None = None,
    progress: Progress = no_progress,
    options: Mapping[str, str] | None = None,
    recorded: Path | None = None,
) -> Scan:
    """Open a capture: detect its format, validate its frames and align its room.

    Args:
        path: Path of the capture.
        voxel_m: Edge length in metres of the cells for later stages. Rooms with too many cells are
            rejected before any long computation. The room's inner corner is a cell corner.
        labels: Folder of label images ``NAME.png`` (uint8 class ids), one for each frame.
        progress: Callback for the progress of the stage ``scan``.
        options: Capture options such as ``depth_unit``, ``every`` and ``colour_camera``; see
            ``ScanOptions``.
        recorded: ``scan.json`` of an earlier run, whose alignment, notes and correction of the
            colour camera are used instead of being estimated.

    Raises:
        CaptureError: If the capture cannot be used.
        DamagedFileError: If ``recorded`` does not contain a valid alignment.
        LimitError: If an image is too large.
        UsageError: If an option is not valid.
    """
    chosen = parse_options(options or {})
    if not voxel_m > 0:
        raise UsageError(f"the voxel size must be above 0 m, got {voxel_m}")
    validated = validate_capture(
        path,
        chosen,
        labels,
        lambda done, total: progress(STAGE, 40 * done // total, PROGRESS_STEPS),
    )
    if not validated.complete and validated.capture.room is None:
        lacks = "depth images" if validated.posed else "poses"
        raise CaptureError(
            validated.capture.folder,
            f"contains no {lacks}; use w2m reconstruct, which computes them from the images",
        )
    stream = CaptureViews(validated.frames, validated.encoding, validated.capture.full_trust)
    notes, correction = list(validated.notes), NO_CORRECTION
    earlier = read_alignment(recorded) if recorded is not None else None
    if validated.capture.one_matrix and chosen.colour_camera == "auto":
        if earlier is not None and earlier.colour_correction is not None:
            correction = earlier.colour_correction
        else:
            progress(STAGE, 40, PROGRESS_STEPS, "estimating the colour camera")
            correction, found = _estimate_colour_camera(stream)
            notes.append(found)
        stream = _with_colour_camera(stream, correction)
    if earlier is not None:
        notes = []  # They are among the recorded ones.
        alignment = _recorded_frame(earlier)
    else:
        progress(STAGE, 60, PROGRESS_STEPS, "estimating gravity and walls")
        alignment = _align(validated, stream)
    check_cell_count(alignment, voxel_m)
    progress(STAGE, PROGRESS_STEPS, PROGRESS_STEPS)
    return Scan(
        views=stream,
        scan_to_room=alignment.scan_to_room,
        room_size_m=alignment.room_size_m,
        frames_used=tuple(frame.name for frame in stream.frames),
        frames_skipped=validated.skipped,
        scale=validated.capture.scale,
        scale_sigma=validated.capture.scale_sigma,
        source=validated.capture.source,
        notes=(*notes, *alignment.notes),
        depth_kind=validated.capture.depth_kind,
        world_up=validated.capture.world_up,
        frame_sigmas=alignment.sigmas,
        source_to_scan=validated.capture.source_to_scan,
        colour_correction=correction,
    )


def _estimate_colour_camera(stream: CaptureViews) -> tuple[tuple[float, float, float], str]:
    """Return the correction of the colour camera, if the estimate is clear, and a note."""
    both = [frame for frame in stream.frames if frame.depth_path and frame.colour_path]
    estimate = estimate_colour_camera(stream.read(evenly_spaced(both, CALIBRATION_FRAMES)))
    if estimate is None:
        return NO_CORRECTION, (
            "too few depth edges to check the colour camera; using the stated intrinsics"
        )
    if not estimate.clear:
        return NO_CORRECTION, (
            "depth edges match colour edges; using the stated intrinsics for colour"
        )
    stated = next(frame.colour_camera for frame in both if frame.colour_camera)
    note = (
        f"the colour camera is estimated from edges: focal length {estimate.scale:.3f} "
        f"times the stated {stated.fx_px:.0f} px, principal point shifted by "
        f"({estimate.shift_x_px:+.1f}, {estimate.shift_y_px:+.1f}) px; held-out frames "
        f"match {estimate.gain:.1f} times better"
    )
    return estimate.correction, note


def _with_colour_camera(
    stream: CaptureViews, correction: tuple[float, float, float]
) -> CaptureViews:
    """Return a stream whose colour cameras are corrected."""
    if correction == NO_CORRECTION:
        return stream
    frames = tuple(
        replace(frame, colour_camera=corrected_camera(frame.colour_camera, correction))
        if frame.colour_camera
        else frame
        for frame in stream.frames
    )
    return CaptureViews(frames, stream.encoding, stream.full_trust)


def _recorded_frame(earlier: RecordedAlignment) -> Alignment:
    return Alignment(earlier.scan_to_room, earlier.room_size_m, earlier.notes, earlier.sigmas)


def _align(validated: ValidatedCapture, stream: CaptureViews) -> Alignment:
    if validated.capture.room is not None:
        return Alignment(*validated.capture.room, ())
    with_depth = without_colour(stream.frames)
    try:
        views = stream.read(evenly_spaced(with_depth, ALIGNMENT_FRAMES))
        return align(views, validated.capture.world_up)
    except ImplausibleRoomError as error:
        raise CaptureError(validated.capture.folder, str(error)) from error


def check_cell_count(alignment: Alignment, voxel_m: float) -> None:
    """Check that a room does not have too many cells.

    Raises:
        UsageError: If there are too many cells. The message contains a suitable voxel size.
    """
    volume_m3 = float(alignment.room_size_m.prod())
    if volume_m3 / voxel_m**3 > MAX_CELLS:
        min_voxel_m = (volume_m3 / MAX_CELLS) ** (1 / 3)
        raise UsageError(
            f"cells of {voxel_m:g} m divide this room into {volume_m3 / voxel_m**3:,.0f} cells, "
            f"the limit is {MAX_CELLS:,}; use cells of at least "
            f"{math.ceil(1000 * min_voxel_m) / 1000:.3f} m (--voxel)"
        )
