"""``w2m dataset export``: a data set in the formats that other loaders read."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from world2minecraft.cli.dataset.options import MORE

if TYPE_CHECKING:
    from world2minecraft.api.datasets import ExportReport

EXAMPLES = """\
w2m dataset export DATA --format nyu --out NYU             for MonoScene, NDC-Scene, ISO, Symphonies
w2m dataset export DATA --format occscannet --out OCC      for ISO, EmbodiedOcc, GPOcc
w2m dataset export DATA --format embodied --out data       whole scenes, for EmbodiedOcc
w2m dataset export DATA --format npz --out NPZ             plain arrays, for anything
w2m dataset export DATA --format nyu --out NYU --limit 20  a few, to try
"""

ShortBin = Annotated[
    bool,
    typer.Option(
        "--short-bin",
        help="Of nyu, write only the headers of the .bin files.",
        rich_help_panel=MORE,
    ),
]
DataRoot = Annotated[
    str | None,
    typer.Option(
        "--data-root",
        help="Of occscannet and embodied, what the paths in files begin with.",
        show_default="./data/occscannet",
        rich_help_panel=MORE,
    ),
]
FramesPerScene = Annotated[
    int | None,
    typer.Option(
        "--frames-per-scene",
        min=0,
        help="Of embodied, frames of each scene; 0 for all.",
        show_default="30",
        rich_help_panel=MORE,
    ),
]


def run(
    source: Annotated[
        Path, typer.Argument(help="A data set, or a folder that w2m dataset import reads.")
    ],
    format: Annotated[str, typer.Option("--format", help="nyu, occscannet, embodied or npz.")],
    out: Annotated[Path, typer.Option("--out", "-o", help="The folder to write.")],
    split: Annotated[
        str | None, typer.Option("--split", help="train or test.", show_default="all")
    ] = None,
    limit: Annotated[
        int | None, typer.Option("--limit", min=1, help="Export this many samples at most.")
    ] = None,
    unknown: Annotated[
        str, typer.Option("--unknown", help="Write unknown cells as keep (255) or empty (0).")
    ] = "keep",
    in_view: Annotated[
        bool, typer.Option("--in-view", help="Make cells outside the image unknown.")
    ] = False,
    short_bin: ShortBin = False,
    data_root: DataRoot = None,
    frames_per_scene: FramesPerScene = None,
) -> None:
    """Write a data set in the format of NYUv2, OccScanNet, EmbodiedOcc-ScanNet, or as plain npz.

    Images are cropped and resampled where a format requires a certain camera. An export that was
    interrupted continues with the same command. docs/occupancy-formats.md describes every file.
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
        "occscannet": f"link {report.out} as data/occscannet where the loader runs",
        "embodied": f"link {report.out} as data where the loader runs",
        "npz": f"np.load('{report.out}/train/KEY.npz')",
    }
    print(f"use:  {first[format]}")
    print(f"next: w2m dataset show {report.out}")
