"""``w2m paper``: the paper's tables, each with what we measured beside it."""

from pathlib import Path
from typing import Annotated

import typer

EXAMPLES = """\
w2m paper                                  which tables there are, and how much of each is filled
w2m paper 6                                one table, by its number or its name
w2m paper all --markdown                   all of them, for a page
w2m paper vln --results mine.yaml          your own results in place of ours
w2m paper occupancy --latex                for a paper of yours
w2m paper occupancy --json                 with the keys of rows and columns that results take

mine.yaml:
  vln:                                     the table
    base-next-view:                        the row
      cells: {3b-sft: 0.61, 7b-sft: 0.66}
      data: my 41 held-out items          what they were measured on
      command: w2m vln evaluate SET ...
"""

Which = Annotated[
    str | None,
    typer.Argument(metavar="[N|NAME|all]", help="A table; without one they are listed."),
]
ResultsFile = Annotated[
    Path | None,
    typer.Option("--results", metavar="FILE", help="Results of your own, YAML or JSON."),
]
Markdown = Annotated[bool, typer.Option("--markdown", help="As Markdown.")]
Latex = Annotated[bool, typer.Option("--latex", help="As LaTeX, for booktabs.")]
Json = Annotated[bool, typer.Option("--json", help="As JSON, every key and source named.")]


def run(
    which: Which = None,
    results: ResultsFile = None,
    markdown: Markdown = False,
    latex: Latex = False,
    json_out: Json = False,
) -> None:
    """Print tables of the paper: as printed, with our figures and what they were measured on.

    A cell of ours that needs what we lack says so and names the command that fills it. Where the
    paper contradicts itself a note says it.

    Raises:
        UsageError: there is no such table, or two forms are asked for.
        InputError: the results cannot be read.
    """
    import json

    from world2minecraft.core.errors import UsageError
    from world2minecraft.paper import fill_table, read_results, read_table, table_names
    from world2minecraft.paper.table_writer import as_latex, as_markdown, as_text, as_values

    if markdown + latex + json_out > 1:
        raise UsageError("choose one of --markdown, --latex and --json")
    own = read_results(results) if results is not None else None
    if which is None and not (markdown or latex or json_out):
        _list()
        return
    names = table_names() if which in (None, "all") else [which]
    tables = [fill_table(read_table(name), own) for name in names]
    if json_out:
        told = [as_values(*one) for one in tables]
        print(json.dumps(told if len(told) > 1 else told[0], indent=2, ensure_ascii=False))
        return
    write = as_latex if latex else as_markdown if markdown else as_text
    print("\n\n".join(write(*one) for one in tables))
    if results is None and not (latex or markdown):
        print(f"\nnext: w2m paper {which} --results mine.yaml   your own results in place of ours")


def _list() -> None:
    """Print a line a table: its number, name, title, and how much of it is filled."""
    from world2minecraft.paper import fill_table, read_table, table_names
    from world2minecraft.paper.table_writer import lacking

    for name in table_names():
        table, ours = fill_table(read_table(name))
        cells = sum(len(one.cells) for one in ours.values())
        lacks = lacking(table, ours)
        state = f"{cells:>3} cells of ours" + (f", {lacks} need what we lack" if lacks else "")
        print(f"{table.number:>2}  {name:<16}{table.title:<46}{state}")
    print("\nnext: w2m paper layouts   one table, with what is measured and how")
