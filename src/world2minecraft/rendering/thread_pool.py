"""Run kernels in parallel on one pool of threads, made when first needed.

Compiled kernels release Python's lock and keep nothing between calls, so they may run on any
number of threads, and any number of threads may call them at once. What they must not share is
their scratch memory and the rows that they write; each work has its own.
"""

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise
from threading import Lock
from typing import TypeVar

Item = TypeVar("Item")

MAX_THREADS = 512  # They are started one by one, as works wait for them.
_lock = Lock()
_running: list[ThreadPoolExecutor] = []  # None or one.


def run_parallel(work: Callable[[Item], object], items: Sequence[Item]) -> None:
    """Call ``work`` once for each item, all at the same time; return when all are done.

    The first item is worked on by the caller's own thread. An error of any is raised, that of the
    first where there are several, after all have ended.
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
    """Return up to ``parts`` bands (first row, past the last) of near equal height.

    Args:
        rows: in all.
        parts: 1 or more.
        step: each band begins with a whole number of these.
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
