"""``w2m forge stats``: the operations and times of edited scenes, as the paper's table."""

import json
from pathlib import Path
from typing import Annotated

import typer

from world2minecraft.core.errors import UsageError

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
        typer.Option("--scratch", help="A scene built from nothing. Repeatable."),
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print everything as JSON.")] = False,
    as_csv: Annotated[bool, typer.Option("--csv", help="Print a line for each scene.")] = False,
    as_latex: Annotated[bool, typer.Option("--latex", help="Print the table in LaTeX.")] = False,
) -> None:
    """Print operations and times of edited scenes as the paper's efficiency table.

    Every gesture is one operation, counted as what it did: an addition (filling holes is one), a
    deletion, an orientation, and what the paper has no row for. An edit that was undone later is
    counted too; undo and redo are not. Time is working time: after 10 s without an action, no
    more is counted. The automated process is the time of the reconstruction.

    Raises:
        InputError: a scene was never edited. UsageError: two formats are asked for.
    """
    from world2minecraft.api.editor import measure_editing

    if as_json + as_csv + as_latex > 1:
        raise UsageError("--json, --csv and --latex exclude each other; give one of them")
    table = measure_editing(scenes, scratch or ())
    if as_json:
        print(json.dumps(table.to_json(), indent=1))
    elif as_csv:
        print(table.to_csv(), end="")
    else:
        print(table.to_latex() if as_latex else table)
