"""The journal of edits: a file that only grows, and that a kill in the middle does not break.

After the mark come records, each a length and a CRC-32 (big-endian, four bytes each) and that many
bytes: a zlib stream of a verb (``+`` done, ``-`` undone, ``*`` done again), the edit's number and,
with ``+``, the edit itself. A record that the file ends within was never finished: it is left out
and cut off before the next one is written.
"""

import os
import struct
import zlib
from collections.abc import Sequence
from pathlib import Path

from world2minecraft.edit.packing import EDIT_LIMITS, pack_edit, unpack_edit
from world2minecraft.errors import DamagedFileError, LimitError, OutputError
from world2minecraft.files import read_bytes, write_bytes
from world2minecraft.types import BlockEdit

EDITS_FILE = "edits.journal"  # Beside a build: what was mended in it.
MARK = b"w2m edits 1\n"
DO, UNDO, REDO = b"+", b"-", b"*"
LEVEL = 1  # Of zlib: a build of a million blocks is recorded in half a second.
MAX_JOURNAL_BYTES = 256 << 20
_HEAD = struct.Struct(">II")
_NUMBER = struct.Struct(">cI")


class Journal:
    """The edits of one thing, in order, and which of them are done now.

    ``steps`` are all records: whether one did an edit (again) or took it back, and its number.
    """

    def __init__(self, path: str | Path):
        """Read the journal at ``path``; a missing file is an empty one.

        Raises:
            DamagedFileError: it is no journal. LimitError: it is too large.
        """
        self.path = Path(path)
        self.edits: list[BlockEdit] = []
        self.is_done: list[bool] = []
        self.steps: list[tuple[bool, int]] = []
        self._end = 0
        if self.path.exists():
            self._read(read_bytes(self.path, MAX_JOURNAL_BYTES))

    def do(self, edit: BlockEdit) -> None:
        """Add an edit that is done. Raises OutputError; then nothing is added."""
        self._write(DO, len(self.edits), pack_edit(edit))
        self.edits.append(edit)
        self._step(True, len(self.edits) - 1)

    def undo(self, number: int) -> None:
        """Record that the edit of this number is taken back. Raises OutputError."""
        self._write(UNDO, number)
        self._step(False, number)

    def redo(self, number: int) -> None:
        """Record that the edit of this number is done again. Raises OutputError."""
        self._write(REDO, number)
        self._step(True, number)

    def _step(self, is_done: bool, number: int) -> None:
        self.is_done[number:] = [is_done, *self.is_done[number + 1 :]]
        self.steps.append((is_done, number))

    def _read(self, data: bytes) -> None:
        if not data.startswith(MARK):
            if MARK.startswith(data):
                return  # Killed while the first bytes were written.
            raise DamagedFileError(self.path, "is no journal of edits")
        at = len(MARK)
        while at + _HEAD.size <= len(data):
            length, checksum = _HEAD.unpack_from(data, at)
            end = at + _HEAD.size + length
            record = data[at + _HEAD.size : end]
            if end > len(data) or (end == len(data) and zlib.crc32(record) != checksum):
                break
            if zlib.crc32(record) != checksum:
                raise DamagedFileError(self.path, f"is damaged at byte {at}")
            self._replay(record)
            at = end
        self._end = at

    def _replay(self, record: bytes) -> None:
        verb, number, rest = self._opened(record)
        if verb == DO and number == len(self.edits):
            self.edits.append(unpack_edit(rest, self.path))
        elif verb not in (UNDO, REDO) or number >= len(self.edits):
            raise DamagedFileError(self.path, f"has a record of edit {number} out of order")
        self._step(verb != UNDO, number)

    def _opened(self, record: bytes) -> tuple[bytes, int, bytes]:
        stream = zlib.decompressobj()
        try:
            content = stream.decompress(record, EDIT_LIMITS.bytes)
            verb, number = _NUMBER.unpack_from(content)
        except (zlib.error, struct.error) as error:
            raise DamagedFileError(self.path, f"has a record that is none ({error})") from error
        if stream.unconsumed_tail:
            raise LimitError(self.path, f"has an edit of more than {EDIT_LIMITS.bytes:,} bytes")
        return verb, number, content[_NUMBER.size :]

    def _write(self, verb: bytes, number: int, edit: bytes = b"") -> None:
        record = packed_record(verb, number, edit)
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            with open(self.path, "r+b" if self.path.exists() else "x+b") as stream:
                stream.truncate(self._end)
                stream.seek(self._end)
                stream.write(record if self._end else MARK + record)
                stream.flush()
                os.fsync(stream.fileno())
                end = stream.tell()
        except OSError as error:
            reason = f"cannot be written: {error.strerror or error}"
            raise OutputError(self.path, reason) from error
        self._end = end


def packed_record(verb: bytes, number: int, edit: bytes = b"") -> bytes:
    """Return the bytes of one record."""
    record = zlib.compress(_NUMBER.pack(verb, number) + edit, LEVEL)
    return _HEAD.pack(len(record), zlib.crc32(record)) + record


def write_journal(path: str | Path, edits: Sequence[BlockEdit]) -> None:
    """Write a whole journal of edits that are all done, atomically. Raises OutputError."""
    records = [packed_record(DO, number, pack_edit(edit)) for number, edit in enumerate(edits)]
    write_bytes(path, MARK + b"".join(records))


def write_edits(build: Path, edits: Sequence[BlockEdit]) -> None:
    """Write what was mended in a build beside it, in place of what a build before it left.

    Raises:
        OutputError: the folder cannot be written.
    """
    path = build / EDITS_FILE
    if edits:
        write_journal(path, edits)
        return
    try:
        path.unlink(missing_ok=True)
    except OSError as error:
        raise OutputError(path, f"cannot be removed: {error.strerror or error}") from error
