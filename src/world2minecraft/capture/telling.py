"""What a capture holds, in words for people and as values for programs."""

import dataclasses
import shlex
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from world2minecraft.core.archives import AnyPath

if TYPE_CHECKING:
    from world2minecraft.capture.describing import CaptureSummary
    from world2minecraft.formats.roomplan import CapturedPlan

SHOWN_SKIPPED = 8


def reconstructing(capture: AnyPath, options: Mapping[str, str]) -> str:
    """Return the command that reconstructs a capture read with some options, to be typed as it is.

    Example:
        >>> reconstructing(Path("my room"), {"unit": "cm"})
        "w2m reconstruct 'my room' --out OUT --set capture.unit=cm"
    """
    words = ["w2m", "reconstruct", str(capture), "--out", "OUT"]
    for name, value in options.items():
        words += ["--set", f"capture.{name}={value}"]
    return typed(words)


def typed(words: Sequence[str]) -> str:
    """Return words as one line for this system's shell, in quotes where they need them."""
    return subprocess.list2cmdline(words) if sys.platform == "win32" else shlex.join(words)


def as_data(summary: "CaptureSummary") -> dict[str, Any]:
    """Return a summary as JSON values: its fields without the pictures."""
    data = {
        field.name: getattr(summary, field.name)
        for field in dataclasses.fields(summary)
        if field.name not in ("survey", "route", "doubts", "folder")
    }
    route = {**dataclasses.asdict(summary.route), "about": summary.route.about}
    doubts = [dataclasses.asdict(doubt) for doubt in summary.doubts]
    return {"folder": str(summary.folder), "route": route, **data, "doubts": doubts}


def summary_lines(summary: "CaptureSummary") -> list[str]:
    """Return what is printed of a capture, the next command last."""
    route = summary.route
    usable = f"{summary.usable} of {summary.frames} frames usable"
    lines = [
        f"{summary.folder}: {route.called} ({summary.source}), {usable}",
        f"  route     {route.words}: {route.about}",
        f"  colour    {_colour(summary)}",
        f"  depth     {_depth(summary)}",
        f"  poses     {_poses(summary)}",
    ]
    if summary.room_size_m:
        size = " x ".join(f"{side:.1f}" for side in summary.room_size_m)
        lines.append(f"  room      about {size} m")
    if summary.labelled:
        lines.append(f"  labels    {summary.labelled} frames")
    lines += [f"  note      {note}" for note in summary.notes]
    lines += [f"  skipped   {name}: {reason}" for name, reason in summary.skipped[:SHOWN_SKIPPED]]
    if len(summary.skipped) > SHOWN_SKIPPED:
        lines.append(f"  skipped   and {len(summary.skipped) - SHOWN_SKIPPED} more")
    words = {"ok": "ok", "warn": "warning", "stop": "stop"}
    for doubt in summary.doubts:
        advice = f": {doubt.advice}" if doubt.advice else ""
        lines.append(f"  {words[doubt.level]:<9} {doubt.text}{advice}")
    return [*lines, f"next: {summary.next_command}"]


def _colour(summary: "CaptureSummary") -> str:
    if summary.colour_size_px is None:
        return "none"
    text = f"{summary.colour_size_px[0]}x{summary.colour_size_px[1]}"
    if summary.colour_focal_px is None:
        return f"{text}, focal length found with the poses"
    guessed = " (a first guess)" * summary.lens_guessed
    return f"{text}, focal length {summary.colour_focal_px:.0f} px{guessed}"


def _depth(summary: "CaptureSummary") -> str:
    size, focal = summary.depth_size_px, summary.depth_focal_px
    if not summary.survey.judged.has_depth:
        return "none; it is computed from the pictures"
    lens = f"{size[0]}x{size[1]}, focal length {focal:.0f} px, " if size and focal else ""
    guessed = " (guessed)" * summary.depth_unit_guessed
    return f"{lens}{summary.depth_unit}{guessed}, typically {summary.typical_depth_m:.1f} m away"


def _poses(summary: "CaptureSummary") -> str:
    if not summary.posed:
        return "none; they are found from the pictures"
    unit = "" if summary.survey.judged.capture.scale == "unknown" else " m"
    return (
        f"{summary.usable} good, {summary.lost_poses} lost, cameras up to "
        f"{summary.cameras_apart_m:.1f}{unit} apart"
    )


def plan_lines(capture: Path, plan: "CapturedPlan") -> list[str]:
    """Return what is printed of a RoomPlan, the next command last."""
    rooms = plan.rooms
    kinds = ("walls", "openings", "objects")
    counts = [(kind, sum(len(getattr(room, kind)) for room in rooms)) for kind in kinds]
    held = ", ".join(
        f"{count} {kind if count != 1 else kind[:-1]}"
        for kind, count in [("rooms", len(rooms)), *counts]
    )
    return [
        f"{capture}: a RoomPlan capture, {held}",
        "  route     walls and furniture are built as they were measured: about 10 s",
        *(f"  note      {note}" for note in plan.notes),
        "  hint      with a scan of the same room: w2m reconstruct SCAN --plan "
        f"{typed([str(capture)])} --out OUT",
        f"next: {reconstructing(capture, {})}",
    ]
