"""The journal of a scene: a log of its history on disk that survives a kill.

A file of records (``record_log``). The first has the verb ``@``: its number is the revision at
which the journal starts, followed by the name of its generation and a line feed. Each further
record is a step and raises the revision by one: ``+`` an operation with its number, its kind and
the operation itself; ``-`` and ``*`` that the operation of this number was undone or redone, with
who did so and when. Operations stay on the disk; memory holds their positions.

An operation is stored as an NBT tree of runs of cells and what they hold. The bytes depend on the
operation alone: cells are sorted, and an array of one repeated value is stored as that value.
Reading checks sizes against those of the scene before it allocates memory.
"""

import json
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from world2minecraft.core.errors import DamagedFileError, UsageError
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
    """Return an operation on a grid of a shape as NBT, not compressed."""
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
    """Return the operation that ``pack_operation`` made bytes of; its cells are in C order.

    Args:
        data: the bytes.
        shape: of the grid it was done to.
        path: the file that errors name.

    Raises:
        DamagedFileError: the bytes are no operation on such a grid. LimitError: they ask for too
        much.
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
    except (KeyError, TypeError, ValueError, AttributeError, UsageError) as error:
        raise DamagedFileError(path, f"holds no operation on a scene ({error})") from error


def pack_objects(objects: Iterable[SceneObject]) -> bytes:
    """Return objects as NBT, not compressed, exact to the last bit."""
    return write_nbt({"objects": _pack_objects(objects)})


def unpack_objects(data: bytes, path: str | Path) -> tuple[SceneObject, ...]:
    """Return the objects that ``pack_objects`` made bytes of.

    Raises:
        DamagedFileError: the bytes are no objects. LimitError: they ask for too much.
    """
    _, root = read_nbt(data, path, OPERATION_LIMITS)
    try:
        return tuple(map(_unpack_object, root["objects"]))
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise DamagedFileError(path, f"holds no objects of a scene ({error})") from error


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
            raise ValueError(f"{name} is of {len(rows)} cells, not {count}")
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
    return SceneObject(number, class_id, box[:3], box[3:6], float(box[6]), confidence, placed)


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
        raise ValueError(f"a box of {len(values)} numbers, not {count}")
    return np.array(values, np.float64)


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
            self._add_record(record, packed)

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
        self._append_turn(UNDO, number, actor, time_s)

    def redo(self, number: int, actor: str = "", time_s: float = 0.0) -> None:
        """Keep that an operation was done again. Raises OutputError."""
        self._append_turn(REDO, number, actor, time_s)

    def operation(self, number: int) -> Operation:
        """Return an operation, read from the disk.

        Raises:
            DamagedFileError: its bytes are not those that were written.
        """
        if number not in self._places:
            raise DamagedFileError(self.file.path, f"has lost edit {number}")
        _, _, content = self.file.unpack(self.file.read(self._places[number]))
        packed = content.partition(b"\n")[2]
        return unpack_operation(packed, self.shape, self.file.path)

    def author_of(self, step: Step) -> tuple[str, float]:
        """Return who took a step of undo or redo, and when, in seconds since 1970."""
        _, _, content = self.file.unpack(self.file.read(step.record))
        try:
            actor, time_s = json.loads(content or b'["", 0]')
            return str(actor), float(time_s)
        except (ValueError, TypeError) as error:
            raise DamagedFileError(self.file.path, f"has a step that is none ({error})") from error

    def line_after(self, line: Timeline, steps: Sequence[Step]) -> Timeline:
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
                raise DamagedFileError(self.file.path, "begins a second time")
            self.generation, self.start = word, number
            return
        if verb not in (DO, UNDO, REDO):
            raise DamagedFileError(self.file.path, f"has a record of the unknown kind {verb!r}")
        if verb == DO:
            self._place(number, record)
        self.steps.append(Step(verb, number, word if verb == DO else "", record))
