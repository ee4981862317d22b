"""The list of all files of a folder with their sizes and SHA-256, and the comparison with it.

``checksums.json`` is ``{"files": {NAME: {"sha256", "size"}}, "sha256"}``. The last value is the
SHA-256 of the list itself, so that a damaged list is not mistaken for damaged files. Hidden files,
such as locks, are not listed.
"""

import hashlib
import json
import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from world2minecraft.core.errors import DamagedFileError, InputError
from world2minecraft.core.files import read_bytes, write_bytes
from world2minecraft.core.progress import Progress, no_progress

CHECKSUMS = "checksums.json"
MAX_LIST_BYTES = 1 << 30  # About five million files.


class FileSum(NamedTuple):
    """The size of a file in bytes and its SHA-256."""

    size: int
    sha256: str


FileSums = Mapping[str, FileSum]
"""Checksums by the name of a file: its POSIX path in the folder."""


@dataclass(frozen=True)
class RepairReport:
    """The result of the repair of a folder.

    Attributes:
        repaired: Names of the files that were made again, with the same contents as before.
        left: Descriptions of the files that remain damaged or unexpected, with what to do.
    """

    repaired: tuple[str, ...] = ()
    left: tuple[str, ...] = ()


@dataclass(frozen=True)
class Differences:
    """The names of the files in which a folder differs from its list, each group sorted.

    Attributes:
        missing: Files that do not exist.
        changed: Files with another content, or that cannot be read.
        extra: Files that are not listed.
    """

    missing: tuple[str, ...] = ()
    changed: tuple[str, ...] = ()
    extra: tuple[str, ...] = ()

    @property
    def damaged(self) -> tuple[str, ...]:
        """The missing and changed files."""
        return tuple(sorted((*self.missing, *self.changed)))

    def faults(self) -> list[str]:
        """Return a description of each difference, such as ``a/b.json: missing``."""
        words = {"unexpected file": self.extra, "missing": self.missing, "changed": self.changed}
        return [f"{name}: {word}" for word, names in words.items() for name in names]


def sum_of_bytes(data: bytes) -> FileSum:
    """Return the checksum of a file with these contents."""
    return FileSum(len(data), hashlib.sha256(data).hexdigest())


def sum_of_file(path: Path) -> FileSum:
    """Read a file and return its checksum.

    Raises:
        InputError: If the file cannot be read.
    """
    try:
        with path.open("rb") as stream:
            digest = hashlib.file_digest(stream, "sha256").hexdigest()
            return FileSum(os.fstat(stream.fileno()).st_size, digest)
    except OSError as error:
        raise InputError(path, f"cannot be read: {error.strerror or error}") from error


def sums_of_files(folder: Path, names: Iterable[str]) -> dict[str, FileSum]:
    """Return the checksums of the files with these names, and of all files in such folders.

    Names that do not exist are omitted.

    Raises:
        InputError: If a file cannot be read.
    """
    files = [
        file
        for name in names
        for file in ([name] if (folder / name).is_file() else files_in(folder, name))
    ]
    return {name: sum_of_file(folder / name) for name in files}


def files_in(folder: Path, inside: str = "") -> Iterator[str]:
    """Yield the names of all files below a folder that are not hidden.

    Args:
        folder: Folder to which the names are relative.
        inside: Name of the subfolder to search, or an empty string to search the whole folder.
    """
    for place, folders, files in os.walk(folder / inside):
        folders[:] = sorted(name for name in folders if name[0] != ".")
        base = Path(place).relative_to(folder)
        yield from ((base / name).as_posix() for name in sorted(files) if name[0] != ".")


def write_checksums(folder: Path, sums: FileSums) -> None:
    """Write the list of the files of a folder.

    Raises:
        OutputError: If the file cannot be written.
    """
    write_bytes(folder / CHECKSUMS, _list_bytes(sums))


def read_checksums(folder: Path) -> dict[str, FileSum]:
    """Read the list of the files of a folder.

    Raises:
        InputError: If the list does not exist.
        DamagedFileError: If a single byte of it has changed.
    """
    path = folder / CHECKSUMS
    data = read_bytes(path, MAX_LIST_BYTES)
    try:
        rows = json.loads(data)["files"]
        sums = {str(name): FileSum(row["size"], row["sha256"]) for name, row in rows.items()}
        is_valid = _list_bytes(sums) == data and all(map(_is_inside, sums))
    except (AttributeError, KeyError, RecursionError, TypeError, ValueError):
        is_valid, sums = False, {}
    if not is_valid:
        raise DamagedFileError(path, "is damaged: it does not match its own checksum")
    return sums


def compare_files(
    folder: Path,
    sums: FileSums,
    is_own: Callable[[str], bool] = lambda name: False,
    progress: Progress = no_progress,
) -> Differences:
    """Read all files of a folder and compare them with its list.

    Args:
        folder: Folder with the files.
        sums: Checksums of its files.
        is_own: Whether a file that is not listed belongs to the folder all the same.
        progress: Callback that is called after each file.
    """
    missing, changed = [], []
    for done, (name, listed) in enumerate(sorted(sums.items())):
        progress("verify", done, len(sums), name)
        path = folder / name
        if not path.is_file():
            missing.append(name)
        elif not _has_sum(path, listed):
            changed.append(name)
    progress("verify", len(sums), len(sums))
    own = {*sums, CHECKSUMS}
    extra = [name for name in files_in(folder) if name not in own and not is_own(name)]
    return Differences(tuple(missing), tuple(changed), tuple(sorted(extra)))


def _has_sum(path: Path, listed: FileSum) -> bool:
    try:
        return path.stat().st_size == listed.size and sum_of_file(path) == listed
    except (InputError, OSError):
        return False


def _list_bytes(sums: FileSums) -> bytes:
    rows = {name: {"sha256": one.sha256, "size": one.size} for name, one in sums.items()}
    text = "".join(f"{name}\0{one.size}\0{one.sha256}\n" for name, one in sorted(sums.items()))
    total = hashlib.sha256(text.encode("utf-8", "surrogateescape")).hexdigest()
    return (json.dumps({"files": rows, "sha256": total}, indent=1, sort_keys=True) + "\n").encode()


def _is_inside(name: str) -> bool:
    """Return whether the name of a file is a relative path that stays in its folder."""
    return name != "" and not name.startswith("/") and ".." not in name.split("/")
