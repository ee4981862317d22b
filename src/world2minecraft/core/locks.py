"""Locks on folders, which the system releases when their process ends for any reason.

The lock file contains ``{"pid", "host"}`` of the holder, for the messages of other processes. On
Windows, other processes cannot read the locked file and report "another process".
"""

import contextlib
import json
import os
import socket
from pathlib import Path

from filelock import FileLock, Timeout

from world2minecraft.core.errors import ConflictError, OutputError

_acquired: set[FileLock] = set()  # filelock releases those that nothing refers to.


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
            on_acquired=_write_holder,
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
            reason = f"is being {self._work} by {self.holder()}"
            raise ConflictError(self.path.parent, reason) from None
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
            holder = json.loads(self.path.read_bytes()[:4096])
            pid, host = int(holder["pid"]), str(holder["host"])
        except (OSError, ValueError, TypeError, KeyError):
            return "another process"
        where = "" if host in ("", socket.gethostname()) else f" on {host}"
        return f"process {pid}{where}" if pid else "another process"

    def _release(self) -> None:
        self._lock.release()
        _acquired.discard(self._lock)


def _write_holder(handle: int) -> None:
    """Write the process that holds the lock into its file."""
    data = json.dumps({"pid": os.getpid(), "host": socket.gethostname()}).encode()
    with contextlib.suppress(OSError):  # A full disk: the lock holds all the same.
        os.ftruncate(handle, 0)
        os.lseek(handle, 0, os.SEEK_SET)
        os.write(handle, data)
