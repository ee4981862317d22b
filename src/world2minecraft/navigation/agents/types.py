"""What an agent is given, what it sees, and what it decides.

An agent is a class with ``begin`` and ``decide``. Most see pictures alone; one that says
``is_privileged`` is given a ``Guide`` to the whole scene besides, as baselines and experts need.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np

from world2minecraft.navigation.types import Move, MoveSet, Stance

OUTCOMES = ("moves", "invalid", "failed")


class Guide(Protocol):
    """What the privileged know of an episode: all ways, and where they lead."""

    def distance_m(self, stance: Stance) -> float:
        """Return how far it is on foot to the nearest goal, metres of the room."""
        ...

    def step(self, stance: Stance, move: Move) -> tuple[Stance, bool]:
        """Return where a move would lead, and whether something would be in the way."""
        ...

    def expert(self, stance: Stance) -> tuple[Move, ...]:
        """Return the moves of the oracle from here, STOP at their end."""
        ...


@dataclass(frozen=True)
class Task:
    """What an agent is given before it starts. ``step_m`` is how far FORWARD goes.

    ``plan`` draws the building from above with a way through it, uint8 [H, W, 3].
    """

    instruction: str
    move_set: MoveSet
    step_m: float
    max_steps: int
    metres_per_block: float
    seed: int = 0
    guide: Guide | None = None  # of privileged agents alone
    plan: Callable[[Sequence[Stance]], np.ndarray] | None = None  # of those who ask for a map


@dataclass(frozen=True, eq=False)
class Observation:
    """What an agent sees when it is asked to decide.

    ``done`` are the moves since it decided last, each with whether something was in the way;
    ``stance`` is where it stands, as odometry without error reports it.
    """

    step: int  # moves made so far
    colour: np.ndarray  # uint8 [H, W, 3]
    stance: Stance
    done: tuple[tuple[Move, bool], ...] = ()


@dataclass(frozen=True)
class Decision:
    """What an agent decides: moves, made in turn, and why.

    ``outcome`` is ``moves``, or ``invalid`` where a model said nothing that can be read, or
    ``failed`` where its server did not answer; then there are no moves, and none are made up.
    ``details`` is for the trace, JSON.
    """

    moves: tuple[Move, ...]
    thought: str = ""
    progress: str = ""
    outcome: str = "moves"
    details: dict[str, Any] = field(default_factory=dict)

    def __post_init__(self):
        if self.outcome not in OUTCOMES or bool(self.moves) != (self.outcome == "moves"):
            raise ValueError(
                f"{self.outcome!r} with {len(self.moves)} moves is no decision: there are moves "
                "where the outcome is moves, and none where it is invalid or failed"
            )
        if Move.STOP in self.moves[:-1]:
            raise ValueError("nothing comes after STOP")


class Agent(Protocol):
    """What walks episodes. One that ``is_blind`` looks at no picture, so none need be drawn."""

    name: str
    is_privileged: bool
    is_blind: bool

    def begin(self, task: Task) -> None:
        """Take a task; what was before is forgotten."""
        ...

    def decide(self, sight: Observation) -> Decision:
        """Return what to do next."""
        ...
