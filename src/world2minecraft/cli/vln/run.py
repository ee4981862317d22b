"""``w2m vln run``: an agent walks by an instruction, live in the terminal and on film."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from world2minecraft.cli import model_options as option
from world2minecraft.cli.panels import MORE

if TYPE_CHECKING:
    from world2minecraft.api.agents import AgentRun

EXAMPLES = """\
w2m vln run OUT "Go to the table"                        the oracle shows the way, no network needed
w2m vln run OUT "Go to the piano" --agent gemini --max-usd 0.20
w2m vln run OUT "Find the bed" --agent openai:gpt-4.1 --map text --chunk 2
w2m vln run OUT "Go to the piano" --agent http://localhost:8000/v1 --model qwen2.5-vl
w2m vln run OUT "Go to the piano" --agent human          walk yourself, by the keyboard
w2m vln run SET --agent random --count 50 --no-video     the episodes of a set
w2m vln run OUT "Go to the piano" --server localhost:25565     on a game server where OUT stands
w2m vln run OUT "Go to the piano" --agent gemini --replay RUN/replies.jsonl
"""

Scene = Annotated[
    Path,
    typer.Argument(
        help="A run, a generated house, a world or a schematic; or a set or an episodes.jsonl, "
        "whose episodes are walked.", show_default=False,
    ),
]  # fmt: skip
Sentence = Annotated[
    str, typer.Argument(metavar="[INSTRUCTION]", help='What to do: "Go to the piano".')
]
AgentName = Annotated[
    str,
    typer.Option(
        "--agent", help="oracle, shortest, random, forward, stop; human (you); gemini, openai, "
        "qwen, local, each with :MODEL if wanted; or the address of a server, http://HOST/v1.",
    ),
]  # fmt: skip
Out = Annotated[
    Path | None,
    typer.Option("--out", "-o", help="Write the run to this folder.", show_default="vln_AGENT"),
]
Goal = Annotated[
    str, typer.Option("--goal", help="The name of the goal, where INSTRUCTION does not name it.")
]
Start = Annotated[
    str,
    typer.Option(
        "--start",
        metavar="X,Y,Z[,YAW]",
        help="Where to begin: the feet in world blocks.",
        rich_help_panel=MORE,
    ),
]
Moves = Annotated[
    str, typer.Option("--moves", help="vlnce (0.25 m, 15 degrees), rxr (30 degrees) or block.")
]
MaxSteps = Annotated[int, typer.Option("--max-steps", help="The most moves of a walk.", min=1)]
Chunk = Annotated[
    int,
    typer.Option(
        "--chunk",
        help="The most moves in one reply of a model.",
        min=1,
        max=4,
        rich_help_panel=MORE,
    ),
]
History = Annotated[
    int,
    typer.Option("--history", help="Earlier views that a model sees.", min=0, rich_help_panel=MORE),
]
Map = Annotated[
    str,
    typer.Option(
        "--map",
        help="What a model sees of earlier positions: none, text (in words) or plan (drawn).",
    ),
]
NoBrowser = Annotated[
    bool,
    typer.Option(
        "--no-browser",
        help="Print the link for a human; open no browser.",
        rich_help_panel=MORE,
    ),
]
Count = Annotated[
    int | None,
    typer.Option("--count", help="Walk this many episodes.", min=1, show_default="all"),
]
Seed = Annotated[
    int, typer.Option("--seed", help="The seed of agents that draw.", rich_help_panel=MORE)
]
Server = Annotated[
    str,
    typer.Option(
        "--server", metavar="HOST[:PORT]", help="Walk with a player on a game server where the "
        "scene stands at its own position; see w2m vln server.",
    ),
]  # fmt: skip
Video = Annotated[bool, typer.Option("--video/--no-video", help="Write walk.mp4 of each walk.")]


@option.with_model_options()
def run(
    scene: Scene,
    instruction: Sentence = "",
    agent: AgentName = "oracle",
    out: Out = None,
    goal: Goal = "",
    start: Start = "",
    moves: Moves = "vlnce",
    max_steps: MaxSteps = 120,
    chunk: Chunk = 4,
    history: History = 3,
    map_kind: Map = "none",
    count: Count = None,
    seed: Seed = 0,
    video: Video = True,
    server: Server = "",
    max_pixels: option.MaxPixels = option.MAX_PIXELS,
    no_browser: NoBrowser = False,
    *,
    model_options: option.ModelOptions,
) -> None:
    """Let an agent walk by an instruction, and score it beside Stop, Random and the oracle.

    The goal is the object that the instruction names last. The same command continues where it was
    interrupted: OUT/replies.jsonl has the replies of a model, which are not requested again.

    Raises:
        UsageError: a name or an option is wrong. InputError: the scene or the goal is not found.
        ServerError: a model does not reply. BudgetError: a cap is reached.
    """
    from world2minecraft.api import run_agent
    from world2minecraft.cli.browser import open_link
    from world2minecraft.cli.outcome import print_compile_note
    from world2minecraft.cli.vln.live_view import live_view

    def on_page(link: str) -> None:
        print(f"walk here: {link}", flush=True)
        if not no_browser:
            open_link(link)

    with live_view(on_begin=print_compile_note) as shown:
        walked = run_agent(
            scene,
            instruction,
            agent=agent,
            out=out,
            goal=goal,
            start=_numbers(start),
            moves=moves,
            max_steps=max_steps,
            chunk=chunk,
            history=history,
            map_kind=map_kind,
            count=count,
            seed=seed,
            video=video,
            server=server,
            max_pixels=max_pixels,
            model=model_options.value(),
            observers=[shown],
            on_page=on_page,
        )
    _print_summary(walked, video)


def _numbers(text: str) -> list[float] | None:
    """Return the numbers of ``--start``, which are checked with the other options."""
    from world2minecraft.core.errors import UsageError

    if not text:
        return None
    try:
        return [float(part) for part in text.split(",")]
    except ValueError as error:
        raise UsageError(f"--start is X,Y,Z or X,Y,Z,YAW, not {text!r}") from error


def _print_summary(walked: "AgentRun", video: bool) -> None:
    from world2minecraft.api.agents import compare_runs, table_text, walks_note

    print()
    print(f"{table_text(compare_runs([walked.folder]).walks)}\n{walks_note()}")
    if walked.cost:
        print(f"asked: {option.cost_line(walked.cost)}")
    place = walked.walk_folder()
    if video:
        print(f"\n  look   {place / 'walk.mp4'}")
    print(f"  read   {place / 'trace.jsonl'}: each view, thought and move")
    print(f"  next   w2m vln table {walked.folder}")
