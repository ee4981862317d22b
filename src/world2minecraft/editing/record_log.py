"""An append-only file of records that survives a kill during a write.

The file starts with a mark. Each record consists of its length and its CRC-32 (big-endian, four
bytes each), followed by a zlib stream of a one-byte verb, a four-byte number and the content. A
record that is cut off by the end of the file was never finished: it is ignored, and removed before
the next record is written. The journals of blocks and of scenes are such files.
"""

import contextlib
import os
import struct
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO, NamedTuple

from world2minecraft.core.errors import DamagedFileError, InputError, LimitError, OutputError

LEVEL = 1  # zlib level; a build of a million blocks is recorded in half a second.
HEAD = struct.Struct(">II")
NUMBER = struct.Struct(">cI")
_STREAM = zlib.compress(b"", LEVEL)[:2]  # Header of each stream.


class Record(NamedTuple):
    """The position of a record in the file, and whether its checksum is correct."""

    at: int
    length: int  # Length of the stream.
    is_whole: bool = True

    @property
    def end(self) -> int:
        """The position of the first byte after the record."""
        return self.at + HEAD.size + self.length


class RecordFile:
    """A file of records.

    ``end`` is the position of the next record, or 0 before the mark is written.
    """

    def __init__(self, path: str | Path, mark: bytes, limit: int, name: str = "journal of edits"):
        """Set the path of the file without reading it.

        Args:
            path: Path of the file, which may not exist yet.
            mark: First bytes of the file.
            limit: Maximum unpacked size of a record in bytes.
            name: File type to name in errors.
        """
        self.path, self.mark, self.limit, self.name = Path(path), mark, limit, name
        self.end = 0

    def scan(self) -> Iterator[tuple[Record, bytes]]:
        """Iterate over the records with their packed streams, including damaged records.

        ``end`` is updated during the iteration. A record with a damaged length is recognised by
        valid records after it. Without any, it is an unfinished record at the end of the file.

        Raises:
            DamagedFileError: If the file does not start with the mark.
            InputError: If the file cannot be read.
        """
        self.end = 0
        try:
            with open(self.path, "rb") as stream:
                size = os.fstat(stream.fileno()).st_size
                start = stream.read(len(self.mark))
                if start != self.mark:
                    if self.mark.startswith(start):
                        return  # Killed while the first bytes were written.
                    raise DamagedFileError(self.path, f"is not a {self.name}")
                self.end = len(self.mark)
                while size - self.end >= HEAD.size:
                    stream.seek(self.end)
                    record, packed = _next(stream, self.end, size)
                    if record is None:
                        return
                    self.end = record.end
                    yield record, packed
        except FileNotFoundError:
            return
        except OSError as error:
            raise InputError(self.path, f"cannot be read: {error.strerror or error}") from error

    def read(self, record: Record) -> bytes:
        """Return the packed stream of a record that was written or scanned.

        Raises:
            DamagedFileError: If the record has changed since.
            InputError: If the file cannot be read.
        """
        try:
            with open(self.path, "rb") as stream:
                stream.seek(record.at)
                data = stream.read(record.end - record.at)
        except OSError as error:
            raise InputError(self.path, f"cannot be read: {error.strerror or error}") from error
        packed = data[HEAD.size :]
        if len(packed) < record.length or zlib.crc32(packed) != HEAD.unpack_from(data)[1]:
            raise DamagedFileError(self.path, f"is damaged at byte {record.at}")
        return packed

    def unpack(self, packed: bytes, most: int | None = None) -> tuple[bytes, int, bytes]:
        """Return the verb, the number and the content of a packed stream.

        Args:
            packed: Stream of a record.
            most: Maximum number of content bytes to unpack. None unpacks all content.

        Raises:
            DamagedFileError: If the stream is not a valid record.
            LimitError: If the unpacked record is too large.
        """
        stream = zlib.decompressobj()
        wanted = self.limit if most is None else NUMBER.size + most
        try:
            content = stream.decompress(packed, wanted)
            verb, number = NUMBER.unpack_from(content)
        except (zlib.error, struct.error) as error:
            raise DamagedFileError(self.path, f"contains an invalid record ({error})") from error
        if stream.unconsumed_tail and most is None:
            raise LimitError(
                self.path, f"contains an edit larger than the limit of {self.limit:,} bytes"
            )
        return verb, number, content[NUMBER.size :]

    def append(self, verb: bytes, number: int, content: bytes = b"") -> Record:
        """Append a record and flush it to the disk.

        Raises:
            OutputError: If the record cannot be written. The file is then unchanged.
            LimitError: If the record is too large to be read.
        """
        if NUMBER.size + len(content) > self.limit:
            raise LimitError(self.path, f"cannot store an edit larger than {self.limit:,} bytes")
        packed = pack_record(verb, number, content)
        at = self.end or len(self.mark)
        is_new = not self.path.exists()
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            with open(self.path, "x+b" if is_new else "r+b") as stream:
                try:
                    stream.truncate(self.end)
                    stream.seek(self.end)
                    stream.write(packed if self.end else self.mark + packed)
                    stream.flush()
                    os.fsync(stream.fileno())
                except OSError:
                    _truncate(stream.fileno(), self.end)
                    raise
            if is_new:
                sync_folder(self.path.parent)
        except OSError as error:
            reason = f"cannot be written: {error.strerror or error}"
            raise OutputError(self.path, reason) from error
        self.end = at + len(packed)
        return Record(at, len(packed) - HEAD.size)


def _next(stream: BinaryIO, at: int, size: int) -> tuple[Record | None, bytes]:
    """Return the record at this position, the damaged bytes up to the next valid one, or None."""
    length, checksum = HEAD.unpack(stream.read(HEAD.size))
    record = Record(at, length)
    if record.end <= size:
        packed = stream.read(length)
        if zlib.crc32(packed) == checksum:
            return record, packed
    stream.seek(at)
    rest = stream.read(size - at)
    found = 0
    while (found := rest.find(_STREAM, found + 1)) >= 0:
        start = found - HEAD.size
        if start <= 0:
            continue
        length, checksum = HEAD.unpack_from(rest, start)
        if found + length <= len(rest) and zlib.crc32(rest[found : found + length]) == checksum:
            return Record(at, start - HEAD.size, is_whole=False), b""
    return None, b""


def pack_record(verb: bytes, number: int, content: bytes = b"") -> bytes:
    """Return the bytes of one record."""
    packed = zlib.compress(NUMBER.pack(verb, number) + content, LEVEL)
    return HEAD.pack(len(packed), zlib.crc32(packed)) + packed


def sync_folder(folder: Path) -> None:
    """Flush the file names in a folder to the disk, if the system supports it."""
    try:
        handle = os.open(folder, os.O_RDONLY)
    except OSError:  # Windows opens no folders.
        return
    with contextlib.suppress(OSError):
        os.fsync(handle)
    os.close(handle)


def _truncate(handle: int, size: int) -> None:
    """Remove the rest of a failed write. If that fails, it is ignored by readers."""
    with contextlib.suppress(OSError):
        os.ftruncate(handle, size)
