"""``w2m scan``: what a capture holds, as text and as one picture, before any long work."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from world2minecraft.capture import CaptureSummary

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
    from world2minecraft.capture import describe_capture
    from world2minecraft.capture.readers.roomplan_detection import find_lone_roomplan
    from world2minecraft.capture.summary import roomplan_lines, summary_lines, summary_to_json
    from world2minecraft.core.errors import UsageError
    from world2minecraft.formats.roomplan import read_roomplan
    from world2minecraft.reconstruction.parameters import Parameters, with_settings

    if picture is not None and (no_picture or as_json):
        raise UsageError("--picture draws one; leave out --no-picture and --json")
    options = with_settings(Parameters(), settings or []).capture
    plan = find_lone_roomplan(capture)
    if plan is not None:
        _print_all(roomplan_lines(capture, read_roomplan(plan)), as_json)
        return
    summary = describe_capture(capture, options=options)
    if as_json:
        print(json.dumps(summary_to_json(summary), indent=1))
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
    from world2minecraft.capture.poster import is_poster, poster_png
    from world2minecraft.core.errors import OutputError
    from world2minecraft.core.files import write_bytes

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
