"""Registration of worker processes in a data set folder, so that the next run can wait for them.

If a build is killed, the lock on its folder is released before its workers have exited. Each worker
therefore holds a shared lock on the ``.crew`` file in the folder while it runs a task, and checks
that its parent process is still alive *after* it has acquired the lock. A new run that holds the
folder lock and finds ``.crew`` unlocked can be sure that no old worker writes to the folder any
more.
"""

# filelock is not used, because its shared locks are SQLite databases beside the data set.

import os
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import wraps
from pathlib import Path
from typing import Protocol, TypeVar

try:
    import fcntl
except ImportError:  # Windows has no shared locks; workers end with their parent there too.
    fcntl = None

from world2minecraft.core.errors import ConflictError, OutputError
from world2minecraft.minecraftocc.engine.process_pool import exit_if_parent_gone
from world2minecraft.minecraftocc.store.folder import CREW

PATIENCE_S = 60.0  # Workers notice within a second; one that writes to a slow disk takes longer.
_PAUSE_S = 0.05


class _Item(Protocol):
    @property
    def folder(self) -> str: ...


Item = TypeVar("Item", bound=_Item)
Result = TypeVar("Result")


def registered_task(
    task: Callable[[Item, Callable[[int], None]], Result],
) -> Callable[[Item, Callable[[int], None]], Result]:
    """Wrap a task so that it runs as a registered process in the ``folder`` of its item."""

    @wraps(task)
    def joined(item: Item, tick: Callable[[int], None]) -> Result:
        with register_process(Path(item.folder)):
            return task(item, tick)

    return joined


@contextmanager
def register_process(folder: Path) -> Iterator[None]:
    """Register this process in a data set folder for the duration of a ``with`` block.

    Raises:
        OutputError: If the folder cannot be written.
    """
    handle = _open_registry(folder)
    try:
        if fcntl is not None:
            fcntl.flock(handle, fcntl.LOCK_SH)
        exit_if_parent_gone()
        yield
    finally:
        os.close(handle)


def wait_for_others(folder: Path, patience_s: float = PATIENCE_S) -> None:
    """Wait until no registered process works in a folder. The caller must hold the folder lock.

    Args:
        folder: Data set folder.
        patience_s: Maximum time to wait in seconds.

    Raises:
        ConflictError: If a process is still at work after this time.
        OutputError: If the folder cannot be written.
    """
    handle, until = _open_registry(folder), time.monotonic() + patience_s
    try:
        while not _is_free(handle):
            if time.monotonic() > until:
                raise ConflictError(
                    folder, "in use by a process of an earlier run; stop that process and try again"
                )
            time.sleep(_PAUSE_S)
    finally:
        os.close(handle)


def remove_registry(folder: Path) -> None:
    """Delete the registration file when the build is complete."""
    (folder / CREW).unlink(missing_ok=True)


def _open_registry(folder: Path) -> int:
    try:
        return os.open(folder / CREW, os.O_RDWR | os.O_CREAT, 0o644)
    except OSError as error:
        reason = f"cannot be written: {error.strerror or error}"
        raise OutputError(folder / CREW, reason) from error


def _is_free(handle: int) -> bool:
    if fcntl is None:
        return True
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True
