"""The agent interface: tasks, observations, decisions and guides.

An agent is a class with the methods ``begin`` and ``decide``. Most agents receive images only. An
agent with ``is_privileged`` set also receives a ``Guide`` with full knowledge of the scene, which
baselines and experts require.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np

from world2minecraft.navigation.types import Move, MoveSet, Stance

OUTCOMES = ("moves", "invalid", "failed")


class Guide(Protocol):
    """The privileged view of an episode: distances to the goal and the effects of moves."""

    def distance_m(self, stance: Stance) -> float:
        """Return the walking distance to the nearest goal in metres of the room."""
        ...

    def step(self, stance: Stance, move: Move) -> tuple[Stance, bool]:
        """Return the stance after a move, and whether the move collides."""
        ...

    def expert(self, stance: Stance) -> tuple[Move, ...]:
        """Return the moves of the expert path from a stance, with STOP at the end."""
        ...


@dataclass(frozen=True)
class Task:
    """The task that an agent receives at the start of an episode.

    Attributes:
        instruction: The instruction to follow.
        move_set: The move set, which defines the turn angle.
        step_m: The length of a FORWARD move in metres.
        max_steps: The maximum number of moves.
        metres_per_block: The scale of the scene.
        seed: The random seed of the agent.
        guide: Full knowledge of the scene, for privileged agents only.
        plan: A function that draws a floor plan with a path as uint8 [H, W, 3], for agents that use
            a map.
    """

    instruction: str
    move_set: MoveSet
    step_m: float
    max_steps: int
    metres_per_block: float
    seed: int = 0
    guide: Guide | None = None
    plan: Callable[[Sequence[Stance]], np.ndarray] | None = None


@dataclass(frozen=True, eq=False)
class Observation:
    """The input of an agent for one decision.

    Attributes:
        step: The number of moves made so far.
        colour: The current view as uint8 [H, W, 3].
        stance: The current position and heading, as reported by error-free odometry.
        done: The moves since the last decision, each with whether it collided.
    """

    step: int
    colour: np.ndarray
    stance: Stance
    done: tuple[tuple[Move, bool], ...] = ()


@dataclass(frozen=True)
class Decision:
    """The moves that an agent decides to make, with its reasoning.

    Attributes:
        moves: The moves in order. Empty unless ``outcome`` is "moves".
        thought: The agent's reasoning.
        progress: The agent's summary of its progress.
        outcome: "moves", "invalid" if a model reply could not be parsed, or "failed" if the server
            did not answer.
        details: JSON data for the trace.
    """

    moves: tuple[Move, ...]
    thought: str = ""
    progress: str = ""
    outcome: str = "moves"
    details: dict[str, Any] = field(default_factory=dict)

    def __post_init__(self):
        if self.outcome not in OUTCOMES or bool(self.moves) != (self.outcome == "moves"):
            raise ValueError(
                f"a decision with outcome {self.outcome!r} must not have {len(self.moves)} "
                "moves: the outcome 'moves' requires at least one move, 'invalid' and "
                "'failed' none"
            )
        if Move.STOP in self.moves[:-1]:
            raise ValueError("STOP must be the last move of a decision")


class Agent(Protocol):
    """The interface of agents that walk episodes.

    No images are rendered for an agent with ``is_blind`` set.
    """

    name: str
    is_privileged: bool
    is_blind: bool

    def begin(self, task: Task) -> None:
        """Start a task and discard the state of the previous one."""
        ...

    def decide(self, sight: Observation) -> Decision:
        """Return the next moves for an observation."""
        ...
