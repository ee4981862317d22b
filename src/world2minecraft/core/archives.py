"""Zip archives read in place, through the part of ``Path`` that readers use.

An ``ArchivePath`` is a file or a folder inside a zip: ``place / "rgb" / "0.jpg"``, ``is_file()``,
``glob("*.jpg")``, ``open("rb")``, ``read_bytes()``. So one reader serves folders and zips. The
archive is hostile until checked: names that leave it, encrypted members, too many members and
members that swell beyond reason are refused before anything is unpacked.
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
    """An opened zip: its members by name, checked, and its folders."""

    def __init__(self, path: Path):
        """Read the list of members.

        Raises:
            InputError: it is missing. DamagedFileError: it is no zip, or a member's name leaves
                it. LimitError: it has too many members.
        """
        self.path = path
        try:
            self._zip = zipfile.ZipFile(path)
        except FileNotFoundError as error:
            raise InputError(path, "is not there") from error
        except UNREADABLE as error:
            raise DamagedFileError(path, f"is no whole zip ({error}); copy it again") from error
        if len(self._zip.infolist()) > MAX_MEMBERS:
            raise LimitError(
                path, f"has over {MAX_MEMBERS:,} members; unpack it and give the folder"
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
        """Return a member's bytes.

        Raises:
            LimitError: it is too large. DamagedFileError: it is packed in a way that is not read,
                encrypted, or fails its check sum.
        """
        info = self.members[name]
        where = f"{self.path}/{name}"
        swollen = info.file_size > RATIO_FROM_BYTES
        swollen = swollen and info.file_size > MAX_RATIO * max(info.compress_size, 1)
        if info.file_size > MAX_MEMBER_BYTES or swollen:
            raise LimitError(where, f"would unpack to {info.file_size:,} bytes, more than is read")
        if info.compress_type not in _PACKED or info.flag_bits & 1:
            raise DamagedFileError(
                where, "is encrypted or packed in a way that is not read; pack it anew"
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
        raise DamagedFileError(path, f"has a member whose name leaves it: {info.filename[:80]!r}")
    return "/".join(part for part in parts if part != ".")


@lru_cache(maxsize=4)
def _open_archive(path: Path, stamp: tuple[int, int]) -> Archive:
    return Archive(path)


@dataclass(frozen=True, order=True)
class ArchivePath:
    """A file or folder of a zip; ``inner`` is its name there, "" for the root."""

    path: Path
    inner: str = ""

    @property
    def archive(self) -> Archive:
        """The opened zip; it is opened once, and again where the file has changed."""
        try:
            found = self.path.stat()
        except OSError as error:
            raise InputError(self.path, f"cannot be read: {error.strerror or error}") from error
        return _open_archive(self.path, (found.st_size, found.st_mtime_ns))

    def __str__(self) -> str:
        """The zip's path and the name inside it, for messages."""
        return f"{self.path}/{self.inner}" if self.inner else str(self.path)

    def __truediv__(self, name: str) -> "ArchivePath":
        """Return the place of a name below this one."""
        joined = PurePosixPath(self.inner) / name
        return ArchivePath(self.path, "" if str(joined) == "." else str(joined))

    @property
    def name(self) -> str:
        """The last part: of the root, the zip's own name."""
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
        """The folder that holds it; the root's is the root."""
        folder = self.inner.rpartition("/")[0]
        return ArchivePath(self.path, folder)

    def is_file(self) -> bool:
        """Whether a member has this name."""
        return self.inner in self.archive.members

    def is_dir(self) -> bool:
        """Whether members lie below this name."""
        return self.inner in self.archive.folders

    def exists(self) -> bool:
        """Whether there is a file or a folder of this name."""
        return self.is_file() or self.is_dir()

    def iterdir(self) -> Iterator["ArchivePath"]:
        """Yield what lies in the folder, by name."""
        for name in sorted(self.archive.folders.get(self.inner, ())):
            yield self / name

    def glob(self, pattern: str) -> Iterator["ArchivePath"]:
        """Yield what matches a pattern of one or more parts, such as ``seq-*/frame-*``."""
        first, _, rest = pattern.partition("/")
        for found in self.iterdir():
            if fnmatchcase(found.name, first):
                if not rest:
                    yield found
                elif found.is_dir():
                    yield from found.glob(rest)

    def rglob(self, pattern: str) -> Iterator["ArchivePath"]:
        """Yield what matches a pattern of one part here and in all folders below."""
        for found in self.iterdir():
            if fnmatchcase(found.name, pattern):
                yield found
            if found.is_dir():
                yield from found.rglob(pattern)

    def stat(self) -> SimpleNamespace:
        """Return ``st_size``, the unpacked size in bytes."""
        if not self.is_file():
            raise FileNotFoundError(str(self))
        return SimpleNamespace(st_size=self.archive.members[self.inner].file_size)

    def read_bytes(self) -> bytes:
        """Return a member's bytes. Raises what ``Archive.read`` raises."""
        if not self.is_file():
            raise FileNotFoundError(str(self))
        return self.archive.read(self.inner)

    def open(self, mode: str = "rb") -> io.BytesIO:
        """Open a member for reading bytes."""
        if mode != "rb":
            raise ValueError(f"an archive is opened with rb, not {mode}")
        return io.BytesIO(self.read_bytes())


AnyPath = Path | ArchivePath


def is_zip(path: Path) -> bool:
    """Whether a file begins as a zip does, whatever it is named."""
    try:
        with path.open("rb") as stream:
            return stream.read(4) in (b"PK\x03\x04", b"PK\x05\x06")
    except OSError:
        return False
