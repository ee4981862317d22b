"""``w2m vln run``: an agent walks by an instruction, live in the terminal and on film."""

from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from world2minecraft.cli import model_options as option

if TYPE_CHECKING:
    from world2minecraft.navigation.types import Episode, Stance

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
        help="A run's folder, a generated house, a world or schematic; or a set or an "
        "episodes.jsonl, whose episodes are walked.", show_default=False,
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
    Path | None, typer.Option("--out", help="Where the run is kept.", show_default="vln_AGENT")
]
Goal = Annotated[
    str, typer.Option("--goal", help="The goal's name, where the words do not say it.")
]
Start = Annotated[
    str,
    typer.Option("--start", metavar="X,Y,Z[,YAW]", help="Where to begin: feet in world blocks."),
]
Moves = Annotated[
    str, typer.Option("--moves", help="vlnce (0.25 m, 15 degrees), rxr (30 degrees) or block.")
]
MaxSteps = Annotated[int, typer.Option("--max-steps", help="Moves that an agent has.", min=1)]
Chunk = Annotated[
    int, typer.Option("--chunk", help="Moves that a model gives at once.", min=1, max=4)
]
History = Annotated[
    int, typer.Option("--history", help="Views of before that a model sees.", min=0)
]
Map = Annotated[
    str,
    typer.Option(
        "--map",
        help="none; text: where it was, in words; plan: the house from above, its way drawn.",
    ),
]
NoBrowser = Annotated[
    bool, typer.Option("--no-browser", help="Of a human: print the link, and open nothing.")
]
Count = Annotated[int | None, typer.Option("--count", help="Walk so many episodes.", min=1)]
Seed = Annotated[int, typer.Option("--seed", help="Of agents that draw.")]
Server = Annotated[
    str,
    typer.Option(
        "--server", metavar="HOST[:PORT]", help="Walk by a player on a running server where the "
        "scene stands at its own place; see w2m vln server.",
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

    The goal is the thing that the instruction names last. The same command goes on where it was
    stopped: what a model said is in OUT/replies.jsonl and not asked again.

    Raises:
        UsageError: a name or an option is wrong. InputError: the scene or the goal cannot be had.
        ServerError: a model cannot be asked. BudgetError: a cap is reached.
    """
    from world2minecraft.navigation.agents import make_agent
    from world2minecraft.navigation.running.sentence_goals import GoalRequest

    folder = out or option.default_run_folder(agent)
    _check_out(folder, scene)
    chats: list[Any] = []

    def chat() -> Any:
        chats.append(model_options.open(agent, folder))
        return chats[0]

    how: dict[str, Any] = {"map_kind": map_kind, "max_px": max_pixels}
    walker = make_agent(agent, chat, chunk=chunk, history=history, **how)
    wish = GoalRequest(instruction, goal, _stance(start), moves, max_steps)
    with closing(_Simulators(server)) as grounds, _human_page(walker, no_browser):
        episodes = _episodes(scene, wish, count, grounds)
        told = _walk(folder, episodes, grounds, walker, seed, video, chats)
    _print_summary(folder, told, episodes, video, chats)


def _check_out(folder: Path, scene: Path) -> None:
    """Refuse to write what was walked over the very episodes that are walked."""
    from world2minecraft.core.errors import UsageError
    from world2minecraft.navigation.records import EPISODES

    source = scene if scene.suffix == ".jsonl" else scene / EPISODES
    if source.is_file() and source.resolve() == (folder / EPISODES).resolve():
        raise UsageError(f"--out {folder} would be written over {source}; name another folder")


class _Simulators:
    """Opens each scene once; of a server that holds it where one is named."""

    def __init__(self, server: str) -> None:
        self._server, self._bodies = server, list[Any]()
        self._scenes: dict[str, Any] = {}
        self._grounds: dict[tuple[str, str], Any] = {}

    def scene(self, path: str) -> Any:
        from world2minecraft.navigation.scene import open_scene

        if path not in self._scenes:
            self._scenes[path] = self._on_server(path) if self._server else open_scene(path)
        return self._scenes[path]

    def _on_server(self, path: str) -> Any:
        from world2minecraft.navigation.server.player import join
        from world2minecraft.navigation.server.streamed_scene import open_server_scene

        if not self._bodies:
            self._bodies.append(join(self._server))
        return open_server_scene(self._bodies[0], labels=path)

    def close(self) -> None:
        for body in self._bodies:
            body.close()

    def __call__(self, episode: "Episode") -> Any:
        from world2minecraft.navigation.running.simulator import SceneSimulator

        key = (episode.scene, episode.move_set)
        if key not in self._grounds:
            scene = self.scene(episode.scene)
            if self._server:
                from world2minecraft.navigation.server.streamed_scene import ServerSimulator

                self._grounds[key] = ServerSimulator(scene, episode.move_set)
            else:
                self._grounds[key] = SceneSimulator(scene, episode.move_set)
        return self._grounds[key]


def _episodes(scene: Path, wish: Any, count: int | None, grounds: _Simulators) -> "list[Episode]":
    from dataclasses import replace

    from world2minecraft.core.errors import UsageError
    from world2minecraft.navigation.records import EPISODES, read_episodes, resolve_scene_path
    from world2minecraft.navigation.running.sentence_goals import episode_of_sentence

    if scene.suffix == ".jsonl" or (scene / EPISODES).is_file():
        if wish.instruction or wish.goal:
            raise UsageError("episodes bring their own instructions; leave the sentence out")
        found = read_episodes(scene)[:count]
        if not found:
            raise UsageError(f"{scene} has no episode")
        folder = scene if scene.is_dir() else scene.parent
        return [replace(one, scene=str(resolve_scene_path(one.scene, folder))) for one in found]
    if not wish.instruction:
        raise UsageError('say what to do, such as w2m vln run OUT "Go to the table"')
    return [episode_of_sentence(grounds.scene(str(scene)), wish)]


def _walk(
    folder: Path, episodes: "list[Episode]", grounds: _Simulators, walker: Any, seed: int,
    video: bool, chats: list[Any],
) -> dict[str, Any]:  # fmt: skip
    from world2minecraft.cli.outcome import print_compile_note
    from world2minecraft.cli.vln.live_view import live_view
    from world2minecraft.navigation.records import write_episodes
    from world2minecraft.navigation.running.episode_evaluation import (
        evaluate_agent,
        write_walks_result,
    )
    from world2minecraft.navigation.running.film import FILM_FILE, Film
    from world2minecraft.navigation.running.trace import TraceWriter

    print_compile_note()
    films: list[Film] = []

    def watching(episode: "Episode", ground: Any) -> list[Any]:
        place = folder / _place(episode, episodes)
        found: list[Any] = [shown, TraceWriter(place), *_people(walker)]
        (place / FILM_FILE).unlink(missing_ok=True)  # Of a walk that was kept here before.
        if video:
            films[:] = [Film(place / FILM_FILE, ground, ground.plans)]
        return [*found, *films]

    with live_view() as shown:
        try:
            walks, beside = evaluate_agent(episodes, grounds, walker, observers=watching, seed=seed)
        except BaseException:
            for film in films:
                film.drop()
            raise
    write_episodes(folder / "episodes.jsonl", episodes)
    facts: dict[str, Any] = {"move_sets": sorted({one.move_set for one in episodes}), "seed": seed}
    if chats:
        facts |= {"model": chats[0].name, "cost": chats[0].ledger.to_json()}
    return write_walks_result(folder, walks, beside, facts)


@contextmanager
def _human_page(walker: Any, no_browser: bool) -> Iterator[None]:
    """Tell a person where to walk and open the page, which is there while the block runs."""
    from world2minecraft.cli.browser import open_link

    try:
        for person in _people(walker):
            print(f"walk here: {person.window.link}", flush=True)
            if not no_browser:
                open_link(person.window.link)
        yield
    finally:
        for person in _people(walker):
            person.close()


def _people(walker: Any) -> list[Any]:
    """Return the walker in a list where it is a person, who hears how the walks went."""
    from world2minecraft.navigation.running.human_agent import HumanAgent

    return [walker] if isinstance(walker, HumanAgent) else []


def _place(episode: "Episode", episodes: "list[Episode]") -> str:
    """Return the folder of an episode: the run's own for a single one, else by its number."""
    return "." if len(episodes) == 1 else f"episodes/{episodes.index(episode):05d}"


def _print_summary(
    folder: Path, told: dict[str, Any], episodes: "list[Episode]", video: bool, chats: list[Any]
) -> None:
    from world2minecraft.navigation.running.result_tables import (
        HEADS_NOTE,
        format_text,
        walks_table,
    )

    print()
    print(f"{format_text(walks_table([told]))}\n{HEADS_NOTE}")
    if chats:
        print(f"asked: {option.cost_line(chats[0])}")
    place = folder / _place(episodes[0], episodes)
    if video:
        print(f"\n  look   {place / 'walk.mp4'}")
    print(f"  read   {place / 'trace.jsonl'}: each view, thought and move")
    print(f"  next   w2m vln table {folder}")


def _stance(text: str) -> "Stance | None":
    from math import isfinite

    from world2minecraft.core.errors import UsageError
    from world2minecraft.navigation.types import Stance

    if not text:
        return None
    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError:
        numbers = []
    if len(numbers) not in (3, 4) or not all(isfinite(one) for one in numbers):
        raise UsageError(f"--start is X,Y,Z or X,Y,Z,YAW, not {text!r}")
    return Stance(*numbers)
