"""``w2m vln table``: the results of runs side by side, as the paper prints them."""

from pathlib import Path
from typing import Annotated

import typer

EXAMPLES = """\
w2m vln table RUN                         one run, beside Stop, Random and the oracle
w2m vln table BARE SFT RFT                the paper's table: model by training
w2m vln table BARE SFT --markdown         for a page
w2m vln table BARE SFT --json             for a program
"""

Runs = Annotated[
    list[Path], typer.Argument(metavar="RUN...", help="Folders of w2m vln run or evaluate.")
]
Markdown = Annotated[bool, typer.Option("--markdown", help="Print Markdown tables.")]
Json = Annotated[bool, typer.Option("--json", help="Print the results as JSON.")]


def run(runs: Runs, markdown: Markdown = False, json_out: Json = False) -> None:
    """Print the results of runs: walks, answers, and how answers differ pair by pair.

    Raises:
        InputError: a run has no result. UsageError: two forms are requested.
    """
    from world2minecraft.api.agents import compare_runs, table_text, walks_note
    from world2minecraft.cli.json_output import print_json
    from world2minecraft.core.errors import UsageError

    if markdown and json_out:
        raise UsageError("choose one of --markdown and --json")
    tables = compare_runs(runs)
    if json_out:
        print_json(tables.to_dict())
        return
    if tables.walks:
        print(f"{table_text(tables.walks, markdown=markdown)}\n\n{walks_note()}")
    if tables.answers:
        print("\n" * bool(tables.walks) + table_text(tables.answers, markdown=markdown))
        print("\npercent correct, with the interval (Wilson, 95 %)")
    if tables.paired:
        print("\nthe same items, answer by answer (McNemar's exact test)\n")
        print(table_text(tables.paired, markdown=markdown))
