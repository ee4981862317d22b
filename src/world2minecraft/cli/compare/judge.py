"""``w2m compare judge``: a vision-language model grades built rooms, all shown alike."""

from pathlib import Path
from typing import Annotated

import typer

from world2minecraft.cli import model_options as option

EXAMPLES = """\
w2m compare judge ROOMS/* OUT --agent gemini --max-usd 1 -o JUDGED
w2m compare judge ROOM OUT --agent http://localhost:8000/v1 -o JUDGED        a server of your own
w2m compare judge ROOM OUT --agent openai:gpt-4o --wish room.txt -o JUDGED
w2m compare judge ROOM OUT --agent gemini -o AGAIN --replay JUDGED/replies.jsonl
"""

Places = Annotated[
    list[Path],
    typer.Argument(
        metavar="BUILT...", help="Folders of w2m compare build, and finished runs.",
        show_default=False,
    ),
]  # fmt: skip
AgentName = Annotated[
    str,
    typer.Option(
        "--agent", help="gemini, openai, qwen, local, each with :MODEL if wanted; or the address "
        "of a server, http://HOST/v1.", show_default=False,
    ),
]  # fmt: skip
Out = Annotated[
    Path, typer.Option("--out", "-o", help="Write grades, replies and pictures to this folder.")
]
Repeats = Annotated[int, typer.Option("--repeats", help="How often each room is graded.", min=1)]
Wish = Annotated[
    Path | None,
    typer.Option(
        "--wish", metavar="FILE", help="What the rooms should be, from w2m compare describe."
    ),
]


@option.with_model_options(option.ModelOptions(temperature=-1.0))
def run(
    places: Places,
    agent: AgentName,
    out: Out,
    repeats: Repeats = 3,
    wish: Wish = None,
    *,
    model_options: option.ModelOptions,
) -> None:
    """Grade rooms from 1 to 10 for realism, completeness and atmosphere.

    Each is shown from the same two corners in the same light, without the name of its method.
    OUT/replies.jsonl has the replies, so that the same command costs nothing again. The prompt is
    part of the program: paper/layouts/prompts/judge.md.

    Raises:
        InputError: a world cannot be read. ServerError, BudgetError: the model does not reply.
    """
    from world2minecraft.api.agents import table_text
    from world2minecraft.api.comparison import judge_rooms, read_wish
    from world2minecraft.api.progress import show_progress

    told = read_wish(wish) if wish else ""
    with show_progress() as progress:
        judged = judge_rooms(
            places,
            out,
            agent=agent,
            repeats=repeats,
            wish=told,
            model=model_options.value(),
            progress=progress,
        )
    print(table_text(judged.table()))
    if judged.unread:
        replies = repeats * len(judged.grades)
        print(f"note: {judged.unread} of {replies} replies hold no grades and are not counted")
    print(f"\n{option.cost_line(judged.cost)}\ngrades  {out / 'judged.json'}")
    print(f"next: look at {out / 'pictures'}, which is all that {judged.model} has seen")
