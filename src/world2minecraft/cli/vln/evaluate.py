"""``w2m vln evaluate``: a model answers the items of a set, by task and composition."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from world2minecraft.cli import model_options as option

if TYPE_CHECKING:
    from world2minecraft.navigation.types import Item

EXAMPLES = """\
w2m vln evaluate SET --agent http://localhost:8000/v1    a server of your own: vLLM, LLaMA-Factory
w2m vln evaluate SET --agent gemini --max-usd 5 --jobs 4
w2m vln evaluate SET --agent majority                    a baseline: no network needed
w2m vln evaluate SET --agent http://localhost:8000/v1 --training rft --style think
w2m vln evaluate SET --agent openai:gpt-4o --split val_unseen --task next_action --count 100
"""

Set = Annotated[Path, typer.Argument(help="A set of w2m vln build.", show_default=False)]
AgentName = Annotated[
    str,
    typer.Option(
        "--agent", help="gemini, openai, qwen, local, each with :MODEL if wanted; or the address "
        "of a server, http://HOST/v1; or a baseline: uniform, majority, blind, repeat, nearest, "
        "alike, odd, oracle.", show_default=False,
    ),
]  # fmt: skip
Out = Annotated[
    Path | None, typer.Option("--out", help="Where the run is kept.", show_default="vln_AGENT")
]
Split = Annotated[
    str, typer.Option("--split", help="train, val_seen, val_unseen, test (both val) or all.")
]
TaskName = Annotated[str, typer.Option("--task", help="next_view, next_action or both.")]
Composition = Annotated[str, typer.Option("--composition", help="base, extend or combined.")]
Count = Annotated[
    int | None, typer.Option("--count", help="Ask so many items, drawn by --seed.", min=1)
]
Seed = Annotated[int, typer.Option("--seed", help="Of the items that are drawn.")]
Style = Annotated[
    str,
    typer.Option(
        "--style", help="letter: as models trained on the exports answer; think: as those "
        "trained by reward; json: held to a schema.",
    ),
]  # fmt: skip
Training = Annotated[
    str,
    typer.Option("--training", help="How the model was trained, for tables: none, sft, rft."),
]
Jobs = Annotated[int, typer.Option("--jobs", help="Questions at a time.", min=1)]


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
    max_pixels: option.MaxPixels = option.MAX_PIXELS,
    *,
    model_options: option.ModelOptions,
) -> None:
    """Ask a model the items of a set, and tell its accuracy with intervals.

    Items are asked by the very words that trainers get. A reply that holds no letter is asked
    again twice and then counts as wrong; each reply is kept in OUT/answers.jsonl. The same command
    goes on where it was stopped.

    Raises:
        UsageError, InputError: a name, an option or the set is wrong.
        ServerError, BudgetError: the model cannot be asked.
    """
    from world2minecraft.core.errors import UnknownNameError
    from world2minecraft.external_models.chat_transport import is_endpoint
    from world2minecraft.navigation.agents.question_answering import VlmAnswerer
    from world2minecraft.navigation.records import read_items
    from world2minecraft.navigation.running.item_evaluation import TRAININGS, select_items

    if training not in TRAININGS:
        raise UnknownNameError("training", training, TRAININGS)
    target = out or option.default_run_folder(agent)
    every = read_items(folder)
    items = select_items(
        every, split=split, task=task, composition=composition, count=count, seed=seed
    )
    place = folder if folder.is_dir() else folder.parent
    chat = None
    if is_endpoint(agent):
        chat = model_options.open(agent, target)
        answerer: Any = VlmAnswerer(chat, place, style, max_px=max_pixels)
    else:
        answerer, items = _baseline(agent, every, items, place)
        training = "baseline"
    facts = {"agent": answerer.name, "training": training, "style": style, "split": split}
    _evaluate(target, items, answerer, jobs, facts)
    _print_summary(target, items, chat)


def _evaluate(
    target: Path, items: "list[Item]", answerer: Any, jobs: int, facts: dict[str, str]
) -> None:
    from world2minecraft.api.progress import show_progress
    from world2minecraft.navigation.running.item_evaluation import evaluate, write_result

    with show_progress() as progress:
        found = evaluate(items, answerer, jobs=jobs, progress=progress)
    write_result(target, found, facts)


def _baseline(
    name: str, every: "list[Item]", items: "list[Item]", place: Path
) -> "tuple[Any, list[Item]]":
    """Return a baseline and the items that it knows the task of."""
    from world2minecraft.core.errors import UnknownNameError, UsageError
    from world2minecraft.external_models.chat_transport import ENDPOINTS
    from world2minecraft.navigation.agents.question_answering import LetterAnswerer
    from world2minecraft.navigation.data.blind_baselines import BASELINES, baseline_letters

    if name not in BASELINES:
        raise UnknownNameError("agent", name, [*BASELINES, *ENDPOINTS])
    letters = baseline_letters(name, every, items, place)
    known = [item for item in items if item.item_id in letters]
    if not known:
        raise UsageError(f"the baseline {name} knows nothing of this task; give --task both")
    return LetterAnswerer(name, letters), known


def _print_summary(target: Path, items: "list[Item]", chat: Any) -> None:
    from world2minecraft.navigation.running.result_tables import (
        answers_table,
        format_text,
        read_result,
    )

    print()
    print(format_text(answers_table([read_result(target)])))
    print("percent right, with the interval (Wilson, 95 %); 3! are three replies without a letter,")
    print("3 failed three items that the server did not answer; both count as wrong")
    if chat is not None:
        print(f"asked: {option.cost_line(chat)}")
    print(f"\n  read   {target / 'answers.jsonl'}: each of {len(items):,} replies")
    print(f"  next   w2m vln table {target} OTHER_RUN")
