"""An agent that a person controls with the keyboard in the browser.

The person sees the same instruction and images as other agents and makes the same moves, so the
walk is traced, filmed and scored like any other. The agent also observes its own walks in order to
display their results.
"""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from world2minecraft.core.errors import UsageError
from world2minecraft.navigation.agents.types import Decision, Observation, Task
from world2minecraft.navigation.browser_window import PATIENCE_S, Window, wait_for_move
from world2minecraft.navigation.types import Episode, Move, Stance

if TYPE_CHECKING:
    from world2minecraft.navigation.running.episode_runner import EpisodeWalk

VIEW_WIDTH_PX = 320  # Before magnification by the page.


class HumanAgent:
    """An agent that makes the moves of the keys pressed in its page at ``window.link``."""

    name, is_privileged, is_blind = "human", False, False

    def __init__(self, window: Window | None = None, patience_s: float = PATIENCE_S):
        self.window = Window(VIEW_WIDTH_PX) if window is None else window
        self.patience_s = patience_s
        self._task: Task | None = None
        self._before = ""

    def begin(self, task: Task) -> None:
        """Start a task."""
        self._task = task

    def decide(self, sight: Observation) -> Decision:
        """Show the view and wait for a key, and return its move.

        Raises:
            UsageError: If no key is pressed in time, or no task was started.
        """
        if self._task is None:
            raise UsageError("call begin(task) before decide(sight)")
        self.window.show(sight.colour, self._told(self._task, sight))
        return Decision((wait_for_move(self.window, self.patience_s),))

    def close(self) -> None:
        """Close the page."""
        self.window.close()

    def on_begin(self, episode: Episode, agent: str) -> None:
        """Do nothing, because ``begin`` already received the episode."""

    def on_decision(
        self, sight: Observation, decision: Decision, made: Sequence[tuple[Move, bool]]
    ) -> None:
        """Do nothing, because the person made the decision."""

    def on_stance(
        self, stance: Stance, step: int, decision: Decision | None, move: Move | None
    ) -> None:
        """Do nothing, because the view is shown before each decision."""

    def on_end(self, walk: "EpisodeWalk") -> None:
        """Show the result of the walk now and beside the next one."""
        from world2minecraft.navigation.running.film import end_text  # noqa: PLC0415  # Imports agents.

        self._before = end_text(walk)
        self.window.say(f"This walk is over. {self._before}.")

    def _told(self, task: Task, sight: Observation) -> str:
        lines = [task.instruction, f"Move {sight.step} of at most {task.max_steps}."]
        if any(collided for _, collided in sight.done):
            lines[1] += " An obstacle is in the way, so you did not move."
        if self._before and sight.step == 0:
            lines.append(f"Previous walk: {self._before}.")
        return "\n".join(lines)
