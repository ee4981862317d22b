"""Baseline agents: some see nothing, and the privileged ones know the scene.

Random, forward and stop are what any other agent has to beat; oracle and shortest say what can be
reached at best. None of them looks at pictures.
"""

import random
from itertools import product

from world2minecraft.core.errors import UsageError
from world2minecraft.navigation.agents.types import Decision, Guide, Observation, Task
from world2minecraft.navigation.types import Move

# How often each move comes in VLN-CE's training split; its random agent draws by these.
MOVE_SHARES = {Move.STOP: 0.02, Move.FORWARD: 0.68, Move.LEFT: 0.15, Move.RIGHT: 0.15}
NEAR_M = 0.25  # Here ``shortest`` stops: half of the least radius of success.


class StopAgent:
    """Stops at once. In small rooms that alone is near enough surprisingly often."""

    name, is_privileged, is_blind = "stop", False, True

    def begin(self, task: Task) -> None:
        """Take a task."""

    def decide(self, sight: Observation) -> Decision:
        """Return STOP."""
        return Decision((Move.STOP,))


class RandomAgent:
    """Draws moves by their shares in VLN-CE, the same ones for the same seed."""

    name, is_privileged, is_blind = "random", False, True

    def __init__(self):
        self._random = random.Random(0)

    def begin(self, task: Task) -> None:
        """Reset the generator to the seed of the task."""
        self._random = random.Random(task.seed)

    def decide(self, sight: Observation) -> Decision:
        """Return one move."""
        return Decision((self._random.choices(list(MOVE_SHARES), list(MOVE_SHARES.values()))[0],))


class ForwardAgent:
    """Walks on until something is in the way, and stops there."""

    name, is_privileged, is_blind = "forward", False, True

    def begin(self, task: Task) -> None:
        """Take a task."""

    def decide(self, sight: Observation) -> Decision:
        """Return FORWARD, or STOP after a collision."""
        blocked = any(collided for _, collided in sight.done)
        return Decision((Move.STOP if blocked else Move.FORWARD,))


class OracleAgent:
    """Does what the oracle would do from where it stands."""

    name, is_privileged, is_blind = "oracle", True, True

    def __init__(self):
        self._guide: Guide | None = None
        self._left: tuple[Move, ...] = ()

    def begin(self, task: Task) -> None:
        """Take a task with a guide. Raises UsageError without one."""
        self._guide, self._left = _guide_of(task, self.name), ()

    def decide(self, sight: Observation) -> Decision:
        """Return the next move of the plan; after a collision a new plan is made."""
        if self._guide is None:
            raise UsageError("call begin(task) before decide(sight)")
        if not self._left or any(collided for _, collided in sight.done):
            self._left = self._guide.expert(sight.stance)
        move, self._left = self._left[0], self._left[1:]
        return Decision((move,))


class ShortestAgent:
    """Takes the turn after which one step forward comes nearest on foot: no plan, one look ahead.

    It falls into the traps of any greedy walk, which is what tells it from the oracle.
    """

    name, is_privileged, is_blind = "shortest", True, True

    def __init__(self):
        self._guide: Guide | None = None
        self._turns = 0

    def begin(self, task: Task) -> None:
        """Take a task with a guide. Raises UsageError without one."""
        self._guide = _guide_of(task, self.name)
        self._turns = max(1, round(180 / task.move_set.turn_deg))

    def decide(self, sight: Observation) -> Decision:
        """Return the first move of the best turn and step, STOP where none is nearer."""
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
        raise UsageError(f"the agent {name} knows the scene; its task needs a guide")
    return task.guide
