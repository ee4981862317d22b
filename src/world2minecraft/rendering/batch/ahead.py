"""Work that overlaps: things are made while those before them are used or written.

Nothing here knows of pictures. Kernels, encoders and files let go of Python's lock, so plain
threads are enough. What waits between two hands is bounded, order is kept, and an error comes out
where the next thing would.
"""

from collections import deque
from collections.abc import Callable, Generator, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from queue import Empty, Full, Queue
from threading import Event, Thread
from typing import Any, TypeVar

Thing = TypeVar("Thing")
Made = TypeVar("Made")

SPARE = 2  # Things that may wait beside those that are made or written.
LOOK_S = 0.05  # How often a thread that waits looks whether it shall stop.


def ahead_of(things: Iterator[Thing], most: int = SPARE) -> Generator[Thing, None, None]:
    """Give the things of an iterator, which a thread takes up to ``most`` ahead.

    Where the user stops early the thread ends, after the thing that it is at, and the iterator is
    closed.
    """
    queue: Queue[tuple[str, Any]] = Queue(max(most, 1))
    stop = Event()

    def put(kind: str, value: Any) -> None:
        while not stop.is_set():
            with suppress(Full):
                queue.put((kind, value), timeout=LOOK_S)
                return

    def take() -> None:
        try:
            for thing in things:
                put("thing", thing)
                if stop.is_set():
                    break
            put("end", None)
        except BaseException as error:  # It is the user's, whatever it is.
            put("error", error)
        finally:
            with suppress(Exception):
                getattr(things, "close", lambda: None)()

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


def done_behind(
    things: Iterator[Thing], work: Callable[[Thing], Made], threads: int, most: int
) -> Generator[Made, None, None]:
    """Give what ``work`` makes of each thing, in order; threads do it while the next are taken.

    Args:
        things: taken in the caller's thread.
        work: called on one of the threads.
        threads: how many at once.
        most: how many things are kept at once, those at work included.

    An error of ``work`` is raised before another thing is taken.
    """
    waiting: deque[Future[Made]] = deque()
    with ThreadPoolExecutor(threads, "world2minecraft-write") as executor:
        try:
            for thing in things:
                waiting.append(executor.submit(work, thing))
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
