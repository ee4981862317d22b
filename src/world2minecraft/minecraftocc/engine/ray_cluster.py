"""An engine that runs tasks on many machines with Ray.

The folder of the data set and its worlds must be on a disk that all machines share. If
``RAY_ADDRESS`` is not set, a temporary cluster is started on this machine.
"""

import os
from collections.abc import Callable, Iterator, Sequence
from importlib import import_module
from typing import Any

from world2minecraft.core.errors import MissingExtraError, WorkerError
from world2minecraft.minecraftocc.engine.process_pool import limit_threads

QUEUED_PER_CPU = 2  # Submitted items per process, so that none is idle.
STORE_BYTES = 128 << 20  # Shared memory; results are small.
RETRIES = 3


class RayEngine:
    """An engine that runs tasks on a Ray cluster. Use it as a context manager."""

    def __init__(self, jobs: int):
        """Prepare an engine for the cluster at ``RAY_ADDRESS``, or for ``jobs`` local processes.

        Raises:
            MissingExtraError: If Ray is not installed.
        """
        os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")  # Send no usage statistics.
        os.environ.setdefault("RAY_ACCEL_ENV_VAR_OVERRIDE_ON_ZERO", "0")
        try:
            self._ray = import_module("ray")
        except ImportError as error:
            raise MissingExtraError("the engine ray", "data") from error
        self.notes: list[str] = []
        self._jobs, self._is_ours = jobs, False

    def __enter__(self) -> "RayEngine":
        """Connect to the cluster, or start one."""
        ray = self._ray
        if not ray.is_initialized():
            words: dict[str, Any] = {"include_dashboard": False, "log_to_driver": False}
            if "RAY_ADDRESS" not in os.environ:
                words |= {"num_cpus": self._jobs, "object_store_memory": STORE_BYTES}
            ray.init(logging_level="error", **words)
            self._is_ours = True
        return self

    def __exit__(self, *_: object) -> None:
        """Shut down the cluster if this engine has started it."""
        if self._is_ours:
            self._ray.shutdown()

    def run(
        self,
        task: Callable[[Any, Callable[[int], None]], Any],
        items: Sequence[Any],
        tick: Callable[[int], None],
    ) -> Iterator[tuple[int, Any]]:
        """Run a task for each item and yield the number and result of each item as it finishes.

        Exceptions of the task are raised again here.

        Raises:
            WorkerError: If worker processes have died repeatedly.
        """
        ray = self._ray
        remote = ray.remote(num_cpus=1, max_retries=RETRIES)(_call_task)
        max_pending = QUEUED_PER_CPU * max(1, int(ray.cluster_resources().get("CPU", 1)))
        pending: dict[Any, int] = {}
        numbers = iter(range(len(items)))
        while True:
            while len(pending) < max_pending and (number := next(numbers, None)) is not None:
                pending[remote.remote(task, items[number])] = number
            if not pending:
                return
            (ready,), _ = ray.wait(list(pending), num_returns=1)
            number = pending.pop(ready)
            result, done = self._got(ready)
            tick(done)
            yield number, result

    def _got(self, ready: Any) -> tuple[Any, int]:
        errors = self._ray.exceptions
        try:
            return self._ray.get(ready)
        except errors.RayTaskError as error:
            raise (error.cause if isinstance(error.cause, Exception) else error) from None
        except errors.RayError as error:
            reason = str(error).splitlines()[0]
            raise WorkerError(f"Ray could not complete a task: {reason}") from error


def _call_task(task: Callable[[Any, Callable[[int], None]], Any], item: Any) -> tuple[Any, int]:
    """Call a task and return its result and the number of images that it reported."""
    limit_threads()
    ticks: list[int] = []
    return task(item, ticks.append), sum(ticks)
