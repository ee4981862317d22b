"""Grade built rooms with a vision-language model, from comparable views: ``w2m compare judge``."""

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
        metavar="BUILT...", help="Folders from w2m compare build, or finished runs.",
        show_default=False,
    ),
]  # fmt: skip
AgentName = Annotated[
    str,
    typer.Option(
        "--agent", help="gemini, openai, qwen or local, optionally followed by :MODEL; or a server "
        "address, http://HOST/v1.", show_default=False,
    ),
]  # fmt: skip
Out = Annotated[
    Path, typer.Option("--out", "-o", help="Write grades, replies and images to this folder.")
]
Repeats = Annotated[
    int, typer.Option("--repeats", help="Number of times to grade each room.", min=1)
]
Wish = Annotated[
    Path | None,
    typer.Option(
        "--wish",
        metavar="FILE",
        help="Description of the intended room, from w2m compare describe.",
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

    Each room is shown from the same two corners in the same light, without the name of its method.
    The replies are stored in OUT/replies.jsonl, so repeating the command costs nothing. The prompt
    is paper/layouts/prompts/judge.md in the program.

    Raises:
        InputError: If a world cannot be read.
        ServerError: If the model does not reply.
        BudgetError: If a limit on requests or cost is reached.
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
        print(f"note: {judged.unread} of {replies} replies contain no grades and are not counted")
    print(f"\n{option.cost_line(judged.cost)}\ngrades  {out / 'judged.json'}")
    print(f"next: view {out / 'pictures'}, the images that {judged.model} graded")
