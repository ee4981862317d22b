"""A person plays an episode in the browser, by the keyboard, and is scored like any agent."""

import queue
import webbrowser
from typing import Any

from world2minecraft.errors import UsageError
from world2minecraft.vln.environment.env import VlnEnv
from world2minecraft.vln.environment.window import Window
from world2minecraft.vln.values import Move

KEYS = {
    "ArrowUp": Move.FORWARD,
    "w": Move.FORWARD,
    "ArrowLeft": Move.LEFT,
    "a": Move.LEFT,
    "ArrowRight": Move.RIGHT,
    "d": Move.RIGHT,
    " ": Move.STOP,
}


def play(env: VlnEnv, *, open_browser: bool = True, patience_s: float = 600.0) -> dict[str, Any]:
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
        move = KEYS.get(_key(window, patience_s))
        if move is None:
            continue
        _, _, over, cut, info = env.step(int(move))
        if over or cut:
            return info


def _key(window: Window, patience_s: float) -> str:
    try:
        return window.keys.get(timeout=patience_s)
    except queue.Empty:
        raise UsageError(f"nobody pressed a key in {patience_s:g} s; {window.link}") from None
