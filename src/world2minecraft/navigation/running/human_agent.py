"""The agent that is a person: at each step the view is shown in the browser and a key is awaited.

The person sees what any agent sees, the instruction and the pictures, and makes the same moves; so
a trace, a film and scores come of it as of any other walk. It listens to its own walks, to tell how
they went.
"""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from world2minecraft.core.errors import UsageError
from world2minecraft.navigation.agents.types import Decision, Observation, Task
from world2minecraft.navigation.browser_window import PATIENCE_S, Window, wait_for_move
from world2minecraft.navigation.types import Episode, Move, Stance

if TYPE_CHECKING:
    from world2minecraft.navigation.running.episode_runner import EpisodeWalk

VIEW_WIDTH_PX = 320  # Times the window's scale.


class HumanAgent:
    """Does what the keys say that are pressed in its window; ``window.link`` opens it."""

    name, is_privileged, is_blind = "human", False, False

    def __init__(self, window: Window | None = None, patience_s: float = PATIENCE_S):
        self.window = Window(VIEW_WIDTH_PX) if window is None else window
        self.patience_s = patience_s
        self._task: Task | None = None
        self._before = ""

    def begin(self, task: Task) -> None:
        """Take a task."""
        self._task = task

    def decide(self, sight: Observation) -> Decision:
        """Show the view and return the move of the next key.

        Raises:
            UsageError: nobody pressed a key for long.
        """
        if self._task is None:
            raise UsageError("call begin(task) before decide(sight)")
        self.window.show(sight.colour, self._told(self._task, sight))
        return Decision((wait_for_move(self.window, self.patience_s),))

    def close(self) -> None:
        """Close the window."""
        self.window.close()

    def on_begin(self, episode: Episode, agent: str) -> None:
        """Hear that an episode begins; ``begin`` told it already."""

    def on_decision(
        self, sight: Observation, decision: Decision, made: Sequence[tuple[Move, bool]]
    ) -> None:
        """Hear what the person did, who knows."""

    def on_stance(
        self, stance: Stance, step: int, decision: Decision | None, move: Move | None
    ) -> None:
        """Hear where one stands."""

    def on_end(self, walk: "EpisodeWalk") -> None:
        """Say how the walk went, now and beside the next one."""
        from world2minecraft.navigation.running.film import end_text  # noqa: PLC0415  # Imports agents.

        self._before = end_text(walk)
        self.window.say(f"This walk is over. {self._before}.")

    def _told(self, task: Task, sight: Observation) -> str:
        lines = [task.instruction, f"Move {sight.step} of at most {task.max_steps}."]
        if any(collided for _, collided in sight.done):
            lines[1] += " Something is in the way: you did not get ahead."
        if self._before and sight.step == 0:
            lines.append(f"The walk before: {self._before}.")
        return "\n".join(lines)
