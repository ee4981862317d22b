"""Manual play of an episode in the browser, scored like any agent."""

import webbrowser
from typing import Any

from world2minecraft.core.errors import UsageError
from world2minecraft.navigation.browser_window import PATIENCE_S, wait_for_move
from world2minecraft.navigation.environment.env import VlnEnv


def play(
    env: VlnEnv, *, open_browser: bool = True, patience_s: float = PATIENCE_S
) -> dict[str, Any]:
    """Let a person play the current episode, and return the last ``info`` with its score.

    Args:
        env: An environment with discrete actions and ``render_mode="human"``, after ``reset``.
        open_browser: Whether to open ``env.window.link`` in the browser.
        patience_s: Seconds to wait for each key press.

    Raises:
        UsageError: If the environment does not support manual play, or no key is pressed in time.
    """
    window = env.window
    if window is None or env.action_space.shape != ():
        raise UsageError(
            "manual play requires an environment that was created with "
            'render_mode="human" and the discrete action space, after reset()'
        )
    if open_browser:
        webbrowser.open(window.link)
    while True:
        _, _, over, cut, info = env.step(int(wait_for_move(window, patience_s)))
        if over or cut:
            return info
