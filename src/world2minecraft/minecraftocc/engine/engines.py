"""The registry of engines, their common interface, and the engine that runs in this process."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager
from typing import Any, Protocol

from world2minecraft.core.errors import UsageError
from world2minecraft.core.registry import Registry

Tick = Callable[[int], None]  # Called with the number of further images that are finished.
Task = Callable[[Any, Tick], Any]  # Defined at module level; arguments and results are pickled.
ENGINES = Registry(
    "engine",
    {
        "pool": "world2minecraft.minecraftocc.engine.process_pool:PoolEngine",
        "ray": "world2minecraft.minecraftocc.engine.ray_cluster:RayEngine",
    },
)
MAX_JOBS = 1024


class InProcessEngine:
    """An engine that runs tasks one after another in this process."""

    def __init__(self):
        """Create an engine with no notes."""
        self.notes: list[str] = []

    def __enter__(self) -> "InProcessEngine":
        """Return the engine."""
        return self

    def __exit__(self, *_: object) -> None:
        """Do nothing, because there are no processes to stop."""

    def run(self, task: Task, items: Sequence[Any], tick: Tick) -> Iterator[tuple[int, Any]]:
        """Run a task for each item and yield the item's number and result, in order."""
        for number, item in enumerate(items):
            yield number, task(item, tick)


class Engine(Protocol):
    """Interface of an engine, which runs a task for each of many items."""

    notes: list[str]  # Errors that were recovered from, in sentences.

    def run(self, task: Task, items: Sequence[Any], tick: Tick) -> Iterator[tuple[int, Any]]:
        """Run a task for each item and yield the number and result of each item as it finishes.

        The first error stops all work and is raised.
        """
        ...


def open_engine(name: str, jobs: int) -> AbstractContextManager[Engine]:
    """Create an engine, to be used in a ``with`` statement.

    Args:
        name: Name of an engine in ``ENGINES``.
        jobs: Number of processes. A pool with one job runs the tasks in this process.

    Raises:
        UnknownNameError: If there is no engine with this name.
        UsageError: If the number of jobs is out of range.
        MissingExtraError: If Ray is requested but not installed.
    """
    if not 1 <= jobs <= MAX_JOBS:
        raise UsageError(f"jobs must be from 1 to {MAX_JOBS}, got {jobs}")
    kind = ENGINES.load(name)
    return InProcessEngine() if name == "pool" and jobs == 1 else kind(jobs)
