"""The worker tasks that turn a capture into a room: survey, reconstruct and generate a demo room.

Each task accepts and returns JSON values, so that it can run in a separate process.
"""

from dataclasses import replace
from pathlib import Path
from typing import Any

from world2minecraft.capture import describe_capture
from world2minecraft.capture.poster import poster_png
from world2minecraft.capture.readers.roomplan_detection import find_lone_roomplan
from world2minecraft.capture.summary import roomplan_lines, summary_lines, summary_to_json
from world2minecraft.construction import BuildParameters
from world2minecraft.core.files import write_bytes, write_json
from world2minecraft.core.output_folders import output_folder
from world2minecraft.core.progress import Progress
from world2minecraft.procgen import generate_room, scan_room
from world2minecraft.procgen.rooms.recipes import room_title
from world2minecraft.reconstruction.floorplans import read_roomplan
from world2minecraft.reconstruction.opening import scene_name
from world2minecraft.reconstruction.parameters import Parameters, with_settings
from world2minecraft.reconstruction.run_folder import RUN
from world2minecraft.runs import run_capture, run_plan

SURVEY, PICTURE = "survey.json", "survey.png"
DEMO_SEED, DEMO_FRAMES = 5, 40  # Those of ``w2m demo``.


def survey(capture: str, folder: str, progress: Progress) -> dict[str, Any]:
    """Survey a capture and write ``survey.json`` and, if the capture has frames, ``survey.png``.

    Returns:
        The contents of ``survey.json``: ``kind`` (``frames`` or ``plan``), ``called``, ``lines``
        [[name, text]], ``diagnostics`` [{level, text, advice}], ``can_start``, ``about_s``,
        ``frames``, ``has_scale`` and ``data``, which is the output of ``w2m scan --json``.

    Raises:
        CaptureError: If the path is not a capture. The message describes the supported captures.
    """
    source, target = Path(capture), Path(folder)
    progress("look", 0, 3)
    plan = find_lone_roomplan(source)
    if plan is not None:
        survey_data = _plan_told(source, roomplan_lines(source, read_roomplan(plan)))
    else:
        summary = describe_capture(source)
        progress("look", 1, 3)
        write_bytes(target / PICTURE, poster_png(summary))
        progress("look", 2, 3)
        stops = any(diagnostic.level == "stop" for diagnostic in summary.diagnostics)
        survey_data = {
            "kind": "frames",
            "route": summary.route.kind,
            "called": summary.route.called,
            "lines": _rows(summary_lines(summary)),
            "doubts": [
                {"level": diagnostic.level, "text": diagnostic.text, "advice": diagnostic.advice}
                for diagnostic in summary.diagnostics
            ],
            "can_start": summary.usable > 0 and not stops,
            "about_s": summary.route.about_s,
            "frames": summary.usable,
            "has_scale": summary.survey.validated.capture.scale == "metric"
            and not summary.route.from_pictures,
            "data": summary_to_json(summary),
        }
    write_json(target / SURVEY, survey_data)
    progress("look", 3, 3)
    return survey_data


def _plan_told(source: Path, lines: list[str]) -> dict[str, Any]:
    return {
        "kind": "plan",
        "route": "plan",
        "called": lines[0].partition(": ")[2] or source.name,
        "lines": _rows(lines),
        "doubts": [],
        "can_start": True,
        "about_s": 10.0,
        "frames": 0,
        "has_scale": True,
        "data": {},
    }


def _rows(lines: list[str]) -> list[list[str]]:
    """Return the named lines of a summary, between its heading and its next command."""
    rows = [line.strip().partition(" ") for line in lines[1:-1]]
    doubts = ("ok", "warning", "stop", "hint")
    return [[name, text.strip()] for name, _, text in rows if name not in doubts]


def parameters_of_choice(choice: dict[str, Any]) -> Parameters:
    """Return the build parameters for the options that a user chose.

    Args:
        choice: Any of ``blocks_per_metre``, ``style``, ``known`` [name, metres], ``mc_version`` and
            ``voxel_m``.

    Raises:
        UsageError: If a value is invalid. The message states the valid values.
    """
    plain = {"blocks_per_metre": float, "voxel_m": float, "mc_version": str}
    given = {key: kind(choice[key]) for key, kind in plain.items() if choice.get(key) is not None}
    chosen = Parameters(**given)
    if choice.get("known"):
        name, metres = choice["known"]
        chosen = replace(chosen, known=(str(name), float(metres)))
    style = choice.get("style")
    return with_settings(chosen, [f"build.style={style}"] if style else [])


def reconstruct(
    capture: str, out: str, choice: dict[str, Any], progress: Progress
) -> dict[str, Any]:
    """Reconstruct a capture into a run folder, and return the folder as ``out`` with a summary."""
    source, target, chosen = Path(capture), Path(out), parameters_of_choice(choice)
    plan = find_lone_roomplan(source)
    with output_folder(target, RUN, "reconstructed", source=source):
        if plan is not None:
            built = run_plan(plan, target, chosen, progress, scene_name(source))
            return {"out": out, "objects": built.objects}
        facts = run_capture(source, target, chosen, progress=progress)
    return {"out": out, "objects": len(facts["objects"]), "notes": facts["scan"]["notes"]}


def demo(
    out: str, progress: Progress, kind: str = "living", seed: int = DEMO_SEED, frames: int = 0
) -> dict[str, Any]:
    """Generate a room, scan it with a virtual camera and reconstruct it, as ``w2m demo`` does."""
    target = Path(out)
    with output_folder(target, RUN, "reconstructed"):
        progress("room", 0, 1)
        room = generate_room(seed, kind=kind)
        progress("room", 1, 1)
        capture = target / "capture"
        scan_room(room, capture, frames=frames or DEMO_FRAMES, seed=seed, progress=progress)
        chosen = Parameters(build=BuildParameters(plaque=room_title(kind)))
        facts = run_capture(capture, target, chosen, progress=progress)
    return {"out": out, "objects": len(facts["objects"])}
