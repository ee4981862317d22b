"""Report statistics of a data set next to the data sets in the paper: ``w2m dataset stats``."""

from pathlib import Path
from typing import Annotated

import typer

from world2minecraft.cli.dataset.options import Jobs
from world2minecraft.cli.json_output import JsonOutput

EXAMPLES = """\
w2m dataset stats DATA                             print the paper's table with DATA
w2m dataset stats DATA --split test --jobs 8       count one split with eight processes
w2m dataset stats NYUv2                            a published data set
w2m dataset stats DATA --json                      print all results as JSON
w2m dataset stats DATA --latex table.tex --plots PLOTS
"""


DataPath = Annotated[Path, typer.Argument(help="Data set: ours, NYUv2, OccScanNet ...")]
Split = Annotated[str | None, typer.Option("--split", help="train or test.", show_default="all")]
Format = Annotated[
    str | None,
    typer.Option("--format", help="nyu, occscannet, embodied or npz.", show_default="detected"),
]
LatexFile = Annotated[
    Path | None, typer.Option("--latex", help="Write the table in LaTeX.", metavar="FILE")
]
Plots = Annotated[
    Path | None, typer.Option("--plots", help="Draw charts as PNG files.", metavar="FOLDER")
]


def run(
    path: DataPath,
    split: Split = None,
    format: Format = None,
    json_file: JsonOutput = None,
    latex_file: LatexFile = None,
    plots: Plots = None,
    jobs: Jobs = None,
) -> None:
    """Count images, scenes, rooms, classes and voxels, as in the paper's table.

    As in the paper, semantic voxels are counted over all images: the occupied cells of the region
    whose centres project into the image. A cell is therefore counted once per image that shows it.
    The number of distinct cells is also listed. A fine class is a block, or a piece of furniture
    regardless of its material. It is counted if at least 3 images show it with at least 100 pixels.

    Raises:
        InputError: If the folder is not a data set or is damaged.
        UsageError: If the split does not exist.
        MissingExtraError: If charts are requested and matplotlib is not installed.
    """
    from world2minecraft.api import dataset_contents as contents
    from world2minecraft.api.progress import show_progress
    from world2minecraft.cli.json_output import print_json, prints_json

    if plots is not None:
        contents.check_charts()
    with show_progress() as progress:
        statistics = contents.dataset_statistics(
            path, split=split, format=format, jobs=jobs, progress=progress
        )
    is_json = prints_json(json_file)
    written = contents.save_statistics(
        statistics, json=None if is_json else json_file, latex=latex_file, plots=plots
    )
    if is_json:
        print_json(contents.statistics_json(statistics))
        return
    print(contents.statistics_text(statistics))
    print()
    for place in written:
        print(f"  wrote  {place}")
    print(f"  next   w2m dataset quality {path}      measure the naturalness and sharpness")
