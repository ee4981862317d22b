"""Background jobs of the editor, with their progress, remaining time and results.

Each job runs in its own thread. Work that must be stoppable at any moment runs in a subprocess of
that thread (``subprocess_job.run_in_subprocess``). Other work is cancelled at its next progress
report. Every state is a ``JobState`` of ``wire.ts`` and is sent to all tabs, at most ten times a
second for each job.
"""

import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, replace
from typing import Any, Protocol

from world2minecraft.core.errors import (
    ConflictError,
    UnknownNameError,
    World2MinecraftError,
    one_line,
)
from world2minecraft.sceneforge.jobs.time_left import TimeLeft

MIN_INTERVAL_S = 0.1  # Between two messages of one stage.
MAX_ENDED_JOBS = 50  # Ended jobs that are remembered, for tabs that come later.
MAX_RUNNING = 4


class CancelledError(Exception):
    """A job was cancelled. It is raised within the job's work, which thereby ends."""


@dataclass(frozen=True)
class JobState:
    """The state of a job as shown in a tab.

    ``share`` is the completed share of the whole job. ``done`` and ``total`` refer to its current
    stage.
    """

    id: str
    title: str
    stage: str = ""
    done: int = 0
    total: int = 0
    share: float | None = None
    left_s: float | None = None
    note: str = ""
    state: str = "running"  # done, failed, cancelled
    result: Any = None

    def message(self) -> dict[str, Any]:
        """Return the state as a message of ``wire.ts``."""
        return {"type": "job"} | asdict(self)


class JobProgress(Protocol):
    """A ``Progress`` callback for a job's work, which can also register how to stop the work."""

    def __call__(self, stage: str, done: int, total: int, note: str = "") -> None:
        """Report one step.

        Raises:
            CancelledError: If the job was cancelled.
        """
        ...

    def on_cancel(self, stop: Callable[[], None]) -> None:
        """Register a function to call when the job is cancelled, or call it if it already is."""
        ...

    def expect(self, usual_s: Mapping[str, float]) -> None:
        """Replace the stages and their typical durations in seconds, which are known only now."""
        ...


JobFunction = Callable[[JobProgress], Any]


class Jobs:
    """All background jobs of one server.

    Args:
        tell: Function that receives the message of each state. The threads of the jobs call it.
        clock: Monotonic clock in seconds.
    """

    def __init__(
        self,
        tell: Callable[[dict[str, Any]], None],
        clock: Callable[[], float] = time.monotonic,
    ):
        self._tell, self._clock = tell, clock
        self._jobs: dict[str, _Job] = {}
        self._lock = threading.Lock()
        self._count = 0

    def start(
        self,
        title: str,
        work: JobFunction,
        usual_s: Mapping[str, float] | None = None,
        ended: Callable[[JobState], None] = lambda state: None,
    ) -> str:
        """Start a job and return its id.

        Args:
            title: Title that is shown to people.
            work: Function that receives a ``JobProgress`` and returns the job's result as JSON
                values.
            usual_s: Stages in order with their typical durations in seconds, to estimate the
                remaining time.
            ended: Function called with the last state, in the job's thread, before the state is
                sent to the tabs.

        Raises:
            ConflictError: If too many jobs are already running.
        """
        with self._lock:
            running = [one for one in self._jobs.values() if one.state.state == "running"]
            if len(running) >= MAX_RUNNING:
                titles = ", ".join(one.state.title for one in running)
                raise ConflictError(
                    title,
                    f"{len(running)} jobs are already running ({titles}); wait until one ends",
                )
            self._count += 1
            state = JobState(f"job{self._count}", title)
            job = _Job(state, TimeLeft(usual_s or {}), self._tell, self._clock)
            self._jobs[state.id] = job
            self._forget()
        job.begin(work, ended)
        return state.id

    def cancel(self, number: str) -> None:
        """Cancel a running job. A job that has ended is not changed.

        Raises:
            UnknownNameError: If no job has this id.
        """
        self._named(number).cancel()

    def state(self, number: str) -> JobState:
        """Return the state of a job.

        Raises:
            UnknownNameError: If no job has this id.
        """
        return self._named(number).state

    def states(self) -> list[dict[str, Any]]:
        """Return the messages of all jobs in the order in which they started."""
        return [job.state.message() for job in list(self._jobs.values())]

    def wait(self, number: str, timeout_s: float | None = None) -> JobState:
        """Wait until a job ends or the timeout expires, and return its state."""
        job = self._named(number)
        job.thread.join(timeout_s)
        return job.state

    def close(self, patience_s: float = 5.0) -> None:
        """Cancel all jobs and wait until they have ended."""
        for job in list(self._jobs.values()):
            job.cancel()
        deadline = time.monotonic() + patience_s
        for job in list(self._jobs.values()):
            job.thread.join(max(deadline - time.monotonic(), 0.0))

    def _named(self, number: str) -> "_Job":
        if number not in self._jobs:
            raise UnknownNameError("job", number, self._jobs)
        return self._jobs[number]

    def _forget(self) -> None:
        ended = [name for name, job in self._jobs.items() if job.state.state != "running"]
        for name in ended[: max(len(ended) - MAX_ENDED_JOBS, 0)]:
            del self._jobs[name]


class _Job:
    """A job: its state, its thread, and the ``JobProgress`` that its work calls."""

    def __init__(
        self,
        state: JobState,
        left: TimeLeft,
        tell: Callable[[dict[str, Any]], None],
        clock: Callable[[], float],
    ):
        self.state, self._left, self._tell, self._clock = state, left, tell, clock
        self._began_s, self._last_sent_s = clock(), float("-inf")
        self._cancelled = threading.Event()
        self._stop: Callable[[], None] = lambda: None

    def begin(self, work: JobFunction, ended: Callable[[JobState], None]) -> None:
        """Start the work in a thread."""
        self._tell(self.state.message())
        self.thread = threading.Thread(
            target=self._run, args=(work, ended), name=self.state.id, daemon=True
        )
        self.thread.start()

    def cancel(self) -> None:
        """Stop the work, or let it end at its next progress report."""
        self._cancelled.set()
        if self.state.state == "running":
            self._stop()

    def on_cancel(self, stop: Callable[[], None]) -> None:
        """Register a function that stops the work. See ``JobProgress.on_cancel``."""
        self._stop = stop
        if self._cancelled.is_set():
            stop()

    def expect(self, usual_s: Mapping[str, float]) -> None:
        """Replace the stages to come. See ``JobProgress.expect``."""
        self._left = TimeLeft(usual_s)

    def __call__(self, stage: str, done: int, total: int, note: str = "") -> None:
        """Report one step. See ``JobProgress``."""
        if self._cancelled.is_set():
            raise CancelledError
        now = self._clock()
        share, left_s = self._left.report(stage, done, total, now - self._began_s)
        fresh = stage != self.state.stage or (total and done >= total)
        self.state = replace(
            self.state, stage=stage, done=done, total=total, note=note, share=share, left_s=left_s
        )
        if fresh or now - self._last_sent_s >= MIN_INTERVAL_S:
            self._last_sent_s = now
            self._tell(self.state.message())

    def _run(self, work: JobFunction, ended: Callable[[JobState], None]) -> None:
        try:
            result = work(self)
            last = replace(self.state, state="done", note="", share=1.0, left_s=0.0, result=result)
            ended(last)
        except CancelledError:
            last = replace(self.state, state="cancelled", note="", left_s=None)
        except Exception as error:  # The job reports any error and ends.
            last = replace(self.state, state="failed", note=describe_error(error), left_s=None)
        if self._cancelled.is_set() and last.state == "failed":
            last = replace(last, state="cancelled", note="")
        self.state = last
        self._tell(last.message())


def describe_error(error: BaseException) -> str:
    """Return a one-line description of an exception."""
    if isinstance(error, World2MinecraftError):
        return one_line(error)
    if isinstance(error, MemoryError):
        return "out of memory; close other programs or choose fewer blocks per metre"
    what = one_line(f"{type(error).__name__}: {error}", 300)
    return f"unexpected {what} (please report it)"
