"""The worker processes of a pool: their start, their tasks and their end.

A worker receives ``SceneMessage``, ``Job`` and ``Task`` through a pipe, renders into the slot of
the task, and answers each task with a ``Reply``. It exits when its pipe is closed.
"""

import pickle
import signal
import threading
import traceback
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from multiprocessing import get_context
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from typing import Any

from world2minecraft.core.errors import WorkerError
from world2minecraft.rendering.batch.arrays import PICTURE_OUTPUTS, BatchArrays
from world2minecraft.rendering.batch.drawing import KernelScene, Views, draw_views
from world2minecraft.rendering.batch.shared_memory import ArrayPlace, SharedArrays, SharedLayout
from world2minecraft.rendering.picture import Picture
from world2minecraft.rendering.ray_caster.shading import ShadingParameters
from world2minecraft.rendering.scene_tables import SceneTables

Make = Callable[[int, Picture], Any]  # Number of the picture, picture; may be sent as a pickle.
EXIT_TIMEOUT_S = 5.0  # Time for a worker to exit by itself.


@dataclass(frozen=True, eq=False)
class SceneMessage:
    """The location of the scene tables in shared memory."""

    plan: SharedLayout
    side_px: int


@dataclass(frozen=True, eq=False)
class Job:
    """The settings shared by several tasks."""

    slots: str  # the name of the memory that pictures are drawn into
    shading: ShadingParameters
    outputs: tuple[str, ...]
    samples: int
    make: Make | None


@dataclass(frozen=True, eq=False)
class Task:
    """Some images of one size, and the locations of their arrays."""

    first: int  # the number of the first picture
    views: Views
    places: dict[str, ArrayPlace]


@dataclass(frozen=True, eq=False)
class Reply:
    """The completion or failure of a task, with the results in ``made`` if the job has ``make``."""

    first: int
    made: list[Any] | None = None
    error: Exception | None = None


def serve(pipe: Connection) -> None:
    """Process the messages from the pipe until it is closed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # The parent gets it, and closes the pipe.
    desk = WorkerState()
    try:
        while (message := pipe.recv()) is not None:
            reply = desk.take(message)
            if reply is not None:
                _send(pipe, reply)
    except (EOFError, ConnectionError):  # The parent is gone.
        return
    finally:
        desk.clear()


def _send(pipe: Connection, reply: Reply) -> None:
    try:
        pipe.send(reply)
    except (pickle.PicklingError, TypeError, AttributeError) as error:
        text = f"the result for image {reply.first} cannot be pickled: {error}"
        pipe.send(Reply(reply.first, error=WorkerError(text)))


class WorkerState:
    """The scene and the job of a worker, and the shared memory that it has joined.

    A worker joins memory with the first task that needs it, because the memory of a job that other
    workers have completed may already be freed.
    """

    def __init__(self):
        """Create a state without a scene or a job."""
        self._scene: SceneMessage | None = None
        self._job: Job | None = None
        self._stage: KernelScene | None = None
        self._blocks: dict[str, SharedArrays] = {}

    def take(self, message: SceneMessage | Job | Task) -> Reply | None:
        """Process a message, and return the reply to a task."""
        if isinstance(message, Task):
            return self._draw(message)
        if isinstance(message, SceneMessage):
            self._scene, self._stage = message, None
        else:
            self._job = message
        return None

    def _draw(self, task: Task) -> Reply:
        try:
            return Reply(task.first, self._made(task))
        except Exception as error:
            return Reply(task.first, error=picklable_error(error))

    def _made(self, task: Task) -> list[Any] | None:
        job, scene = self._job, self._scene
        if job is None or scene is None:
            raise WorkerError("a worker received a task before its scene")
        if self._stage is None:
            tables = self._joined("scene", scene.plan).arrays()
            self._stage = KernelScene(SceneTables(**tables), scene.side_px)
        slots = self._joined("slots", SharedLayout(job.slots, {}))
        arrays = BatchArrays(**{name: slots.array(at) for name, at in task.places.items()})
        outputs = (*PICTURE_OUTPUTS, *job.outputs)
        draw_views(self._stage, task.views, job.shading, outputs, job.samples, 1, arrays)
        if job.make is None:
            return None
        numbers = range(len(task.views.poses))
        return [job.make(task.first + number, arrays.picture(number)) for number in numbers]

    def _joined(self, use: str, plan: SharedLayout) -> SharedArrays:
        """Return the memory for a use; what was there for it before is let go."""
        block = self._blocks.get(use)
        if block is None or block.plan.name != plan.name:
            if block is not None:
                block.close()
            block = self._blocks[use] = SharedArrays.join(plan)
        return block

    def clear(self) -> None:
        """Release all shared memory."""
        self._stage = None
        for block in self._blocks.values():
            block.close()


def picklable_error(error: Exception) -> Exception:
    """Return an exception if it can be pickled, else a ``WorkerError`` that describes it."""
    try:
        copied = pickle.loads(pickle.dumps(error))
    except Exception:
        copied = None
    if type(copied) is type(error) and str(copied) == str(error):
        return error.with_traceback(None)  # Its frames hold shared memory.
    text = "".join(traceback.format_exception_only(error)).strip()
    return WorkerError(f"a worker failed: {text}")


@dataclass(eq=False)
class Worker:
    """A worker process as seen by the pool."""

    number: int
    process: BaseProcess
    pipe: Connection
    tasks: deque[int] = field(default_factory=deque)  # First pictures of what it works on.


@contextmanager
def ignore_interrupts() -> Iterator[None]:
    """Start child processes that ignore Ctrl-C, because the parent stops them."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def start_worker(number: int) -> Worker:
    """Start a worker as a new interpreter on every system, for consistent behaviour."""
    context = get_context("spawn")
    ours, theirs = context.Pipe()
    name = f"world2minecraft-render-{number}"
    process = context.Process(target=serve, args=(theirs,), name=name, daemon=True)
    process.start()
    theirs.close()  # So that the pipe ends with the worker.
    return Worker(number, process, ours)


def stop_workers(hands: list[Worker], blocks: list[SharedArrays]) -> None:
    """Stop workers, forcibly if necessary, and free the shared memory."""
    for hand in hands:
        with suppress(OSError):
            hand.pipe.send(None)
        hand.pipe.close()
    for hand in hands:
        hand.process.join(EXIT_TIMEOUT_S)
        if hand.process.is_alive():
            hand.process.kill()
            hand.process.join()
    for block in blocks:
        block.close()
    hands.clear()
    blocks.clear()
