"""``w2m forge stats``: how much work scenes were, as the paper's table."""

from pathlib import Path
from typing import Annotated

import typer

EXAMPLES = """\
w2m forge stats OUT                           a scene that was edited with w2m forge
w2m forge stats A.forge B.forge --csv         a line for each scene
w2m forge stats OUT --scratch EMPTY           beside a scene built from nothing
w2m forge stats OUT1 OUT2 --latex             the table for a paper
"""


def run(
    scenes: Annotated[list[Path], typer.Argument(help="Edited scenes, or their .forge folders.")],
    scratch: Annotated[
        list[Path] | None,
        typer.Option("--scratch", help="A scene built from nothing; may be given again."),
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print everything as JSON.")] = False,
    as_csv: Annotated[bool, typer.Option("--csv", help="Print a line for each scene.")] = False,
    as_latex: Annotated[bool, typer.Option("--latex", help="Print the table in LaTeX.")] = False,
) -> None:
    """Print operations and times of edited scenes as the paper's efficiency table.

    Every gesture is one operation, counted as what it did: an addition (filling holes is one), a
    deletion, an orientation, and what the paper has no row for. What was taken back later is
    counted all the same; undo and redo are not. Time is that of work: where nobody did anything
    for 10 s, no more is counted. The automated process is what the reconstruction took.

    Args:
        scenes: what was opened with w2m forge, or its folders of edits.
        scratch: scenes that were built from an empty grid, for the other column.
        as_json: whether to print JSON.
        as_csv: whether to print CSV.
        as_latex: whether to print LaTeX.

    Raises:
        InputError: a scene was never edited. UsageError: two forms are asked for.
    """
    import json

    from world2minecraft.core.errors import UsageError
    from world2minecraft.sceneforge.effort_table import (
        effort_at,
        stats_csv,
        stats_json,
        stats_latex,
        stats_text,
    )

    if as_json + as_csv + as_latex > 1:
        raise UsageError("--json, --csv and --latex are three forms of one table; give one")
    efforts = [effort_at(place) for place in scenes]
    others = [effort_at(place) for place in scratch or ()]
    if as_json:
        print(json.dumps(stats_json(efforts, others), indent=1))
    elif as_csv:
        print(stats_csv([*efforts, *others]), end="")
    else:
        print((stats_latex if as_latex else stats_text)(efforts, others))
