"""Evaluate a model on the items of a navigation set: ``w2m vln evaluate``."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from world2minecraft.cli import model_options as option
from world2minecraft.cli.panels import MORE, Force

if TYPE_CHECKING:
    from world2minecraft.api.agents import AgentAnswers

EXAMPLES = """\
w2m vln evaluate SET --agent http://localhost:8000/v1    your own server: vLLM, LLaMA-Factory
w2m vln evaluate SET --agent gemini --max-usd 5 --jobs 4
w2m vln evaluate SET --agent majority                    a baseline: no network needed
w2m vln evaluate SET --agent majority --json             the accuracies as JSON
w2m vln evaluate SET --agent http://localhost:8000/v1 --training rft --style think
w2m vln evaluate SET --agent openai:gpt-4o --split val_unseen --task next_action --count 100
"""

Set = Annotated[Path, typer.Argument(help="Navigation set from w2m vln build.", show_default=False)]
AgentName = Annotated[
    str,
    typer.Option(
        "--agent", help="gemini, openai, qwen or local, optionally followed by :MODEL; a server "
        "address, http://HOST/v1; or a baseline: uniform, majority, blind, repeat, nearest, "
        "alike, odd, oracle.", show_default=False,
    ),
]  # fmt: skip
Out = Annotated[
    Path | None,
    typer.Option("--out", "-o", help="Write the run to this folder.", show_default="vln_AGENT"),
]
Split = Annotated[
    str, typer.Option("--split", help="train, val_seen, val_unseen, test (both val) or all.")
]
TaskName = Annotated[str, typer.Option("--task", help="next_view, next_action or both.")]
Composition = Annotated[str, typer.Option("--composition", help="base, extend or combined.")]
Count = Annotated[
    int | None,
    typer.Option(
        "--count", help="Number of items, sampled with --seed.", min=1, show_default="all"
    ),
]
Seed = Annotated[
    int, typer.Option("--seed", help="Random seed of the sample.", rich_help_panel=MORE)
]
Style = Annotated[
    str,
    typer.Option(
        "--style", help="Reply format: letter (for models trained on the exports), think (for "
        "models trained by reinforcement) or json (with a schema).",
    ),
]  # fmt: skip
Training = Annotated[
    str,
    typer.Option("--training", help="Training method to show in tables: none, sft, rft."),
]
Jobs = Annotated[int, typer.Option("--jobs", help="Number of simultaneous requests.", min=1)]
Json = Annotated[bool, typer.Option("--json", help="Print the result as JSON.")]


@option.with_model_options()
def run(
    folder: Set,
    agent: AgentName,
    out: Out = None,
    split: Split = "test",
    task: TaskName = "both",
    composition: Composition = "combined",
    count: Count = None,
    seed: Seed = 0,
    style: Style = "letter",
    training: Training = "none",
    jobs: Jobs = 1,
    json_out: Json = False,
    max_pixels: option.MaxPixels = option.MAX_PIXELS,
    force: Force = False,
    *,
    model_options: option.ModelOptions,
) -> None:
    """Ask a model the items of a set, and report its accuracy with confidence intervals.

    Items are worded as in the training exports. A reply without a letter is requested up to two
    more times and then counted as wrong. OUT/answers.jsonl contains all replies. Repeat the command
    to resume an interrupted evaluation.

    Raises:
        UsageError: If a name or an option is invalid.
        InputError: If the set cannot be read.
        ServerError: If the model does not reply.
        BudgetError: If a limit on requests or cost is reached.
    """
    from world2minecraft.api import evaluate_agent
    from world2minecraft.api.progress import show_progress
    from world2minecraft.cli.json_output import print_json

    with show_progress() as progress:
        answers = evaluate_agent(
            folder,
            agent,
            out=out,
            split=split,
            task=task,
            composition=composition,
            count=count,
            seed=seed,
            style=style,
            training=training,
            jobs=jobs,
            max_pixels=max_pixels,
            force=force,
            model=model_options.value(),
            progress=progress,
        )
    if json_out:
        print_json({**answers.result, "folder": str(answers.folder), "cost": answers.cost or None})
    else:
        _print_summary(answers)


def _print_summary(answers: "AgentAnswers") -> None:
    from world2minecraft.api.agents import compare_runs, table_text

    folder = answers.folder
    print()
    print(table_text(compare_runs([folder]).answers))
    print("percent correct, with 95 % Wilson interval; '3!' means three replies without a letter,")
    print("'3 failed' three items without a reply from the server; both count as wrong")
    if answers.cost:
        print(f"cost: {option.cost_line(answers.cost)}")
    print(f"\n  read   {folder / 'answers.jsonl'}: all {answers.count:,} replies")
    print(f"  next   w2m vln table {folder} OTHER_RUN")
