"""What a process of a pool does: it joins the scene in shared memory and draws what it is told.

It gets ``SceneMessage``, ``Job`` and ``Task`` through a pipe, draws into the slot that the task
names, and answers each task with a ``Reply``. It ends with its pipe.
"""

import pickle
import signal
import traceback
from collections.abc import Callable
from dataclasses import dataclass
from multiprocessing.connection import Connection
from typing import Any

from world2minecraft.errors import WorkerError
from world2minecraft.render.batch.arrays import PICTURE_OUTPUTS, BatchArrays
from world2minecraft.render.batch.draw import Stage, Views, draw_views
from world2minecraft.render.batch.shared import Block, BlockPlan, Place
from world2minecraft.render.picture import Picture
from world2minecraft.render.shade import Lamp
from world2minecraft.render.tables import SceneTables

Make = Callable[[int, Picture], Any]  # Number of the picture, picture; may be sent as a pickle.


@dataclass(frozen=True, eq=False)
class SceneMessage:
    """Where the tables of the scene lie."""

    plan: BlockPlan
    side_px: int


@dataclass(frozen=True, eq=False)
class Job:
    """What tasks have in common."""

    slots: str  # the name of the memory that pictures are drawn into
    lamp: Lamp
    outputs: tuple[str, ...]
    samples: int
    make: Make | None


@dataclass(frozen=True, eq=False)
class Task:
    """Some pictures of one size, and the places of their arrays."""

    first: int  # the number of the first picture
    views: Views
    places: dict[str, Place]


@dataclass(frozen=True, eq=False)
class Reply:
    """A task is done, or has failed; ``made`` where the job says what to make of pictures."""

    first: int
    made: list[Any] | None = None
    error: Exception | None = None


def serve(pipe: Connection) -> None:
    """Do what comes through the pipe until it ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # The parent is told, and closes the pipe.
    desk = Desk()
    try:
        while (message := pipe.recv()) is not None:
            reply = desk.take(message)
            if reply is not None:
                _send(pipe, reply)
    except (EOFError, OSError):  # The parent is gone.
        return
    finally:
        desk.clear()


def _send(pipe: Connection, reply: Reply) -> None:
    try:
        pipe.send(reply)
    except (pickle.PicklingError, TypeError, AttributeError) as error:
        text = f"what was made of picture {reply.first} cannot be sent back: {error}"
        pipe.send(Reply(reply.first, error=WorkerError(text)))


class Desk:
    """The memory that a worker has joined, and the job that it is at."""

    def __init__(self):
        """Begin with nothing."""
        self._stage: Stage | None = None
        self._job: Job | None = None
        self._scene: Block | None = None
        self._slots: Block | None = None

    def take(self, message: SceneMessage | Job | Task) -> Reply | None:
        """Do what a message says; return the answer to a task."""
        if isinstance(message, Task):
            return self._draw(message)
        if isinstance(message, SceneMessage):
            self._stage = None
            _close(self._scene)
            self._scene = Block.join(message.plan)
            self._stage = Stage(SceneTables(**self._scene.arrays()), message.side_px)
            return None
        _close(self._slots)
        self._slots, self._job = Block.join(BlockPlan(message.slots, {})), message
        return None

    def _draw(self, task: Task) -> Reply:
        try:
            return Reply(task.first, self._made(task))
        except Exception as error:
            return Reply(task.first, error=_sendable(error))

    def _made(self, task: Task) -> list[Any] | None:
        job, slots, stage = self._job, self._slots, self._stage
        if job is None or slots is None or stage is None:
            raise WorkerError("a worker was given a task before its scene")
        arrays = BatchArrays(**{name: slots.array(at) for name, at in task.places.items()})
        outputs = (*PICTURE_OUTPUTS, *job.outputs)
        draw_views(stage, task.views, job.lamp, outputs, job.samples, 1, arrays)
        if job.make is None:
            return None
        numbers = range(len(task.views.poses))
        return [job.make(task.first + number, arrays.picture(number)) for number in numbers]

    def clear(self) -> None:
        """Let go of all memory."""
        self._stage, self._job = None, None
        _close(self._scene)
        _close(self._slots)


def _close(block: Block | None) -> None:
    if block is not None:
        block.close()


def _sendable(error: Exception) -> Exception:
    """Return an error as it is where that can be sent, else one that tells it."""
    try:
        copied = pickle.loads(pickle.dumps(error))
    except Exception:
        copied = None
    if type(copied) is type(error) and str(copied) == str(error):
        return error.with_traceback(None)  # Its frames hold shared memory.
    told = "".join(traceback.format_exception_only(error)).strip()
    return WorkerError(f"a worker failed: {told}")
