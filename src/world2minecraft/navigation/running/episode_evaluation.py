"""Many episodes walked by one agent, beside those that any result has to be held against.

``result.json`` has the scores of the agent, of Stop, Random and the oracle on the very same
episodes, and each episode's own.
"""

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

from world2minecraft.core.files import write_json
from world2minecraft.navigation.agents import AGENTS, REFERENCE_AGENTS, Agent
from world2minecraft.navigation.running.episode_runner import EpisodeWalk, Observer, walk_episode
from world2minecraft.navigation.running.item_evaluation import RESULT_FILE
from world2minecraft.navigation.running.simulator import Simulator
from world2minecraft.navigation.running.trace import score_json
from world2minecraft.navigation.scores import summarise
from world2minecraft.navigation.types import Episode, check_reachable

Observers = Callable[[Episode, Simulator], Sequence[Observer]]


def evaluate_agent(
    episodes: Iterable[Episode],
    ground_of: Callable[[Episode], Simulator],
    agent: Agent,
    *,
    observers: Observers,
    seed: int = 0,
) -> tuple[list[EpisodeWalk], dict[str, list[EpisodeWalk]]]:
    """Walk episodes, and return the agent's walks and those beside them by name.

    Raises:
        InputError: one of them cannot be walked; this is found before the first is.
        What ``walk_episode`` raises.
    """
    walks: list[EpisodeWalk] = []
    beside: dict[str, list[EpisodeWalk]] = {name: [] for name in REFERENCE_AGENTS}
    all_episodes = list(episodes)
    for episode in all_episodes:
        check_reachable(episode, ground_of(episode).distance_m(episode.start, episode.goals))
    for episode in all_episodes:
        ground = ground_of(episode)
        watching = observers(episode, ground)
        walks.append(walk_episode(ground, episode, agent, observers=watching, seed=seed))
        for name, own in beside.items():
            own.append(walk_episode(ground, episode, AGENTS.load(name)(), seed=seed))
    return walks, beside


def walks_summary(walks: Sequence[EpisodeWalk]) -> dict[str, Any]:
    """Return the means of walks, with how many decisions could not be used."""
    result = summarise([walk.score for walk in walks])
    return result | {
        "invalid": sum(walk.invalid for walk in walks),
        "failed": sum(walk.failed for walk in walks),
        "decisions": sum(walk.decisions for walk in walks),
        "ends": {end: sum(walk.end == end for walk in walks) for end in {w.end for w in walks}},
    }


def write_walks_result(
    folder: str | Path,
    walks: Sequence[EpisodeWalk],
    beside: dict[str, list[EpisodeWalk]],
    facts: dict[str, Any],
) -> dict[str, Any]:
    """Write ``result.json`` and return what it holds."""
    result = {
        "kind": "walks",
        "agent": walks[0].agent,
        "summary": walks_summary(walks),
        "beside": {name: walks_summary(own) for name, own in beside.items()},
        "episodes": [
            {
                "episode_id": walk.episode.episode_id,
                "instruction": walk.episode.instruction.text,
                "end": walk.end,
                "invalid": walk.invalid,
                "failed": walk.failed,
                "score": score_json(walk),
            }
            for walk in walks
        ],
        **facts,
    }
    write_json(Path(folder) / RESULT_FILE, result)
    return result
