"""Locking of a world through ``session.lock``, as the game does while a world is open.

The game keeps the first byte of the file locked while it has the world open. If the lock can be
acquired, no game has the world open, and the game cannot open the world until it is released.
"""

# Not with filelock, which uses flock: Java, and so the game, uses POSIX locks, which ignore flock.

import errno
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from world2minecraft.core.errors import ConflictError, OutputError
from world2minecraft.core.locks import folder_lock
from world2minecraft.minecraft.worlds.level_dat import no_world

try:
    import fcntl
except ImportError:  # Windows has none.
    fcntl = None
try:
    import msvcrt
except ImportError:  # Only Windows has one.
    msvcrt = None

LOCK_FILE = "session.lock"
SNOWMAN = "\u2603".encode()  # What the game writes there, by its own taste.


@contextmanager
def session_lock(world: Path) -> Iterator[None]:
    """Lock a world, so that neither the game nor another run of the program opens it.

    Raises:
        ConflictError: If the game or another process has the world open.
        InputError: If the world is not found.
        OutputError: If the world folder cannot be written.
    """
    if not (world / "level.dat").is_file():
        raise no_world(world)
    with folder_lock(world, "changed"), _session(world):  # The first names the other process.
        yield


@contextmanager
def _session(world: Path) -> Iterator[None]:
    path = world / LOCK_FILE
    was_there = path.exists()
    try:
        stream = open(path, "r+b" if was_there else "x+b")  # noqa: SIM115  # Closed below.
    except OSError as error:
        raise OutputError(world, f"cannot open {LOCK_FILE}: {error.strerror or error}") from error
    is_held = False
    try:
        is_held = _take(stream, world)
        if not is_held:
            raise ConflictError(
                world,
                "is open in the game, a server or another program; close the world, then try again",
            )
        if not was_there:
            stream.write(SNOWMAN)
            stream.flush()
        yield
    finally:
        if is_held and not was_there:
            _remove(path)
        stream.close()  # The lock goes with it.
        if is_held and not was_there:
            _remove(path)  # Windows removes no file that is open.


def _take(stream: Any, world: Path) -> bool:
    try:
        if fcntl is not None:
            fcntl.lockf(stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
        elif msvcrt is not None:
            stream.seek(0)
            msvcrt.locking(stream.fileno(), msvcrt.LK_NBLCK, 1)  # type: ignore[attr-defined]
    except OSError as error:
        if error.errno in (errno.EACCES, errno.EAGAIN, errno.EDEADLK):
            return False
        raise OutputError(world, f"cannot lock {LOCK_FILE}: {error.strerror or error}") from error
    return True


def _remove(path: Path) -> None:
    with suppress(OSError):
        path.unlink(missing_ok=True)
