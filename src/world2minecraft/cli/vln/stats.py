"""``w2m vln stats``: what a navigation set holds, beside the paper's, and what guessing scores."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from world2minecraft.cli.json_output import JsonOutput

if TYPE_CHECKING:
    from world2minecraft.api.navigation import BaselineRow

EXAMPLES = """\
w2m vln stats SET                          lengths beside the paper's, balance, baselines
w2m vln stats SET --no-baselines           without reading the pictures
w2m vln stats SET --json                   every figure, as JSON
w2m vln stats SET --plot lengths.png       the paper's histograms
"""

SetPath = Annotated[Path, typer.Argument(help="A set of w2m vln build, or an items.jsonl.")]
Baselines = Annotated[
    bool, typer.Option("--baselines/--no-baselines", help="Score what guessing reaches.")
]
PlotFile = Annotated[
    Path | None, typer.Option("--plot", help="Draw the lengths as PNG.", metavar="FILE")
]


def run(
    path: SetPath,
    baselines: Baselines = True,
    json_file: JsonOutput = None,
    plot: PlotFile = None,
) -> None:
    """Count items, lengths of instructions, answers and wrong choices, as the paper's table does.

    Base are reconstructions, extend all other worlds. Lengths are in characters. Baselines are
    scored on the held-out splits; one that sees no picture and is ten points above chance is
    flagged, as such a set does not test vision.

    Raises:
        InputError: it is no set, or a picture is missing.
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
        print(f"\nWithout understanding, on {_where(rows)} (95 % interval):")
    for row in rows:
        low, high = row.accuracy.low, row.accuracy.high
        flag = "  FLAG: needs no picture" if row.is_flagged else ""
        print(
            f"  {row.task:<12}{row.name:<16}{row.accuracy.share:6.3f}  "
            f"[{low:.3f}, {high:.3f}]  of {row.accuracy.total:,}, chance {row.chance:.3f}{flag}"
        )
    print()


def _where(rows: "Sequence[BaselineRow]") -> str:
    """Return what the baselines were scored on, in words."""
    trained = sorted({row.task for row in rows if not row.is_held})
    if not trained:
        return "the held-out splits"
    if len(trained) == len({row.task for row in rows}):
        return "train, as nothing is held out"
    return f"the held-out splits; {', '.join(trained)} on train, as none of it is held out"
