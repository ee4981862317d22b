"""The journal of the edits of blocks: a file of records, each doing an edit or taking it back.

The verbs are ``+`` done, ``-`` undone, ``*`` done again; the number is the edit's, and with ``+``
comes the edit itself. ``records.py`` tells how they lie in the file.
"""

from collections.abc import Sequence
from pathlib import Path

from world2minecraft.core.errors import DamagedFileError, LimitError, OutputError
from world2minecraft.core.files import write_bytes
from world2minecraft.core.types import BlockEdit
from world2minecraft.editing.packing import EDIT_LIMITS, pack_edit, unpack_edit
from world2minecraft.editing.record_log import RecordFile, packed_record

EDITS_FILE = "edits.journal"  # Beside a build: what was mended in it.
MARK = b"w2m edits 1\n"
DO, UNDO, REDO = b"+", b"-", b"*"
MAX_JOURNAL_BYTES = 256 << 20


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
        self._file = RecordFile(path, MARK, EDIT_LIMITS.bytes)
        self.edits: list[BlockEdit] = []
        self.is_done: list[bool] = []
        self.steps: list[tuple[bool, int]] = []
        if self.path.exists():
            self._read()

    def do(self, edit: BlockEdit) -> None:
        """Add an edit that is done. Raises OutputError; then nothing is added."""
        self._file.append(DO, len(self.edits), pack_edit(edit))
        self.edits.append(edit)
        self._step(True, len(self.edits) - 1)

    def undo(self, number: int) -> None:
        """Record that the edit of this number is taken back. Raises OutputError."""
        self._file.append(UNDO, number)
        self._step(False, number)

    def redo(self, number: int) -> None:
        """Record that the edit of this number is done again. Raises OutputError."""
        self._file.append(REDO, number)
        self._step(True, number)

    def _step(self, is_done: bool, number: int) -> None:
        self.is_done[number:] = [is_done, *self.is_done[number + 1 :]]
        self.steps.append((is_done, number))

    def _read(self) -> None:
        size = self.path.stat().st_size
        if size > MAX_JOURNAL_BYTES:
            most = f"at most {MAX_JOURNAL_BYTES:,} are read"
            raise LimitError(self.path, f"has {size:,} bytes; {most}")
        for record, packed in self._file.scan():
            if not record.is_whole:
                raise DamagedFileError(self.path, f"is damaged at byte {record.at}")
            self._replay(*self._file.opened(packed))

    def _replay(self, verb: bytes, number: int, rest: bytes) -> None:
        if verb == DO and number == len(self.edits):
            self.edits.append(unpack_edit(rest, self.path))
        elif verb not in (UNDO, REDO) or number >= len(self.edits):
            raise DamagedFileError(self.path, f"has a record of edit {number} out of order")
        self._step(verb != UNDO, number)


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
