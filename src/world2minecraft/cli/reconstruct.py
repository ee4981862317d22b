"""``w2m reconstruct``: a capture becomes a Minecraft world, with a report."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from world2minecraft.cli.build.options import (
    Formats,
    PaletteName,
    Scale,
    Settings,
    Style,
    Version,
    style_note,
    with_build_options,
)

if TYPE_CHECKING:
    from world2minecraft.core.progress import Progress
    from world2minecraft.reconstruction.floorplans import PlanWorld
    from world2minecraft.reconstruction.parameters import Parameters

# A plan alone in ``w2m reconstruct``: what came of it, told.


def print_plan_outcome(out: Path, built: "PlanWorld") -> None:
    """Print what came of a plan, and how to see it."""
    from world2minecraft.cli.outcome import print_play_steps

    size = " x ".join(f"{side:.1f}" for side in built.scan.room_size_m)
    count = len(built.layouts)
    print(f"\n{count} room{'s' * (count != 1)} of a plan, {size} m, {built.objects} objects.")
    print("note: a plan has no colours; floor, walls and furniture have usual ones")
    for note in built.scan.notes:
        print(f"note: {note}")
    print(f"\n  look   {out / 'report.html'} in a browser, {out / 'preview.png'}")
    print_play_steps(out / "build")


EXAMPLES = """\
w2m reconstruct my_scan --out OUT                         the whole way
w2m reconstruct IMG_2041.MOV --out OUT                    a phone's video; a folder of photos too
w2m reconstruct my_photos --out OUT --known "table height" 0.72
w2m reconstruct photo.jpg --out OUT --depth hf:ORG/NAME   one photo, its depth by a network
w2m reconstruct photo.jpg --out OUT --predictor mono --fov 55
w2m reconstruct room.glb --out OUT                        a mesh or a point cloud
w2m reconstruct my_scan --out OUT --blocks-per-metre 2    smaller, coarser
w2m reconstruct my_scan --out OUT --labels my_labels      with 2D label images
w2m reconstruct my_scan --out OUT --semantics hf:shi-labs/oneformer_ade20k_swin_tiny
w2m reconstruct my_scan --out OUT --from build            build again, all before kept
w2m reconstruct my_scan --out OUT --method paper          the paper's steps alone
w2m reconstruct my_scan --out OUT --set find.cluster_radius=3
w2m reconstruct my_scan --out OUT --follow                while the scan still goes on
"""


CapturePlace = Annotated[
    Path, typer.Argument(help="Photos, a video, a scan, a mesh ...; w2m scan tells.")
]
Start = Annotated[
    str | None,
    typer.Option("--from", metavar="STAGE", help="scan, register, fuse, ... or report."),
]
LabelImages = Annotated[
    Path | None, typer.Option("--labels", help="A folder of 2D label images, one a frame.")
]
Method = Annotated[str, typer.Option("--method", help="best, or paper: its steps and no others.")]
Follow = Annotated[
    bool,
    typer.Option("--follow", help="Watch a capture that still grows; a file named done ends it."),
]


FollowIdle = Annotated[
    float, typer.Option("--follow-idle-s", help="Seconds without a new frame that end --follow.")
]
Known = Annotated[
    tuple[str, float] | None,
    typer.Option("--known", metavar="NAME METRES", help='A length: "table height" 0.72.'),
]
KnownPoints = Annotated[
    tuple[str, str, float] | None,
    typer.Option(
        "--known-points",
        metavar="A:x,y B:x,y METRES",
        help="Two pixels, of photos A and B, and the metres between what they show.",
    ),
]
DepthModel = Annotated[
    str,
    typer.Option(
        "--depth", "--depth-model", metavar="hf:ID", help="A network for the depth of pictures."
    ),
]
Semantics = Annotated[
    str,
    typer.Option("--semantics", metavar="hf:ID", help="A network that says what pixels show."),
]
FieldOfView = Annotated[
    float | None,
    typer.Option("--fov", metavar="DEGREES", help="Of one photo: lower to upper edge; else EXIF."),
]
LabellerName = Annotated[
    str, typer.Option("--labeller", help="auto, completion, votes or geometric.")
]
PredictorName = Annotated[
    str, typer.Option("--predictor", help="depth; mono, or mono:FILE.onnx: the paper's way.")
]
Plan = Annotated[
    Path | None, typer.Option("--plan", help="A RoomPlan of the same room, as more evidence.")
]


def run(
    capture: CapturePlace,
    out: Annotated[Path, typer.Option("--out", help="The folder of the results.")],
    voxel: Annotated[float, typer.Option("--voxel", help="Size of a cell, in metres.")] = 0.08,
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
    settings: Settings = None,
    follow: Follow = False,
    follow_idle_s: FollowIdle = 60.0,
) -> None:
    """Turn a capture into a Minecraft world.

    The world opens in creative mode, standing in the room. A run that was cut off goes on from
    its last finished stage when the same command is given again. Photos and videos are given
    poses and depth first, which takes a minute or two.
    """
    from world2minecraft.cli.outcome import print_compile_note, print_outcome
    from world2minecraft.cli.progress import show_progress
    from world2minecraft.reconstruction.parameters import Parameters, with_method, with_settings
    from world2minecraft.runs import run_capture

    chosen = Parameters(
        voxel,
        blocks_per_metre,
        predictor,
        labeller=labeller,
        mc_version=mc_version,
        known=known,
        known_points=known_points,
        depth_model=depth_model,
        plan="" if plan is None else str(plan),
    )
    chosen = with_build_options(with_method(chosen, method), style, palette, formats)
    chosen = with_settings(chosen, option_settings(semantics, fov) + (settings or []))
    check_stage(start, follow)
    style_note(chosen)
    print_compile_note()
    needs_frames = {"--from": start, "--labels": labels, "--follow": follow}
    if build_lone_plan(capture, out, chosen, [name for name in needs_frames if needs_frames[name]]):
        return
    with show_progress() as progress:
        if follow:
            follow_capture(capture, out, chosen, labels, follow_idle_s, progress)
        facts = run_capture(capture, out, chosen, start, labels, progress)
    print_outcome(out, facts)


def check_stage(start: str | None, follow: bool) -> None:
    """Raise UsageError, before any work, where ``--from`` names no stage, or goes not with it."""
    from world2minecraft.core.errors import UnknownNameError, UsageError
    from world2minecraft.reconstruction.pipeline import STAGES

    if follow and start is not None:
        raise UsageError("--follow reads a whole capture; leave out --from")
    stages = (*STAGES, "report")
    if start is not None and start not in stages:
        raise UnknownNameError("stage", start, stages)


def option_settings(semantics: str, fov: float | None) -> list[str]:
    """Return options that stand for settings as such."""
    told = {"occupy.semantics": semantics, "capture.fov_deg": "" if fov is None else str(fov)}
    return [f"{key}={value}" for key, value in told.items() if value]


def build_lone_plan(
    capture: Path, out: Path, chosen: "Parameters", needs_frames: list[str]
) -> bool:
    """Build what a RoomPlan alone says, where the capture is one; return whether it is.

    UsageError for options that need frames, of which a plan has none.
    """
    from world2minecraft.capture.readers.roomplan_detection import find_lone_roomplan
    from world2minecraft.cli.progress import show_progress
    from world2minecraft.core.errors import UsageError
    from world2minecraft.reconstruction.opening import scene_name
    from world2minecraft.runs import run_plan

    drawn = find_lone_roomplan(capture)
    if drawn is None:
        return False
    if needs_frames:
        raise UsageError(
            f"{capture} is a RoomPlan and has no frames; leave out {' and '.join(needs_frames)}"
        )
    with show_progress() as progress:
        built = run_plan(drawn, out, chosen, progress, scene_name(capture))
    print_plan_outcome(out, built)
    return True


def follow_capture(
    capture: Path,
    out: Path,
    chosen: "Parameters",
    labels: Path | None,
    idle_s: float,
    progress: "Progress",
) -> None:
    """Follow a capture until it is complete."""
    from world2minecraft.reconstruction.online import follow

    follow(capture, out, chosen, labels=labels, idle_s=idle_s, progress=progress)
