"""Writer and reader for shards, tar files to which samples are appended one by one.

An unfinished shard is named ``NAME.tar.part``. Each sample is appended in a single write and
flushed to disk. When the part is opened again after a crash, its complete samples are found by
their checksums, the rest is truncated, and writing continues. At the end, the file is flushed and
renamed. Therefore the same samples always produce identical files, however often the work was
interrupted.

Members use the ustar format without owners and times, so the file depends only on its content. Each
member has a header of 512 bytes, followed by its data and zeros up to a multiple of 512 bytes.
Samples are found by reading headers and JSON only; images are skipped.
"""

import errno
import hashlib
import os
import re
import tarfile
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from io import FileIO
from pathlib import Path
from typing import Any, BinaryIO

from filelock import lock_descriptor

from world2minecraft.core.errors import ConflictError, DamagedFileError, OutputError
from world2minecraft.minecraftocc.store.sample_files import FACTS, MAX_FACTS_BYTES, read_facts

BLOCK = 512
RECORD = 20 * BLOCK  # The size of a tar file is a multiple of this.
MAX_KEY_LENGTH = 90  # With ".depth.png", this is the longest possible name of a ustar member.
MEMBER_NAME = re.compile(r"([A-Za-z0-9_-]{1,90})\.([a-z]{2,6}(?:\.[a-z]{2,6})?)")
_MAX_MEMBERS = 8
_CHUNK = 1 << 20
PART = ".part"
PATIENCE_S = 60.0  # A worker whose parent was killed exits after its current sample.
_POLL_S = 0.05


@dataclass(frozen=True)
class Member:
    """The position of a member's data in a shard.

    Attributes:
        key: Key of the sample, such as ``house_0001-a-000012``.
        kind: ``jpg``, ``depth.png``, ``occ.npz`` or ``json``.
        offset: Position of the data in bytes.
        size: Size of the data in bytes.
    """

    key: str
    kind: str
    offset: int
    size: int

    @property
    def end(self) -> int:
        """Position of the next member in bytes."""
        return self.offset + self.size + padding(self.size)


def padding(size: int) -> int:
    """Return the number of zero bytes that follow a member's data of this size."""
    return -size % BLOCK


def member_bytes(name: str, data: bytes) -> bytes:
    """Return a member's header, data and padding as bytes.

    Example:
        >>> len(member_bytes("a.json", b"{}"))
        1024
    """
    info = tarfile.TarInfo(name)  # Its time and owner are 0, its mode is 644.
    info.size = len(data)
    return info.tobuf(tarfile.USTAR_FORMAT) + data + bytes(padding(len(data)))


def end_bytes(length: int) -> bytes:
    """Return the end marker for a tar file of this length.

    It consists of two blocks of zeros, followed by zeros up to a full record.
    """
    return bytes(2 * BLOCK + -(length + 2 * BLOCK) % RECORD)


def member_at(stream: BinaryIO, offset: int, length: int) -> Member | None:
    """Read the member header at an offset in a tar file.

    Args:
        stream: Tar file.
        offset: Position of the header in bytes.
        length: Length of the tar file in bytes.

    Returns:
        The member, or None if there is no complete member at this position, which is the case at
        the end of the file and where it is damaged.
    """
    stream.seek(offset)
    block = stream.read(BLOCK)
    if len(block) < BLOCK:
        return None
    try:
        info = tarfile.TarInfo.frombuf(block, "ascii", "strict")
    except (tarfile.HeaderError, ValueError):
        return None
    name = MEMBER_NAME.fullmatch(info.name)
    if name is None or not info.isreg() or info.size < 0:
        return None
    member = Member(name[1], name[2], offset + BLOCK, info.size)
    return member if member.end <= length else None


@dataclass(frozen=True, eq=False)
class StoredSample:
    """A sample in a shard.

    Attributes:
        key: Key of the sample.
        offset: Position of the sample in bytes.
        size: Size of the sample in bytes, including headers.
        members: Its members.
        facts: Content of its JSON.
        facts_sha256: SHA-256 of its JSON.
    """

    key: str
    offset: int
    size: int
    members: tuple[Member, ...]
    facts: dict[str, Any]
    facts_sha256: str


def stored_samples(stream: BinaryIO, length: int, checked: bool = False) -> Iterator[StoredSample]:
    """Yield the samples of a shard up to its end or up to the first incomplete sample.

    Args:
        stream: Shard, or unfinished part of a shard.
        length: Size of the file in bytes.
        checked: Whether to verify the checksums of all members.
    """
    offset = 0
    while (sample := _sample_at(stream, offset, length)) is not None:
        if checked and not has_valid_checksums(stream, sample):
            return
        yield sample
        offset = sample.offset + sample.size


def has_valid_checksums(stream: BinaryIO, sample: StoredSample) -> bool:
    """Return whether the members of a sample match the checksums in its JSON."""
    checksums = sample.facts.get("sha256")
    others = [member for member in sample.members if member.kind != FACTS]
    if not isinstance(checksums, dict) or set(checksums) != {member.kind for member in others}:
        return False
    return all(checksums[member.kind] == _member_digest(stream, member) for member in others)


def _sample_at(stream: BinaryIO, offset: int, length: int) -> StoredSample | None:
    members: list[Member] = []
    at = offset
    while len(members) < _MAX_MEMBERS:
        member = member_at(stream, at, length)
        if member is None or (members and member.key != members[0].key):
            return None
        members.append(member)
        at = member.end
        if member.kind == FACTS:
            break
    if members[-1].kind != FACTS or members[-1].size > MAX_FACTS_BYTES:
        return None
    stream.seek(members[-1].offset)
    data = stream.read(members[-1].size)
    try:
        facts = read_facts(data, members[-1].key)
    except DamagedFileError:
        return None
    if facts.get("key") != members[0].key:
        return None
    total = hashlib.sha256(data).hexdigest()
    return StoredSample(members[0].key, offset, at - offset, tuple(members), facts, total)


def _member_digest(stream: BinaryIO, member: Member) -> str:
    stream.seek(member.offset)
    digest, left = hashlib.sha256(), member.size
    while left > 0 and (data := stream.read(min(left, _CHUNK))):
        digest.update(data)
        left -= len(data)
    return digest.hexdigest()


class ShardWriter:
    """A writer for a shard, which continues after the ``done`` samples that already exist."""

    def __init__(self, path: Path, keys: Sequence[str]):
        """Open an unfinished shard and truncate it after its last complete sample.

        Args:
            path: Path of the finished shard.
            keys: Keys of all its samples, in order.

        Raises:
            OutputError: If the file cannot be written.
            ConflictError: If another process is writing the file.
        """
        self.path, self.keys, self.done = path, tuple(keys), 0
        self._part = path.with_name(path.name + PART)
        self._stream: FileIO | None = None
        self._length = 0
        if path.exists():
            self.done = len(self.keys)
            return
        with _readable_errors(path):
            path.parent.mkdir(parents=True, exist_ok=True)
            self._stream = _open_locked(self._part)
        if self._stream is None:  # Another process has finished the shard in the meantime.
            self.done = len(self.keys)
            return
        self._resume(self._stream)

    def __enter__(self) -> "ShardWriter":
        """Return the writer."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close the file. An unfinished shard remains as a part."""
        self.close()

    def append(self, members: Mapping[str, bytes]) -> None:
        """Append the next sample and flush it to disk.

        Args:
            members: Content of each member by kind, in order.

        Raises:
            OutputError: If the disk is full, or if the file cannot be written.
        """
        if self._stream is None or self.done >= len(self.keys):
            raise ValueError(f"{self.path} already contains all its samples")
        key = self.keys[self.done]
        data = b"".join(member_bytes(f"{key}.{kind}", one) for kind, one in members.items())
        with _readable_errors(self.path):
            self._write(data)
        self._length += len(data)
        self.done += 1

    def finish(self) -> None:
        """Write the end of the tar file and rename it to its final name.

        Raises:
            OutputError: If the disk is full, or if the file cannot be written.
        """
        if self._stream is None:
            return
        if self.done != len(self.keys):
            raise ValueError(f"{self.path} contains only {self.done} of {len(self.keys)} samples")
        with _readable_errors(self.path):
            self._write(end_bytes(self._length))
            if os.name == "nt":  # Windows cannot rename an open file.
                self.close()
            os.replace(self._part, self.path)
            _flush_folder(self.path.parent)
        self.close()

    def close(self) -> None:
        """Close the file without finishing the shard."""
        if self._stream is not None:
            self._stream.close()
            self._stream = None

    def _resume(self, stream: FileIO) -> None:
        length = os.fstat(stream.fileno()).st_size
        for key, sample in zip(self.keys, stored_samples(stream, length, checked=True)):  # noqa: B905
            if sample.key != key:
                break
            self.done += 1
            self._length = sample.offset + sample.size
        with _readable_errors(self.path):
            stream.truncate(self._length)
            stream.seek(self._length)

    def _write(self, data: bytes) -> None:
        """Append data and flush it to disk. If this fails, what was written of it is removed."""
        if self._stream is None:
            return
        try:
            left = memoryview(data)
            while left:
                left = left[self._stream.write(left) :]
            os.fsync(self._stream.fileno())
        except OSError:
            self._cut(self._stream.fileno())
            raise

    def _cut(self, handle: int) -> None:
        """Remove partially written data, as reopening the part would do too."""
        with suppress(OSError):
            os.ftruncate(handle, self._length)
            os.lseek(handle, self._length, os.SEEK_SET)


def _open_locked(part: Path) -> FileIO | None:
    """Open a part exclusively, or return None if another process has finished the shard."""
    until = time.monotonic() + PATIENCE_S
    while time.monotonic() < until:
        handle = os.open(part, os.O_RDWR | os.O_CREAT | getattr(os, "O_BINARY", 0), 0o644)
        stream = os.fdopen(handle, "r+b", buffering=0)
        if lock_descriptor(handle, blocking=False) and _is_at(handle, part):
            if not part.with_name(part.name.removesuffix(PART)).exists():
                return stream
            stream.close()
            part.unlink(missing_ok=True)
            return None
        stream.close()
        time.sleep(_POLL_S)
    raise ConflictError(part, "another process is writing this file; wait until it has finished")


def _is_at(handle: int, path: Path) -> bool:
    try:
        return os.path.samestat(os.fstat(handle), os.stat(path))
    except OSError:
        return False


def _flush_folder(folder: Path) -> None:
    """Flush the entries of a folder to disk, if the system supports it."""
    if os.name != "nt":
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


@contextmanager
def _readable_errors(path: Path) -> Iterator[None]:
    """Convert system errors to messages that state the next step."""
    try:
        yield
    except OSError as error:
        if error.errno in (errno.ENOSPC, errno.EDQUOT):
            reason = "the disk is full; free some space and run the same command again to resume"
        else:
            reason = f"cannot be written: {error.strerror or error}"
        raise OutputError(path, reason) from error
