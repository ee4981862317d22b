"""Who works on a folder: a lock that the system lets go of when its process ends, however it ends.

The file holds ``{"pid", "host"}`` of the one that has it, for the others to tell.
"""

import contextlib
import json
import os
import socket
from pathlib import Path

try:
    import fcntl
except ImportError:  # Windows has none.
    fcntl = None
    import msvcrt

from world2minecraft.errors import ConflictError, OutputError

_ROUNDS = 8  # Tries to take over from the dead, against others who try the same.
_FAR = 1 << 30  # Where Windows locks a byte: locked ones cannot be read there.


class Lock:
    """The lock at a path, held from ``take`` to ``let_go``."""

    def __init__(self, path: Path, work: str = "edited"):
        """Name the lock and what is done under it; nothing is taken."""
        self.path, self._work = path, work
        self._handle: int | None = None

    def take(self) -> None:
        """Take the lock, over from a process that is dead if need be.

        Raises:
            ConflictError: another process has it. OutputError: the folder cannot be written.
        """
        for _ in range(_ROUNDS):
            try:
                handle = os.open(self.path, os.O_RDWR | os.O_CREAT, 0o644)
            except OSError as error:
                reason = f"cannot be written: {error.strerror or error}"
                raise OutputError(self.path, reason) from error
            if try_lock(handle) and self._is_there(handle):
                told = json.dumps({"pid": os.getpid(), "host": socket.gethostname()}).encode()
                with contextlib.suppress(OSError):  # A full disk: the lock holds all the same.
                    os.ftruncate(handle, 0)
                    os.pwrite(handle, told, 0) if fcntl else os.write(handle, told)
                self._handle = handle
                return
            is_left = self.is_of_the_dead() and self._is_there(handle)
            os.close(handle)
            if is_left:  # A child of the dead one still holds it.
                self.path.unlink(missing_ok=True)
            elif self.path.exists():
                break
        raise ConflictError(self.path.parent, f"is being {self._work} by {self.holder()}")

    def let_go(self) -> None:
        """Let go of the lock, where it is held."""
        if self._handle is not None:
            with contextlib.suppress(OSError):
                os.ftruncate(self._handle, 0)
            os.close(self._handle)
            self._handle = None

    def remove(self) -> None:
        """Let go of the lock and leave no file of it behind."""
        if self._handle is not None:
            with contextlib.suppress(OSError):  # Windows keeps a file that is open.
                self.path.unlink(missing_ok=True)
            self.let_go()
            if fcntl is None:
                with contextlib.suppress(OSError):
                    self.path.unlink(missing_ok=True)

    def holder(self) -> str:
        """Return who has the lock, in words."""
        pid, host = self._told()
        where = "" if host in ("", socket.gethostname()) else f" on {host}"
        return f"process {pid}{where}" if pid else "another process"

    def is_of_the_dead(self) -> bool:
        """Whether the process that the file tells of ran on this machine and has ended."""
        pid, host = self._told()
        if not pid or host != socket.gethostname() or fcntl is None:
            return False  # On Windows a look at a process would end it.
        try:
            os.kill(pid, 0)
        except ProcessLookupError:
            return True
        except OSError:
            return False
        return False

    def _told(self) -> tuple[int, str]:
        try:
            told = json.loads(self.path.read_bytes()[:4096])
            return int(told["pid"]), str(told["host"])
        except (OSError, ValueError, TypeError, KeyError):
            return 0, ""

    def _is_there(self, handle: int) -> bool:
        """Whether the file that was locked is still the one at the path."""
        try:
            return os.path.samestat(os.fstat(handle), os.stat(self.path))
        except OSError:
            return False


def try_lock(handle: int) -> bool:
    """Lock an open file for this process, unless another has it; closing it lets go."""
    try:
        if fcntl is not None:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        else:
            os.lseek(handle, _FAR, os.SEEK_SET)
            msvcrt.locking(handle, msvcrt.LK_NBLCK, 1)  # type: ignore[attr-defined]
            os.lseek(handle, 0, os.SEEK_SET)
    except OSError:
        return False
    return True
