"""The worker processes of a pool: how they are started, and ended in any case."""

import signal
import threading
from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from multiprocessing import get_context
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess

from world2minecraft.rendering.batch.shared_memory import Block
from world2minecraft.rendering.batch.worker import serve

PATIENCE_S = 5.0  # For a worker to end by itself.


@dataclass(eq=False)
class Hand:
    """A worker as the pool sees it."""

    number: int
    process: BaseProcess
    pipe: Connection
    tasks: deque[int] = field(default_factory=deque)  # First pictures of what it works on.


@contextmanager
def deaf_to_interrupts() -> Iterator[None]:
    """Start children that Ctrl-C does not reach: the parent ends them."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def started(number: int) -> Hand:
    """Start a worker: a new interpreter on every system, so that all behave alike."""
    context = get_context("spawn")
    ours, theirs = context.Pipe()
    name = f"world2minecraft-render-{number}"
    process = context.Process(target=serve, args=(theirs,), name=name, daemon=True)
    process.start()
    theirs.close()  # So that the pipe ends with the worker.
    return Hand(number, process, ours)


def release(hands: list[Hand], blocks: list[Block]) -> None:
    """End workers, the patient way first, and take shared memory away."""
    for hand in hands:
        with suppress(OSError):
            hand.pipe.send(None)
        hand.pipe.close()
    for hand in hands:
        hand.process.join(PATIENCE_S)
        if hand.process.is_alive():
            hand.process.kill()
            hand.process.join()
    for block in blocks:
        block.close()
    hands.clear()
    blocks.clear()
