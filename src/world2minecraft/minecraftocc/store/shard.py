"""A shard that is being written: sample by sample, so that no crash costs more than one.

While it grows it is ``NAME.tar.part``. Each sample is appended in one write and flushed to disk.
Whoever opens the part again, after any crash, finds the samples that are whole and right by their
sums, cuts off the rest and goes on; at the end it is flushed and renamed. So the same samples give
the same bytes, however often the work was broken off.
"""

import errno
import os
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from io import FileIO
from pathlib import Path

from filelock import lock_descriptor

from world2minecraft.core.errors import ConflictError, OutputError
from world2minecraft.minecraftocc.store.stored import stored_samples
from world2minecraft.minecraftocc.store.tar import end_bytes, member_bytes

PART = ".part"
PATIENCE_S = 60.0  # A worker whose builder was killed ends with its sample.
_LOOK_S = 0.05


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
        with _told(path):
            path.parent.mkdir(parents=True, exist_ok=True)
            self._stream = _locked(self._part)
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
        with _told(self.path):
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
        with _told(self.path):
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
        with _told(self.path):
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


def _locked(part: Path) -> FileIO | None:
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
        time.sleep(_LOOK_S)
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
def _told(path: Path) -> Iterator[None]:
    """Turn errors of the system into one line that says what to do."""
    try:
        yield
    except OSError as error:
        if error.errno in (errno.ENOSPC, errno.EDQUOT):
            reason = "the disk is full; free some space and run the same command again to go on"
        else:
            reason = f"cannot be written: {error.strerror or error}"
        raise OutputError(path, reason) from error
