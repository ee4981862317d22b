"""What a process of the pool does: it takes orders through a pipe until that ends."""

import os
import signal
from collections.abc import Callable
from dataclasses import dataclass
from multiprocessing import parent_process
from multiprocessing.connection import Connection
from threading import Thread
from typing import Any

from world2minecraft.rendering.batch.workers import sendable


@dataclass(frozen=True, eq=False)
class Order:
    """A task, an item, and the item's number."""

    number: int
    task: Callable[[Any, Callable[[int], None]], Any]
    item: Any


@dataclass(frozen=True, eq=False)
class Ticked:
    """So many images more are done."""

    count: int


@dataclass(frozen=True, eq=False)
class Done:
    """An item is done."""

    number: int
    result: Any


@dataclass(frozen=True, eq=False)
class Failed:
    """An item has failed."""

    error: Exception


class _Deserted(BaseException):
    """The one who gave the order is gone."""


def serve(pipe: Connection) -> None:
    """Do what comes through the pipe until it ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # The parent is told, and ends us.
    Thread(target=_end_with_parent, daemon=True).start()
    one_thread()

    def tick(count: int) -> None:
        try:
            pipe.send(Ticked(count))
        except OSError:
            raise _Deserted from None

    try:
        while True:
            order: Order = pipe.recv()
            pipe.send(_answer(order, tick))
    except (EOFError, OSError, _Deserted):
        return


def end_if_deserted() -> None:
    """End what is being done, in a worker of a pool whose parent has ended."""
    parent = parent_process()
    if parent is not None and not parent.is_alive():
        raise _Deserted


def one_thread() -> None:
    """Let libraries use one thread: there is a process for each core."""
    from threadpoolctl import threadpool_limits  # noqa: PLC0415

    threadpool_limits(1)


def _end_with_parent() -> None:
    """End this process with its parent, in the middle of whatever it does."""
    parent = parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


def _answer(order: Order, tick: Callable[[int], None]) -> Done | Failed:
    try:
        return Done(order.number, order.task(order.item, tick))
    except Exception as error:
        return Failed(sendable(error))
