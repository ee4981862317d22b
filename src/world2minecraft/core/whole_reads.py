"""Reads of a folder that another process may be writing: one whole state or an error, no mixture.

A writer that replaces files one by one holds ``changing``, which marks the folder with the file
``.changing``. A reader holds ``unchanged``, which refuses a marked folder and compares the state of
its files before and after. A process that is killed leaves the mark, because the folder then holds
files of two states; the next writer removes it.
"""

import json
import os
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TypeVar

from world2minecraft.core.errors import ConflictError, InputError, OutputError
from world2minecraft.core.locks import LOCK_FILE, Lock

CHANGING = ".changing"
PATIENCE_S, PAUSE_S = 2.0, 0.02  # Saving a room replaces five files within some milliseconds.
# Files of a run that state what is being done rather than results.
STATEMENTS = ("manifest.json", "run.json")
Value = TypeVar("Value")
_active: set[Path] = set()  # Marks of this process.
State = tuple[tuple[object, ...], ...]


@contextmanager
def changing(folder: Path, work: str) -> Iterator[None]:
    """Mark a folder whose files are being replaced, so that readers refuse it.

    If the block fails after it has changed files, the mark remains. The caller holds the lock of
    the folder. The block may mark the folder again.

    Args:
        folder: Folder that is changed.
        work: What is done to it, for the messages of readers, such as ``saved``.

    Raises:
        OutputError: If the folder cannot be written.
    """
    mark = folder / CHANGING
    if (key := mark.resolve()) in _active:
        yield
        return
    was_marked, before = mark.exists(), _state(folder)
    holder = {"pid": os.getpid(), "since": int(time.time()), "host": "", "work": work}
    try:
        mark.write_text(json.dumps(holder))
    except OSError as error:
        raise OutputError(mark, f"cannot be written: {error.strerror or error}") from error
    _active.add(key)
    try:
        yield
    except BaseException:
        if not was_marked and _state(folder) == before:
            remove_mark(folder)
        raise
    finally:
        _active.discard(key)
    remove_mark(folder)


def remove_mark(folder: Path) -> None:
    """Remove the mark that a killed process left in a folder whose files are whole again."""
    with suppress(OSError):
        (folder / CHANGING).unlink(missing_ok=True)


@contextmanager
def unchanged(folder: Path) -> Iterator[None]:
    """Check that no other process changes a folder while the block reads it.

    Raises:
        ConflictError: If the folder is being changed, or was changed meanwhile.
    """
    mark = folder / CHANGING
    if _is_mine(mark):
        yield
        return
    _check_unmarked(mark)
    before = _state(folder)
    try:
        yield
    except (InputError, OSError) as error:
        _check_same(folder, before, error)
        raise
    _check_same(folder, before)


def read_whole(folder: Path, read: Callable[[], Value]) -> Value:
    """Read several files of a folder, again if they were changed meanwhile.

    Args:
        folder: Folder that is read.
        read: Function that reads it.

    Raises:
        ConflictError: If the folder is still being changed after two seconds.
    """
    until = time.monotonic() + PATIENCE_S
    while True:
        try:
            with unchanged(folder):
                return read()
        except _ChangedError:
            if time.monotonic() > until:
                raise
            time.sleep(PAUSE_S)


class _ChangedError(ConflictError):
    """A folder was changed while it was read."""


def _check_unmarked(mark: Path) -> None:
    if mark.exists():
        what = Lock(mark, "changed").conflict()
        raise _ChangedError(
            mark.parent,
            f"{what}; read it when that has finished, or repeat that command if it was stopped",
        )


def _check_same(folder: Path, before: State, error: BaseException | None = None) -> None:
    _check_unmarked(folder / CHANGING)
    if _state(folder) != before:
        raise _ChangedError(
            folder, "was changed by another process while it was read; try again"
        ) from error


def _is_mine(mark: Path) -> bool:
    """Return whether this process, or the one that started it as a worker, changes the folder."""
    if mark.resolve() in _active:
        return True
    try:
        return json.loads(mark.read_bytes())["pid"] == os.getppid()
    except (OSError, ValueError, TypeError, KeyError):
        return False


def _state(folder: Path) -> State:
    """Return what changes if a file of a folder or of a direct subfolder is replaced."""
    found: list[tuple[object, ...]] = []
    with suppress(OSError):
        found.append((".", os.stat(folder).st_ino))
        for entry in _entries(folder):
            found.append(_facts(entry))
            if entry.is_dir():
                found += [(entry.name, *_facts(one)) for one in _entries(entry.path)]
    return tuple(found)


def _entries(folder: str | Path) -> list[os.DirEntry[str]]:
    with os.scandir(folder) as found:
        listed = [one for one in found if one.name[0] != "." and one.name != LOCK_FILE]
    return sorted((one for one in listed if one.name not in STATEMENTS), key=lambda one: one.name)


def _facts(entry: os.DirEntry[str]) -> tuple[object, ...]:
    stat = entry.stat()
    return (entry.name, stat.st_ino, stat.st_size, 0 if entry.is_dir() else stat.st_mtime_ns)
