"""Delivery of messages to the open browser tabs, in order.

The queue of a tab that does not read, for example on a sleeping laptop, is bounded. When it is full
it is emptied, and once the tab reads again it first receives a new ``hello``, upon which it loads
the scene again. Tabs do not wait for each other.
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
    """An open browser tab and its queue of messages."""

    def __init__(self, actor: str):
        self.actor = actor
        self._queue: deque[str] = deque()
        self._bytes = 0
        self._lost = False
        self._something = asyncio.Event()

    def put(self, text: str) -> None:
        """Add a message to the queue, or empty the queue if it is full."""
        self._something.set()
        if self._lost:
            return
        self._queue.append(text)
        self._bytes += len(text)
        if len(self._queue) > MAX_QUEUED or self._bytes > MAX_QUEUED_BYTES:
            self.reset()

    def reset(self) -> None:
        """Empty the queue, so that the tab loads the scene again."""
        self._queue.clear()
        self._bytes, self._lost = 0, True
        self._something.set()

    async def get(self, hello: Callable[[], dict[str, Any]]) -> str:
        """Return the next message, or a current ``hello`` if messages were lost."""
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
    """All open browser tabs of a server.

    Its methods must be called on the server's event loop, except ``broadcast_threadsafe``.
    """

    def __init__(self):
        self._tabs: list[Tab] = []
        self._count = 0
        self._loop: asyncio.AbstractEventLoop | None = None  # Known once a tab is open.

    @property
    def count(self) -> int:
        """The number of open tabs."""
        return len(self._tabs)

    def open(self) -> Tab | None:
        """Return a new tab, or None if too many are open."""
        if len(self._tabs) >= MAX_TABS:
            return None
        self._loop = asyncio.get_running_loop()
        self._count += 1
        tab = Tab(f"tab {self._count}")
        self._tabs.append(tab)
        return tab

    def close(self, tab: Tab) -> None:
        """Remove a tab."""
        self._tabs.remove(tab)

    def broadcast(self, message: dict[str, Any]) -> None:
        """Send a message of ``wire.ts`` to every tab."""
        text = to_json_text(message)
        for tab in self._tabs:
            tab.put(text)

    def broadcast_threadsafe(self, message: dict[str, Any]) -> None:
        """Send a message to every tab, from any thread."""
        if self._loop is not None and not self._loop.is_closed():
            self._loop.call_soon_threadsafe(self.broadcast, message)

    def restart(self) -> None:
        """Make every tab load the scene again after another document was opened."""
        for tab in self._tabs:
            tab.reset()


def to_json_text(message: dict[str, Any]) -> str:
    """Return a message as JSON text."""
    return json.dumps(message, separators=(",", ":"), allow_nan=False)
