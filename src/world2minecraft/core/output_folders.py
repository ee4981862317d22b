"""Output folders: who may write there, one process at a time, and what a failure leaves.

The program writes into a folder that does not exist, is empty, or has a marker: a file that only
the program writes. Other folders need ``force``.
"""

import json
import os
import shutil
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager, nullcontext, suppress
from dataclasses import dataclass
from pathlib import Path

from world2minecraft.core.errors import InputError, OutputError, UsageError
from world2minecraft.core.locks import LOCK_FILE, folder_lock
from world2minecraft.core.whole_reads import CHANGING, changing, remove_mark

FREE_BYTES = 64 << 20  # A reconstruction of one room writes 1 to 20 MB.
DRAFT, REPLACED = ".part", ".replaced"  # In the output folder, while a command writes it.
MAX_LISTED, MAX_MARKER_BYTES = 4, 256 << 20


@dataclass(frozen=True)
class FolderKind:
    """A kind of output folder.

    Attributes:
        markers: Files that mark a folder as the program's own, each with a key that it contains if
            it is JSON, or in its first line if it is JSON lines, or an empty text if its name
            suffices.
        names: Files and folders that commands of this kind write, as patterns such as ``*.png``.
        in_place: Whether commands replace files one by one, so that readers of other processes
            refuse the folder meanwhile.
    """

    markers: Mapping[str, str]
    names: tuple[str, ...]
    in_place: bool = False


@contextmanager
def output_folder(
    folder: Path,
    kind: FolderKind,
    work: str,
    *,
    force: bool = False,
    keep: bool = True,
    source: Path | None = None,
) -> Iterator[None]:
    """Check that a folder may be written, create it and hold its lock.

    If the block fails, what it wrote into a folder that was empty is removed unless ``keep``, and
    so are the folders that were created for nothing.

    Args:
        folder: Output folder.
        kind: Kind of folder to write.
        work: What is done to it, for the messages of other processes, such as ``built``.
        force: Whether to write into a folder that contains other files.
        keep: Whether a failed command leaves its results, so that it can be continued.
        source: What the command reads. If it lies in the folder, it does not count as another file.

    Raises:
        UsageError: If the folder contains other files, without ``force``.
        ConflictError: If another process writes the folder.
        OutputError: If it is a file, is not writable or its disk is full.
    """
    check_owned(folder, kind, force, source)
    made = [path for path in (folder, *folder.parents) if not path.exists()]
    check_writable(folder)
    try:
        with folder_lock(folder, work) as lock:
            was_empty = not others_in(folder, source)
            shutil.rmtree(folder / DRAFT, ignore_errors=True)  # Of a killed process.
            changes = kind.in_place and not was_empty
            try:
                with changing(folder, work) if changes else nullcontext():
                    yield
            except BaseException:
                rest = others_in(folder, source) if was_empty else []
                if not keep and was_empty:
                    _remove_all(rest)
                    remove_mark(folder)
                elif lock and rest and not _has_marker(folder, kind.markers):
                    lock.leave()  # As the marker of what the same command will continue.
                raise
            finally:
                shutil.rmtree(folder / DRAFT, ignore_errors=True)
    except BaseException:
        for path in made:
            with suppress(OSError):
                path.rmdir()  # Unless it contains something.
        raise


def check_owned(
    folder: Path, kind: FolderKind, force: bool = False, source: Path | None = None
) -> None:
    """Check that a folder may be written: it is empty, has a marker or is written by ``force``.

    The arguments are those of ``output_folder``.

    Raises:
        UsageError: If the folder contains other files, without ``force``.
        OutputError: If it is a file or cannot be read.
    """
    if folder.exists() and not folder.is_dir():
        raise OutputError(folder, "is a file; the output must be a folder")
    try:
        others = others_in(folder, source)
    except OSError as error:
        raise OutputError(folder, f"cannot be read: {error.strerror or error}") from error
    if force or not others or is_owned(folder, kind):
        return
    replaced = [path.name for path in others if any(map(path.match, kind.names))]
    does = f"replace {_listed(replaced)} there" if replaced else "write beside them"
    raise UsageError(
        f"{folder} contains other files ({_listed(path.name for path in others)}); choose another "
        f"folder, or use --force to {does}"
    )


def is_owned(folder: Path, kind: FolderKind) -> bool:
    """Return whether a folder has a marker of the program, or a lock that a killed process left."""
    return _has_marker(folder, {**kind.markers, LOCK_FILE: "pid"})


def others_in(folder: Path, source: Path | None = None) -> list[Path]:
    """Return the contents of a folder except the lock, the draft and what contains the source."""
    found = folder.iterdir() if folder.is_dir() else ()
    others = sorted(path for path in found if path.name not in (LOCK_FILE, DRAFT, CHANGING))
    if source is None:
        return others
    place = source.resolve()
    return [path for path in others if not place.is_relative_to(path.resolve())]


def check_writable(folder: Path) -> None:
    """Create a folder and check that it is writable with enough free space.

    Raises:
        OutputError: If it is a file, is not writable or its disk is full.
    """
    if folder.exists() and not folder.is_dir():
        raise OutputError(folder, "is a file; the output must be a folder")
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(folder, f"cannot create the folder: {error.strerror or error}") from error
    if not os.access(folder, os.W_OK):
        raise OutputError(folder, "the folder is not writable; choose another output folder")
    free = shutil.disk_usage(folder).free
    if free < FREE_BYTES:
        needed = f"{FREE_BYTES >> 20} MB are required; free some space or choose another folder"
        raise OutputError(folder, f"the disk has {free >> 20} MB free, {needed}")


@contextmanager
def draft_of(folder: Path, changed: Iterable[str] = ()) -> Iterator[Path]:
    """Yield a draft folder whose contents replace those of a folder if the block succeeds.

    Files are moved in the order in which they were written. The caller holds the output folder.
    Errors that name a file of the draft name the file of the folder instead.

    Args:
        folder: Output folder.
        changed: Names of subfolders that the draft begins with a copy of.

    Raises:
        OutputError: If a file cannot be moved.
    """
    draft = folder / DRAFT
    draft.mkdir()
    try:
        for name in changed:
            if (folder / name).is_dir():
                shutil.copytree(folder / name, draft / name, symlinks=True)
        yield draft
        with changing(folder, "replaced"):
            for path in sorted(draft.iterdir(), key=lambda path: path.stat().st_mtime_ns):
                _put_in_place(path, folder / path.name)
    except InputError as error:
        if not Path(error.path).is_relative_to(draft):
            raise
        raise type(error)(folder / Path(error.path).relative_to(draft), error.reason) from error
    except OSError as error:
        named = Path(error.filename) if isinstance(error.filename, str) else folder
        where = folder if named.is_relative_to(folder) else named
        raise OutputError(where, f"cannot be written: {error.strerror or error}") from error
    finally:
        shutil.rmtree(draft, ignore_errors=True)


def _put_in_place(path: Path, target: Path) -> None:
    """Move a file or folder of a draft to its place, and remove what was there."""
    old = path.with_name(REPLACED)
    if target.is_dir() and not target.is_symlink():
        os.replace(target, old)
    try:
        os.replace(path, target)
    except OSError:
        if old.exists():
            os.replace(old, target)
        raise
    shutil.rmtree(old, ignore_errors=True)


def _has_marker(folder: Path, markers: Mapping[str, str]) -> bool:
    return any(_is_marker(folder / name, key) for name, key in markers.items())


def _is_marker(path: Path, key: str) -> bool:
    if not path.is_file() or not key:
        return path.is_file()
    try:
        with path.open("rb") as stream:
            data = json.loads(
                stream.readline(MAX_MARKER_BYTES)
                if path.suffix == ".jsonl"
                else stream.read(MAX_MARKER_BYTES)
            )
    except OSError:
        return True  # Windows: a lock that is held.
    except (ValueError, RecursionError):
        return False
    return isinstance(data, dict) and key in data


def _remove_all(paths: Iterable[Path]) -> None:
    for path in paths:
        if path.is_dir() and not path.is_symlink():
            shutil.rmtree(path, ignore_errors=True)
        else:
            with suppress(OSError):
                path.unlink()


def _listed(names: Iterable[str]) -> str:
    """Return names as a text, with the number of further ones if there are many."""
    every = list(names)
    more = len(every) - MAX_LISTED
    return ", ".join(every[:MAX_LISTED]) + (f" and {more} more" if more > 0 else "")
