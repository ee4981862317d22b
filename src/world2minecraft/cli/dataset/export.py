"""``w2m dataset export``: a data set in the formats that the loaders of others read."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from world2minecraft.minecraftocc.exporters import ExportReport

EXAMPLES = """\
w2m dataset export DATA --format nyu --out NYU             for MonoScene, NDC-Scene, ISO, Symphonies
w2m dataset export DATA --format occscannet --out OCC      for ISO, EmbodiedOcc, GPOcc
w2m dataset export DATA --format embodied --out data       whole scenes, for EmbodiedOcc
w2m dataset export DATA --format npz --out NPZ             plain arrays, for anything
w2m dataset export DATA --format nyu --out NYU --limit 20  a few, to try
"""


def run(
    source: Annotated[
        Path, typer.Argument(help="A data set, or a folder that w2m dataset import reads.")
    ],
    format: Annotated[str, typer.Option("--format", help="nyu, occscannet, embodied or npz.")],
    out: Annotated[Path, typer.Option("--out", help="The folder to write.")],
    split: Annotated[
        str | None, typer.Option("--split", help="train or test alone; all by default.")
    ] = None,
    limit: Annotated[
        int | None, typer.Option("--limit", min=1, help="At most so many samples.")
    ] = None,
    unknown: Annotated[
        str, typer.Option("--unknown", help="Unknown cells: keep (255) or empty (0).")
    ] = "keep",
    in_view: Annotated[
        bool, typer.Option("--in-view", help="Make cells outside the picture unknown.")
    ] = False,
    short_bin: Annotated[
        bool, typer.Option("--short-bin", help="nyu: only the heads of the .bin files.")
    ] = False,
    data_root: Annotated[
        str | None,
        typer.Option("--data-root", help="occscannet, embodied: what paths in files begin with."),
    ] = None,
    frames_per_scene: Annotated[
        int | None,
        typer.Option("--frames-per-scene", min=0, help="embodied: 30 by default; 0 for all."),
    ] = None,
) -> None:
    """Write a data set in the format of NYUv2, OccScanNet, EmbodiedOcc-ScanNet, or as plain npz.

    Pictures are cropped and resampled where a format asks for a certain camera. An export that was
    stopped goes on when the same command is given again. docs/occupancy-formats.md has every file.
    """
    from world2minecraft.api.progress import show_progress
    from world2minecraft.minecraftocc.exporters import ExportRule, export_samples
    from world2minecraft.minecraftocc.exporters.options import DATA_ROOT, FRAMES_PER_SCENE
    from world2minecraft.minecraftocc.importers import open_occupancy

    rule = ExportRule(
        unknown=unknown,
        in_view=in_view,
        short_bin=short_bin,
        data_root=DATA_ROOT if data_root is None else data_root.rstrip("/"),
        frames_per_scene=FRAMES_PER_SCENE if frames_per_scene is None else frames_per_scene,
    )
    samples = open_occupancy(source)
    with show_progress() as progress:
        report = export_samples(
            samples, format, out, rule, split=split, limit=limit, progress=progress
        )
    _print_summary(report, format)


def _print_summary(report: "ExportReport", format: str) -> None:
    before = f", {report.passed_over} were there already" if report.passed_over else ""
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
