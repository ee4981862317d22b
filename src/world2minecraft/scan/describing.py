"""``describe_capture``: what a folder holds, told before any long work."""

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from world2minecraft.archive import AnyPath
from world2minecraft.scan.judged import JudgedCapture, judge_capture
from world2minecraft.scan.options import parse_options
from world2minecraft.types import Camera


@dataclass(frozen=True)
class CaptureSummary:
    """What ``w2m scan`` prints.

    ``frames`` counts all, ``usable`` those that a reconstruction would read; ``skipped`` names
    the others with reasons. ``next_command`` is what to type.
    """

    folder: AnyPath
    source: str
    frames: int
    usable: int
    lost_poses: int
    colour_size_px: tuple[int, int] | None
    depth_size_px: tuple[int, int] | None
    colour_focal_px: float | None
    depth_focal_px: float | None
    depth_unit: str
    depth_unit_guessed: bool
    typical_depth_m: float
    cameras_apart_m: float
    labelled: int
    skipped: tuple[tuple[str, str], ...]
    notes: tuple[str, ...]
    warnings: tuple[str, ...]
    next_command: str


def describe_capture(
    path: str | Path, *, options: Mapping[str, str] | None = None
) -> CaptureSummary:
    """Describe a capture from its headers and a few decoded images.

    Raises what ``open_scan`` raises for captures that cannot be used.
    """
    judged = judge_capture(path, parse_options(options or {}))
    frames = judged.frames
    places = np.array([np.asarray(frame.camera_to_world)[:3, 3] for frame in frames])
    colour = next((frame.colour_camera for frame in frames if frame.colour_camera), None)
    depth = next((frame.depth_camera for frame in frames if frame.depth_camera), None)
    return CaptureSummary(
        folder=judged.capture.folder,
        source=judged.capture.source,
        frames=len(judged.capture.frames),
        usable=len(frames),
        lost_poses=sum("pose" in reason or "tracking" in reason for _, reason in judged.skipped),
        colour_size_px=_size(colour),
        depth_size_px=_size(depth),
        colour_focal_px=colour.fx_px if colour else None,
        depth_focal_px=depth.fx_px if depth else None,
        depth_unit=judged.encoding.said,
        depth_unit_guessed=judged.encoding.guessed,
        typical_depth_m=judged.typical_depth_m,
        cameras_apart_m=float(np.ptp(places, axis=0).max()),
        labelled=sum(frame.labels_path is not None for frame in frames),
        skipped=judged.skipped,
        notes=judged.notes,
        warnings=_warnings(judged, colour is None),
        next_command=f"w2m reconstruct {judged.capture.folder} --out OUT",
    )


def _size(camera: Camera | None) -> tuple[int, int] | None:
    return (camera.width_px, camera.height_px) if camera else None


def _warnings(judged: JudgedCapture, colourless: bool) -> tuple[str, ...]:
    warnings = []
    total = len(judged.capture.frames)
    for reason, count in Counter(reason for _, reason in judged.skipped).most_common(3):
        warnings.append(f"{count} of {total} frames are left out: {reason}")
    if len(judged.frames) < 10:
        warnings.append(f"only {len(judged.frames)} frames; 30 or more from all sides show a room")
    if colourless:
        warnings.append("no colour images: blocks will have the colours of their classes")
    if judged.capture.one_matrix:
        warnings.append("depth and colour share one stated matrix; the colour camera is estimated")
    return tuple(warnings)
