"""Let an agent follow an instruction, shown live and recorded as video: ``w2m vln run``."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from world2minecraft.cli import model_options as option
from world2minecraft.cli.panels import MORE, Force

if TYPE_CHECKING:
    from world2minecraft.api.agents import AgentRun

EXAMPLES = """\
w2m vln run OUT "Go to the table"                        the oracle agent, without any model
w2m vln run OUT "Go to the piano" --agent gemini --max-usd 0.20
w2m vln run OUT "Find the bed" --agent openai:gpt-4.1 --map text --chunk 2
w2m vln run OUT "Go to the piano" --agent http://localhost:8000/v1 --model qwen2.5-vl
w2m vln run OUT "Go to the piano" --agent human          walk yourself by keyboard
w2m vln run SET --agent random --count 50 --no-video     the episodes of a set
w2m vln run OUT "Go to the piano" --server localhost:25565     on a game server that contains OUT
w2m vln run OUT "Go to the piano" --agent gemini --replay RUN/replies.jsonl
"""

Scene = Annotated[
    Path,
    typer.Argument(
        help="Run, generated house, world or schematic; or a navigation set or episodes.jsonl "
        "with the episodes to walk.", show_default=False,
    ),
]  # fmt: skip
Sentence = Annotated[
    str, typer.Argument(metavar="[INSTRUCTION]", help='Instruction, such as "Go to the piano".')
]
AgentName = Annotated[
    str,
    typer.Option(
        "--agent", help="oracle, shortest, random, forward, stop; human (you); gemini, openai, "
        "qwen or local, optionally followed by :MODEL; or a server address, http://HOST/v1.",
    ),
]  # fmt: skip
Out = Annotated[
    Path | None,
    typer.Option("--out", "-o", help="Write the run to this folder.", show_default="vln_AGENT"),
]
Goal = Annotated[
    str, typer.Option("--goal", help="Name of the goal, if INSTRUCTION does not name it.")
]
Start = Annotated[
    str,
    typer.Option(
        "--start",
        metavar="X,Y,Z[,YAW]",
        help="Start position of the feet in world block coordinates.",
        rich_help_panel=MORE,
    ),
]
Moves = Annotated[
    str,
    typer.Option(
        "--moves", help="Move set: vlnce (0.25 m, 15 degrees), rxr (30 degrees) or block."
    ),
]
MaxSteps = Annotated[
    int, typer.Option("--max-steps", help="Maximum number of moves in a walk.", min=1)
]
Chunk = Annotated[
    int,
    typer.Option(
        "--chunk",
        help="Maximum number of moves in one model reply.",
        min=1,
        max=4,
        rich_help_panel=MORE,
    ),
]
History = Annotated[
    int,
    typer.Option(
        "--history", help="Number of earlier views shown to a model.", min=0, rich_help_panel=MORE
    ),
]
Map = Annotated[
    str,
    typer.Option(
        "--map",
        help="How to show earlier positions to a model: none, text or plan (an image).",
    ),
]
NoBrowser = Annotated[
    bool,
    typer.Option(
        "--no-browser",
        help="With --agent human, print the link without opening a browser.",
        rich_help_panel=MORE,
    ),
]
Count = Annotated[
    int | None,
    typer.Option("--count", help="Number of episodes to walk.", min=1, show_default="all"),
]
Seed = Annotated[
    int, typer.Option("--seed", help="Random seed of the agent.", rich_help_panel=MORE)
]
Server = Annotated[
    str,
    typer.Option(
        "--server", metavar="HOST[:PORT]", help="Walk with a player on a game server that contains "
        "the scene at its original position; see w2m vln server.",
    ),
]  # fmt: skip
Video = Annotated[bool, typer.Option("--video/--no-video", help="Write a walk.mp4 for each walk.")]


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
    force: Force = False,
    no_browser: NoBrowser = False,
    *,
    model_options: option.ModelOptions,
) -> None:
    """Let an agent follow an instruction, and score it next to Stop, Random and the oracle.

    The goal is the last object named in the instruction. Repeat the command to resume an
    interrupted run. OUT/replies.jsonl contains the replies of a model, which are not requested
    again.

    Raises:
        UsageError: If a name or an option is invalid.
        InputError: If the scene or the goal is not found.
        ServerError: If the model does not reply.
        BudgetError: If a limit on requests or cost is reached.
    """
    from world2minecraft.api import run_agent
    from world2minecraft.cli.browser import open_link
    from world2minecraft.cli.vln.live_view import live_view

    def on_page(link: str) -> None:
        print(f"walk here: {link}", flush=True)
        if not no_browser:
            open_link(link)

    with live_view(on_begin=_compile) as shown:
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
            force=force,
            model=model_options.value(),
            observers=[shown],
            on_page=on_page,
        )
    _print_summary(walked, video)


def _numbers(text: str) -> list[float] | None:
    """Return the numbers given with ``--start``, which are checked with the other options."""
    from world2minecraft.core.errors import UsageError

    if not text:
        return None
    try:
        return [float(part) for part in text.split(",")]
    except ValueError as error:
        raise UsageError(f"--start must be X,Y,Z or X,Y,Z,YAW, got {text!r}") from error


def _print_summary(walked: "AgentRun", video: bool) -> None:
    from world2minecraft.api.agents import compare_runs, table_text, walks_note

    print()
    print(f"{table_text(compare_runs([walked.folder]).walks)}\n{walks_note()}")
    if walked.cost:
        print(f"cost: {option.cost_line(walked.cost)}")
    place = walked.walk_folder()
    if video:
        print(f"\n  look   {place / 'walk.mp4'}")
    print(f"  read   {place / 'trace.jsonl'}: all views, thoughts and moves")
    print(f"  next   w2m vln table {walked.folder}")


def _compile() -> None:
    """Compile what a walk needs, with progress on stderr."""
    from world2minecraft.api.progress import show_progress
    from world2minecraft.core.precompile import compile_kernels

    with show_progress() as progress:
        compile_kernels("navigation", progress)
