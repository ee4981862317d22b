"""The journal of a scene: a log of its history that a kill does not break.

A file of records (``records.py``). The first has the verb ``@``: its number is the revision at
which the journal starts, and with it comes the name of its generation and a line feed. Each
further one is a step, and raises the revision by one: ``+`` an operation with its number, its
kind and the operation itself; ``-`` and ``*`` that the one of this number was taken back or done
again, with who did so and when. Operations stay on the disk; memory holds where they lie.
"""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.types import Operation
from world2minecraft.editing.record_log import Record, RecordFile
from world2minecraft.editing.scene.history import Line
from world2minecraft.editing.scene.packing import OPERATION_LIMITS, pack_operation, unpack_operation

MARK = b"w2m scene 1\n"
START, DO, UNDO, REDO = b"@", b"+", b"-", b"*"
_KIND = 1024  # Bytes in which a kind ends: 200 characters of any alphabet.


class Step(NamedTuple):
    """One record of the journal; ``kind`` is empty where its bytes are damaged."""

    verb: bytes
    number: int
    kind: str
    record: Record


class SceneJournal:
    """The steps since revision ``start``, and the operations that they did.

    ``steps`` are all of them; one with a damaged record has the verb ``b""``. ``generation`` is
    the name that the journal was begun with, empty where there is none yet.
    """

    def __init__(self, path: str | Path, shape: tuple[int, int, int]):
        """Read where the records of the journal at ``path`` lie; a missing file is an empty one.

        Args:
            path: the file.
            shape: of the scene's grid.

        Raises:
            DamagedFileError: it is no journal. InputError: it cannot be read.
        """
        self.file = RecordFile(path, MARK, OPERATION_LIMITS.bytes, "journal of a scene")
        self.shape, self.start, self.generation = shape, 0, ""
        self.steps: list[Step] = []
        self._places: dict[int, Record] = {}
        self._next = 0
        for record, packed in self.file.scan():
            self._take(record, packed)

    @property
    def rev(self) -> int:
        """The revision after the last step."""
        return self.start + len(self.steps)

    def begin(self, generation: str, start: int = 0) -> None:
        """Write the first record of a new journal. Raises OutputError."""
        self.file.append(START, start, f"{generation}\n".encode())
        self.generation, self.start = generation, start

    def do(self, operation: Operation) -> int:
        """Keep an operation that is done; return its number. Raises OutputError."""
        number = self._next
        kind = operation.kind.encode() + b"\n"
        record = self.file.append(DO, number, kind + pack_operation(operation, self.shape))
        self._place(number, record)
        self.steps.append(Step(DO, number, operation.kind, record))
        return number

    def undo(self, number: int, actor: str = "", time_s: float = 0.0) -> None:
        """Keep that an operation was taken back. Raises OutputError."""
        self._turn(UNDO, number, actor, time_s)

    def redo(self, number: int, actor: str = "", time_s: float = 0.0) -> None:
        """Keep that an operation was done again. Raises OutputError."""
        self._turn(REDO, number, actor, time_s)

    def operation(self, number: int) -> Operation:
        """Return an operation, read from the disk.

        Raises:
            DamagedFileError: its bytes are not those that were written.
        """
        if number not in self._places:
            raise DamagedFileError(self.file.path, f"has lost edit {number}")
        _, _, content = self.file.opened(self.file.read(self._places[number]))
        packed = content.partition(b"\n")[2]
        return unpack_operation(packed, self.shape, self.file.path)

    def turned_by(self, step: Step) -> tuple[str, float]:
        """Return who took a step of undo or redo, and when, in seconds since 1970."""
        _, _, content = self.file.opened(self.file.read(step.record))
        try:
            actor, time_s = json.loads(content or b'["", 0]')
            return str(actor), float(time_s)
        except (ValueError, TypeError) as error:
            raise DamagedFileError(self.file.path, f"has a step that is none ({error})") from error

    def line_after(self, line: Line, steps: Sequence[Step]) -> Line:
        """Return where a line comes to by some steps, none of them damaged.

        Raises:
            DamagedFileError: the steps do not follow from the line.
        """
        for step in steps:
            done, numbers = line.done, line.numbers
            if step.verb == DO:
                line = line.with_new(step.number, step.kind)
            elif step.verb == UNDO and done and numbers[done - 1] == step.number:
                line = line.moved(-1)
            elif step.verb == REDO and done < len(numbers) and numbers[done] == step.number:
                line = line.moved(1)
            else:
                raise DamagedFileError(self.file.path, f"has a step of edit {step.number} too many")
        return line

    def bytes_of(self, number: int) -> int:
        """Return how many bytes of the disk an operation takes; 0 where it is not there."""
        record = self._places.get(number)
        return record.length if record else 0

    def _place(self, number: int, record: Record) -> None:
        self._places[number], self._next = record, number + 1

    def _turn(self, verb: bytes, number: int, actor: str, time_s: float) -> None:
        told = json.dumps([actor, time_s], separators=(",", ":")).encode()
        record = self.file.append(verb, number, told)
        self.steps.append(Step(verb, number, "", record))

    def _take(self, record: Record, packed: bytes) -> None:
        if not record.is_whole:
            self.steps.append(Step(b"", -1, "", record))
            return
        verb, number, content = self.file.opened(packed, _KIND)
        word = content.partition(b"\n")[0].decode(errors="replace")
        if verb == START:
            if self.steps or self.generation:
                raise DamagedFileError(self.file.path, "begins a second time")
            self.generation, self.start = word, number
            return
        if verb not in (DO, UNDO, REDO):
            raise DamagedFileError(self.file.path, f"has a record of the unknown kind {verb!r}")
        if verb == DO:
            self._place(number, record)
        self.steps.append(Step(verb, number, word if verb == DO else "", record))
