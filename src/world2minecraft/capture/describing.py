"""``describe_capture``: what a capture holds, told before any long work."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from world2minecraft.capture.images import read_header
from world2minecraft.capture.judged import JudgedCapture, judge_capture
from world2minecraft.capture.options import parse_options
from world2minecraft.capture.quality import Survey, survey_capture
from world2minecraft.capture.quality.diagnostics import Doubt, doubts_of
from world2minecraft.capture.quality.processing_route import Route, route_of
from world2minecraft.capture.telling import reconstructing
from world2minecraft.core.archives import AnyPath
from world2minecraft.core.types import Camera


@dataclass(frozen=True)
class CaptureSummary:
    """What ``w2m scan`` prints.

    ``frames`` counts all, ``usable`` those that a reconstruction would read; ``skipped`` names
    the others with reasons. Focal lengths are None where nothing is stated; ``lens_guessed`` says
    that they are a first guess. ``next_command`` is what to type. ``survey`` is what the picture
    is drawn from.
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
    doubts: tuple[Doubt, ...]
    next_command: str
    survey: Survey = field(repr=False, compare=False)

    @property
    def warnings(self) -> tuple[str, ...]:
        """The texts of the doubts that are no praise."""
        return tuple(doubt.text for doubt in self.doubts if doubt.level != "ok")


def describe_capture(
    path: str | Path, *, options: Mapping[str, str] | None = None
) -> CaptureSummary:
    """Describe a capture from its headers and some decoded images.

    Raises what ``judge_capture`` raises for captures that cannot be read.
    """
    return describe(judge_capture(path, parse_options(options or {})), options)


def describe(judged: JudgedCapture, options: Mapping[str, str] | None = None) -> CaptureSummary:
    """Describe a capture that is judged; ``options`` are named again in the next command."""
    frames = judged.frames
    survey = survey_capture(judged)
    route = route_of(judged)
    colour = next((frame.colour_camera for frame in frames if frame.colour_camera), None)
    depth = next((frame.depth_camera for frame in frames if frame.depth_camera), None)
    room = None if survey.plan is None else survey.plan.room_size_m
    return CaptureSummary(
        folder=judged.capture.folder,
        source=judged.capture.source,
        route=route,
        frames=len(frames) + len(judged.skipped),
        usable=len(frames),
        lost_poses=sum("pose" in reason or "tracking" in reason for _, reason in judged.skipped),
        posed=judged.posed,
        colour_size_px=_size(judged, colour),
        depth_size_px=_camera_size(depth),
        colour_focal_px=colour.fx_px if colour else None,
        depth_focal_px=depth.fx_px if depth else None,
        lens_guessed=judged.capture.lens == "guess",
        depth_unit=judged.encoding.said,
        depth_unit_guessed=judged.encoding.guessed,
        typical_depth_m=judged.typical_depth_m,
        cameras_apart_m=_apart_m(survey),
        room_size_m=None if room is None else (float(room[0]), float(room[1]), float(room[2])),
        labelled=sum(frame.labels_path is not None for frame in frames),
        skipped=judged.skipped,
        notes=judged.notes,
        doubts=doubts_of(survey, route),
        next_command=reconstructing(judged.capture.folder, options or {}),
        survey=survey,
    )


def _apart_m(survey: Survey) -> float:
    if survey.plan is None:
        return 0.0
    return float(np.ptp(survey.plan.cameras[:, :3, 3], axis=0).max())


def _camera_size(camera: Camera | None) -> tuple[int, int] | None:
    return (camera.width_px, camera.height_px) if camera else None


def _size(judged: JudgedCapture, camera: Camera | None) -> tuple[int, int] | None:
    """Return the size of the colour images, from a header where no camera is stated."""
    place = next((frame.colour_path for frame in judged.frames if frame.colour_path), None)
    if camera is None and place is not None:
        return read_header(place).size
    return _camera_size(camera)
