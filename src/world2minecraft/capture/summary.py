"""Summary of a capture, as text and as JSON values."""

import dataclasses
import shlex
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from world2minecraft.capture.images import read_header
from world2minecraft.capture.options import parse_options
from world2minecraft.capture.quality import Survey, survey_capture
from world2minecraft.capture.quality.diagnostics import Diagnostic, diagnose_capture
from world2minecraft.capture.quality.processing_route import Route, choose_route
from world2minecraft.capture.validation import ValidatedCapture, validate_capture
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.types import Camera

if TYPE_CHECKING:
    from world2minecraft.formats.roomplan import CapturedPlan


MAX_SKIPPED_LINES = 8


def reconstruct_command(capture: AnyPath, options: Mapping[str, str]) -> str:
    """Return the shell command that reconstructs a capture with the given options.

    Example:
        >>> reconstruct_command(Path("my room"), {"unit": "cm"})
        "w2m reconstruct 'my room' --out OUT --set capture.unit=cm"
    """
    words = ["w2m", "reconstruct", str(capture), "--out", "OUT"]
    for name, value in options.items():
        words += ["--set", f"capture.{name}={value}"]
    return shell_command(words)


def shell_command(words: Sequence[str]) -> str:
    """Join words to a command line for the system's shell, with quotes where necessary."""
    return subprocess.list2cmdline(words) if sys.platform == "win32" else shlex.join(words)


def summary_to_json(summary: "CaptureSummary") -> dict[str, Any]:
    """Return the fields of a summary as JSON values, without images."""
    data = {
        field.name: getattr(summary, field.name)
        for field in dataclasses.fields(summary)
        if field.name not in ("survey", "route", "diagnostics", "folder")
    }
    route = {**dataclasses.asdict(summary.route), "about": summary.route.about}
    diagnostics = [dataclasses.asdict(diagnostic) for diagnostic in summary.diagnostics]
    return {"folder": str(summary.folder), "route": route, **data, "doubts": diagnostics}


def summary_lines(summary: "CaptureSummary") -> list[str]:
    """Return the printed text of a summary, with the next command as the last line."""
    route = summary.route
    usable = f"{summary.usable} of {summary.frames} frames usable"
    lines = [
        f"{summary.folder}: {route.called} ({summary.source}), {usable}",
        f"  route     {route.words}: {route.about}",
        f"  colour    {_colour_text(summary)}",
        f"  depth     {_depth_text(summary)}",
        f"  poses     {_poses_text(summary)}",
    ]
    if summary.room_size_m:
        size = " x ".join(f"{side:.1f}" for side in summary.room_size_m)
        lines.append(f"  room      about {size} m")
    if summary.labelled:
        lines.append(f"  labels    {summary.labelled} frames")
    lines += [f"  note      {note}" for note in summary.notes]
    lines += [
        f"  skipped   {name}: {reason}" for name, reason in summary.skipped[:MAX_SKIPPED_LINES]
    ]
    if len(summary.skipped) > MAX_SKIPPED_LINES:
        lines.append(f"  skipped   and {len(summary.skipped) - MAX_SKIPPED_LINES} more")
    words = {"ok": "ok", "warn": "warning", "stop": "stop"}
    for diagnostic in summary.diagnostics:
        advice = f": {diagnostic.advice}" if diagnostic.advice else ""
        lines.append(f"  {words[diagnostic.level]:<9} {diagnostic.text}{advice}")
    return [*lines, f"next: {summary.next_command}"]


def _colour_text(summary: "CaptureSummary") -> str:
    if summary.colour_size_px is None:
        return "none"
    text = f"{summary.colour_size_px[0]}x{summary.colour_size_px[1]}"
    if summary.colour_focal_px is None:
        return f"{text}, focal length estimated with the poses"
    guessed = " (initial estimate)" * summary.lens_guessed
    return f"{text}, focal length {summary.colour_focal_px:.0f} px{guessed}"


def _depth_text(summary: "CaptureSummary") -> str:
    size, focal = summary.depth_size_px, summary.depth_focal_px
    if not summary.survey.validated.has_depth:
        return "none; computed from the images"
    lens = f"{size[0]}x{size[1]}, focal length {focal:.0f} px, " if size and focal else ""
    guessed = " (inferred)" * summary.depth_unit_guessed
    return f"{lens}{summary.depth_unit}{guessed}, median {summary.typical_depth_m:.1f} m"


def _poses_text(summary: "CaptureSummary") -> str:
    if not summary.posed:
        return "none; computed from the images"
    unit = "" if summary.survey.validated.capture.scale == "unknown" else " m"
    return (
        f"{summary.usable} valid, {summary.lost_poses} lost, camera positions span "
        f"{summary.cameras_apart_m:.1f}{unit}"
    )


def roomplan_lines(capture: Path, plan: "CapturedPlan") -> list[str]:
    """Return the printed text for a RoomPlan capture, with the next command as the last line."""
    rooms = plan.rooms
    kinds = ("walls", "openings", "objects")
    counts = [(kind, sum(len(getattr(room, kind)) for room in rooms)) for kind in kinds]
    held = ", ".join(
        f"{count} {kind if count != 1 else kind[:-1]}"
        for kind, count in [("rooms", len(rooms)), *counts]
    )
    return [
        f"{capture}: a RoomPlan capture with {held}",
        "  route     walls and furniture are built as measured: about 10 s",
        *(f"  note      {note}" for note in plan.notes),
        "  hint      with a scan of the same room: w2m reconstruct SCAN --plan "
        f"{shell_command([str(capture)])} --out OUT",
        f"next: {reconstruct_command(capture, {})}",
    ]


@dataclass(frozen=True)
class CaptureSummary:
    """The summary printed by ``w2m scan``.

    Attributes:
        folder: Path of the capture.
        source: Name of the format.
        route: Processing steps of ``w2m reconstruct``.
        frames: Number of all frames.
        usable: Number of frames that a reconstruction would use.
        lost_poses: Number of frames without a valid pose.
        posed: Whether the capture contains poses.
        colour_size_px: Width and height of the colour images, or None.
        depth_size_px: Width and height of the depth images, or None.
        colour_focal_px: Focal length of the colour images, or None if it is not stated.
        depth_focal_px: Focal length of the depth images, or None if it is not stated.
        lens_guessed: Whether the focal lengths are initial estimates.
        depth_unit: Depth unit in words.
        depth_unit_guessed: Whether the depth unit was inferred.
        typical_depth_m: Median depth in metres, or 0.
        cameras_apart_m: Largest extent of the camera positions along an axis.
        room_size_m: Size of the room in metres, or None.
        labelled: Number of frames with labels.
        skipped: Names of the skipped frames, with reasons.
        notes: Remarks about the capture.
        diagnostics: Findings, the most severe first.
        next_command: Command to run next.
        survey: Data from which the poster is drawn.
    """

    folder: AnyPath
    source: str
    route: Route
    frames: int
    usable: int
    lost_poses: int
    posed: bool
    colour_size_px: tuple[int, int] | None
    depth_size_px: tuple[int, int] | None
    colour_focal_px: float | None
    depth_focal_px: float | None
    lens_guessed: bool
    depth_unit: str
    depth_unit_guessed: bool
    typical_depth_m: float
    cameras_apart_m: float
    room_size_m: tuple[float, float, float] | None
    labelled: int
    skipped: tuple[tuple[str, str], ...]
    notes: tuple[str, ...]
    diagnostics: tuple[Diagnostic, ...]
    next_command: str
    survey: Survey = field(repr=False, compare=False)

    @property
    def warnings(self) -> tuple[str, ...]:
        """The texts of the diagnostics with a level other than ``ok``."""
        return tuple(diagnostic.text for diagnostic in self.diagnostics if diagnostic.level != "ok")


def describe_capture(
    path: str | Path, *, options: Mapping[str, str] | None = None
) -> CaptureSummary:
    """Summarise a capture from image headers and some decoded images.

    Raises:
        CaptureError: If the capture cannot be used.
        LimitError: If an image is too large.
    """
    return describe_validated(validate_capture(path, parse_options(options or {})), options)


def describe_validated(
    validated: ValidatedCapture, options: Mapping[str, str] | None = None
) -> CaptureSummary:
    """Summarise a validated capture. ``options`` are repeated in the next command."""
    frames = validated.frames
    survey = survey_capture(validated)
    route = choose_route(validated)
    colour = next((frame.colour_camera for frame in frames if frame.colour_camera), None)
    depth = next((frame.depth_camera for frame in frames if frame.depth_camera), None)
    room = None if survey.plan is None else survey.plan.room_size_m
    return CaptureSummary(
        folder=validated.capture.folder,
        source=validated.capture.source,
        route=route,
        frames=len(frames) + len(validated.skipped),
        usable=len(frames),
        lost_poses=sum("pose" in reason or "tracking" in reason for _, reason in validated.skipped),
        posed=validated.posed,
        colour_size_px=_colour_size(validated, colour),
        depth_size_px=_camera_size(depth),
        colour_focal_px=colour.fx_px if colour else None,
        depth_focal_px=depth.fx_px if depth else None,
        lens_guessed=validated.capture.lens == "guess",
        depth_unit=validated.encoding.description,
        depth_unit_guessed=validated.encoding.guessed,
        typical_depth_m=validated.typical_depth_m,
        cameras_apart_m=_camera_extent_m(survey),
        room_size_m=None if room is None else (float(room[0]), float(room[1]), float(room[2])),
        labelled=sum(frame.labels_path is not None for frame in frames),
        skipped=validated.skipped,
        notes=validated.notes,
        diagnostics=diagnose_capture(survey, route),
        next_command=reconstruct_command(validated.capture.folder, options or {}),
        survey=survey,
    )


def _camera_extent_m(survey: Survey) -> float:
    if survey.plan is None:
        return 0.0
    return float(np.ptp(survey.plan.cameras[:, :3, 3], axis=0).max())


def _camera_size(camera: Camera | None) -> tuple[int, int] | None:
    return (camera.width_px, camera.height_px) if camera else None


def _colour_size(validated: ValidatedCapture, camera: Camera | None) -> tuple[int, int] | None:
    """Return the size of the colour images, read from a header if no camera is stated."""
    place = next((frame.colour_path for frame in validated.frames if frame.colour_path), None)
    if camera is None and place is not None:
        return read_header(place).size
    return _camera_size(camera)
