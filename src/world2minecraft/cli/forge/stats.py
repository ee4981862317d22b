"""Report operations and times of edited scenes, as in the paper's table: ``w2m forge stats``."""

import json
from pathlib import Path
from typing import Annotated

import typer

from world2minecraft.core.errors import UsageError

EXAMPLES = """\
w2m forge stats OUT                           a scene that was edited with w2m forge
w2m forge stats A.forge B.forge --csv         one line per scene
w2m forge stats OUT --scratch EMPTY           compare with a scene built from scratch
w2m forge stats OUT1 OUT2 --latex             print the table in LaTeX
"""


def run(
    scenes: Annotated[list[Path], typer.Argument(help="Edited scenes, or their .forge folders.")],
    scratch: Annotated[
        list[Path] | None,
        typer.Option("--scratch", help="Scene built from an empty grid. Repeatable."),
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print all results as JSON.")] = False,
    as_csv: Annotated[bool, typer.Option("--csv", help="Print one CSV line per scene.")] = False,
    as_latex: Annotated[bool, typer.Option("--latex", help="Print the table in LaTeX.")] = False,
) -> None:
    """Print operations and times of edited scenes as the paper's efficiency table.

    Every gesture is one operation, counted by its effect: an addition (including filling holes), a
    deletion, an orientation, or another operation that the paper's table omits. Edits that were
    undone later are counted. Undo and redo are not. Time is working time: pauses are counted up to
    10 s. The time of the automated process is that of the reconstruction.

    Raises:
        InputError: If a scene has never been edited.
        UsageError: If two formats are requested.
    """
    from world2minecraft.api.editor import measure_editing

    if as_json + as_csv + as_latex > 1:
        raise UsageError("use only one of --json, --csv and --latex")
    table = measure_editing(scenes, scratch or ())
    if as_json:
        print(json.dumps(table.to_json(), indent=1))
    elif as_csv:
        print(table.to_csv(), end="")
    else:
        print(table.to_latex() if as_latex else table)
