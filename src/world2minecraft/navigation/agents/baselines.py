"""Baseline agents: blind ones, and privileged ones that know the scene.

The agents random, forward and stop are lower bounds that any other agent should exceed. The agents
oracle and shortest show what can be achieved with full knowledge of the scene. None of them uses
images.
"""

import random
from itertools import product

from world2minecraft.core.errors import UsageError
from world2minecraft.navigation.agents.types import Decision, Guide, Observation, Task
from world2minecraft.navigation.types import Move

# Frequencies of the moves in VLN-CE's training split, which its random agent uses.
MOVE_SHARES = {Move.STOP: 0.02, Move.FORWARD: 0.68, Move.LEFT: 0.15, Move.RIGHT: 0.15}
NEAR_M = 0.25  # Distance at which ``shortest`` stops, half of the smallest success radius.


class StopAgent:
    """An agent that stops at once, which succeeds surprisingly often in small rooms."""

    name, is_privileged, is_blind = "stop", False, True

    def begin(self, task: Task) -> None:
        """Accept a task. This agent ignores it."""

    def decide(self, sight: Observation) -> Decision:
        """Return STOP."""
        return Decision((Move.STOP,))


class RandomAgent:
    """An agent that samples random moves with the move frequencies of VLN-CE's training split.

    The same task seed gives the same moves.
    """

    name, is_privileged, is_blind = "random", False, True

    def __init__(self):
        self._random = random.Random(0)

    def begin(self, task: Task) -> None:
        """Reset the random generator to the seed of the task."""
        self._random = random.Random(task.seed)

    def decide(self, sight: Observation) -> Decision:
        """Return one random move."""
        return Decision((self._random.choices(list(MOVE_SHARES), list(MOVE_SHARES.values()))[0],))


class ForwardAgent:
    """An agent that walks forward until it collides, and then stops."""

    name, is_privileged, is_blind = "forward", False, True

    def begin(self, task: Task) -> None:
        """Accept a task. This agent ignores it."""

    def decide(self, sight: Observation) -> Decision:
        """Return FORWARD, or STOP after a collision."""
        blocked = any(collided for _, collided in sight.done)
        return Decision((Move.STOP if blocked else Move.FORWARD,))


class OracleAgent:
    """An agent that follows the expert path from its current position."""

    name, is_privileged, is_blind = "oracle", True, True

    def __init__(self):
        self._guide: Guide | None = None
        self._left: tuple[Move, ...] = ()

    def begin(self, task: Task) -> None:
        """Start a task.

        Raises:
            UsageError: If the task has no guide.
        """
        self._guide, self._left = _guide_of(task, self.name), ()

    def decide(self, sight: Observation) -> Decision:
        """Return the next move of the expert path, which is planned again after a collision."""
        if self._guide is None:
            raise UsageError("call begin(task) before decide(sight)")
        if not self._left or any(collided for _, collided in sight.done):
            self._left = self._guide.expert(sight.stance)
        move, self._left = self._left[0], self._left[1:]
        return Decision((move,))


class ShortestAgent:
    """A greedy agent that chooses the turn after which one forward step gets closest to the goal.

    It looks one step ahead and does not plan, so unlike the oracle it can get stuck in dead ends.
    """

    name, is_privileged, is_blind = "shortest", True, True

    def __init__(self):
        self._guide: Guide | None = None
        self._turns = 0

    def begin(self, task: Task) -> None:
        """Start a task.

        Raises:
            UsageError: If the task has no guide.
        """
        self._guide = _guide_of(task, self.name)
        self._turns = max(1, round(180 / task.move_set.turn_deg))

    def decide(self, sight: Observation) -> Decision:
        """Return the turns and the forward step that get closest to the goal, or STOP."""
        guide = self._guide
        if guide is None:
            raise UsageError("call begin(task) before decide(sight)")
        here = guide.distance_m(sight.stance)
        if here <= NEAR_M:
            return Decision((Move.STOP,))
        best, moves = here, (Move.STOP,)
        for count, turn in product(range(self._turns + 1), (Move.LEFT, Move.RIGHT)):
            stance = sight.stance
            for _ in range(count):
                stance, _ = guide.step(stance, turn)
            ahead, _ = guide.step(stance, Move.FORWARD)
            left = guide.distance_m(ahead)
            if left < best - 1e-9:
                best, moves = left, (*[turn] * count, Move.FORWARD)
        return Decision(moves)


def _guide_of(task: Task, name: str) -> Guide:
    if task.guide is None:
        raise UsageError(
            f"agent {name!r} requires knowledge of the scene; pass a Task with a guide"
        )
    return task.guide
