"""``w2m vln table``: the results of runs side by side, as the paper prints them."""

from pathlib import Path
from typing import Annotated

import typer

EXAMPLES = """\
w2m vln table RUN                         one run, beside Stop, Random and the oracle
w2m vln table BARE SFT RFT                the paper's table: model by training
w2m vln table BARE SFT --markdown         for a page
"""

Runs = Annotated[
    list[Path], typer.Argument(metavar="RUN...", help="Folders of w2m vln run or evaluate.")
]
Markdown = Annotated[bool, typer.Option("--markdown", help="As a Markdown table.")]


def run(runs: Runs, markdown: Markdown = False) -> None:
    """Print the results of runs: walks, answers, and how answers differ pair by pair.

    Raises:
        InputError: a run has no result.
    """
    from world2minecraft.navigation.running.result_tables import (
        HEADS_NOTE,
        answers_table,
        format_markdown,
        format_text,
        paired_table,
        read_result,
        walks_table,
    )

    write = format_markdown if markdown else format_text
    results = [read_result(path) for path in runs]
    walks = [one for one in results if one["kind"] == "walks"]
    answers = [one for one in results if one["kind"] == "answers"]
    if walks:
        print(f"{write(walks_table(walks))}\n\n{HEADS_NOTE}")
    if answers:
        print("\n" * bool(walks) + write(answers_table(answers)))
        print("\npercent right, with the interval (Wilson, 95 %)")
    if len(answers) > 1:
        print("\nthe same items, answer by answer (McNemar's exact test)\n")
        print(write(paired_table(answers)))
