"""Streaming of images: the next images are rendered while the last ones are encoded and written.

Kernels, encoders and file operations release the GIL, so threads are sufficient. Queues are
bounded, order is preserved, and errors are raised in place of the next item.
"""

from collections import deque
from collections.abc import Callable, Collection, Generator, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import closing, suppress
from dataclasses import replace
from queue import Empty, Full, Queue
from threading import Event, Thread
from typing import Any, TypeVar

import numpy as np

from world2minecraft.core.coordinates import apply
from world2minecraft.core.errors import UsageError
from world2minecraft.core.progress import Progress, no_progress
from world2minecraft.rendering.batch.pool import MAX_WORKERS, RenderPool
from world2minecraft.rendering.light import LightSettings
from world2minecraft.rendering.picture import DEFAULT_OUTPUTS, Picture, render_volume
from world2minecraft.rendering.scene import BlockScene
from world2minecraft.rendering.shading_parameters import DAY, Backdrop, exposure_of
from world2minecraft.rendering.views.cameras import Shot

Item = TypeVar("Item")
Made = TypeVar("Made")

SPARE = 2  # Items that may wait, besides those in progress.
POLL_S = 0.05  # Interval at which a waiting thread checks whether to stop.
Pictures = Generator[tuple[int, Picture], None, None]
Write = Callable[[int, Shot, Picture], Any]
MAX_WRITERS = 256


def prefetch(items: Iterator[Item], most: int = SPARE) -> Generator[Item, None, None]:
    """Yield the items of an iterable, which a thread reads up to ``most`` items ahead.

    If the consumer stops early, the thread ends after its current item, and the iterator is closed.
    """
    queue: Queue[tuple[str, Any]] = Queue(max(most, 1))
    stop = Event()

    def put(kind: str, value: Any) -> None:
        while not stop.is_set():
            with suppress(Full):
                queue.put((kind, value), timeout=POLL_S)
                return

    def take() -> None:
        """Queue the items, then the end or the error of the iterator."""
        try:
            for item in items:
                put("item", item)
                if stop.is_set():
                    break
            put("end", None)
        except BaseException as error:  # It is the user's, whatever it is.
            put("error", error)
        finally:
            with suppress(Exception):
                getattr(items, "close", lambda: None)()

    thread = Thread(target=take, name="world2minecraft-ahead", daemon=True)
    thread.start()
    try:
        while True:
            kind, value = queue.get()
            if kind == "error":
                raise value
            if kind == "end":
                return
            yield value
    finally:
        stop.set()
        with suppress(Empty):
            queue.get_nowait()
        thread.join()


def ordered_map(
    items: Iterator[Item], work: Callable[[Item], Made], threads: int, most: int
) -> Generator[Made, None, None]:
    """Yield the results of ``work`` for all items, in order, computed by threads.

    Args:
        items: Items, which are read in the caller's thread.
        work: Function, called on one of the threads.
        threads: Number of threads.
        most: Maximum number of items in progress or waiting.

    An exception from ``work`` is raised before another item is read.
    """
    waiting: deque[Future[Made]] = deque()
    with ThreadPoolExecutor(threads, "world2minecraft-write") as executor:
        try:
            for item in items:
                waiting.append(executor.submit(work, item))
                _raise_first(waiting)
                while waiting and (len(waiting) >= most or waiting[0].done()):
                    yield waiting.popleft().result()
            while waiting:
                yield waiting.popleft().result()
        finally:
            for one in waiting:
                one.cancel()


def _raise_first(waiting: deque[Future[Made]]) -> None:
    for one in waiting:
        if one.done() and (error := one.exception()) is not None:
            raise error


def render_stream(
    scene: BlockScene,
    shots: Sequence[Shot],
    *,
    outputs: Collection[str] = DEFAULT_OUTPUTS,
    light: LightSettings = DAY,
    samples: int = 1,
    threads: int = 1,
    background: Backdrop | None = None,
    write: Write | None = None,
    encode_threads: int = 1,
    jobs: int = 1,
    progress: Progress = no_progress,
) -> Iterator[Any]:
    """Render the images of shots, and write each image while the next ones are rendered.

    All images share one exposure, computed from all eye positions, unless the light or the scene
    defines one. Order is preserved, only a few images are in memory, and the first error ends the
    stream.

    Args:
        scene: The result of ``prepare_scene`` for a volume.
        shots: The shots, with cameras of any size.
        outputs: Additional outputs, as for ``render_volume``. Depth, range, block and face are
            always included.
        light: Light settings, such as the time of day and the exposure.
        samples: Each pixel's colour is the mean of ``samples`` x ``samples`` rays.
        threads: Number of threads per image. With several jobs, each job uses one thread.
        background: sRGB colours of the first and last row of the background. None uses the sky.
        write: Function called with the number, the shot and the image, on one of
            ``encode_threads``. Its result is yielded instead of the image. Without it, images are
            yielded and rendered ahead.
        encode_threads: Number of images written in parallel.
        jobs: Number of rendering processes; see ``RenderPool``.
        progress: Callback with the number of completed images, as stage ``render``.

    Raises:
        UsageError: If an argument is invalid.
        WorkerError: If a worker process has died.
    """
    for name, value, most in (
        ("encode_threads", encode_threads, MAX_WRITERS),
        ("jobs", jobs, MAX_WORKERS),
    ):
        if not 1 <= value <= most:
            raise UsageError(f"{name} must be 1 to {most}, got {value}")
    eyes = [apply(scene.room_to_grid, shot.camera_to_room[:3, 3]) for shot in shots]
    if shots:
        scene = replace(scene, exposure=exposure_of(light, scene, np.array(eyes)))
    words: dict[str, Any] = {
        "outputs": outputs, "light": light, "samples": samples, "background": background
    }  # fmt: skip
    pictures = (
        _by_processes(scene, shots, jobs, words)
        if jobs > 1 and len(shots) > 1
        else _one_by_one(scene, shots, threads, words)
    )
    return _stream(pictures, shots, write, encode_threads, progress)


def _stream(
    pictures: Pictures,
    shots: Sequence[Shot],
    write: Write | None,
    encode_threads: int,
    progress: Progress,
) -> Iterator[Any]:
    progress("render", 0, len(shots))
    if write is None:
        results = prefetch(pictures, SPARE)
    else:
        given = write

        def work(one: tuple[int, Picture]) -> Any:
            return given(one[0], shots[one[0]], one[1])

        results = ordered_map(pictures, work, encode_threads, encode_threads + SPARE)
    with closing(pictures), closing(results):
        for done, result in enumerate(results, 1):
            progress("render", done, len(shots))
            yield result[1] if write is None else result


def _one_by_one(
    scene: BlockScene, shots: Sequence[Shot], threads: int, words: dict[str, Any]
) -> Pictures:
    for number, shot in enumerate(shots):
        camera, pose = shot.camera, shot.camera_to_room
        yield number, render_volume(scene, camera, pose, threads=threads, **words)


def _by_processes(
    scene: BlockScene, shots: Sequence[Shot], jobs: int, words: dict[str, Any]
) -> Pictures:
    cameras = [shot.camera for shot in shots]
    poses = [shot.camera_to_room for shot in shots]
    with RenderPool(scene, min(jobs, len(shots))) as pool:
        yield from pool.render(cameras, np.array(poses), **words)
