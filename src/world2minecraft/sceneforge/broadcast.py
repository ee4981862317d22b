"""The tabs that are open: each gets every message in order, or starts again.

A tab that does not read (its laptop sleeps) costs a bounded queue: when that is full it is
emptied, and once the tab reads again its first message is a fresh ``hello``, at which it gets the
scene again. No tab waits for another.
"""

import asyncio
import json
from collections import deque
from collections.abc import Callable
from typing import Any

MAX_QUEUED_BYTES = 8 << 20
MAX_QUEUED = 512
MAX_TABS = 64


class Tab:
    """One open page and the messages that wait for it."""

    def __init__(self, actor: str):
        self.actor = actor
        self._queue: deque[str] = deque()
        self._bytes = 0
        self._lost = False
        self._something = asyncio.Event()

    def put(self, text: str) -> None:
        """Add a message, or drop all where the tab does not keep up."""
        self._something.set()
        if self._lost:
            return
        self._queue.append(text)
        self._bytes += len(text)
        if len(self._queue) > MAX_QUEUED or self._bytes > MAX_QUEUED_BYTES:
            self.reset()

    def reset(self) -> None:
        """Drop what waits; the tab starts again."""
        self._queue.clear()
        self._bytes, self._lost = 0, True
        self._something.set()

    async def get(self, hello: Callable[[], dict[str, Any]]) -> str:
        """Return the next message; a ``hello`` of now where some were lost."""
        while True:
            if self._lost:
                self._lost = False
                return to_json_text(hello())
            if self._queue:
                text = self._queue.popleft()
                self._bytes -= len(text)
                return text
            self._something.clear()
            await self._something.wait()


class Broadcaster:
    """All tabs of a server.

    Its methods are called on the server's loop, but for ``broadcast_threadsafe``.
    """

    def __init__(self):
        self._tabs: list[Tab] = []
        self._count = 0
        self._loop: asyncio.AbstractEventLoop | None = None  # Known once a tab is open.

    @property
    def count(self) -> int:
        """How many tabs are open."""
        return len(self._tabs)

    def open(self) -> Tab | None:
        """Return a new tab, None where there are too many."""
        if len(self._tabs) >= MAX_TABS:
            return None
        self._loop = asyncio.get_running_loop()
        self._count += 1
        tab = Tab(f"tab {self._count}")
        self._tabs.append(tab)
        return tab

    def close(self, tab: Tab) -> None:
        """Forget a tab."""
        self._tabs.remove(tab)

    def broadcast(self, message: dict[str, Any]) -> None:
        """Send a message of wire.ts to every tab."""
        text = to_json_text(message)
        for tab in self._tabs:
            tab.put(text)

    def broadcast_threadsafe(self, message: dict[str, Any]) -> None:
        """The same from any thread; nothing happens where no tab is open."""
        if self._loop is not None and not self._loop.is_closed():
            self._loop.call_soon_threadsafe(self.broadcast, message)

    def restart(self) -> None:
        """Let every tab start again: another document is open."""
        for tab in self._tabs:
            tab.reset()


def to_json_text(message: dict[str, Any]) -> str:
    """Return a message as it is sent."""
    return json.dumps(message, separators=(",", ":"), allow_nan=False)
