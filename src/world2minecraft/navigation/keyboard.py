"""The keys by which a person walks, as they come from a window."""

import queue

from world2minecraft.core.errors import UsageError
from world2minecraft.navigation.values import Move
from world2minecraft.navigation.window import Window

PATIENCE_S = 600.0  # Without a key for so long nobody is there.
KEYS = {
    "ArrowUp": Move.FORWARD,
    "w": Move.FORWARD,
    "ArrowLeft": Move.LEFT,
    "a": Move.LEFT,
    "ArrowRight": Move.RIGHT,
    "d": Move.RIGHT,
    " ": Move.STOP,
}


def pressed_move(window: Window, patience_s: float = PATIENCE_S) -> Move:
    """Wait for a key that means a move, and return the move.

    Raises:
        UsageError: nobody pressed a key for that long.
    """
    while True:
        try:
            key = window.keys.get(timeout=patience_s)
        except queue.Empty:
            raise UsageError(
                f"nobody pressed a key in {patience_s:g} s; {window.link} is the page for them"
            ) from None
        if key in KEYS:
            return KEYS[key]
