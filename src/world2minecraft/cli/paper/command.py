"""``w2m paper``: the paper's tables, each with what we measured beside it."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from world2minecraft.api.paper import FilledTable

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
    typer.Argument(metavar="[N|NAME|all]", help="A table; without it, all are listed."),
]
ResultsFile = Annotated[
    Path | None,
    typer.Option(
        "--results", metavar="FILE", help="Your own results, YAML or JSON, in place of ours."
    ),
]
Markdown = Annotated[bool, typer.Option("--markdown", help="Print Markdown.")]
Latex = Annotated[bool, typer.Option("--latex", help="Print LaTeX, for booktabs.")]
Json = Annotated[bool, typer.Option("--json", help="Print JSON, with the keys and sources.")]


def run(
    which: Which = None,
    results: ResultsFile = None,
    markdown: Markdown = False,
    latex: Latex = False,
    json_out: Json = False,
) -> None:
    """Print tables of the paper: as printed, with our figures and what they were measured on.

    A cell of ours that needs what we lack says so and names the command that fills it. A note
    marks where the paper contradicts itself.

    Raises:
        UsageError: there is no such table, or two forms are requested.
        InputError: the results cannot be read.
    """
    import json

    from world2minecraft.api.paper import paper_tables
    from world2minecraft.core.errors import UsageError

    if markdown + latex + json_out > 1:
        raise UsageError("choose one of --markdown, --latex and --json")
    tables = paper_tables(which or "all", results=results)
    if which is None and not (markdown or latex or json_out):
        _list(tables)
        return
    if json_out:
        values = [one.to_dict() for one in tables]
        print(json.dumps(values if len(values) > 1 else values[0], indent=2, ensure_ascii=False))
        return
    texts = [one.latex() if latex else one.markdown() if markdown else str(one) for one in tables]
    print("\n\n".join(texts))
    if results is None and not (latex or markdown):
        print(f"\nnext: w2m paper {which} --results mine.yaml   your own results in place of ours")


def _list(tables: "list[FilledTable]") -> None:
    """Print a line for each table: its number, name, title, and how much of it is filled."""
    for one in tables:
        table, lacks = one.table, one.lacking
        state = f"{one.cells:>3} cells of ours" + (f", {lacks} need what we lack" if lacks else "")
        print(f"{table.number:>2}  {table.name:<16}{table.title:<46}{state}")
    print("\nnext: w2m paper layouts   one table, with what is measured and how")
