"""An append-only file of records that survives a kill in the middle of a write.

After the mark come records, each a length and a CRC-32 (big-endian, four bytes each) and that many
bytes: a zlib stream of a verb of one byte, a number of four and what belongs to them. A record
that the file ends within was never finished: it is left out and cut off before the next one is
written. Both journals, of blocks and of scenes, are such files.
"""

import contextlib
import os
import struct
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO, NamedTuple

from world2minecraft.core.errors import DamagedFileError, InputError, LimitError, OutputError

LEVEL = 1  # Of zlib: a build of a million blocks is recorded in half a second.
HEAD = struct.Struct(">II")
NUMBER = struct.Struct(">cI")
_STREAM = zlib.compress(b"", LEVEL)[:2]  # What each stream begins with.


class Record(NamedTuple):
    """Where a record lies, and whether its bytes are those that were written."""

    at: int
    length: int  # Of its stream.
    is_whole: bool = True

    @property
    def end(self) -> int:
        """The first byte after it."""
        return self.at + HEAD.size + self.length


class RecordFile:
    """The file: ``end`` is where the next record goes, 0 where the mark is still to be written."""

    def __init__(self, path: str | Path, mark: bytes, limit: int, name: str = "journal of edits"):
        """Name the file; nothing is read.

        Args:
            path: where it lies, or will.
            mark: its first bytes.
            limit: the most bytes that one record may unpack to.
            name: what errors call it.
        """
        self.path, self.mark, self.limit, self.name = Path(path), mark, limit, name
        self.end = 0

    def scan(self) -> Iterator[tuple[Record, bytes]]:
        """Go through the records with their streams; ``end`` follows, past damaged ones too.

        A damaged length is known by the whole records after it: without any it is a torn tail.

        Raises:
            DamagedFileError: it is no such file. InputError: it cannot be read.
        """
        self.end = 0
        try:
            with open(self.path, "rb") as stream:
                size = os.fstat(stream.fileno()).st_size
                start = stream.read(len(self.mark))
                if start != self.mark:
                    if self.mark.startswith(start):
                        return  # Killed while the first bytes were written.
                    raise DamagedFileError(self.path, f"is no {self.name}")
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
        """Return the stream of a record that was written or scanned.

        Raises:
            DamagedFileError: other bytes are there now. InputError: it cannot be read.
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
        """Return the verb, the number and what belongs to them, of the stream of a record.

        Args:
            packed: the stream.
            most: stop after so many bytes of what belongs to them.

        Raises:
            DamagedFileError: it is none. LimitError: it unpacks to too much.
        """
        stream = zlib.decompressobj()
        wanted = self.limit if most is None else NUMBER.size + most
        try:
            content = stream.decompress(packed, wanted)
            verb, number = NUMBER.unpack_from(content)
        except (zlib.error, struct.error) as error:
            raise DamagedFileError(self.path, f"has a record that is none ({error})") from error
        if stream.unconsumed_tail and most is None:
            raise LimitError(self.path, f"has an edit of more than {self.limit:,} bytes")
        return verb, number, content[NUMBER.size :]

    def append(self, verb: bytes, number: int, content: bytes = b"") -> Record:
        """Write a record to the disk; when it returns, a kill or a power cut leaves it there.

        Raises:
            OutputError: it cannot be written; the file holds what it held. LimitError: it is
            larger than a reader takes.
        """
        if NUMBER.size + len(content) > self.limit:
            raise LimitError(self.path, f"takes no edit of more than {self.limit:,} bytes")
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
    """Return the record that begins here, what is damaged up to the next whole one, or None."""
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
    """Bring the names in a folder to the disk, where the system can."""
    try:
        handle = os.open(folder, os.O_RDONLY)
    except OSError:  # Windows opens no folders.
        return
    with contextlib.suppress(OSError):
        os.fsync(handle)
    os.close(handle)


def _truncate(handle: int, size: int) -> None:
    """Take away what a failed write left; where that fails too, it is cut off when read."""
    with contextlib.suppress(OSError):
        os.ftruncate(handle, size)
