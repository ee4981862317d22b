"""A shared thread pool that runs kernels in parallel, created when first needed.

Compiled kernels release the GIL and have no state, so they may run on any number of threads.
Concurrent calls must not share scratch memory or write the same rows; each work item has its own.
"""

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise
from threading import Lock
from typing import TypeVar

Item = TypeVar("Item")

MAX_THREADS = 512  # A thread starts only when work is waiting for it.
_lock = Lock()
_running: list[ThreadPoolExecutor] = []  # At most one.


def run_parallel(work: Callable[[Item], object], items: Sequence[Item]) -> None:
    """Call ``work`` for all items in parallel, and return when all calls are done.

    The calling thread processes the first item. If calls raise exceptions, the exception of the
    first such item is raised after all calls have ended.
    """
    if not items:
        return
    waiting = [_executor().submit(work, item) for item in items[1:]]
    try:
        work(items[0])
    finally:
        errors = [error for one in waiting if (error := one.exception())]
    if errors:
        raise errors[0]


def bands(rows: int, parts: int, step: int) -> list[tuple[int, int]]:
    """Divide rows into up to ``parts`` bands (first row, end row) of nearly equal height.

    Args:
        rows: Total number of rows.
        parts: Maximum number of bands, at least 1.
        step: Bands start at multiples of this number of rows.
    """
    steps = -(-rows // step)
    edges = [min(rows, step * (steps * n // parts)) for n in range(parts)] + [rows]
    return [(a, b) for a, b in pairwise(edges) if b > a]


def _executor() -> ThreadPoolExecutor:
    with _lock:
        if not _running:
            _running.append(ThreadPoolExecutor(MAX_THREADS, "world2minecraft-render"))
        return _running[0]


def _reset_after_fork() -> None:
    """A forked process has none of its parent's threads, and perhaps a lock that one held."""
    global _lock  # noqa: PLW0603
    _lock = Lock()
    _running.clear()


if hasattr(os, "register_at_fork"):  # Windows has no fork.
    os.register_at_fork(after_in_child=_reset_after_fork)
