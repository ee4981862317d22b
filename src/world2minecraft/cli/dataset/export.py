"""Export a data set to published formats: ``w2m dataset export``."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from world2minecraft.cli.panels import MORE, Force

if TYPE_CHECKING:
    from world2minecraft.api.datasets import ExportReport

EXAMPLES = """\
w2m dataset export DATA --format nyu --out NYU             for MonoScene, NDC-Scene, ISO, Symphonies
w2m dataset export DATA --format occscannet --out OCC      for ISO, EmbodiedOcc, GPOcc
w2m dataset export DATA --format occscannet --out OCC --axes iso    to train ISO
w2m dataset export DATA --format embodied --out data       whole scenes, for EmbodiedOcc
w2m dataset export DATA --format npz --out NPZ             plain arrays
w2m dataset export DATA --format nyu --out NYU --limit 20  a few samples to try
"""

ShortBin = Annotated[
    bool,
    typer.Option(
        "--short-bin",
        help="Write only the headers of the .bin files (nyu only).",
        rich_help_panel=MORE,
    ),
]
DataRoot = Annotated[
    str | None,
    typer.Option(
        "--data-root",
        help="Prefix of the paths in the files (occscannet and embodied only).",
        show_default="./data/occscannet",
        rich_help_panel=MORE,
    ),
]
FramesPerScene = Annotated[
    int | None,
    typer.Option(
        "--frames-per-scene",
        min=0,
        help="Number of frames per scene, or 0 for all (embodied only).",
        show_default="30",
        rich_help_panel=MORE,
    ),
]

Axes = Annotated[
    str,
    typer.Option(
        "--axes",
        help="Axis order of the labels: published, or iso for ISO's loader (occscannet only).",
        rich_help_panel=MORE,
    ),
]


def run(
    source: Annotated[
        Path, typer.Argument(help="Data set, or a folder that w2m dataset import accepts.")
    ],
    format: Annotated[str, typer.Option("--format", help="nyu, occscannet, embodied or npz.")],
    out: Annotated[Path, typer.Option("--out", "-o", help="Output folder.")],
    split: Annotated[
        str | None, typer.Option("--split", help="train or test.", show_default="all")
    ] = None,
    limit: Annotated[
        int | None, typer.Option("--limit", min=1, help="Maximum number of samples.")
    ] = None,
    unknown: Annotated[
        str, typer.Option("--unknown", help="How to write unknown cells: keep (255) or empty (0).")
    ] = "keep",
    in_view: Annotated[
        bool, typer.Option("--in-view", help="Mark cells outside the image as unknown.")
    ] = False,
    short_bin: ShortBin = False,
    data_root: DataRoot = None,
    frames_per_scene: FramesPerScene = None,
    axes: Axes = "published",
    force: Force = False,
) -> None:
    """Export a data set in the format of NYUv2, OccScanNet, EmbodiedOcc-ScanNet, or as npz files.

    Images are cropped and resampled if the format requires a specific camera. Repeat the command to
    resume an interrupted export. docs/reference/occupancy-formats.md describes all files.
    """
    from world2minecraft.api import export_dataset
    from world2minecraft.api.progress import show_progress

    with show_progress() as progress:
        report = export_dataset(
            source,
            out,
            format,
            split=split,
            limit=limit,
            unknown=unknown,
            in_view=in_view,
            short_bin=short_bin,
            data_root=data_root,
            frames_per_scene=frames_per_scene,
            axes=axes,
            force=force,
            progress=progress,
        )
    _print_summary(report, format)


def _print_summary(report: "ExportReport", format: str) -> None:
    before = f", {report.passed_over} exist already" if report.passed_over else ""
    print(f"{report.written} samples written to {report.out}{before}")
    for note in report.notes:
        print(f"note: {note}")
    first = {
        "nyu": f"NYU_root={report.out} NYU_preprocess_root={report.out} for MonoScene",
        "occscannet": f"link {report.out} as data/occscannet next to the loader",
        "embodied": f"link {report.out} as data next to the loader",
        "npz": f"np.load('{report.out}/train/KEY.npz')",
    }
    print(f"use:  {first[format]}")
    print(f"next: w2m dataset show {report.out}")
