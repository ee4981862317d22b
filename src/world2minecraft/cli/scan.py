"""Report the contents of a capture as text and as an image: ``w2m scan``."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from world2minecraft.core.errors import OutputError, UsageError

if TYPE_CHECKING:
    from world2minecraft.api.captures import CaptureReport

EXAMPLES = """\
w2m scan my_photos                        a folder of photos: JPEG, PNG, HEIC
w2m scan IMG_2041.MOV                     a phone's video
w2m scan kitchen.r3d                      the export of a LiDAR app; zips are read in place
w2m scan scene0000_00.sens                a data set's recording, or its folder
w2m scan room.glb --set capture.unit=cm   a mesh or a point cloud
w2m scan my_scan -o look.png              write the overview image to another file
w2m scan my_scan --json                   print JSON, without an image
"""


def run(
    capture: Annotated[
        Path,
        typer.Argument(help="Photos, video, app export, data set, mesh or point cloud."),
    ],
    picture: Annotated[
        Path | None,
        typer.Option(
            "--out",
            "-o",
            "--picture",
            metavar="PNG",
            help="Overview image to write.",
            show_default="NAME-scan.png",
        ),
    ] = None,
    no_picture: Annotated[
        bool, typer.Option("--no-picture", help="Do not write an image.")
    ] = False,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print JSON, and write no image.")
    ] = False,
    settings: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="capture.KEY=VALUE", help="Option of the capture reader."),
    ] = None,
) -> None:
    """Report the contents and shortcomings of a capture, and how to improve it.

    A few images are read and, if the capture has camera poses, a preliminary floor plan is computed
    within seconds. Only the overview image is written.

    Raises:
        UsageError: If options exclude each other.
        CaptureError: If the capture cannot be read.
    """
    from world2minecraft.api import inspect_capture
    from world2minecraft.cli.build.options import parse_settings

    if picture is not None and (no_picture or as_json):
        raise UsageError("--out writes an image; omit --no-picture and --json")
    report = inspect_capture(capture, settings=parse_settings(settings))
    if as_json:
        print(json.dumps(report.to_json(), indent=1))
        return
    lines = report.lines
    print("\n".join(lines[:-1]))
    if not no_picture and report.summary is not None:
        print(f"image: {_save_picture(report, picture)}")
    print(lines[-1])


def _save_picture(report: "CaptureReport", picture: Path | None) -> str:
    """Write the overview image, and return its path or the reason why it was not written."""
    if picture is not None:
        return str(report.save_picture(picture))
    name = "" if report.summary is None else Path(report.summary.folder.name).stem
    chosen = Path(f"{name or 'capture'}-scan.png")
    try:
        return str(report.save_picture(chosen, replace=False))
    except OutputError as error:
        return f"not written; {error}; choose another file with -o PNG"
