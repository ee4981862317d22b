"""One agent walks episodes: those of a set, or one of a sentence; the run is written to a folder.

::

    OUT/episodes.jsonl, OUT/result.json
    OUT/trace.jsonl, OUT/views/, OUT/walk.mp4    of a single walk
    OUT/episodes/NNNNN/...                       the same of each of several
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from world2minecraft.core.errors import UsageError
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
from world2minecraft.navigation.running.trace import TraceWriter
from world2minecraft.navigation.scene import VlnScene, open_scene
from world2minecraft.navigation.types import Episode

PageCallback = Callable[[str], object]


@dataclass(frozen=True)
class RunRequest:
    """What is walked and what is written.

    ``goal`` holds the instruction of a single walk; ``count`` limits the episodes of a set;
    ``server`` is the game server whose player walks; ``observers`` follow every walk.
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
    """Walk the episodes and write the run; return the episodes and what ``result.json`` holds.

    Args:
        request: what is walked.
        agent: who walks.
        on_page: called with the address of the page where a human walks.
        facts: called at the end, for what else ``result.json`` holds.

    Raises:
        UsageError: an option is wrong. InputError: the scene or the goal is not found.
    """
    with closing(Simulators(request.server)) as grounds, _human_page(agent, on_page):
        episodes = _episodes(request, grounds)
        return episodes, _walk(request, episodes, grounds, agent, facts)


def check_out(folder: Path, scene: Path) -> None:
    """Raise UsageError where the run would overwrite the episodes that it walks."""
    source = scene if scene.suffix == ".jsonl" else scene / EPISODES
    if source.is_file() and source.resolve() == (folder / EPISODES).resolve():
        raise UsageError(f"--out {folder} would overwrite {source}; choose another folder")


class Simulators:
    """Opens each scene once, on a game server where one is named."""

    def __init__(self, server: str) -> None:
        self._server, self._bodies = server, list[Any]()
        self._scenes: dict[str, VlnScene] = {}
        self._grounds: dict[tuple[str, str], Simulator] = {}

    def scene(self, path: str) -> VlnScene:
        """Return the scene of a path."""
        if path not in self._scenes:
            self._scenes[path] = self._on_server(path) if self._server else open_scene(path)
        return self._scenes[path]

    def close(self) -> None:
        """Leave the server."""
        for body in self._bodies:
            body.close()

    def __call__(self, episode: Episode) -> Simulator:
        """Return what an episode is walked on."""
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
    """Return the folder of a walk: that of the run for a single one, else one by its number."""
    return folder if len(episodes) == 1 else folder / f"episodes/{number:05d}"


def _episodes(request: RunRequest, grounds: Simulators) -> list[Episode]:
    scene, goal = request.scene, request.goal
    if scene.suffix == ".jsonl" or (scene / EPISODES).is_file():
        if goal.instruction or goal.goal:
            raise UsageError(f"the episodes of {scene} have instructions; leave out INSTRUCTION")
        found = read_episodes(scene)[: request.count]
        if not found:
            raise UsageError(f"{scene} has no episode")
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
        place = walk_folder(request.folder, episodes.index(episode), episodes)
        found: list[Any] = [*request.observers, TraceWriter(place), *_people(agent)]
        (place / FILM_FILE).unlink(missing_ok=True)  # Of an earlier walk.
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
    """Report the page where a person walks, which exists while the block runs."""
    try:
        for person in _people(agent):
            on_page(person.window.link)
        yield
    finally:
        for person in _people(agent):
            person.close()


def _people(agent: Agent) -> list[HumanAgent]:
    """Return the agent in a list where it is a person, who observes the walks too."""
    return [agent] if isinstance(agent, HumanAgent) else []
