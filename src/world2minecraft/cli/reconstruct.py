"""``w2m reconstruct``: turn a capture into a Minecraft world, with a report."""

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
from world2minecraft.cli.panels import MORE

if TYPE_CHECKING:
    from world2minecraft.api import Run

EXAMPLES = """\
w2m reconstruct my_scan -o OUT                         an app's export, RGB-D frames
w2m reconstruct IMG_2041.MOV -o OUT                    a phone's video; a folder of photos too
w2m reconstruct my_photos -o OUT --known "table height" 0.72
w2m reconstruct room.glb -o OUT                        a mesh or a point cloud
w2m reconstruct photo.jpg -o OUT --depth hf:ORG/NAME   one photo, its depth by a network
w2m reconstruct my_scan -o OUT --semantics hf:shi-labs/oneformer_ade20k_swin_tiny
w2m reconstruct my_scan -o OUT --from build --style display    build again, all else unchanged
w2m reconstruct my_scan -o OUT --method paper          the paper's steps alone
w2m reconstruct my_scan -o OUT --follow                while the scan still goes on
"""

CapturePath = Annotated[
    Path, typer.Argument(help="Photos, a video, an app's export, frames, a mesh, a plan.")
]
Out = Annotated[Path, typer.Option("--out", "-o", help="Folder of the results.")]
Voxel = Annotated[
    float, typer.Option("--voxel", help="Size of a cell in metres.", rich_help_panel=MORE)
]
Start = Annotated[
    str | None,
    typer.Option("--from", metavar="STAGE", help="Start from a stage: scan, register, fuse, label, "
                 "find, furnish, build or report."),
]  # fmt: skip
LabelImages = Annotated[
    Path | None,
    typer.Option("--labels", help="Folder of 2D label images, one for each frame."),
]
Method = Annotated[
    str, typer.Option("--method", help="best, or paper: the steps of the paper alone.")
]
Follow = Annotated[
    bool,
    typer.Option("--follow", help="Watch a capture that still grows, until a file named done "
                 "appears.", rich_help_panel=MORE),
]  # fmt: skip
FollowIdle = Annotated[
    float,
    typer.Option("--follow-idle-s", help="Seconds without a new frame that end --follow.",
                 rich_help_panel=MORE),
]  # fmt: skip
Known = Annotated[
    tuple[str, float] | None,
    typer.Option("--known", metavar="NAME METRES",
                 help='A length that gives photos their scale: "table height" 0.72.'),
]  # fmt: skip
KnownPoints = Annotated[
    tuple[str, str, float] | None,
    typer.Option("--known-points", metavar="A:x,y B:x,y METRES", rich_help_panel=MORE,
                 help="Pixels of photos A and B, and the metres between what they show."),
]  # fmt: skip
DepthModel = Annotated[
    str,
    typer.Option("--depth", "--depth-model", metavar="hf:ID",
                 help="Network for the depth of pictures.", rich_help_panel=MORE),
]  # fmt: skip
Semantics = Annotated[
    str,
    typer.Option("--semantics", metavar="hf:ID", help="Network that segments the pictures.",
                 rich_help_panel=MORE),
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
Plan = Annotated[
    Path | None,
    typer.Option("--plan", help="RoomPlan of the same room, as further evidence.",
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
    semantics: Semantics = "",
    predictor: PredictorName = "depth",
    fov: FieldOfView = None,
    plan: Plan = None,
    mc_version: Version = "1.20.1",
    settings: SettingList = None,
    follow: Follow = False,
    follow_idle_s: FollowIdle = 60.0,
) -> None:
    """Turn a capture into a Minecraft world.

    The world opens in creative mode, with the player standing in the room. A run that was
    interrupted continues after its last finished stage when the same command is given again.
    Photos and videos are given poses and depth first, which takes a minute or two.
    """
    from world2minecraft.api import reconstruct
    from world2minecraft.api.progress import show_progress
    from world2minecraft.cli.outcome import with_compile_note

    changes = parse_settings(settings)
    print_style_note(blocks_per_metre, changes.get("build.style", style))
    with show_progress() as shown:
        progress = with_compile_note(shown)
        made = reconstruct(
            capture,
            out,
            labels=labels,
            method=method,
            voxel_m=voxel,
            blocks_per_metre=blocks_per_metre,
            style=style,
            palette=palette,
            formats=split_names(formats),
            mc_version=mc_version,
            known=known,
            known_points=known_points,
            fov_deg=fov,
            plan=plan,
            depth_model=depth_model,
            semantics=semantics,
            predictor=predictor,
            labeller=labeller,
            start=start,
            follow=follow,
            follow_idle_s=follow_idle_s,
            settings=changes,
            progress=progress,
        )
    print_run(made)


def print_run(made: "Run") -> None:
    """Print what a run found and the next steps; a plan alone has no frames to speak of."""
    from world2minecraft.cli.outcome import print_outcome, print_play_steps

    if "scan" in made.report:
        print_outcome(made.folder, made.report)
        return
    size = " x ".join(f"{side:.1f}" for side in made.report["room_size_m"])
    rooms, objects = len(made.report["rooms"]), len(made.objects)
    print(f"\n{rooms} room{'s' * (rooms != 1)} of a floor plan, {size} m, {objects} objects.")
    print("note: a plan has no colours; floor, walls and furniture have typical ones")
    for note in made.report["notes"]:
        print(f"note: {note}")
    print(f"\n  look   {made.folder / 'report.html'} in a browser, {made.folder / 'preview.png'}")
    print_play_steps(made.folder / "build")
