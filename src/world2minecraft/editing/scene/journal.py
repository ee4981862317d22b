"""The journal of a scene: its history as a file that survives a kill.

The journal is a file of records (see ``record_log``). The first record has the verb ``@``. Its
number is the revision at which the journal starts, and its content is the name of its generation
and a line feed. Each further record is a step that increases the revision by one: ``+`` with the
number, the kind and the content of an operation, or ``-`` and ``*`` for an operation that was
undone or redone, with the user and the time. Operations are read from the disk when needed, and
only their positions are kept in memory.

An operation is stored as an NBT tree of runs of cells and their contents. The bytes depend only on
the operation: cells are sorted, and an array of one repeated value is stored as that value. Sizes
are checked against the scene before memory is allocated.
"""

import json
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from world2minecraft.core.errors import MALFORMED, DamagedFileError, UsageError
from world2minecraft.core.types import Alternative, GridCells, Operation, Placement, SceneObject
from world2minecraft.editing.record_log import Record, RecordFile
from world2minecraft.editing.scene.cell_patch import cells_of_runs, runs_of_cells
from world2minecraft.editing.scene.history import Timeline
from world2minecraft.minecraft.nbt import NbtLimits, read_nbt, write_nbt

OPERATION_LIMITS = NbtLimits(depth=12, values=4_000_000, bytes=1 << 30)
Shape = tuple[int, int, int]
# Fields of GridCells, the bytes of one cell and how they are read.
_ARRAYS = {
    "labels": np.dtype("u1"),
    "confidence": np.dtype("<f2"),
    "colour": np.dtype("u1"),
    "source": np.dtype("u1"),
    "instance": np.dtype("<u2"),
}
MARK = b"w2m scene 1\n"
START, DO, UNDO, REDO = b"@", b"+", b"-", b"*"
_KIND = 1024  # Bytes in which a kind ends: 200 characters of any alphabet.


def pack_operation(operation: Operation, shape: Shape) -> bytes:
    """Return an operation on a grid with the given shape as uncompressed NBT."""
    flat = np.ravel_multi_index(tuple(operation.cells.T), shape)
    order = None if (np.diff(flat) > 0).all() else np.argsort(flat)
    return write_nbt(
        {
            "kind": operation.kind,
            "counts_as": operation.counts_as,
            "class_id": -1 if operation.class_id is None else operation.class_id,
            "actor": operation.actor,
            "time_s": float(operation.time_s),
            "runs": runs_of_cells(operation.cells, shape).astype(np.int32).ravel(),
            "before": _pack_cells(operation.before, order),
            "after": _pack_cells(operation.after, order),
            "objects_before": _pack_objects(operation.objects_before),
            "objects_after": _pack_objects(operation.objects_after),
        }
    )


def unpack_operation(data: bytes, shape: Shape, path: str | Path) -> Operation:
    """Parse an operation written by ``pack_operation``. Its cells are in C order.

    Args:
        data: Bytes of the operation.
        shape: Shape of the grid.
        path: File to name in errors.

    Raises:
        DamagedFileError: If the bytes are not a valid operation on such a grid.
        LimitError: If the operation is too large.
    """
    _, root = read_nbt(data, path, OPERATION_LIMITS)
    try:
        cells = cells_of_runs(np.asarray(root["runs"], np.int32).reshape(-1, 2), shape)  # type: ignore[arg-type]
        return Operation(
            kind=root["kind"],
            cells=cells,
            before=_unpack_cells(root["before"], len(cells)),
            after=_unpack_cells(root["after"], len(cells)),
            objects_before=tuple(map(_unpack_object, root["objects_before"])),
            objects_after=tuple(map(_unpack_object, root["objects_after"])),
            counts_as=root["counts_as"],
            class_id=None if root["class_id"] < 0 else int(root["class_id"]),
            actor=str(root["actor"]),
            time_s=float(root["time_s"]),
        )
    except (*MALFORMED, UsageError) as error:
        raise DamagedFileError(
            path, f"does not contain a valid scene operation ({error})"
        ) from error


def pack_objects(objects: Iterable[SceneObject]) -> bytes:
    """Return objects as uncompressed NBT, with exact floating-point values."""
    return write_nbt({"objects": _pack_objects(objects)})


def unpack_objects(data: bytes, path: str | Path) -> tuple[SceneObject, ...]:
    """Parse objects written by ``pack_objects``.

    Raises:
        DamagedFileError: If the bytes are not valid objects.
        LimitError: If the objects are too large.
    """
    _, root = read_nbt(data, path, OPERATION_LIMITS)
    try:
        return tuple(map(_unpack_object, root["objects"]))
    except MALFORMED as error:
        raise DamagedFileError(path, f"does not contain valid scene objects ({error})") from error


def _pack_cells(held: GridCells, order: np.ndarray | None) -> dict[str, np.ndarray]:
    return {
        name: _pack_array(getattr(held, name) if order is None else getattr(held, name)[order])
        for name in _ARRAYS
    }


def _pack_array(values: np.ndarray) -> np.ndarray:
    same = len(values) > 1 and (values[1:] == values[0]).all()
    kept = np.ascontiguousarray(values[:1] if same else values)
    little = kept.astype(kept.dtype.newbyteorder("<"), copy=False)
    return little.reshape(-1).view(np.int8)


def _unpack_cells(held: Mapping[str, Any], count: int) -> GridCells:
    arrays = {}
    for name, dtype in _ARRAYS.items():
        values = np.asarray(held[name], np.int8).view(dtype).astype(dtype.newbyteorder("="))
        rows = values.reshape(-1, 3) if name == "colour" else values
        if len(rows) == 1 and count:
            rows = np.repeat(rows, count, axis=0)
        arrays[name] = rows
        if len(rows) != count:
            raise ValueError(f"{name} must have {count} cells, got {len(rows)}")
    return GridCells(**arrays)


def _pack_objects(objects: Iterable[SceneObject]) -> list[dict[str, Any]]:
    return [
        {
            "id": one.id,
            "class_id": one.class_id,
            "box": [*map(float, one.center_m), *map(float, one.size_m), float(one.yaw_deg)],
            "confidence": float(one.confidence),
            "placements": [_pack_placement(placed) for placed in one.placements],
        }
        | ({"name": one.name, "name_confidence": float(one.name_confidence)} if one.name else {})
        for one in objects
    ]


def _pack_placement(placed: Placement) -> dict[str, Any]:
    return {
        "template": placed.template,
        "box": [*map(float, placed.center_m), *map(float, placed.size_m)],
        "quarter_turns": int(placed.quarter_turns),
        "iou": float(placed.iou),
        "parameters": {name: float(value) for name, value in placed.parameters.items()},
        "alternatives": [
            {"template": a.template, "quarter_turns": int(a.quarter_turns), "iou": float(a.iou)}
            for a in placed.alternatives
        ],
    }


def _unpack_object(held: Mapping[str, Any]) -> SceneObject:
    number, class_id = int(held["id"]), int(held["class_id"])
    box = _as_floats(held["box"], 7)
    placed = tuple(_unpack_placement(number, class_id, one) for one in held["placements"])
    confidence = float(held["confidence"])
    named = (str(held.get("name", "")), float(held.get("name_confidence", 0.0)))
    fields = (box[:3], box[3:6], float(box[6]), confidence, placed)
    return SceneObject(number, class_id, *fields, *named)


def _unpack_placement(number: int, class_id: int, held: Mapping[str, Any]) -> Placement:
    box = _as_floats(held["box"], 6)
    return Placement(
        number,
        class_id,
        str(held["template"]),
        box[:3],
        box[3:],
        int(held["quarter_turns"]),
        float(held["iou"]),
        {str(name): float(value) for name, value in held["parameters"].items()},
        tuple(
            Alternative(str(a["template"]), int(a["quarter_turns"]), float(a["iou"]))
            for a in held["alternatives"]
        ),
    )


def _as_floats(values: Sequence[Any], count: int) -> np.ndarray:
    if len(values) != count:
        raise ValueError(f"a box must have {count} numbers, got {len(values)}")
    return np.array(values, np.float64)


class Step(NamedTuple):
    """A record of the journal. ``kind`` is empty if the record is damaged."""

    verb: bytes
    number: int
    kind: str
    record: Record


class SceneJournal:
    """The steps since revision ``start``, and their operations.

    ``steps`` contains all steps. A step with a damaged record has the verb ``b""``. ``generation``
    is the name of the journal's generation, or empty if the journal has not been started.
    """

    def __init__(self, path: str | Path, shape: tuple[int, int, int]):
        """Read the positions of the records in a journal. A missing file is an empty journal.

        Args:
            path: Path of the journal.
            shape: Shape of the scene's grid.

        Raises:
            DamagedFileError: If the file is not a valid journal.
            InputError: If the file cannot be read.
        """
        self.file = RecordFile(path, MARK, OPERATION_LIMITS.bytes, "journal of a scene")
        self.shape, self.start, self.generation = shape, 0, ""
        self.steps: list[Step] = []
        self._places: dict[int, Record] = {}
        self._next = 0
        for record, packed in self.file.scan():
            self._add_record(record, packed)

    @property
    def rev(self) -> int:
        """The revision after the last step."""
        return self.start + len(self.steps)

    def begin(self, generation: str, start: int = 0) -> None:
        """Write the first record of a new journal.

        Raises:
            OutputError: If the file cannot be written.
        """
        self.file.append(START, start, f"{generation}\n".encode())
        self.generation, self.start = generation, start

    def do(self, operation: Operation) -> int:
        """Record an applied operation and return its number.

        Raises:
            OutputError: If the file cannot be written.
        """
        number = self._next
        kind = operation.kind.encode() + b"\n"
        record = self.file.append(DO, number, kind + pack_operation(operation, self.shape))
        self._place(number, record)
        self.steps.append(Step(DO, number, operation.kind, record))
        return number

    def undo(self, number: int, actor: str = "", time_s: float = 0.0) -> None:
        """Record that an operation was undone.

        Raises:
            OutputError: If the file cannot be written.
        """
        self._append_turn(UNDO, number, actor, time_s)

    def redo(self, number: int, actor: str = "", time_s: float = 0.0) -> None:
        """Record that an operation was redone.

        Raises:
            OutputError: If the file cannot be written.
        """
        self._append_turn(REDO, number, actor, time_s)

    def operation(self, number: int) -> Operation:
        """Read an operation from the file.

        Raises:
            DamagedFileError: If the record is damaged.
        """
        if number not in self._places:
            raise DamagedFileError(self.file.path, f"does not contain edit {number}")
        _, _, content = self.file.unpack(self.file.read(self._places[number]))
        packed = content.partition(b"\n")[2]
        return unpack_operation(packed, self.shape, self.file.path)

    def author_of(self, step: Step) -> tuple[str, float]:
        """Return the user and time, in seconds since 1970, of an undo or redo step."""
        _, _, content = self.file.unpack(self.file.read(step.record))
        try:
            actor, time_s = json.loads(content or b'["", 0]')
            return str(actor), float(time_s)
        except MALFORMED as error:
            raise DamagedFileError(self.file.path, f"contains an invalid step ({error})") from error

    def line_after(self, line: Timeline, steps: Sequence[Step]) -> Timeline:
        """Return a timeline after some undamaged steps.

        Raises:
            DamagedFileError: If the steps do not match the timeline.
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
                raise DamagedFileError(
                    self.file.path, f"contains an unexpected step of edit {step.number}"
                )
        return line

    def bytes_of(self, number: int) -> int:
        """Return the size of an operation in the file in bytes, or 0 if it does not exist."""
        record = self._places.get(number)
        return record.length if record else 0

    def _place(self, number: int, record: Record) -> None:
        self._places[number], self._next = record, number + 1

    def _append_turn(self, verb: bytes, number: int, actor: str, time_s: float) -> None:
        content = json.dumps([actor, time_s], separators=(",", ":")).encode()
        record = self.file.append(verb, number, content)
        self.steps.append(Step(verb, number, "", record))

    def _add_record(self, record: Record, packed: bytes) -> None:
        if not record.is_whole:
            self.steps.append(Step(b"", -1, "", record))
            return
        verb, number, content = self.file.unpack(packed, _KIND)
        word = content.partition(b"\n")[0].decode(errors="replace")
        if verb == START:
            if self.steps or self.generation:
                raise DamagedFileError(self.file.path, "contains a second start record")
            self.generation, self.start = word, number
            return
        if verb not in (DO, UNDO, REDO):
            raise DamagedFileError(self.file.path, f"contains a record of unknown type {verb!r}")
        if verb == DO:
            self._place(number, record)
        self.steps.append(Step(verb, number, word if verb == DO else "", record))
