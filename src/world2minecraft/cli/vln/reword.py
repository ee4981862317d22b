"""``w2m vln reword``: the walks of a set in the words of people, or of a language model."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from world2minecraft.cli import model_options as option

if TYPE_CHECKING:
    from world2minecraft.api.navigation import RewordedSet

EXAMPLES = """\
w2m vln reword SET --annotations words.csv                 people's words
w2m vln reword SET --rewrite gemini --max-usd 1            a model's, where they say the same
w2m vln reword SET --rewrite http://localhost:8000/v1 --model qwen
w2m vln reword SET --plain                                 the generated words again
"""

SetPath = Annotated[Path, typer.Argument(help="A set of w2m vln build; it is changed.")]
Annotations = Annotated[
    Path | None,
    typer.Option("--annotations", help="CSV or JSONL: trajectory_id, instruction."),
]
Rewrite = Annotated[
    str, typer.Option("--rewrite", help="gemini, openai, qwen or local; or a server's address.")
]
Plain = Annotated[bool, typer.Option("--plain", help="Use the generated words again.")]
Jobs = Annotated[int, typer.Option("--jobs", help="Simultaneous questions.", min=1, max=64)]


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

    Words are added to trajectories.jsonl and none is removed. Items and episodes use a person's
    words where there are some, else a model's, else the generated ones. A model's words are
    accepted only where the same turns and objects are read from them, in the same order; its
    replies are recorded, so that the same command requests nothing twice.

    Raises:
        UsageError, InputError: an option or a file is wrong. ServerError: the model does not reply.
    """
    from world2minecraft.api.navigation import reword_navigation_set
    from world2minecraft.api.progress import show_progress

    with show_progress() as progress:
        done = reword_navigation_set(
            path,
            annotations=annotations,
            rewrite=rewrite,
            plain=plain,
            jobs=jobs,
            model=model_options.value(),
            progress=progress,
        )
    _print_summary(path, done)


def _print_summary(path: Path, done: "RewordedSet") -> None:
    sources = ", ".join(f"{count:,} {name}" for name, count in sorted(done.sources.items()))
    print(f"\n{path}: items by the source of their words: {sources}.")
    if done.cost is not None:
        rejected = {reason: n for reason, n in sorted(done.outcomes.items()) if reason}
        why = ", ".join(f"{reason} {n}" for reason, n in rejected.items()) or "none"
        total = sum(done.outcomes.values())
        print(f"  accepted {done.outcomes.get('', 0):,} of {total:,}; rejected: {why}")
        print(f"  asked    {option.cost_line(done.cost)}")
    print(f"  next     w2m vln stats {path}      lengths, and what blind guessing scores")
