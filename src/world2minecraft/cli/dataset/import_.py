"""``w2m dataset import``: an occupancy data set of others becomes one of ours."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from world2minecraft.core.progress import Progress

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
    out: Annotated[Path, typer.Option("--out", help="The data set to write, a new folder.")],
    format: Annotated[
        str | None, typer.Option("--format", help="Found out by default; nyu, occscannet ...")
    ] = None,
    labels: Annotated[
        Path | None,
        typer.Option("--labels", help="nyu: where MonoScene's base/ lies, if elsewhere."),
    ] = None,
    split: Annotated[
        str | None, typer.Option("--split", help="train or test alone; all by default.")
    ] = None,
    limit: Annotated[
        int | None, typer.Option("--limit", min=1, help="At most so many samples.")
    ] = None,
) -> None:
    """Read an occupancy data set of others into a data set that w2m trains on, scores and shows.

    Pickles are read without running anything: one that asks for more than arrays is refused.
    """
    from itertools import islice

    from world2minecraft.api.progress import show_progress
    from world2minecraft.core.errors import UsageError
    from world2minecraft.minecraftocc.importers import open_occupancy
    from world2minecraft.minecraftocc.store import write_store

    found = open_occupancy(source, format, labels=labels)
    count = len(found.keys(split)) if limit is None else min(limit, len(found.keys(split)))
    if not count:
        raise UsageError(f"{source} has no sample in {split}: {found.describe()}")
    print(f"{source}: {found.describe()}")
    with show_progress() as progress:
        write_store(
            out,
            islice(found.samples(split), count),
            {"imported": {"format": found.format, "samples": count}},
            progress=_of(progress, count),
        )
    print(f"{count:,} samples written to {out}")
    print(f"next: w2m dataset show {out}")


def _of(progress: "Progress", count: int) -> "Progress":
    """Return a progress that knows how many samples there are."""

    def told(stage: str, done: int, total: int, note: str = "") -> None:
        progress(stage, done, total or count, note)

    return told
