"""``w2m scan``: what a capture holds, as text and as one picture, before any long work."""

import dataclasses
import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from world2minecraft.exchange.roomplan import CapturedPlan
    from world2minecraft.scan import CaptureSummary

SHOWN_SKIPPED = 8
EXAMPLES = """\
w2m scan my_photos                        a folder of photos: JPEG, PNG, HEIC
w2m scan IMG_2041.MOV                     a phone's video
w2m scan kitchen.r3d                      what a LiDAR app exports: zips are read in place
w2m scan scene0000_00.sens                a data set's recording; its folders too
w2m scan room.glb --set capture.unit=cm   a mesh or a point cloud
w2m scan my_scan --picture look.png       the picture elsewhere; --no-picture for none
w2m scan my_scan --json                   for programs
"""


def run(
    capture: Annotated[
        Path,
        typer.Argument(help="Photos, a video, an app's export, a data set, a mesh, a cloud ..."),
    ],
    picture: Annotated[
        Path | None,
        typer.Option("--picture", help="Where the picture goes; NAME-scan.png here by default."),
    ] = None,
    no_picture: Annotated[bool, typer.Option("--no-picture", help="Draw none.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON; no picture.")] = False,
    settings: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="capture.KEY=VALUE", help="An option of the reader."),
    ] = None,
) -> None:
    """Tell what was found in a capture, what is missing, and what to do about it.

    A few pictures are looked at, and where there are poses a first plan is laid out, in seconds.
    Nothing but the picture is written.

    Args:
        capture: what to look at.
        picture: where the picture goes.
        no_picture: draw none.
        as_json: print JSON.
        settings: options of the reader, such as ``capture.depth_unit=mm``.
    """
    from world2minecraft.errors import UsageError
    from world2minecraft.exchange.roomplan import find_roomplan, read_roomplan
    from world2minecraft.parameters import Parameters, with_settings
    from world2minecraft.scan import describe_capture

    if picture is not None and (no_picture or as_json):
        raise UsageError("--picture draws one; leave out --no-picture and --json")
    options = with_settings(Parameters(), settings or []).capture
    plan = find_roomplan(capture)
    if plan is not None:
        _print_all(plan_lines(capture, read_roomplan(plan)), as_json)
        return
    summary = describe_capture(capture, options=options)
    if as_json:
        print(json.dumps(as_data(summary), indent=1))
        return
    lines = summary_lines(summary)
    for line in lines[:-1]:
        print(line)
    if not no_picture:
        print(f"picture: {_write_picture(summary, picture)}")
    print(lines[-1])


def _print_all(lines: list[str], as_json: bool) -> None:
    print(json.dumps({"lines": lines}, indent=1) if as_json else "\n".join(lines))


def _write_picture(summary: "CaptureSummary", picture: Path | None) -> str:
    """Write the picture and return where it is, or why there is none."""
    from world2minecraft.errors import OutputError
    from world2minecraft.files import write_bytes
    from world2minecraft.scan.poster import is_poster, poster_png

    chosen = picture or Path(f"{Path(summary.folder.name).stem or 'capture'}-scan.png")
    if picture is None and chosen.exists() and not is_poster(chosen):
        return f"none; {chosen} is here and not one of these: say --picture PATH"
    data = poster_png(summary)
    try:
        write_bytes(chosen, data)
    except OutputError:
        if picture is not None:
            raise
        return "none; this folder cannot be written: say --picture PATH"
    return str(chosen)


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
        f"{capture} --out OUT",
        f"next: w2m reconstruct {capture} --out OUT",
    ]
