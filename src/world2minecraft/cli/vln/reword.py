"""Replace the wording of a navigation set by that of people or a model: ``w2m vln reword``."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from world2minecraft.cli import model_options as option

if TYPE_CHECKING:
    from world2minecraft.api.navigation import RewordedSet

EXAMPLES = """\
w2m vln reword SET --annotations words.csv                 use human instructions
w2m vln reword SET --rewrite gemini --max-usd 1            use equivalent instructions of a model
w2m vln reword SET --rewrite http://localhost:8000/v1 --model qwen
w2m vln reword SET --plain                                 restore the generated instructions
"""

SetPath = Annotated[Path, typer.Argument(help="Navigation set to change, from w2m vln build.")]
Annotations = Annotated[
    Path | None,
    typer.Option("--annotations", help="CSV or JSONL with trajectory_id, instruction."),
]
Rewrite = Annotated[
    str, typer.Option("--rewrite", help="gemini, openai, qwen, local or a server address.")
]
Plain = Annotated[bool, typer.Option("--plain", help="Restore the generated instructions.")]
Jobs = Annotated[
    int, typer.Option("--jobs", help="Number of simultaneous requests.", min=1, max=64)
]


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
    """Use instructions written by people or a language model in a navigation set.

    Instructions are added to trajectories.jsonl, and none are removed. Items and episodes prefer
    human instructions, then those of a model, then the generated ones. An instruction from a model
    is accepted only if the same turns and objects can be parsed from it in the same order. Replies
    are recorded, so repeating the command sends no request twice.

    Raises:
        UsageError: If an option is invalid.
        InputError: If a file cannot be read.
        ServerError: If the model does not reply.
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
    print(f"\n{path}: items by source of the instruction: {sources}.")
    if done.cost is not None:
        rejected = {reason: n for reason, n in sorted(done.outcomes.items()) if reason}
        why = ", ".join(f"{reason} {n}" for reason, n in rejected.items()) or "none"
        total = sum(done.outcomes.values())
        print(f"  accepted {done.outcomes.get('', 0):,} of {total:,}; rejected: {why}")
        print(f"  cost     {option.cost_line(done.cost)}")
    print(f"  next     w2m vln stats {path}      lengths and baseline scores")
