"""``RenderPool``: worker processes that share one scene in memory and render images of it.

The arrays of the scene are written to shared memory once. Each process has its own pipe, so that a
killed process does not block the others. Images are returned through a ring of slots in shared
memory, so that memory is bounded for any number of poses. All shared memory is freed at the end,
also after an error, after Ctrl-C, and when a process dies.

``concurrent.futures`` is not suitable: ``ProcessPoolExecutor`` sends pickled results through a
pipe, and does not limit the number of results that are waiting.
"""

import pickle
import weakref
from collections import deque
from collections.abc import Collection, Iterator, Sequence
from dataclasses import fields, replace
from multiprocessing.connection import wait
from typing import Any

import numpy as np

from world2minecraft.core.errors import UsageError, WorkerError
from world2minecraft.core.machine import usable_cores
from world2minecraft.core.types import Camera
from world2minecraft.rendering.batch.arrays import (
    PICTURE_OUTPUTS,
    ArraySpec,
    BatchArrays,
    array_specs,
    check_batch,
)
from world2minecraft.rendering.batch.drawing import (
    KernelScene,
    Views,
    checked_poses,
    draw_views,
    views_of,
)
from world2minecraft.rendering.batch.shared_memory import SharedArrays, lay_out
from world2minecraft.rendering.batch.workers import (
    EXIT_TIMEOUT_S,
    Job,
    Make,
    Reply,
    SceneMessage,
    Task,
    Worker,
    ignore_interrupts,
    start_worker,
    stop_workers,
)
from world2minecraft.rendering.light import LightSettings
from world2minecraft.rendering.picture import DEFAULT_OUTPUTS, Picture
from world2minecraft.rendering.scene import BlockScene
from world2minecraft.rendering.scene_tables import SceneTables
from world2minecraft.rendering.shading_parameters import DAY, Backdrop, shading_parameters

TASK_PX = 1 << 16  # Minimum number of pixels of a task: a message takes 0.1 ms.
MAX_TASK_PICTURES = 64  # Pictures.
MAX_WORKERS = 256
QUEUED_TASKS = 2  # Tasks per worker, so that workers never wait.
UNIT_EXPOSURE = LightSettings(exposure=1.0)


class SlotRing:
    """A ring of slots in shared memory with their tasks, in the order of the images."""

    def __init__(self, slots: int, slot_bytes: int):
        """Create a ring in which all slots are free."""
        self.free = deque(range(slots))
        self.taken: dict[int, Task] = {}
        self.done: dict[int, Reply] = {}
        self._slot_of: dict[int, int] = {}
        self._bytes = slot_bytes

    def take(self, first: int, views: Views, rooms: dict[str, ArraySpec]) -> Task:
        """Reserve a slot for images and return the task that renders into it."""
        slot = self._slot_of[first] = self.free.popleft()
        self.taken[first] = Task(first, views, lay_out(rooms, slot * self._bytes)[0])
        return self.taken[first]

    def next_reply(self, ordered: bool) -> Reply | None:
        """Return the next reply in order, if it has arrived."""
        if ordered:
            return self.done.get(next(iter(self.taken), -1))
        return next(iter(self.done.values()), None)

    def give_back(self, first: int) -> None:
        """Free the slot of a task."""
        del self.taken[first], self.done[first]
        self.free.append(self._slot_of.pop(first))


def pictures_of(reply: Reply, ring: SlotRing, block: SharedArrays) -> list[tuple[int, Any]]:
    """Return the results of a task, or copies of its images, each with its number."""
    if reply.made is not None:
        return list(enumerate(reply.made, reply.first))
    task = ring.taken[reply.first]
    arrays = BatchArrays(**{name: block.array(place) for name, place in task.places.items()})
    numbers = range(len(task.views.poses))
    return [(reply.first + number, _copied(arrays.picture(number))) for number in numbers]


def _copied(picture: Picture) -> Picture:
    arrays = {one.name: getattr(picture, one.name) for one in fields(picture)}
    return replace(picture, **{k: v.copy() for k, v in arrays.items() if v is not None})


def split_into_tasks(cameras: Sequence[Camera]) -> Iterator[tuple[int, int]]:
    """Divide poses into tasks of consecutive images of one size; small images share a task."""
    first = 0
    while first < len(cameras):
        size = cameras[first].height_px, cameras[first].width_px
        most = min(max(TASK_PX // (size[0] * size[1]), 1), MAX_TASK_PICTURES)
        last = first + 1
        while last < len(cameras) and last - first < most:
            if (cameras[last].height_px, cameras[last].width_px) != size:
                break
            last += 1
        yield first, last
        first = last


class RenderPool:
    """A pool of processes that render images of one scene, used as a context manager.

    Example::

        with RenderPool(scene, workers=8) as pool:
            for number, picture in pool.render(camera, poses):
                ...

    Workers are new interpreters on every system (``spawn``), so a script that creates a pool must
    guard its main code with ``if __name__ == "__main__":``. Only one thread at a time may use a
    pool.
    """

    def __init__(self, scene: BlockScene, workers: int | None = None):
        """Share the scene, compile the kernels if necessary, and start the workers.

        Args:
            scene: The result of ``prepare_scene`` for a volume, or ``EditableScene.scene``.
            workers: Number of processes. None uses the number of CPU cores.

        Raises:
            UsageError: If the number of workers is out of range, or if there is not enough shared
                memory.
        """
        count = usable_cores() if workers is None else workers
        if not 1 <= count <= MAX_WORKERS:
            raise UsageError(f"workers must be 1 to {MAX_WORKERS}, got {count}")
        self.workers, self._scene, self._busy = count, scene, False
        self._blocks: list[SharedArrays] = [_share_tables(scene)]
        self._hands: list[Worker] = []
        self._end = weakref.finalize(self, stop_workers, self._hands, self._blocks)
        try:
            _compile(self._blocks[0], scene)
            with ignore_interrupts():
                for number in range(count):
                    self._hands.append(start_worker(number))
            self._tell(SceneMessage(self._blocks[0].plan, scene.side_px))
        except BaseException:
            self.close()
            raise

    def __enter__(self) -> "RenderPool":
        """Return the pool."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close the pool."""
        self.close()

    def close(self) -> None:
        """Stop the workers and free the shared memory. May be called twice."""
        self._end()

    def update(self, scene: BlockScene) -> None:
        """Replace the scene of the workers, starting with the next job.

        Raises:
            UsageError: If the pool is closed or is still rendering.
        """
        self._check_idle()
        old, new = self._blocks[0], _share_tables(scene)
        self._scene, self._blocks[0] = scene, new
        self._tell(SceneMessage(new.plan, scene.side_px))
        old.close()

    def render(
        self,
        cameras: Camera | Sequence[Camera],
        poses: np.ndarray | Sequence[np.ndarray],
        *,
        outputs: Collection[str] = DEFAULT_OUTPUTS,
        light: LightSettings = DAY,
        samples: int = 1,
        background: Backdrop | None = None,
        ordered: bool = True,
        make: Make | None = None,
    ) -> Iterator[tuple[int, Any]]:
        """Render images for many poses, and yield each image with its number.

        All images share one exposure, computed from all eye positions, unless the light or the
        scene defines one. They are identical to those of ``render_batch``, for any number of
        workers. Memory is limited to a few images per worker.

        Args:
            cameras: One camera for all poses, or one camera for each pose, of any size.
            poses: ``camera_to_room`` matrices, float64 [N, 4, 4].
            outputs: Additional outputs, as for ``render_volume``. Depth, range, block and face are
                always included.
            light: Light settings, such as the time of day and the exposure.
            samples: Each pixel's colour is the mean of ``samples`` x ``samples`` rays.
            background: sRGB colours of the first and last row of the background. None uses the sky.
            ordered: Whether to yield images in the order of their poses rather than as they are
                completed.
            make: Function called in the worker with the number and the image, whose arrays are only
                valid during the call. Its result, such as JPEG bytes, is yielded instead of the
                image. It must be a module-level function or a ``functools.partial`` of one.

        Raises:
            UsageError: If an argument is invalid, or if the pool is closed or busy.
            WorkerError: If a worker has died. The pool is then closed.
        """
        self._check_idle()
        matrices = checked_poses(poses)
        each = [cameras] * len(matrices) if isinstance(cameras, Camera) else list(cameras)
        if len(each) != len(matrices):
            raise UsageError(
                f"{len(matrices)} poses need one camera or {len(matrices)} cameras, got {len(each)}"
            )
        for size in {(one.height_px, one.width_px) for one in each}:
            check_batch(len(each), size, samples)
        wanted = tuple(outputs)
        runs = [views_of(self._scene, each[a:b], matrices[a:b]) for a, b in split_into_tasks(each)]
        array_specs(1, (1, 1), wanted, self._scene.semantic.shape)  # Unknown names raise now.
        if not runs:
            return iter(())
        eyes = np.concatenate([run.poses[:, :, 3] for run in runs])
        shading = shading_parameters(light, self._scene, background, eyes)
        return self._draw(runs, Job("", shading, wanted, samples, make), ordered)

    def _draw(self, runs: list[Views], job: Job, ordered: bool) -> Iterator[tuple[int, Any]]:
        """Hand out the tasks and give what comes back."""
        self._check_idle()
        self._busy = True
        outputs, shape = (*PICTURE_OUTPUTS, *job.outputs), self._scene.semantic.shape
        rooms = [array_specs(len(run.poses), run.size, outputs, shape) for run in runs]
        ends = [lay_out(each)[1] for each in rooms]
        slots = min(len(runs), QUEUED_TASKS * self.workers + 1)
        block = SharedArrays.create({}, slots * max(ends))
        self._blocks.append(block)
        ring = SlotRing(slots, max(ends))
        try:
            self._tell(replace(job, slots=block.plan.name))
            firsts = np.cumsum([0, *(len(run.poses) for run in runs)]).tolist()
            tasks = deque(zip(firsts, runs, rooms, strict=False))
            while tasks or ring.taken:
                self._hand_out(tasks, ring)
                reply = ring.next_reply(ordered)
                if reply is None:
                    self._listen(ring)
                    continue
                pictures = pictures_of(reply, ring, block)
                ring.give_back(reply.first)
                yield from pictures
        finally:
            self._drain()
            if block in self._blocks:  # Else the pool was closed, and this with it.
                self._blocks.remove(block)
            block.close()
            self._busy = False

    def _hand_out(self, tasks: deque, ring: SlotRing) -> None:
        """Give tasks to those workers that have few, as long as there are slots."""
        while tasks and ring.free:
            hand = min(self._hands, key=lambda one: len(one.tasks))
            if len(hand.tasks) >= QUEUED_TASKS:
                return
            task = ring.take(*tasks.popleft())
            hand.tasks.append(task.first)
            self._send(hand, task)

    def _listen(self, ring: SlotRing) -> None:
        """Wait for replies."""
        by_pipe = {hand.pipe: hand for hand in self._hands}
        for pipe in wait(list(by_pipe)):
            hand = by_pipe[pipe]  # type: ignore[index]
            reply = self._receive(hand)
            if reply.error is not None:
                raise reply.error
            ring.done[reply.first] = reply

    def _receive(self, hand: Worker) -> Reply:
        try:
            reply = hand.pipe.recv()
        except (EOFError, OSError):
            raise self._lost(hand) from None
        hand.tasks.popleft()
        return reply

    def _send(self, hand: Worker, message: object) -> None:
        try:
            hand.pipe.send(message)
        except OSError:
            raise self._lost(hand) from None

    def _tell(self, message: SceneMessage | Job) -> None:
        """Send all workers a message, pickled once."""
        try:
            data = pickle.dumps(message)
        except (pickle.PicklingError, AttributeError, TypeError) as error:
            raise UsageError(
                "make must be picklable: use a module-level function or a functools.partial "
                f"of one ({error})"
            ) from error
        for hand in self._hands:
            try:
                hand.pipe.send_bytes(data)
            except OSError:
                raise self._lost(hand) from None

    def _drain(self) -> None:
        """Wait for what workers still draw into slots; a pool that is closed has none."""
        for hand in self._hands:
            while hand.tasks:
                try:
                    hand.pipe.recv()
                except (EOFError, OSError):
                    hand.tasks.clear()
                    break
                hand.tasks.popleft()

    def _lost(self, hand: Worker) -> WorkerError:
        """Close the pool and return the error that says which worker died, and of what."""
        hand.process.join(EXIT_TIMEOUT_S)
        code, number, doing = hand.process.exitcode, hand.number + 1, list(hand.tasks)
        hand.tasks.clear()
        at = f" while rendering image {doing[0]}" if doing else ""
        if code is not None and code < 0:
            why = "it was killed, probably because memory ran out; use fewer workers"
        else:
            why = (
                "see its output above; a script that creates a RenderPool must guard its main code "
                "with 'if __name__ == \"__main__\":'"
            )
        total = self.workers
        self.close()
        return WorkerError(f"worker {number} of {total} exited with code {code}{at}: {why}")

    def _check_idle(self) -> None:
        if not self._end.alive:
            raise UsageError("this RenderPool is closed; create a new one")
        if self._busy:
            raise UsageError(
                "this RenderPool is still rendering; exhaust or close the iterator that "
                "render() returned"
            )


def _share_tables(scene: BlockScene) -> SharedArrays:
    """Copy the tables of a scene to shared memory."""
    tables = {name: np.ascontiguousarray(array) for name, array in scene.tables._asdict().items()}
    places, size = lay_out({name: (array.shape, array.dtype) for name, array in tables.items()})
    block = SharedArrays.create(places, size)
    for name, array in block.arrays().items():
        array[...] = tables[name]
    return block


def _compile(block: SharedArrays, scene: BlockScene) -> None:
    """Draw a tiny picture just as workers do, so that they find all kernels compiled."""
    stage = KernelScene(SceneTables(**block.arrays()), scene.side_px)
    shading = pickle.loads(pickle.dumps(shading_parameters(UNIT_EXPOSURE, scene)))
    views = Views((8, 8), np.eye(4)[None, :3].copy(), np.array([[8.0, 8.0, 4.0, 4.0]]))
    outputs = ("colour", "depth", "free")
    rooms = array_specs(1, (8, 8), outputs, scene.semantic.shape)
    arrays = BatchArrays(**{name: np.zeros(*room) for name, room in rooms.items()})
    draw_views(stage, views, shading, outputs, 2, 1, arrays)
