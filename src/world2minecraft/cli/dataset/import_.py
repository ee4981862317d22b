"""``w2m dataset import``: convert a published occupancy data set into one of ours."""

from pathlib import Path
from typing import Annotated

import typer

EXAMPLES = """\
w2m dataset import depthbin --labels preprocess --out NYU     NYUv2 as MonoScene has it
w2m dataset import OccScanNet --out OCC --limit 500           a part, to try
w2m dataset import data --format embodied --out SCENES        EmbodiedOcc-ScanNet's frames
w2m dataset import NYUtrain/NYU0003_0000.bin --out ONE        one SSCNet file
"""


def run(
    source: Annotated[
        Path, typer.Argument(help="A folder of NYUv2, OccScanNet, EmbodiedOcc-ScanNet or npz.")
    ],
    out: Annotated[Path, typer.Option("--out", "-o", help="The data set to write, a new folder.")],
    format: Annotated[
        str | None,
        typer.Option("--format", help="nyu, occscannet, embodied or npz.", show_default="detected"),
    ] = None,
    labels: Annotated[
        Path | None,
        typer.Option("--labels", help="Of nyu, the folder of MonoScene's base/, if elsewhere."),
    ] = None,
    split: Annotated[
        str | None, typer.Option("--split", help="train or test.", show_default="all")
    ] = None,
    limit: Annotated[
        int | None, typer.Option("--limit", min=1, help="Import this many samples at most.")
    ] = None,
) -> None:
    """Convert a published occupancy data set into one that w2m trains on, scores and shows.

    Pickles are read without executing anything: one that asks for more than arrays is refused.
    """
    from world2minecraft.api import import_dataset, open_dataset
    from world2minecraft.api.progress import show_progress

    found = open_dataset(source, format=format, labels=labels)
    print(f"{source}: {found.describe()}")
    with show_progress() as progress:
        made = import_dataset(found, out, split=split, limit=limit, progress=progress)
    print(f"{len(made):,} samples written to {out}")
    print(f"next: w2m dataset show {out}")
