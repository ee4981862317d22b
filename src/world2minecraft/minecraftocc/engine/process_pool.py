"""A process pool that reports progress and replaces workers that die.

If a worker dies (killed, or out of memory), it is replaced and its item is started again; the new
worker finds the files that the old one wrote to disk. Workers exit with their parent process,
however the parent ends: a thread in each worker waits for the parent to exit.

``concurrent.futures`` is not suitable: if a process of a ``ProcessPoolExecutor`` is killed, all
waiting items fail with ``BrokenProcessPool``, and it is not possible to determine which item caused
it.
"""

import os
import signal
from collections import Counter, deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from multiprocessing import get_context, parent_process
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from threading import Thread
from typing import Any

from world2minecraft.core.errors import WorkerError
from world2minecraft.rendering.batch.workers import picklable_error

UNCAUGHT = 1  # Exit code of a Python process after an uncaught exception.
MAX_DEATHS = 3  # Workers that may die on the same item before it is considered the cause.
PATIENCE_S = 5.0


@dataclass(frozen=True, eq=False)
class WorkItem:
    """An item for a worker, with its number and the task to run."""

    number: int
    task: Callable[[Any, Callable[[int], None]], Any]
    item: Any


@dataclass(frozen=True, eq=False)
class ProgressMessage:
    """A message from a worker: ``count`` more images are finished."""

    count: int


@dataclass(frozen=True, eq=False)
class ResultMessage:
    """A message from a worker: an item is finished."""

    number: int
    result: Any


@dataclass(frozen=True, eq=False)
class ErrorMessage:
    """A message from a worker: an item has failed with an exception."""

    error: Exception


class _ParentGone(BaseException):
    """Raised in a worker whose parent process has exited."""


def run_worker(pipe: Connection) -> None:
    """Run the tasks that arrive through a pipe until the pipe is closed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # The parent handles it and stops its workers.
    Thread(target=_end_with_parent, daemon=True).start()
    limit_threads()

    def tick(count: int) -> None:
        try:
            pipe.send(ProgressMessage(count))
        except OSError:
            raise _ParentGone from None

    try:
        while True:
            order: WorkItem = pipe.recv()
            pipe.send(_execute(order, tick))
    except (EOFError, OSError, _ParentGone):
        return


def exit_if_parent_gone() -> None:
    """Stop the current task if this process is a pool worker whose parent has exited."""
    parent = parent_process()
    if parent is not None and not parent.is_alive():
        raise _ParentGone


def limit_threads() -> None:
    """Limit libraries to one thread in this process, because there is one process per core."""
    from threadpoolctl import threadpool_limits  # noqa: PLC0415

    threadpool_limits(1)


def _end_with_parent() -> None:
    """Wait for the parent process to exit, then exit immediately."""
    parent = parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


def _execute(order: WorkItem, tick: Callable[[int], None]) -> ResultMessage | ErrorMessage:
    try:
        return ResultMessage(order.number, order.task(order.item, tick))
    except Exception as error:
        return ErrorMessage(picklable_error(error))


@dataclass(eq=False)
class _Worker:
    """A worker process with its pipe and its current item."""

    process: BaseProcess
    pipe: Connection
    number: int | None = None  # Of its current item.


class PoolEngine:
    """An engine that runs tasks in a pool of processes. Use it as a context manager."""

    def __init__(self, jobs: int):
        """Create a pool with ``jobs`` processes, which are started with the first items."""
        self.notes: list[str] = []
        self._jobs = jobs
        self._workers: list[_Worker] = []

    def __enter__(self) -> "PoolEngine":
        """Return the engine."""
        return self

    def __exit__(self, *_: object) -> None:
        """Stop all workers immediately. Files that they have written are complete."""
        for worker in self._workers:
            worker.pipe.close()
            if worker.number is not None:
                worker.process.terminate()
        for worker in self._workers:
            worker.process.join(PATIENCE_S)
            if worker.process.is_alive():
                worker.process.kill()
                worker.process.join()
        self._workers.clear()

    def run(
        self,
        task: Callable[[Any, Callable[[int], None]], Any],
        items: Sequence[Any],
        tick: Callable[[int], None],
    ) -> Iterator[tuple[int, Any]]:
        """Run a task for each item and yield the number and result of each item as it finishes.

        Exceptions of the task are raised again here.

        Raises:
            WorkerError: If several workers in a row have died while processing the same item.
        """
        waiting, deaths = deque(range(len(items))), Counter[int]()
        while waiting or any(worker.number is not None for worker in self._workers):
            self._assign_items(task, items, waiting)
            busy = {worker.pipe: worker for worker in self._workers if worker.number is not None}
            for pipe in wait(list(busy)):
                worker = busy[pipe]  # type: ignore[index]
                message = self._receive(worker)
                if isinstance(message, ProgressMessage):
                    tick(message.count)
                elif isinstance(message, ErrorMessage):
                    worker.number = None
                    raise message.error
                elif isinstance(message, ResultMessage):
                    worker.number = None
                    yield message.number, message.result
                else:
                    self._replace(worker, waiting, deaths, len(items))

    def _assign_items(
        self, task: Callable[..., Any], items: Sequence[Any], waiting: deque[int]
    ) -> None:
        while waiting and len(self._workers) < min(self._jobs, len(items)):
            self._workers.append(_start_worker())
        for worker in self._workers:
            if worker.number is None and waiting:
                number = waiting.popleft()
                with suppress(OSError):  # A dead worker is detected by the end of its pipe.
                    worker.pipe.send(WorkItem(number, task, items[number]))
                worker.number = number

    def _receive(self, worker: _Worker) -> ProgressMessage | ResultMessage | ErrorMessage | None:
        """Return the next message of a worker, or None if it has died."""
        try:
            return worker.pipe.recv()
        except (EOFError, OSError):
            return None

    def _replace(
        self, worker: _Worker, waiting: deque[int], deaths: Counter[int], count: int
    ) -> None:
        number = worker.number if worker.number is not None else 0
        worker.pipe.close()
        worker.process.join(PATIENCE_S)
        self._workers.remove(worker)
        code, deaths[number] = worker.process.exitcode, deaths[number] + 1
        how = f"by signal {-code}" if code is not None and code < 0 else f"with code {code}"
        if deaths[number] == MAX_DEATHS:
            what = f"{MAX_DEATHS} workers in a row exited {how} on part {number + 1} of {count}"
            if code == UNCAUGHT:
                raise WorkerError(
                    f"{what}; see their errors above, and in a script of your own call the "
                    'function under if __name__ == "__main__":'
                )
            raise WorkerError(
                f"{what}, possibly for lack of memory; run the same command with fewer jobs "
                "(--jobs) to resume"
            )
        self.notes.append(f"A worker exited {how}; another worker resumed its task.")
        waiting.appendleft(number)


def _start_worker() -> _Worker:
    """Start a worker with a new interpreter, so that all systems behave alike."""
    # Imported late, because workers import this module too and start faster without the renderer.
    from world2minecraft.rendering.batch.workers import ignore_interrupts  # noqa: PLC0415

    context = get_context("spawn")
    ours, theirs = context.Pipe()
    process = context.Process(target=run_worker, args=(theirs,), name="w2m-dataset", daemon=True)
    with ignore_interrupts():
        process.start()
    theirs.close()  # So that the pipe is closed when the worker exits.
    return _Worker(process, ours)
