"""Locks on folders, which the system releases when their process ends for any reason.

The lock file contains ``{"pid", "host", "since", "work"}`` of the holder, for the messages of other
processes; ``since`` is in seconds since 1970. On Windows, other processes cannot read the locked
file and report "another process".
"""

import contextlib
import json
import os
import socket
import time
from collections.abc import Callable, Iterator
from contextvars import ContextVar
from pathlib import Path
from typing import Any

from filelock import FileLock, Timeout

from world2minecraft.core.errors import ConflictError, OutputError

LOCK_FILE = ".lock"
WAIT_S = 0.2  # Between two tries to acquire a lock that is waited for.
Tell = Callable[[str], None]  # Receives "process 123 since 14:02", once for each lock.

_acquired: set[FileLock] = set()  # filelock releases those that nothing refers to.
_held: ContextVar[frozenset[Path]] = ContextVar("held", default=frozenset())
_waits: ContextVar[Tell | None] = ContextVar("waits", default=None)


class Lock:
    """A lock at a path, held from ``acquire`` to ``release``."""

    def __init__(self, path: Path, work: str = "edited"):
        """Set the path of the lock and the verb for messages, without acquiring the lock."""
        self.path, self._work = path, work
        self._lock = FileLock(
            path,
            blocking=False,
            thread_local=False,
            fallback_to_soft=False,
            on_acquired=self._write_holder,
        )

    def acquire(self) -> None:
        """Acquire the lock, if necessary from a process that has ended.

        Raises:
            ConflictError: If another process holds the lock.
            OutputError: If the folder cannot be written.
        """
        try:
            self._lock.acquire()
        except Timeout:
            raise ConflictError(self.path.parent, self.conflict()) from None
        except OSError as error:
            reason = f"cannot be written: {error.strerror or error}"
            raise OutputError(self.path, reason) from error
        _acquired.add(self._lock)

    def release(self) -> None:
        """Release the lock if it is held."""
        if self._lock.is_locked:
            with contextlib.suppress(OSError):
                os.truncate(self.path, 0)
            self._release()

    def leave(self) -> None:
        """Release the lock, and leave its file as the mark of work that failed."""
        if self._lock.is_locked:
            self._release()

    def remove(self) -> None:
        """Release the lock and delete its file."""
        if self._lock.is_locked:
            with contextlib.suppress(OSError):  # Windows keeps a file that is open.
                self.path.unlink(missing_ok=True)
            self._release()
            if os.name == "nt":
                with contextlib.suppress(OSError):
                    self.path.unlink(missing_ok=True)

    def holder(self) -> str:
        """Return a description of the process that holds the lock."""
        try:
            held = self._read()
            pid, host = int(held["pid"]), str(held["host"])
        except (OSError, ValueError, TypeError, KeyError):
            return "another process"
        where = "" if host in ("", socket.gethostname()) else f" on {host}"
        return f"process {pid}{where}{_since_text(held)}" if pid else "another process"

    def conflict(self) -> str:
        """Return what the process that holds the lock is doing, as the reason of an error."""
        work = self._work
        with contextlib.suppress(OSError, ValueError, TypeError, AttributeError):
            work = str(self._read().get("work") or work)
        return f"is being {work} by {self.holder()}"

    def _read(self) -> dict[str, Any]:
        return json.loads(self.path.read_bytes()[:4096])

    def _release(self) -> None:
        self._lock.release()
        _acquired.discard(self._lock)

    def _write_holder(self, handle: int) -> None:
        """Write the process that holds the lock into its file."""
        holder = {
            "pid": os.getpid(),
            "host": socket.gethostname(),
            "since": int(time.time()),
            "work": self._work,
        }
        with contextlib.suppress(OSError):  # A full disk: the lock holds all the same.
            os.ftruncate(handle, 0)
            os.lseek(handle, 0, os.SEEK_SET)
            os.write(handle, json.dumps(holder).encode())


@contextlib.contextmanager
def folder_lock(folder: Path, work: str) -> Iterator[Lock | None]:
    """Hold the lock of an existing folder, which its file ``.lock`` shows while it is held.

    Within the block, the same thread may lock the folder again, which yields None.

    Args:
        folder: Folder that is written.
        work: What is done to it, for the messages of other processes, such as ``built``.

    Raises:
        ConflictError: If another process holds the lock, outside of ``wait_for_locks``.
        OutputError: If the folder cannot be written.
    """
    key = folder.resolve()
    if key in _held.get():
        yield None
        return
    lock = Lock(folder / LOCK_FILE, work)
    acquire_or_wait(lock)
    token = _held.set(_held.get() | {key})
    try:
        yield lock
    finally:
        _held.reset(token)
        lock.remove()


def acquire_or_wait(lock: Lock) -> None:
    """Acquire a lock. Within ``wait_for_locks``, wait until its holder has released it.

    Raises:
        ConflictError: If another process holds the lock, outside of ``wait_for_locks``.
        OutputError: If the folder cannot be written.
    """
    told = ""
    while True:
        try:
            return lock.acquire()
        except ConflictError:
            tell = _waits.get()
            if tell is None:
                raise
            if (holder := lock.holder()) != told:
                told = holder
                tell(holder)
            time.sleep(WAIT_S)
        except OutputError:  # The holder may have removed the folder that it made.
            if _waits.get() is None or lock.path.parent.exists():
                raise
            lock.path.parent.mkdir(parents=True, exist_ok=True)


@contextlib.contextmanager
def wait_for_locks(tell: Tell = lambda holder: None) -> Iterator[None]:
    """Wait for the locks of folders within the block, instead of raising ConflictError.

    Args:
        tell: Receives the holder of each lock that is waited for, such as ``process 123 since
            14:02``.

    Example:
        >>> with wait_for_locks(print):
        ...     pass  # w2m.build(room, "OUT") waits here while another process writes OUT.
    """
    token = _waits.set(tell)
    try:
        yield
    finally:
        _waits.reset(token)


def _since_text(held: dict[str, Any]) -> str:
    """Return since when a lock is held, such as ``" since 14:02"``, with the day if not today."""
    try:
        since = time.localtime(int(held["since"]))
    except (KeyError, TypeError, ValueError, OverflowError, OSError):
        return ""  # A lock of a former version.
    is_today = since[:3] == time.localtime()[:3]
    return time.strftime(" since %H:%M" if is_today else " since %Y-%m-%d %H:%M", since)
