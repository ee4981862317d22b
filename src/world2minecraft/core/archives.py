"""Zip archives read in place, through the part of the ``Path`` interface that readers use.

An ``ArchivePath`` is a file or a folder inside a zip: ``place / "rgb" / "0.jpg"``, ``is_file()``,
``glob("*.jpg")``, ``open("rb")``, ``read_bytes()``. This allows the same reader to process folders
and zips. Archives are not trusted: names that point outside the archive, encrypted members, too
many members and members with an extreme compression ratio are rejected before anything is unpacked.
"""

import io
import stat
import struct
import zipfile
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from fnmatch import fnmatchcase
from functools import lru_cache
from pathlib import Path, PurePosixPath
from types import SimpleNamespace

from world2minecraft.core.errors import DamagedFileError, InputError, LimitError

# What zipfile and numpy raise over a damaged archive; RuntimeError is an encrypted member.
UNREADABLE = (
    zipfile.BadZipFile,
    zlib.error,
    ValueError,
    EOFError,
    OSError,
    NotImplementedError,
    RuntimeError,
    struct.error,
    OverflowError,
)
MAX_MEMBERS = 300_000  # An hour of frames with depth and confidence beside them.
MAX_MEMBER_BYTES = 1 << 30
MAX_RATIO = 1000  # The most that deflate can do is about 1032; real pictures stay under 20.
RATIO_FROM_BYTES = 1 << 20
_PACKED = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)


class Archive:
    """An open zip archive with its checked members by name, and its folders."""

    def __init__(self, path: Path):
        """Read the list of members.

        Raises:
            InputError: If the file does not exist.
            DamagedFileError: If the file is not a zip, or a member's name points outside the
                archive.
            LimitError: If the archive has too many members.
        """
        self.path = path
        try:
            self._zip = zipfile.ZipFile(path)
        except FileNotFoundError as error:
            raise InputError(path, "not found") from error
        except UNREADABLE as error:
            raise DamagedFileError(
                path, f"is not a complete zip file ({error}); copy it again"
            ) from error
        if len(self._zip.infolist()) > MAX_MEMBERS:
            raise LimitError(
                path, f"has over {MAX_MEMBERS:,} members; unpack it and use the folder"
            )
        self.members = {
            _check_name(path, info): info for info in self._zip.infolist() if not info.is_dir()
        }
        self.folders: dict[str, set[str]] = {"": set()}
        for name in self.members:
            self._add_folders(name)

    def _add_folders(self, name: str) -> None:
        inner = name
        while inner:
            folder, _, last = inner.rpartition("/")
            known = folder in self.folders
            self.folders.setdefault(folder, set()).add(last)
            if known:
                break
            inner = folder

    def read(self, name: str) -> bytes:
        """Return the contents of a member.

        Raises:
            LimitError: If the member is too large.
            DamagedFileError: If the member is encrypted, uses an unsupported compression method, or
                fails its checksum.
        """
        info = self.members[name]
        where = f"{self.path}/{name}"
        swollen = info.file_size > RATIO_FROM_BYTES
        swollen = swollen and info.file_size > MAX_RATIO * max(info.compress_size, 1)
        if info.file_size > MAX_MEMBER_BYTES or swollen:
            raise LimitError(
                where, f"would unpack to {info.file_size:,} bytes, which exceeds the limit"
            )
        if info.compress_type not in _PACKED or info.flag_bits & 1:
            raise DamagedFileError(
                where, "is encrypted or uses unsupported compression; pack it again as a plain zip"
            )
        try:
            return self._zip.read(info)
        except UNREADABLE as error:
            raise DamagedFileError(where, f"cannot be unpacked ({error})") from error


def _check_name(path: Path, info: zipfile.ZipInfo) -> str:
    name = info.filename.replace("\\", "/").rstrip("/")
    parts = PurePosixPath(name).parts
    linked = stat.S_ISLNK(info.external_attr >> 16)
    if not parts or name.startswith("/") or ".." in parts or ":" in parts[0] or linked:
        raise DamagedFileError(
            path, f"contains a member with an unsafe name: {info.filename[:80]!r}"
        )
    return "/".join(part for part in parts if part != ".")


@lru_cache(maxsize=4)
def _open_archive(path: Path, stamp: tuple[int, int]) -> Archive:
    return Archive(path)


@dataclass(frozen=True, order=True)
class ArchivePath:
    """A file or folder in a zip. ``inner`` is its name there, or "" for the root."""

    path: Path
    inner: str = ""

    @property
    def archive(self) -> Archive:
        """The open archive, which is opened once, and again if the file changes."""
        return _open_archive(self.path, file_stamp(self.path))

    def __str__(self) -> str:
        """Return the path of the zip and the name inside it, for messages."""
        return f"{self.path}/{self.inner}" if self.inner else str(self.path)

    def __truediv__(self, name: str) -> "ArchivePath":
        """Return the path of a name below this path."""
        joined = PurePosixPath(self.inner) / name
        return ArchivePath(self.path, "" if str(joined) == "." else str(joined))

    @property
    def name(self) -> str:
        """The last component of the path. For the root, the file name of the zip."""
        return PurePosixPath(self.inner).name if self.inner else self.path.name

    @property
    def stem(self) -> str:
        """The name without its last suffix."""
        return PurePosixPath(self.name).stem

    @property
    def suffix(self) -> str:
        """The last suffix, with its dot."""
        return PurePosixPath(self.name).suffix

    @property
    def parent(self) -> "ArchivePath":
        """The parent folder. The parent of the root is the root."""
        folder = self.inner.rpartition("/")[0]
        return ArchivePath(self.path, folder)

    def is_file(self) -> bool:
        """Return whether a member has this name."""
        return self.inner in self.archive.members

    def is_dir(self) -> bool:
        """Return whether the archive has members below this name."""
        return self.inner in self.archive.folders

    def exists(self) -> bool:
        """Return whether the archive has a file or folder with this name."""
        return self.is_file() or self.is_dir()

    def iterdir(self) -> Iterator["ArchivePath"]:
        """Yield the contents of the folder, sorted by name."""
        for name in sorted(self.archive.folders.get(self.inner, ())):
            yield self / name

    def glob(self, pattern: str) -> Iterator["ArchivePath"]:
        """Yield the paths that match a pattern such as ``seq-*/frame-*``."""
        first, _, rest = pattern.partition("/")
        for found in self.iterdir():
            if fnmatchcase(found.name, first):
                if not rest:
                    yield found
                elif found.is_dir():
                    yield from found.glob(rest)

    def rglob(self, pattern: str) -> Iterator["ArchivePath"]:
        """Yield the paths in this folder and all subfolders whose name matches a pattern."""
        for found in self.iterdir():
            if fnmatchcase(found.name, pattern):
                yield found
            if found.is_dir():
                yield from found.rglob(pattern)

    def stat(self) -> SimpleNamespace:
        """Return ``st_size``, the unpacked size in bytes.

        Raises:
            FileNotFoundError: If the path is not a file.
        """
        if not self.is_file():
            raise FileNotFoundError(str(self))
        return SimpleNamespace(st_size=self.archive.members[self.inner].file_size)

    def read_bytes(self) -> bytes:
        """Return the contents of the file.

        Raises:
            FileNotFoundError: If the path is not a file.
            LimitError: If the file is too large.
            DamagedFileError: If the file cannot be unpacked.
        """
        if not self.is_file():
            raise FileNotFoundError(str(self))
        return self.archive.read(self.inner)

    def open(self, mode: str = "rb") -> io.BytesIO:
        """Open the file for reading bytes."""
        if mode != "rb":
            raise ValueError(f"mode must be rb, got {mode}")
        return io.BytesIO(self.read_bytes())


AnyPath = Path | ArchivePath


def file_stamp(path: AnyPath) -> tuple[int, int]:
    """Return the size and modification time of a file or of its archive, to detect changes.

    Raises:
        InputError: If the file is missing.
    """
    try:
        found = (path.path if isinstance(path, ArchivePath) else path).stat()
    except OSError as error:
        raise InputError(path, f"cannot be read: {error.strerror or error}") from error
    return found.st_size, found.st_mtime_ns


def is_zip(path: Path) -> bool:
    """Return whether a file starts with the signature of a zip, regardless of its name."""
    try:
        with path.open("rb") as stream:
            return stream.read(4) in (b"PK\x03\x04", b"PK\x05\x06")
    except OSError:
        return False
