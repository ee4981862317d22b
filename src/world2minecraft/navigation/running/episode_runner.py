"""Execution of an episode: the agent observes, decides and moves until it stops, and is scored.

The moves of a decision are made in order. After a collision the remaining moves are dropped and the
agent observes again. A decision without moves also counts as a step, and three of them in a row end
the walk without STOP. Observers are notified of all events.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from world2minecraft.navigation.agents.types import Agent, Decision, Observation, Task
from world2minecraft.navigation.running.simulator import Simulator, SimulatorGuide
from world2minecraft.navigation.scores import EpisodeScore, WalkedPath, score_episode
from world2minecraft.navigation.types import Episode, Move, Stance, check_reachable

MAX_SILENT_DECISIONS = 3  # Decisions without moves in a row that end a walk.
ENDS = ("stopped", "out of steps", "gave up")
_DARK = np.zeros((1, 1, 3), np.uint8)  # The image for blind agents.


@dataclass(frozen=True, eq=False)
class EpisodeWalk:
    """The course and the result of an episode.

    Attributes:
        episode: The episode.
        agent: The name of the agent.
        stances: The start and the stance after each move.
        made: The moves except STOP, each with whether it collided.
        end: One of ``ENDS``.
        steps: The number of steps.
        decisions: The number of decisions.
        invalid: The number of decisions that could not be parsed.
        failed: The number of decisions for which the server did not answer.
        score: The score of the walk.
    """

    episode: Episode
    agent: str
    stances: tuple[Stance, ...]
    made: tuple[tuple[Move, bool], ...]
    end: str
    steps: int
    decisions: int
    invalid: int
    failed: int
    score: EpisodeScore


class Observer(Protocol):
    """The interface of objects that are notified of the events of a walk."""

    def on_begin(self, episode: Episode, agent: str) -> None:
        """Handle the start of an episode."""
        ...

    def on_decision(
        self, sight: Observation, decision: Decision, made: Sequence[tuple[Move, bool]]
    ) -> None:
        """Handle a decision, with the observation before it and the moves made after it."""
        ...

    def on_stance(
        self, stance: Stance, step: int, decision: Decision | None, move: Move | None
    ) -> None:
        """Handle the start stance or a new stance after a move."""
        ...

    def on_end(self, walk: EpisodeWalk) -> None:
        """Handle the end of a walk."""
        ...


def walk_episode(
    ground: Simulator,
    episode: Episode,
    agent: Agent,
    *,
    observers: Sequence[Observer] = (),
    seed: int = 0,
) -> EpisodeWalk:
    """Walk an episode with an agent, and return the result.

    Args:
        ground: The simulator.
        episode: The episode.
        agent: The agent.
        observers: The observers to notify.
        seed: The random seed of the agent.

    Raises:
        InputError: If no path leads to the goal.
        BudgetError: If the limit on calls or cost is reached.
        ServerError: If a model cannot be queried.
    """
    check_reachable(episode, ground.distance_m(episode.start, episode.goals))
    state = _State(ground, episode, agent, observers)
    guide = SimulatorGuide(ground, episode) if agent.is_privileged else None
    agent.begin(
        Task(
            episode.instruction.text, ground.move_set, ground.step_m, episode.max_steps,
            ground.metres_per_block, seed, guide, ground.plan,
        )
    )  # fmt: skip
    for observer in observers:
        observer.on_begin(episode, agent.name)
        observer.on_stance(episode.start, 0, None, None)
    while state.end is None:
        state.decide()
    walk = state.walk()
    for observer in observers:
        observer.on_end(walk)
    return walk


class _State:
    """The state of a walk in progress."""

    def __init__(
        self, ground: Simulator, episode: Episode, agent: Agent, observers: Sequence[Observer]
    ):
        self.ground, self.episode, self.agent, self.observers = ground, episode, agent, observers
        self.stances: list[Stance] = [episode.start]
        self.made: list[tuple[Move, bool]] = []
        self.last: tuple[tuple[Move, bool], ...] = ()
        self.steps = self.decisions = self.silent = 0
        self.counts = {"invalid": 0, "failed": 0}
        self.end: str | None = None

    def decide(self) -> None:
        """Show the agent the current view and execute its decision."""
        here = self.stances[-1]
        colour = _DARK if self.agent.is_blind else self.ground.view(here)
        sight = Observation(self.steps, colour, here, self.last)
        decision = self.agent.decide(sight)
        self.decisions += 1
        before = len(self.made)
        if decision.moves:
            self.silent = 0
            self._make(decision)
        else:
            self._pass(decision)
        self.last = tuple(self.made[before:])
        made_moves = self.last if self.end != "stopped" else (*self.last, (Move.STOP, False))
        for observer in self.observers:
            observer.on_decision(sight, decision, made_moves)
        if self.end is None and self.steps >= self.episode.max_steps:
            self.end = "out of steps"

    def walk(self) -> EpisodeWalk:
        """Return the completed walk with its score."""
        return EpisodeWalk(
            self.episode, self.agent.name, tuple(self.stances), tuple(self.made),
            self.end or "", self.steps, self.decisions, self.counts["invalid"],
            self.counts["failed"], self._score(),
        )  # fmt: skip

    def _pass(self, decision: Decision) -> None:
        self.steps += 1
        self.silent += 1
        self.counts[decision.outcome] += 1
        self._tell(decision, None)
        if self.silent >= MAX_SILENT_DECISIONS:
            self.end = "gave up"

    def _make(self, decision: Decision) -> None:
        for move in decision.moves:
            if self.steps >= self.episode.max_steps:
                return
            self.steps += 1
            if move == Move.STOP:
                self.end = "stopped"
                self._tell(decision, move)
                return
            stance, collided = self.ground.step(self.stances[-1], move)
            self.stances.append(stance)
            self.made.append((move, collided))
            self._tell(decision, move)
            if collided:
                return

    def _tell(self, decision: Decision, move: Move | None) -> None:
        for observer in self.observers:
            observer.on_stance(self.stances[-1], self.steps, decision, move)

    def _score(self) -> EpisodeScore:
        goals = self.episode.goals
        positions = self.ground.to_room_m(np.array([one.feet for one in self.stances]))
        distance = np.array([self.ground.distance_m(one, goals) for one in self.stances])
        walked = WalkedPath(
            positions, distance, self.end == "stopped", self.steps,
            sum(collided for _, collided in self.made),
        )  # fmt: skip
        return score_episode(walked, reference_m(self.ground, self.episode))


def reference_m(ground: Simulator, episode: Episode) -> np.ndarray:
    """Return the episode's reference path, or the oracle's path, in metres as float64 [M, 3]."""
    stances = list(episode.reference)
    if not stances:
        stances = [episode.start]
        for move in ground.expert(episode.start, episode.goals, episode.facing):
            if move != Move.STOP:
                stances.append(ground.offline.step(stances[-1], move)[0])
    return ground.to_room_m(np.array([one.feet for one in stances]))
