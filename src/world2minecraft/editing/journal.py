"""The journal of block edits: a file of records that apply or undo edits.

The verbs are ``+`` for apply, ``-`` for undo and ``*`` for redo. Each record contains the number of
its edit. A ``+`` record also contains the edit as an NBT tree, which preserves the types of block
data. ``record_log`` describes the file format.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import MALFORMED, DamagedFileError, LimitError, OutputError
from world2minecraft.core.files import write_bytes
from world2minecraft.core.types import BlockEdit, BlockEntity, Blocks, Entity
from world2minecraft.editing.record_log import RecordFile, pack_record
from world2minecraft.minecraft.nbt import NbtLimits, read_nbt, write_nbt

EDIT_LIMITS = NbtLimits(depth=64, values=2_000_000, bytes=256 << 20)
EDITS_FILE = "edits.journal"  # In the folder of a build: what the clean-up repaired.
MARK = b"w2m edits 1\n"
DO, UNDO, REDO = b"+", b"-", b"*"
MAX_JOURNAL_BYTES = 256 << 20


def pack_edit(edit: BlockEdit) -> bytes:
    """Return an edit as uncompressed NBT. Equal edits give identical bytes."""
    return write_nbt(
        {
            "kind": edit.kind,
            "reason": edit.reason,
            "class_id": -1 if edit.class_id is None else edit.class_id,
            "instance": -1 if edit.instance is None else edit.instance,
            "palette": list(edit.palette),
            "cells": np.ascontiguousarray(edit.cells.ravel(), np.int32),
            "before": _pack_blocks(edit.before),
            "after": _pack_blocks(edit.after),
        }
    )


def unpack_edit(data: bytes, path: str | Path) -> BlockEdit:
    """Parse an edit written by ``pack_edit``.

    Args:
        data: Bytes of the edit.
        path: File to name in errors.

    Raises:
        DamagedFileError: If the bytes are not a valid edit.
        LimitError: If the edit is too large.
    """
    _, root = read_nbt(data, path, EDIT_LIMITS)
    try:
        return BlockEdit(
            kind=root["kind"],
            cells=np.asarray(root["cells"], np.int32).reshape(-1, 3),
            palette=tuple(map(str, root["palette"])),
            before=_unpack_blocks(root["before"]),
            after=_unpack_blocks(root["after"]),
            reason=str(root["reason"]),
            class_id=_none_if_negative(root["class_id"]),
            instance=_none_if_negative(root["instance"]),
        )
    except MALFORMED as error:
        raise DamagedFileError(path, f"does not contain a valid block edit ({error})") from error


def _pack_blocks(blocks: Blocks) -> dict[str, Any]:
    return {
        "states": blocks.states.astype(np.int32),
        "semantic": blocks.semantic.view(np.int8),
        "instance": blocks.instance.astype(np.int32),
        "data": [
            {"id": e.id, "pos": np.array(e.block_pos, np.int32), "nbt": dict(e.nbt)}
            for e in blocks.block_entities
        ],
        "entities": [
            {
                "id": e.id,
                "pos": [float(value) for value in e.position],
                "class_id": int(e.class_id),
                "instance": int(e.instance),
                "nbt": dict(e.nbt),
            }
            for e in blocks.entities
        ],
    }


def _unpack_blocks(held: Mapping[str, Any]) -> Blocks:
    return Blocks(
        states=_as_uint16(held["states"]),
        semantic=np.asarray(held["semantic"], np.int8).view(np.uint8),
        instance=_as_uint16(held["instance"]),
        block_entities=tuple(
            BlockEntity(_as_triple(e["pos"], int), str(e["id"]), dict(e["nbt"]))
            for e in held["data"]
        ),
        entities=tuple(
            Entity(
                _as_triple(e["pos"], float),
                str(e["id"]),
                dict(e["nbt"]),
                int(e["class_id"]),
                int(e["instance"]),
            )
            for e in held["entities"]
        ),
    )


def _as_uint16(values: Any) -> np.ndarray:
    numbers = np.asarray(values, np.int32)
    if numbers.size and not 0 <= numbers.min() <= numbers.max() <= 0xFFFF:
        raise ValueError("palette indices and object ids must be 0 to 65535")
    return numbers.astype(np.uint16)


def _as_triple(values: Any, kind: Any) -> tuple[Any, Any, Any]:
    x, y, z = (kind(value) for value in values)
    return x, y, z


def _none_if_negative(value: int) -> int | None:
    return None if value < 0 else int(value)


class Journal:
    """The edits of a build in order, and which of them are currently applied.

    ``steps`` contains one entry per record: whether the record applied or undid an edit, and the
    number of the edit.
    """

    def __init__(self, path: str | Path):
        """Read the journal at ``path``. A missing file is an empty journal.

        Raises:
            DamagedFileError: If the file is not a valid journal.
            LimitError: If the file is too large.
        """
        self.path = Path(path)
        self._file = RecordFile(path, MARK, EDIT_LIMITS.bytes)
        self.edits: list[BlockEdit] = []
        self.is_done: list[bool] = []
        self.steps: list[tuple[bool, int]] = []
        if self.path.exists():
            self._read()

    def do(self, edit: BlockEdit) -> None:
        """Append an applied edit.

        Raises:
            OutputError: If the file cannot be written. Nothing is appended then.
        """
        self._file.append(DO, len(self.edits), pack_edit(edit))
        self.edits.append(edit)
        self._step(True, len(self.edits) - 1)

    def undo(self, number: int) -> None:
        """Record that the edit with this number was undone.

        Raises:
            OutputError: If the file cannot be written.
        """
        self._file.append(UNDO, number)
        self._step(False, number)

    def redo(self, number: int) -> None:
        """Record that the edit with this number was redone.

        Raises:
            OutputError: If the file cannot be written.
        """
        self._file.append(REDO, number)
        self._step(True, number)

    def _step(self, is_done: bool, number: int) -> None:
        self.is_done[number:] = [is_done, *self.is_done[number + 1 :]]
        self.steps.append((is_done, number))

    def _read(self) -> None:
        size = self.path.stat().st_size
        if size > MAX_JOURNAL_BYTES:
            most = f"the limit is {MAX_JOURNAL_BYTES:,}"
            raise LimitError(self.path, f"has {size:,} bytes; {most}")
        for record, packed in self._file.scan():
            if not record.is_whole:
                raise DamagedFileError(self.path, f"is damaged at byte {record.at}")
            self._replay(*self._file.unpack(packed))

    def _replay(self, verb: bytes, number: int, rest: bytes) -> None:
        if verb == DO and number == len(self.edits):
            self.edits.append(unpack_edit(rest, self.path))
        elif verb not in (UNDO, REDO) or number >= len(self.edits):
            raise DamagedFileError(self.path, f"contains a record of edit {number} out of order")
        self._step(verb != UNDO, number)


def write_journal(path: str | Path, edits: Sequence[BlockEdit]) -> None:
    """Write a journal of applied edits atomically.

    Raises:
        OutputError: If the file cannot be written.
    """
    records = [pack_record(DO, number, pack_edit(edit)) for number, edit in enumerate(edits)]
    write_bytes(path, MARK + b"".join(records))


def write_edits(build: Path, edits: Sequence[BlockEdit]) -> None:
    """Write the repairs of a build to its folder, replacing those of an earlier build.

    Raises:
        OutputError: If the folder cannot be written.
    """
    path = build / EDITS_FILE
    if edits:
        write_journal(path, edits)
        return
    try:
        path.unlink(missing_ok=True)
    except OSError as error:
        raise OutputError(path, f"cannot be removed: {error.strerror or error}") from error
