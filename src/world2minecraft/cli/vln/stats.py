"""``w2m vln stats``: what a navigation set holds, beside the paper's, and what guessing scores."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from world2minecraft.navigation.data.blind_baselines import BaselineRow

EXAMPLES = """\
w2m vln stats SET                          lengths beside the paper's, balance, baselines
w2m vln stats SET --no-baselines           without reading the pictures
w2m vln stats SET --json stats.json        every figure
w2m vln stats SET --plot lengths.png       the paper's histograms
"""

SetPath = Annotated[Path, typer.Argument(help="A set of w2m vln build, or an items.jsonl.")]
Baselines = Annotated[
    bool, typer.Option("--baselines/--no-baselines", help="Score those that do not understand.")
]
JsonFile = Annotated[
    Path | None, typer.Option("--json", help="Write every figure.", metavar="FILE")
]
PlotFile = Annotated[
    Path | None, typer.Option("--plot", help="Draw the lengths as PNG.", metavar="FILE")
]


def run(
    path: SetPath,
    baselines: Baselines = True,
    json_file: JsonFile = None,
    plot: PlotFile = None,
) -> None:
    """Count items, lengths of instructions, answers and wrong choices, as the paper's table does.

    Base are reconstructions, extend all other worlds. Lengths are in characters. Baselines are
    scored on what is held out; one that sees no picture and is right ten points above chance is
    flagged, as such a set tests no seeing.

    Args:
        path: the set.
        baselines: whether they are scored.
        json_file: to write.
        plot: to write.

    Raises:
        InputError: it is no set, or a picture is missing.
    """
    from world2minecraft.core.files import write_json
    from world2minecraft.navigation.data.blind_baselines import score_baselines as score
    from world2minecraft.navigation.data.splits import find_leaks
    from world2minecraft.navigation.data.statistics import (
        compute_statistics,
        statistics_json,
        statistics_text,
    )
    from world2minecraft.navigation.records import read_items

    items = read_items(path)
    statistics, leaks = compute_statistics(items), find_leaks(items)
    print(statistics_text(statistics, leaks))
    rows = score(items, path if path.is_dir() else path.parent) if baselines else []
    _print_baselines(rows)
    if json_file is not None:
        write_json(json_file, statistics_json(statistics, leaks, rows))
        print(f"  wrote  {json_file}")
    if plot is not None:
        from world2minecraft.navigation.data.statistics import write_histograms

        write_histograms(items, plot)
        print(f"  wrote  {plot}")
    print(f"  next   w2m vln evaluate {path} --agent oracle")


def _print_baselines(rows: "list[BaselineRow]") -> None:
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


def _where(rows: "list[BaselineRow]") -> str:
    """Return what the baselines were scored on, in words."""
    trained = sorted({row.task for row in rows if not row.is_held})
    if not trained:
        return "what is held out"
    if len(trained) == len({row.task for row in rows}):
        return "train, as nothing is held out"
    return f"what is held out; {', '.join(trained)} on train, as nothing of it is"
