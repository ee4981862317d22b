"""Evaluation of an agent on several episodes, together with the reference agents.

``result.json`` contains the scores of the agent and those of Stop, Random and Oracle on the same
episodes, as well as the score of each episode.
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
    """Walk episodes with an agent and with each reference agent.

    Args:
        episodes: The episodes to walk.
        ground_of: A function that returns the simulator of an episode.
        agent: The agent to evaluate.
        observers: A function that returns the observers of a walk.
        seed: The random seed of the agents.

    Returns:
        The walks of the agent, and the walks of the reference agents by name.

    Raises:
        InputError: If the goal of an episode cannot be reached. This is checked before the first
            walk.
        BudgetError: If the limit on calls or cost is reached.
        ServerError: If a model cannot be queried.
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
    """Return the mean scores of walks, and the number of unusable decisions."""
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
    """Write ``result.json``, and return its content.

    Args:
        folder: The output folder.
        walks: The walks of the agent.
        beside: The walks of the reference agents by name.
        facts: Additional values for the result.
    """
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
