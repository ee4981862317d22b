"""Write and read shards: tar files to which samples are appended one by one.

While it grows it is ``NAME.tar.part``. Each sample is appended in one write and flushed to disk.
Whoever opens the part again, after any crash, finds the samples that are complete by their
checksums, cuts off the rest and continues; at the end it is flushed and renamed. So the same
samples give the same bytes, however often the work was interrupted.

Members are ustar without owners and times, so that bytes depend on content alone: a header of 512
bytes, the data, and zeros up to the next whole 512. Samples are found by their headers and their
JSON; images are skipped.
"""

import errno
import hashlib
import os
import re
import tarfile
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from io import FileIO
from pathlib import Path
from typing import Any, BinaryIO

from filelock import lock_descriptor

from world2minecraft.core.errors import ConflictError, DamagedFileError, OutputError
from world2minecraft.minecraftocc.store.sample_files import FACTS, MAX_FACTS_BYTES, read_facts

BLOCK = 512
RECORD = 20 * BLOCK  # A tar is so many bytes, or a multiple.
MAX_KEY_LENGTH = 90  # With ".depth.png" it is as long as the name of a ustar member may be.
MEMBER_NAME = re.compile(r"([A-Za-z0-9_-]{1,90})\.([a-z]{2,6}(?:\.[a-z]{2,6})?)")
_MAX_MEMBERS = 8
_CHUNK = 1 << 20
PART = ".part"
PATIENCE_S = 60.0  # A worker whose builder was killed ends with its sample.
_POLL_S = 0.05


@dataclass(frozen=True)
class Member:
    """Where the data of a member lie in a shard."""

    key: str  # "house_0001-a-000012"
    kind: str  # "jpg", "depth.png", "occ.npz" or "json"
    offset: int
    size: int

    @property
    def end(self) -> int:
        """Where the next member begins."""
        return self.offset + self.size + padding(self.size)


def padding(size: int) -> int:
    """Return how many zeros follow so many bytes of data."""
    return -size % BLOCK


def member_bytes(name: str, data: bytes) -> bytes:
    """Return a member with its header and its padding.

    Example:
        >>> len(member_bytes("a.json", b"{}"))
        1024
    """
    info = tarfile.TarInfo(name)  # Its time and owner are 0, its mode is 644.
    info.size = len(data)
    return info.tobuf(tarfile.USTAR_FORMAT) + data + bytes(padding(len(data)))


def end_bytes(length: int) -> bytes:
    """Return what ends a tar of so many bytes: two blocks of zeros, filled up to a record."""
    return bytes(2 * BLOCK + -(length + 2 * BLOCK) % RECORD)


def member_at(stream: BinaryIO, offset: int, length: int) -> Member | None:
    """Read the header at an offset of a tar that is ``length`` bytes long.

    Returns None where there is no whole member of ours: at the end, or where bytes are damaged.
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
    """A sample in a shard: where it lies, and what its JSON tells."""

    key: str
    offset: int
    size: int
    members: tuple[Member, ...]
    facts: dict[str, Any]
    facts_sha256: str


def stored_samples(stream: BinaryIO, length: int, checked: bool = False) -> Iterator[StoredSample]:
    """Give the whole samples from the start of a shard, up to its end or the first that is not.

    Args:
        stream: the shard or its part.
        length: its size in bytes.
        checked: whether the sums of all members are compared, not of their JSON alone.
    """
    offset = 0
    while (sample := _sample_at(stream, offset, length)) is not None:
        if checked and not has_valid_checksums(stream, sample):
            return
        yield sample
        offset = sample.offset + sample.size


def has_valid_checksums(stream: BinaryIO, sample: StoredSample) -> bool:
    """Whether the members of a sample have the checksums that its JSON states."""
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
    """A shard from its first to its last sample; ``done`` are there already when it is opened."""

    def __init__(self, path: Path, keys: Sequence[str]):
        """Open the part of a shard, and cut it to its last whole sample.

        Args:
            path: of the finished shard.
            keys: of all its samples, in their order.

        Raises:
            OutputError: it cannot be written. ConflictError: another process writes it.
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
        if self._stream is None:  # Another process has finished it meanwhile.
            self.done = len(self.keys)
            return
        self._resume(self._stream)

    def __enter__(self) -> "ShardWriter":
        """Return the writer."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close the part; it stays, unless the shard is finished."""
        self.close()

    def append(self, members: Mapping[str, bytes]) -> None:
        """Append the next sample and flush it to the disk.

        Raises:
            OutputError: the disk is full, or the part cannot be written.
        """
        if self._stream is None or self.done >= len(self.keys):
            raise ValueError(f"{self.path} has all its samples")
        key = self.keys[self.done]
        data = b"".join(member_bytes(f"{key}.{kind}", one) for kind, one in members.items())
        with _readable_errors(self.path):
            try:
                self._write(data)
            except OSError:
                self._cut()
                raise
        self._length += len(data)
        self.done += 1

    def finish(self) -> None:
        """End the archive and give it its name. Raises as ``append``."""
        if self._stream is None:
            return
        if self.done != len(self.keys):
            raise ValueError(f"{self.path} has {self.done} of {len(self.keys)} samples")
        with _readable_errors(self.path):
            try:
                self._write(end_bytes(self._length))
            except OSError:
                self._cut()
                raise
            if os.name == "nt":  # There an open file keeps its name.
                self.close()
            os.replace(self._part, self.path)
            _flush_folder(self.path.parent)
        self.close()

    def close(self) -> None:
        """Let go of the part."""
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
        if self._stream is not None:
            left = memoryview(data)
            while left:
                left = left[self._stream.write(left) :]
            os.fsync(self._stream.fileno())

    def _cut(self) -> None:
        """Take back what was written of a sample; the next opening would do it too."""
        if self._stream is not None:
            try:
                os.ftruncate(self._stream.fileno(), self._length)
                os.lseek(self._stream.fileno(), self._length, os.SEEK_SET)
            except OSError:
                return


def _open_locked(part: Path) -> FileIO | None:
    """Open a part for this process alone; None where it has become a shard meanwhile."""
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
    raise ConflictError(part, "is being written by another process")


def _is_at(handle: int, path: Path) -> bool:
    try:
        return os.path.samestat(os.fstat(handle), os.stat(path))
    except OSError:
        return False


def _flush_folder(folder: Path) -> None:
    """Flush a folder's names, where the system lets one."""
    if os.name != "nt":
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


@contextmanager
def _readable_errors(path: Path) -> Iterator[None]:
    """Turn errors of the system into one line that says what to do."""
    try:
        yield
    except OSError as error:
        if error.errno in (errno.ENOSPC, errno.EDQUOT):
            reason = "the disk is full; free some space and run the same command again to go on"
        else:
            reason = f"cannot be written: {error.strerror or error}"
        raise OutputError(path, reason) from error
