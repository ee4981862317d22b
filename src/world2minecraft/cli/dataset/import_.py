"""Convert a published occupancy data set to our own format: ``w2m dataset import``."""

from pathlib import Path
from typing import Annotated

import typer

from world2minecraft.cli.panels import Force

EXAMPLES = """\
w2m dataset import depthbin --labels preprocess --out NYU     NYUv2 as MonoScene has it
w2m dataset import OccScanNet --out OCC --limit 500           a few samples to try
w2m dataset import data --format embodied --out SCENES        EmbodiedOcc-ScanNet's frames
w2m dataset import NYUtrain/NYU0003_0000.bin --out ONE        one SSCNet file
"""


def run(
    source: Annotated[
        Path, typer.Argument(help="Folder of NYUv2, OccScanNet, EmbodiedOcc-ScanNet or npz files.")
    ],
    out: Annotated[Path, typer.Option("--out", "-o", help="New folder for the data set.")],
    format: Annotated[
        str | None,
        typer.Option("--format", help="nyu, occscannet, embodied or npz.", show_default="detected"),
    ] = None,
    labels: Annotated[
        Path | None,
        typer.Option(
            "--labels", help="Folder with MonoScene's base/, if stored elsewhere (nyu only)."
        ),
    ] = None,
    split: Annotated[
        str | None, typer.Option("--split", help="train or test.", show_default="all")
    ] = None,
    limit: Annotated[
        int | None, typer.Option("--limit", min=1, help="Maximum number of samples.")
    ] = None,
    force: Force = False,
) -> None:
    """Convert a published occupancy data set to our own format for training, scoring and viewing.

    Pickle files are read without executing code. A pickle file with anything other than arrays is
    rejected.
    """
    from world2minecraft.api import import_dataset, open_dataset
    from world2minecraft.api.progress import show_progress

    found = open_dataset(source, format=format, labels=labels)
    print(f"{source}: {found.describe()}")
    with show_progress() as progress:
        made = import_dataset(found, out, split=split, limit=limit, force=force, progress=progress)
    print(f"{len(made):,} samples written to {out}")
    print(f"next: w2m dataset show {out}")
