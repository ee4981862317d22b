"""``w2m compare judge``: a vision-language model grades built rooms, all shown alike."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from world2minecraft.cli import model_options as option

if TYPE_CHECKING:
    from world2minecraft.external_models.chat_client import ChatModel
    from world2minecraft.paper.layouts.judge import Grades

EXAMPLES = """\
w2m compare judge ROOMS/* OUT --agent gemini --max-usd 1 --out JUDGED
w2m compare judge ROOM OUT --agent http://localhost:8000/v1 --out JUDGED     a server of your own
w2m compare judge ROOM OUT --agent openai:gpt-4o --wish room.txt --out JUDGED
w2m compare judge ROOM OUT --agent gemini --out AGAIN --replay JUDGED/replies.jsonl
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
Out = Annotated[Path, typer.Option("--out", help="Where grades, replies and pictures are kept.")]
Repeats = Annotated[int, typer.Option("--repeats", help="How often each room is graded.", min=1)]
Wish = Annotated[
    Path | None,
    typer.Option(
        "--wish", metavar="FILE", help="What the rooms were to be, as w2m compare describe says it."
    ),
]
MAX_WISH_BYTES = 16 << 10


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

    Each is shown from the same two corners in the same light; the model is not told who made it.
    Replies are kept in OUT/replies.jsonl, so that the same command costs nothing again. The prompt
    is part of the program: compare/prompts/judge.md.

    Raises:
        InputError: a world cannot be read. ServerError, BudgetError: the model cannot be asked.
    """
    from world2minecraft.core.files import read_bytes, write_json
    from world2minecraft.navigation.running.result_tables import format_text
    from world2minecraft.paper.layouts.judge import means_of, prompt_sum
    from world2minecraft.paper.layouts.score_table import grade_table

    told = read_bytes(wish, MAX_WISH_BYTES).decode("utf-8", "replace") if wish else ""
    chat = model_options.open(agent, out)
    grades = grade_scenes(places, chat, out, told, repeats)
    write_json(
        out / "judged.json",
        {"model": chat.name, "prompt": prompt_sum(), "wish": told, "repeats": repeats,
         "temperature": chat.temperature, "scenes": [one.told() for one in grades]},
    )  # fmt: skip
    print(format_text(grade_table(means_of(grades))))
    unread = sum(one.unread for one in grades)
    if unread:
        print(
            f"note: {unread} of {repeats * len(grades)} replies hold no grades and count for none"
        )
    print(f"\n{option.cost_line(chat)}\ngrades  {out / 'judged.json'}")
    print(f"next: look at {out / 'pictures'}, which is all that {chat.name} has seen")


def grade_scenes(
    places: list[Path], chat: "ChatModel", out: Path, wish: str, repeats: int
) -> "list[Grades]":
    """Return the grades of built rooms; their pictures are written to ``out/pictures``."""
    from world2minecraft.api.progress import show_progress
    from world2minecraft.cli.compare.build import folder_names
    from world2minecraft.core.files import write_bytes
    from world2minecraft.formats.build_reader import read_build
    from world2minecraft.paper.layouts.importers import read_layouts_of
    from world2minecraft.paper.layouts.judge import grade, pictures_of

    scenes = [read_layouts_of(place)[0] for place in places]
    names, grades = folder_names(scenes), []
    with show_progress() as progress:
        for done, (place, scene) in enumerate(zip(places, scenes, strict=True)):
            progress("judge", done, len(places), scene.name)
            pictures = pictures_of(read_build(place).volume)
            for number, picture in enumerate(pictures, start=1):
                write_bytes(out / "pictures" / f"{names[done]}-{number}.jpg", picture.data)
            grades.append(
                grade(chat, scene.name, scene.method, pictures, wish=wish, repeats=repeats)
            )
        progress("judge", len(places), len(places))
    return grades
