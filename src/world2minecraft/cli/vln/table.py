"""Print the results of runs side by side, as in the paper: ``w2m vln table``."""

from pathlib import Path
from typing import Annotated

import typer

EXAMPLES = """\
w2m vln table RUN                         one run next to Stop, Random and the oracle
w2m vln table BARE SFT RFT                the paper's table: model by training
w2m vln table BARE SFT --markdown         print Markdown
w2m vln table BARE SFT --json             print JSON
"""

Runs = Annotated[
    list[Path],
    typer.Argument(metavar="RUN...", help="Folders from w2m vln run or w2m vln evaluate."),
]
Markdown = Annotated[bool, typer.Option("--markdown", help="Print Markdown tables.")]
Json = Annotated[bool, typer.Option("--json", help="Print the results as JSON.")]


def run(runs: Runs, markdown: Markdown = False, json_out: Json = False) -> None:
    """Print the results of runs: walks, answers, and pairwise comparisons of answers.

    Raises:
        InputError: If a run has no result.
        UsageError: If two formats are requested.
    """
    from world2minecraft.api.agents import compare_runs, table_text, walks_note
    from world2minecraft.cli.json_output import print_json
    from world2minecraft.core.errors import UsageError

    if markdown and json_out:
        raise UsageError("--markdown and --json exclude each other; omit one of them")
    tables = compare_runs(runs)
    if json_out:
        print_json(tables.to_dict())
        return
    if tables.walks:
        print(f"{table_text(tables.walks, markdown=markdown)}\n\n{walks_note()}")
    if tables.answers:
        print("\n" * bool(tables.walks) + table_text(tables.answers, markdown=markdown))
        print("\npercent correct, with 95 % Wilson interval")
    if tables.paired:
        print("\npaired answers to the same items (McNemar's exact test)\n")
        print(table_text(tables.paired, markdown=markdown))
