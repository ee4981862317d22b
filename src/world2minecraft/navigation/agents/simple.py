"""Agents that see nothing: what any other has to beat."""

import random

from world2minecraft.navigation.agents.values import Decision, Sight, Task
from world2minecraft.navigation.values import Move

# How often each move comes in VLN-CE's training split; its random agent draws by these.
SHARES = {Move.STOP: 0.02, Move.FORWARD: 0.68, Move.LEFT: 0.15, Move.RIGHT: 0.15}


class StopAgent:
    """Stops at once. In small rooms that alone is near enough surprisingly often."""

    name, is_privileged, is_blind = "stop", False, True

    def begin(self, task: Task) -> None:
        """Take a task."""

    def decide(self, sight: Sight) -> Decision:
        """Return STOP."""
        return Decision((Move.STOP,))


class RandomAgent:
    """Draws moves by their shares in VLN-CE, the same ones for the same seed."""

    name, is_privileged, is_blind = "random", False, True

    def __init__(self):
        self._random = random.Random(0)

    def begin(self, task: Task) -> None:
        """Begin to draw anew from the seed of the task."""
        self._random = random.Random(task.seed)

    def decide(self, sight: Sight) -> Decision:
        """Return one move."""
        return Decision((self._random.choices(list(SHARES), list(SHARES.values()))[0],))


class ForwardAgent:
    """Walks on until something is in the way, and stops there."""

    name, is_privileged, is_blind = "forward", False, True

    def begin(self, task: Task) -> None:
        """Take a task."""

    def decide(self, sight: Sight) -> Decision:
        """Return FORWARD, or STOP after a collision."""
        blocked = any(collided for _, collided in sight.done)
        return Decision((Move.STOP if blocked else Move.FORWARD,))
