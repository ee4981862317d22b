"""Convert a capture to a Minecraft world with a report: ``w2m reconstruct``."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from world2minecraft.cli.build.options import (
    Formats,
    PaletteName,
    Scale,
    SettingList,
    Style,
    Version,
    parse_settings,
    print_style_note,
    split_names,
)
from world2minecraft.cli.panels import MORE, Force

if TYPE_CHECKING:
    from world2minecraft.api import Run

EXAMPLES = """\
w2m reconstruct my_scan -o OUT                         an app's export, RGB-D frames
w2m reconstruct IMG_2041.MOV -o OUT                    a phone's video; a folder of photos too
w2m reconstruct my_photos -o OUT --known "table height" 0.72
w2m reconstruct room.glb -o OUT                        a mesh or a point cloud
w2m reconstruct photo.jpg -o OUT --depth hf:ORG/NAME   one photo, with estimated depth
w2m reconstruct my_scan -o OUT --semantics hf:shi-labs/oneformer_ade20k_swin_tiny
w2m reconstruct my_scan -o OUT --predictions PRED --convention monoscene
w2m reconstruct my_scan -o OUT --from build --style display    repeat only the build
w2m reconstruct my_scan -o OUT --method paper          only the steps in the paper
w2m reconstruct my_scan -o OUT --follow                during the scan
"""

CapturePath = Annotated[
    Path, typer.Argument(help="Photos, video, app export, RGB-D frames, mesh or floor plan.")
]
Out = Annotated[Path, typer.Option("--out", "-o", help="Output folder.")]
Voxel = Annotated[float, typer.Option("--voxel", help="Cell size in metres.", rich_help_panel=MORE)]
Start = Annotated[
    str | None,
    typer.Option("--from", metavar="STAGE", help="Restart from a stage: scan, register, fuse, "
                 "label, find, furnish, build or report."),
]  # fmt: skip
LabelImages = Annotated[
    Path | None,
    typer.Option("--labels", help="Folder of 2D label images, one per frame."),
]
Method = Annotated[
    str, typer.Option("--method", help="best, or paper (only the steps in the paper).")
]
Follow = Annotated[
    bool,
    typer.Option("--follow", help="Watch a capture during recording until a file named done "
                 "appears.", rich_help_panel=MORE),
]  # fmt: skip
FollowIdle = Annotated[
    float,
    typer.Option("--follow-idle-s", rich_help_panel=MORE,
                 help="With --follow, stop after this many seconds without a frame."),
]  # fmt: skip
Known = Annotated[
    tuple[str, float] | None,
    typer.Option("--known", metavar="NAME METRES",
                 help='Known length that sets the scale of photos: "table height" 0.72.'),
]  # fmt: skip
KnownPoints = Annotated[
    tuple[str, str, float] | None,
    typer.Option("--known-points", metavar="A:x,y B:x,y METRES", rich_help_panel=MORE,
                 help="Pixels in photos A and B, and the distance of the points in metres."),
]  # fmt: skip
DepthModel = Annotated[
    str,
    typer.Option("--depth", "--depth-model", metavar="hf:ID",
                 help="Depth estimation network.", rich_help_panel=MORE),
]  # fmt: skip
Semantics = Annotated[
    str,
    typer.Option("--semantics", metavar="auto|generated|none|hf:ID",
                 rich_help_panel=MORE,
                 help="Segmentation network that names objects; auto is the built-in one."),
]  # fmt: skip
FieldOfView = Annotated[
    float | None,
    typer.Option("--fov", metavar="DEGREES", help="Vertical field of view of a single photo.",
                 show_default="from EXIF", rich_help_panel=MORE),
]  # fmt: skip
LabellerName = Annotated[
    str,
    typer.Option("--labeller", help="auto, completion, votes or geometric.", rich_help_panel=MORE),
]
PredictorName = Annotated[
    str,
    typer.Option("--predictor", help="depth; mono or mono:FILE.onnx for a monocular network.",
                 rich_help_panel=MORE),
]  # fmt: skip
Predictions = Annotated[
    Path | None,
    typer.Option("--predictions", metavar="DIR", help="Occupancy grids of another network: one "
                 "file per view, or one of the scene.", rich_help_panel=MORE),
]  # fmt: skip
Convention = Annotated[
    str,
    typer.Option("--convention", help="Axes of the predictions: monoscene, iso, embodiedocc, "
                 "sscnet or w2m.", show_default="detected", rich_help_panel=MORE),
]  # fmt: skip
Classes = Annotated[
    str,
    typer.Option("--classes", help="Class ids of the predictions: nyu12, embodied (12 is empty), "
                 "occscannet or a YAML file.", show_default="detected", rich_help_panel=MORE),
]  # fmt: skip
Plan = Annotated[
    Path | None,
    typer.Option("--plan", help="RoomPlan of the same room, used as additional evidence.",
                 rich_help_panel=MORE),
]  # fmt: skip


def run(
    capture: CapturePath,
    out: Out,
    voxel: Voxel = 0.08,
    blocks_per_metre: Scale = 4.0,
    style: Style = None,
    palette: PaletteName = None,
    formats: Formats = None,
    start: Start = None,
    labels: LabelImages = None,
    labeller: LabellerName = "auto",
    method: Method = "best",
    known: Known = None,
    known_points: KnownPoints = None,
    depth_model: DepthModel = "",
    semantics: Semantics = "auto",
    predictor: PredictorName = "depth",
    predictions: Predictions = None,
    convention: Convention = "",
    classes: Classes = "",
    fov: FieldOfView = None,
    plan: Plan = None,
    mc_version: Version = "1.20.1",
    settings: SettingList = None,
    follow: Follow = False,
    follow_idle_s: FollowIdle = 60.0,
    force: Force = False,
) -> None:
    """Convert a capture to a Minecraft world.

    The world opens in creative mode with the player inside the room. Repeat the command to resume
    an interrupted run after its last completed stage. For photos and videos, camera poses and depth
    are estimated first, which takes one or two minutes.
    """
    from world2minecraft.api import reconstruct
    from world2minecraft.api.progress import show_progress

    changes = parse_settings(settings)
    print_style_note(blocks_per_metre, changes.get("build.style", style))
    with show_progress() as progress:
        made = reconstruct(
            capture, out, labels=labels, method=method, voxel_m=voxel,
            blocks_per_metre=blocks_per_metre, style=style, palette=palette,
            formats=split_names(formats), mc_version=mc_version, known=known,
            known_points=known_points, fov_deg=fov, plan=plan, depth_model=depth_model,
            semantics=semantics, predictor=predictor, predictions=predictions,
            convention=convention, classes=classes, labeller=labeller, start=start,
            follow=follow, follow_idle_s=follow_idle_s, settings=changes, force=force,
            progress=progress,
        )  # fmt: skip
    print_run(made)


def print_run(made: "Run") -> None:
    """Print the results of a run and the next steps. A floor plan has no frames to report."""
    from world2minecraft.cli.outcome import print_outcome, print_play_steps

    if "scan" in made.report:
        print_outcome(made.folder, made.report)
        return
    size = " x ".join(f"{side:.1f}" for side in made.report["room_size_m"])
    rooms, objects = len(made.report["rooms"]), len(made.objects)
    print(f"\n{rooms} room{'s' * (rooms != 1)} of a floor plan, {size} m, {objects} objects.")
    print("note: a plan has no colours; floor, walls and furniture use typical colours")
    for note in made.report["notes"]:
        print(f"note: {note}")
    print(f"\n  look   {made.folder / 'report.html'} in a browser, {made.folder / 'preview.png'}")
    print_play_steps(made.folder / "build")
