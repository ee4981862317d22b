"""``w2m reconstruct``: a capture becomes a Minecraft world, with a report."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from world2minecraft.cli.build_options import (
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
    from world2minecraft.parameters import Parameters
    from world2minecraft.progress import Progress

EXAMPLES = """\
w2m reconstruct my_scan --out OUT                         the whole way
w2m reconstruct my_scan --out OUT --blocks-per-metre 2    smaller, coarser
w2m reconstruct my_scan --out OUT --labels my_labels      with 2D label images
w2m reconstruct my_scan --out OUT --from build            build again, all before kept
w2m reconstruct my_scan --out OUT --method paper          the paper's steps alone
w2m reconstruct my_scan --out OUT --set find.cluster_radius=3
w2m reconstruct my_scan --out OUT --follow                while the scan still goes on
"""


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


def run(
    capture: Annotated[Path, typer.Argument(help="A folder of posed RGB-D frames.")],
    out: Annotated[Path, typer.Option("--out", help="The folder of the results.")],
    voxel: Annotated[float, typer.Option("--voxel", help="Size of a cell, in metres.")] = 0.08,
    blocks_per_metre: Scale = 4.0,
    style: Style = None,
    palette: PaletteName = None,
    formats: Formats = None,
    start: Start = None,
    labels: LabelImages = None,
    labeller: Annotated[str, typer.Option("--labeller", help="auto, votes or geometric.")] = "auto",
    method: Method = "best",
    mc_version: Version = "1.20.1",
    settings: Settings = None,
    follow: Follow = False,
    follow_idle_s: Annotated[
        float,
        typer.Option("--follow-idle-s", help="Seconds without a new frame that end --follow."),
    ] = 60.0,
) -> None:
    """Turn a capture into a Minecraft world.

    The world opens in creative mode, standing in the room. A run that was cut off goes on from
    its last finished stage when the same command is given again.

    Args:
        capture: the folder to read; ``w2m scan`` tells what it holds.
        out: the folder to write.
        voxel: the cell's size in metres.
        blocks_per_metre: the scale.
        style: what furniture is made of.
        palette: which blocks may be used.
        formats: further forms of the build.
        start: the stage to begin at.
        labels: 2D label images.
        labeller: how cells are labelled.
        method: how objects and poses are found.
        mc_version: the game version.
        settings: further parameters.
        follow: keep room.npz and preview.png fresh while frames come, then finish.
        follow_idle_s: how long to wait for a new frame.
    """
    from world2minecraft.cli.outcome import compiling_note, say_where
    from world2minecraft.cli.progress import shown
    from world2minecraft.errors import UsageError
    from world2minecraft.parameters import Parameters, with_method, with_settings

    chosen = Parameters(voxel, blocks_per_metre, labeller=labeller, mc_version=mc_version)
    chosen = with_build_options(with_method(chosen, method), style, palette, formats)
    chosen = with_settings(chosen, settings or [])
    if follow and start is not None:
        raise UsageError("--follow reads a whole capture; leave out --from")
    style_note(chosen)
    compiling_note()
    with shown() as progress:
        if follow:
            watch(capture, out, chosen, labels, follow_idle_s, progress)
        facts = make(capture, out, chosen, start, labels, progress)
    say_where(out, facts)


def watch(
    capture: Path,
    out: Path,
    chosen: "Parameters",
    labels: Path | None,
    idle_s: float,
    progress: "Progress",
) -> None:
    """Follow a capture until it is complete."""
    from world2minecraft.live import follow

    follow(capture, out, chosen, labels=labels, idle_s=idle_s, progress=progress)


def make(
    capture: Path,
    out: Path,
    chosen: "Parameters",
    start: str | None,
    labels: Path | None,
    progress: "Progress",
) -> dict[str, Any]:
    """Run the pipeline and write its report; return what ``report.json`` holds."""
    from world2minecraft.pipeline import reconstruct, registered_before
    from world2minecraft.report import write_report
    from world2minecraft.scan import open_scan

    if start == "report":
        options = {"labels": labels, "options": chosen.capture}
        scan = open_scan(capture, voxel_m=chosen.voxel_m, progress=progress, **options)
        scan = registered_before(scan, out)
    else:
        scan = reconstruct(capture, out, chosen, start=start, labels=labels, progress=progress)
    truth = capture if (capture / "truth.npz").is_file() else None
    return write_report(out, scan, truth=truth, progress=progress)
