"""Register the processes at work in a data set's folder, so that the next run can wait for them.

A build that is killed lets go of its folder before its workers have noticed. Each worker therefore
holds the folder's ``.crew`` file, shared, while it has something to do there, and looks whether the
one who gave the order still lives *after* it has taken hold: so whoever takes the folder over and
then finds the file free knows that nobody writes there any more.
"""

# Not by filelock: its locks that readers share are databases of SQLite beside the data set.

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
    """Return a task that is done as one of the crew of its item's ``folder``."""

    @wraps(task)
    def joined(item: Item, tick: Callable[[int], None]) -> Result:
        with register_process(Path(item.folder)):
            return task(item, tick)

    return joined


@contextmanager
def register_process(folder: Path) -> Iterator[None]:
    """Be one of those at work in a folder.

    Raises:
        OutputError: the folder cannot be written.
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
    """Wait until nobody is at work in a folder that one has the lock of.

    Raises:
        ConflictError: somebody still is. OutputError: the folder cannot be written.
    """
    handle, until = _open_registry(folder), time.monotonic() + patience_s
    try:
        while not _is_free(handle):
            if time.monotonic() > until:
                raise ConflictError(
                    folder, "a process of an earlier run is still at work here; end it first"
                )
            time.sleep(_PAUSE_S)
    finally:
        os.close(handle)


def remove_registry(folder: Path) -> None:
    """Take the crew's file away when all is done."""
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
