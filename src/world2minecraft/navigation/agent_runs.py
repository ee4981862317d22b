"""Run an agent on a set of episodes, or on a single instruction, and write the results.

The output folder contains::

    OUT/episodes.jsonl, OUT/result.json
    OUT/trace.jsonl, OUT/views/, OUT/walk.mp4    for a single walk
    OUT/episodes/NNNNN/...                       the same files for each of several walks
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from world2minecraft.core.errors import UsageError
from world2minecraft.core.output_folders import FolderKind
from world2minecraft.navigation.agents.types import Agent
from world2minecraft.navigation.records import (
    EPISODES,
    read_episodes,
    resolve_scene_path,
    write_episodes,
)
from world2minecraft.navigation.running.episode_evaluation import evaluate_agent, write_walks_result
from world2minecraft.navigation.running.episode_runner import Observer
from world2minecraft.navigation.running.film import FILM_FILE, Film
from world2minecraft.navigation.running.human_agent import HumanAgent
from world2minecraft.navigation.running.sentence_goals import GoalRequest, episode_of_sentence
from world2minecraft.navigation.running.simulator import SceneSimulator, Simulator
from world2minecraft.navigation.running.trace import TRACE_FILE, VIEWS_FOLDER, TraceWriter
from world2minecraft.navigation.scene import VlnScene, open_scene
from world2minecraft.navigation.types import Episode

# A run or an evaluation of an agent. Both write result.json last.
AGENT_RUN = FolderKind(
    {"result.json": "kind", "replies.jsonl": "question"},
    (
        "result.json", EPISODES, "episodes", TRACE_FILE, VIEWS_FOLDER, FILM_FILE, "answers.jsonl",
        "replies.jsonl",
    ),
)  # fmt: skip
PageCallback = Callable[[str], object]


@dataclass(frozen=True)
class RunRequest:
    """The scene, goal and output options of a run.

    Attributes:
        scene: The scene folder, or a file or folder with episodes.
        folder: The output folder.
        goal: The instruction and goal of a single walk. Ignored for a set of episodes.
        count: The maximum number of episodes to walk. None walks all episodes.
        seed: The random seed of the agent.
        video: Whether to write a video of each walk.
        server: The address of a game server on which to walk. Empty walks in the simulator.
        observers: Additional observers of every walk.
    """

    scene: Path
    folder: Path
    goal: GoalRequest
    count: int | None = None
    seed: int = 0
    video: bool = True
    server: str = ""
    observers: Sequence[Observer] = ()


def run_walks(
    request: RunRequest,
    agent: Agent,
    on_page: PageCallback,
    facts: Callable[[], dict[str, Any]] = dict,
) -> tuple[list[Episode], dict[str, Any]]:
    """Walk the requested episodes and write the run to its folder.

    Args:
        request: The scene, goal and output options.
        agent: The agent that walks.
        on_page: Called with the URL of the browser page if the agent is a human player.
        facts: Called at the end of the run. Its result is added to ``result.json``.

    Returns:
        The episodes, and the content of ``result.json``.

    Raises:
        UsageError: If an option is invalid.
        InputError: If the scene or the goal is not found.
    """
    with closing(Simulators(request.server)) as grounds, _human_page(agent, on_page):
        episodes = _episodes(request, grounds)
        return episodes, _walk(request, episodes, grounds, agent, facts)


def check_out(folder: Path, scene: Path) -> None:
    """Check that a run does not overwrite the episodes that it reads.

    Raises:
        UsageError: If the output folder contains the input episode file.
    """
    source = scene if scene.suffix == ".jsonl" else scene / EPISODES
    if source.is_file() and source.resolve() == (folder / EPISODES).resolve():
        raise UsageError(f"--out {folder} would overwrite {source}; choose another folder")


class Simulators:
    """A factory of simulators, optionally on a game server, that opens each scene once."""

    def __init__(self, server: str) -> None:
        self._server, self._bodies = server, list[Any]()
        self._scenes: dict[str, VlnScene] = {}
        self._grounds: dict[tuple[str, str], Simulator] = {}

    def scene(self, path: str) -> VlnScene:
        """Return the scene at a path, opening it on the first call."""
        if path not in self._scenes:
            self._scenes[path] = self._on_server(path) if self._server else open_scene(path)
        return self._scenes[path]

    def close(self) -> None:
        """Disconnect all players from the server."""
        for body in self._bodies:
            body.close()

    def __call__(self, episode: Episode) -> Simulator:
        """Return the simulator in which to walk an episode."""
        key = (episode.scene, episode.move_set)
        if key not in self._grounds:
            self._grounds[key] = self._simulator(self.scene(episode.scene), episode.move_set)
        return self._grounds[key]

    def _simulator(self, scene: Any, move_set: str) -> Simulator:
        if not self._server:
            return SceneSimulator(scene, move_set)
        from world2minecraft.navigation.server.streamed_scene import (  # noqa: PLC0415
            ServerSimulator,
        )

        return ServerSimulator(scene, move_set)

    def _on_server(self, path: str) -> VlnScene:
        from world2minecraft.navigation.server.player import join  # noqa: PLC0415  # Needs Node.
        from world2minecraft.navigation.server.streamed_scene import (  # noqa: PLC0415
            open_server_scene,
        )

        if not self._bodies:
            self._bodies.append(join(self._server))
        return open_server_scene(self._bodies[0], labels=path)


def walk_folder(folder: Path, number: int, episodes: Sequence[Episode]) -> Path:
    """Return the output folder of a walk.

    A single walk is written to the run folder itself, each of several walks to a numbered
    subfolder.
    """
    return folder if len(episodes) == 1 else folder / f"episodes/{number:05d}"


def _episodes(request: RunRequest, grounds: Simulators) -> list[Episode]:
    scene, goal = request.scene, request.goal
    if scene.suffix == ".jsonl" or (scene / EPISODES).is_file():
        if goal.instruction or goal.goal:
            raise UsageError(
                f"{scene} already contains episodes with instructions; omit INSTRUCTION and --goal"
            )
        found = read_episodes(scene)[: request.count]
        if not found:
            raise UsageError(f"{scene} does not contain any episodes")
        folder = scene if scene.is_dir() else scene.parent
        return [replace(one, scene=str(resolve_scene_path(one.scene, folder))) for one in found]
    if not goal.instruction:
        raise UsageError('INSTRUCTION is missing; for example: w2m vln run OUT "Go to the table"')
    return [episode_of_sentence(grounds.scene(str(scene)), goal)]


def _walk(
    request: RunRequest,
    episodes: list[Episode],
    grounds: Simulators,
    agent: Agent,
    facts: Callable[[], dict[str, Any]],
) -> dict[str, Any]:
    films: list[Film] = []

    def watching(episode: Episode, ground: Any) -> list[Observer]:
        """Return the observers of an episode, which write its trace and video."""
        place = walk_folder(request.folder, episodes.index(episode), episodes)
        found: list[Any] = [*request.observers, TraceWriter(place), *_people(agent)]
        (place / FILM_FILE).unlink(missing_ok=True)  # The film of an earlier walk.
        if request.video:
            films[:] = [Film(place / FILM_FILE, ground, ground.plans)]
        return [*found, *films]

    try:
        walks, beside = evaluate_agent(
            episodes, grounds, agent, observers=watching, seed=request.seed
        )
    except BaseException:
        for film in films:
            film.drop()
        raise
    write_episodes(request.folder / EPISODES, episodes)
    own = {"move_sets": sorted({one.move_set for one in episodes}), "seed": request.seed}
    return write_walks_result(request.folder, walks, beside, own | facts())


@contextmanager
def _human_page(agent: Agent, on_page: PageCallback) -> Iterator[None]:
    """Report the URL of the human player's page, and close the page when the block ends."""
    try:
        for person in _people(agent):
            on_page(person.window.link)
        yield
    finally:
        for person in _people(agent):
            person.close()


def _people(agent: Agent) -> list[HumanAgent]:
    """Return the agent in a list if it is a human player, who also observes the walks."""
    return [agent] if isinstance(agent, HumanAgent) else []
