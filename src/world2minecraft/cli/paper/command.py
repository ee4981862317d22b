"""Print the paper's tables next to our own results: ``w2m paper``."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from world2minecraft.api.paper import FilledTable

EXAMPLES = """\
w2m paper                                  list the tables and how complete they are
w2m paper 6                                print a table, by its number or name
w2m paper all --markdown                   print all tables in Markdown
w2m paper vln --results mine.yaml          use your own results instead of ours
w2m paper occupancy --latex                print the table in LaTeX
w2m paper occupancy --json                 print JSON, with the row and column keys for results

mine.yaml:
  vln:                                     the table
    base-next-view:                        the row
      cells: {3b-sft: 0.61, 7b-sft: 0.66}
      data: my 41 held-out items          what they were measured on
      command: w2m vln evaluate SET ...
"""

Which = Annotated[
    str | None,
    typer.Argument(
        metavar="[N|NAME|all]", help="Table to print. By default, all tables are listed."
    ),
]
ResultsFile = Annotated[
    Path | None,
    typer.Option(
        "--results", metavar="FILE", help="YAML or JSON file with results to use instead of ours."
    ),
]
Markdown = Annotated[bool, typer.Option("--markdown", help="Print the tables in Markdown.")]
Latex = Annotated[bool, typer.Option("--latex", help="Print the tables in LaTeX with booktabs.")]
Json = Annotated[bool, typer.Option("--json", help="Print JSON with keys and sources.")]


def run(
    which: Which = None,
    results: ResultsFile = None,
    markdown: Markdown = False,
    latex: Latex = False,
    json_out: Json = False,
) -> None:
    """Print the paper's tables with the published and our own results and the data behind them.

    A cell that requires resources we lack names them and the command that would fill the cell.
    Notes mark contradictions within the paper.

    Raises:
        UsageError: If the table is unknown, or if two formats are requested.
        InputError: If the results cannot be read.
    """
    import json

    from world2minecraft.api.paper import paper_tables
    from world2minecraft.core.errors import UsageError

    if markdown + latex + json_out > 1:
        raise UsageError("use only one of --markdown, --latex and --json")
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
        print(f"\nnext: w2m paper {which} --results mine.yaml   use your own results instead")


def _list(tables: "list[FilledTable]") -> None:
    """Print one line per table: number, name, title, and number of filled cells."""
    for one in tables:
        table, lacks = one.table, one.lacking
        state = f"{one.cells:>3} cells filled" + (f", {lacks} missing" if lacks else "")
        print(f"{table.number:>2}  {table.name:<16}{table.title:<46}{state}")
    print("\nnext: w2m paper layouts   print one table and how it is measured")
