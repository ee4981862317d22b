"""``w2m vln reword``: the walks of a set in the words of people, or of a language model."""

from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from world2minecraft.cli import model_options as option

if TYPE_CHECKING:
    from world2minecraft.external_models.chat_client import ChatModel
    from world2minecraft.navigation.data.rewording import NavigationSet

EXAMPLES = """\
w2m vln reword SET --annotations words.csv                 people's words
w2m vln reword SET --rewrite gemini --max-usd 1            a model's, where they say the same
w2m vln reword SET --rewrite http://localhost:8000/v1 --model qwen
w2m vln reword SET --plain                                 back to the program's own
"""
REPLIES = "rewriting"  # The folder of a set where replies are kept.

SetPath = Annotated[Path, typer.Argument(help="A set of w2m vln build; it is changed.")]
Annotations = Annotated[
    Path | None,
    typer.Option("--annotations", help="CSV or JSONL: trajectory_id, instruction."),
]
Rewrite = Annotated[
    str, typer.Option("--rewrite", help="A model's server, by address, or gemini, openai ...")
]
Plain = Annotated[bool, typer.Option("--plain", help="Ask in the program's own words again.")]
Jobs = Annotated[int, typer.Option("--jobs", help="Questions at a time.", min=1, max=64)]


@option.with_model_options()
def run(
    path: SetPath,
    annotations: Annotations = None,
    rewrite: Rewrite = "",
    plain: Plain = False,
    jobs: Jobs = 4,
    *,
    model_options: option.ModelOptions,
) -> None:
    """Let a set ask in the words of people, or of a language model.

    Words are added to trajectories.jsonl and none is taken away. Items and episodes use a person's
    words where there are some, else a model's, else the program's own. A model's words are taken
    only where the same turns and things are read from them, in the same order; its replies
    are kept, so that the same command asks nothing twice.

    Raises:
        UsageError, InputError: an option or a file is wrong. ServerError: the model gives no reply.
    """
    from world2minecraft.core.errors import UsageError
    from world2minecraft.navigation.data.rewording import (
        ORDER,
        add_annotations,
        read_set,
        select_instructions,
        write_set,
    )

    if not (annotations or rewrite or plain):
        raise UsageError("nothing to do; give --annotations FILE, --rewrite MODEL or --plain")
    made, chat, outcomes = read_set(path), None, Counter[str]()
    if annotations is not None:
        made = add_annotations(made, annotations)
    if rewrite:
        chat = model_options.open(rewrite, path / REPLIES)
        made, outcomes = _reword(made, chat, jobs)
    made = select_instructions(made, ORDER[-1:] if plain else ORDER)
    write_set(path, made)
    _print_summary(path, made, outcomes, chat)


def _reword(
    made: "NavigationSet", chat: "ChatModel", jobs: int
) -> "tuple[NavigationSet, Counter[str]]":
    from world2minecraft.api.progress import show_progress
    from world2minecraft.external_models.chat_messages import Turn
    from world2minecraft.external_models.structured_replies import strip_reasoning
    from world2minecraft.navigation.data.rewording import reword_set

    def ask(prompt: str) -> str:
        return strip_reasoning(chat.ask((Turn("user", (prompt,)),))[1].text)

    with show_progress() as progress:
        return reword_set(made, ask, chat.name, jobs, progress)


def _print_summary(
    path: Path, made: "NavigationSet", outcomes: Counter[str], chat: "ChatModel | None"
) -> None:
    sources = Counter(item.instruction.source for item in made.items)
    told = ", ".join(f"{count:,} {name}" for name, count in sorted(sources.items()))
    print(f"\n{path}: items ask in words of {told}.")
    if chat is not None:
        refused = {reason: n for reason, n in sorted(outcomes.items()) if reason}
        why = ", ".join(f"{reason} {n}" for reason, n in refused.items()) or "none"
        print(f"  taken    {outcomes['']:,} of {sum(outcomes.values()):,}; refused: {why}")
        print(f"  asked    {option.cost_line(chat)}")
    print(f"  next     w2m vln stats {path}      lengths, and what blind guessing scores")
