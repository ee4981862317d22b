"""Report statistics and baseline scores of a navigation set: ``w2m vln stats``."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from world2minecraft.cli.json_output import JsonOutput

if TYPE_CHECKING:
    from world2minecraft.api.navigation import BaselineRow

EXAMPLES = """\
w2m vln stats SET                          lengths next to the paper's, balance, baselines
w2m vln stats SET --no-baselines           skip the baselines, without reading images
w2m vln stats SET --json                   print all results as JSON
w2m vln stats SET --plot lengths.png       draw histograms as in the paper
"""

SetPath = Annotated[
    Path, typer.Argument(help="Navigation set from w2m vln build, or an items.jsonl.")
]
Baselines = Annotated[bool, typer.Option("--baselines/--no-baselines", help="Score the baselines.")]
PlotFile = Annotated[
    Path | None, typer.Option("--plot", help="Draw the lengths as a PNG file.", metavar="FILE")
]


def run(
    path: SetPath,
    baselines: Baselines = True,
    json_file: JsonOutput = None,
    plot: PlotFile = None,
) -> None:
    """Count items, instruction lengths, answers and wrong choices, as in the paper's table.

    Base items are from reconstructions, and extend items from all other worlds. Lengths are in
    characters. Baselines are scored on the held-out splits. A baseline that uses no image and is
    ten points above chance is flagged, because such a set does not test vision.

    Raises:
        InputError: If the path is not a navigation set or an image is missing.
    """
    from world2minecraft.api.navigation import navigation_statistics
    from world2minecraft.cli.json_output import print_json, prints_json
    from world2minecraft.core.files import write_json

    found = navigation_statistics(path, baselines=baselines)
    if plot is not None:
        found.plot(plot)
    if prints_json(json_file):
        print_json(found.to_dict())
        return
    print(found)
    _print_baselines(found.baselines)
    if json_file is not None:
        write_json(json_file, found.to_dict())
        print(f"  wrote  {json_file}")
    if plot is not None:
        print(f"  wrote  {plot}")
    print(f"  next   w2m vln evaluate {path} --agent oracle")


def _print_baselines(rows: "Sequence[BaselineRow]") -> None:
    if rows:
        print(f"\nBaselines on {_where(rows)} (95 % interval):")
    for row in rows:
        low, high = row.accuracy.low, row.accuracy.high
        flag = "  FLAG: uses no image" if row.is_flagged else ""
        print(
            f"  {row.task:<12}{row.name:<16}{row.accuracy.share:6.3f}  "
            f"[{low:.3f}, {high:.3f}]  of {row.accuracy.total:,}, chance {row.chance:.3f}{flag}"
        )
    print()


def _where(rows: "Sequence[BaselineRow]") -> str:
    """Return a description of the splits that the baselines were scored on."""
    trained = sorted({row.task for row in rows if not row.is_held})
    if not trained:
        return "the held-out splits"
    if len(trained) == len({row.task for row in rows}):
        return "train, because nothing is held out"
    return f"the held-out splits; {', '.join(trained)} on train, because none of it is held out"
