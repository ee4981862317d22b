"""A person plays an episode in the browser, by the keyboard, and is scored like any agent."""

import webbrowser
from typing import Any

from world2minecraft.core.errors import UsageError
from world2minecraft.navigation.browser_window import PATIENCE_S, wait_for_move
from world2minecraft.navigation.environment.env import VlnEnv


def play(
    env: VlnEnv, *, open_browser: bool = True, patience_s: float = PATIENCE_S
) -> dict[str, Any]:
    """Let a person play the episode that was begun, and return the last ``info`` with its score.

    Args:
        env: with discrete actions and ``render_mode="human"``, after ``reset``.
        open_browser: whether to open ``env.window.link``; else somebody else does.
        patience_s: how long to wait for a key.

    Raises:
        UsageError: the environment cannot be played so, or nobody pressed a key for that long.
    """
    window = env.window
    if window is None or env.action_space.shape != ():
        raise UsageError(
            'a person plays an environment made with render_mode="human" and single discrete '
            "moves, after reset()"
        )
    if open_browser:
        webbrowser.open(window.link)
    while True:
        _, _, over, cut, info = env.step(int(wait_for_move(window, patience_s)))
        if over or cut:
            return info
