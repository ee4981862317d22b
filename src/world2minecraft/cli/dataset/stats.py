"""``w2m dataset stats``: what a data set holds, beside the data sets of the paper."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from world2minecraft.minecraftocc.statistics import DatasetStatistics

EXAMPLES = """\
w2m dataset stats DATA                             the paper's table, with DATA below it
w2m dataset stats DATA --split test --jobs 8       a split, counted by eight processes
w2m dataset stats NYUv2                            a data set of others
w2m dataset stats DATA --json stats.json           every figure
w2m dataset stats DATA --latex table.tex --plots PLOTS
"""


DataPath = Annotated[Path, typer.Argument(help="A data set: ours, NYUv2, OccScanNet ...")]
Split = Annotated[str | None, typer.Option("--split", help="Only train, or only test.")]
Format = Annotated[
    str | None, typer.Option("--format", help="nyu, occscannet, embodied or npz; found out.")
]
JsonFile = Annotated[
    Path | None, typer.Option("--json", help="Write every figure.", metavar="FILE")
]
LatexFile = Annotated[
    Path | None, typer.Option("--latex", help="Write the table for a paper.", metavar="FILE")
]
Plots = Annotated[
    Path | None, typer.Option("--plots", help="Draw charts as PNG files.", metavar="FOLDER")
]
Jobs = Annotated[
    int | None, typer.Option("--jobs", "-j", help="Processes; one for each core.", min=1)
]


def run(
    path: DataPath,
    split: Split = None,
    format: Format = None,
    json_file: JsonFile = None,
    latex_file: LatexFile = None,
    plots: Plots = None,
    jobs: Jobs = None,
) -> None:
    """Count pictures, scenes, rooms, classes and voxels, as the paper's table does.

    Semantic voxels are counted as the paper counts: over all pictures, the occupied cells of the
    region whose centres fall into the picture, so that a cell counts for each picture that holds
    it. The distinct cells of the worlds are told beside. A fine class is a block, or a piece of
    furniture whatever it is made of; it counts once 3 pictures see it by 100 pixels.

    Args:
        path: the data set.
        split: of it; all where None.
        format: of a data set of others.
        json_file: to write.
        latex_file: to write.
        plots: folder of charts to write.
        jobs: processes that count.

    Raises:
        InputError: it is no data set, or damaged. UsageError: there is no such split.
        MissingExtraError: plots are asked for, and matplotlib is not installed.
    """
    from world2minecraft.api.progress import show_progress
    from world2minecraft.core.machine import usable_cores
    from world2minecraft.minecraftocc.statistics import statistics_text
    from world2minecraft.minecraftocc.statistics.dataset_statistics import statistics_of

    if plots is not None:
        from world2minecraft.minecraftocc.statistics.plots import need_matplotlib

        need_matplotlib()
    with show_progress() as progress:
        statistics = statistics_of(
            path, split, format=format, jobs=jobs or usable_cores(), progress=progress
        )
    print(statistics_text(statistics))
    print()
    for place in _write(statistics, json_file, latex_file, plots):
        print(f"  wrote  {place}")
    print(f"  next   w2m dataset quality {path}      how natural and how sharp its pictures are")


def _write(
    statistics: "DatasetStatistics",
    json_file: Path | None,
    latex_file: Path | None,
    plots: Path | None,
) -> list[Path]:
    """Write what is asked for, and return where it lies."""
    from world2minecraft.core.files import write_json, write_text
    from world2minecraft.minecraftocc.statistics import statistics_json, statistics_latex
    from world2minecraft.minecraftocc.statistics.plots import write_plots

    written = []
    if json_file is not None:
        write_json(json_file, statistics_json(statistics))
        written.append(json_file)
    if latex_file is not None:
        write_text(latex_file, statistics_latex(statistics) + "\n")
        written.append(latex_file)
    return [*written, *(write_plots(statistics, plots) if plots is not None else ())]
