"""The engines by name, their common interface, and the one that runs in this process."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager
from typing import Any, Protocol

from world2minecraft.core.errors import UsageError
from world2minecraft.core.registry import Registry

Tick = Callable[[int], None]  # Called with how many images more are done.
Task = Callable[[Any, Tick], Any]  # At the top of a module; what it takes and gives is sent.
ENGINES = Registry(
    "engine",
    {
        "pool": "world2minecraft.minecraftocc.engine.process_pool:PoolEngine",
        "ray": "world2minecraft.minecraftocc.engine.ray_cluster:RayEngine",
    },
)
MAX_JOBS = 1024


class InProcessEngine:
    """Calls a task in this process."""

    def __init__(self):
        """Begin with no notes."""
        self.notes: list[str] = []

    def __enter__(self) -> "InProcessEngine":
        """Return the engine."""
        return self

    def __exit__(self, *_: object) -> None:
        """End; there is nothing to end."""

    def run(
        self,
        task: Callable[[Any, Callable[[int], None]], Any],
        items: Sequence[Any],
        tick: Callable[[int], None],
    ) -> Iterator[tuple[int, Any]]:
        """Give each item's number and result, in order."""
        for number, item in enumerate(items):
            yield number, task(item, tick)


class Engine(Protocol):
    """Calls a task with each of many items."""

    notes: list[str]  # What went wrong and was repaired, in sentences.

    def run(self, task: Task, items: Sequence[Any], tick: Tick) -> Iterator[tuple[int, Any]]:
        """Give each item's number and result as they are done; the first error ends all."""
        ...


def open_engine(name: str, jobs: int) -> AbstractContextManager[Engine]:
    """Return an engine, to be used in a ``with`` block.

    Args:
        name: one of ``ENGINES``.
        jobs: how many processes; with one, a pool is this process itself.

    Raises:
        UnknownNameError: there is no such engine. UsageError: the number is out of range.
        MissingExtraError: Ray is requested and is not installed.
    """
    if not 1 <= jobs <= MAX_JOBS:
        raise UsageError(f"jobs may be 1 to {MAX_JOBS}, not {jobs}")
    kind = ENGINES.load(name)
    return InProcessEngine() if name == "pool" and jobs == 1 else kind(jobs)
