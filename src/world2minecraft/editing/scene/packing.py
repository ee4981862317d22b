"""An operation on a scene as bytes and back: an NBT tree of runs of cells and what they hold.

The bytes depend on what the operation does and nothing else: cells are sorted, and an array that
holds one value throughout is one value. Reading checks sizes against the scene's before it takes
memory.
"""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import DamagedFileError, UsageError
from world2minecraft.core.types import Alternative, GridCells, Operation, Placement, SceneObject
from world2minecraft.editing.scene.runs import cells_of_runs, runs_of_cells
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
            "before": _packed_cells(operation.before, order),
            "after": _packed_cells(operation.after, order),
            "objects_before": _packed_objects(operation.objects_before),
            "objects_after": _packed_objects(operation.objects_after),
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
            before=_unpacked_cells(root["before"], len(cells)),
            after=_unpacked_cells(root["after"], len(cells)),
            objects_before=tuple(map(_unpacked_object, root["objects_before"])),
            objects_after=tuple(map(_unpacked_object, root["objects_after"])),
            counts_as=root["counts_as"],
            class_id=None if root["class_id"] < 0 else int(root["class_id"]),
            actor=str(root["actor"]),
            time_s=float(root["time_s"]),
        )
    except (KeyError, TypeError, ValueError, AttributeError, UsageError) as error:
        raise DamagedFileError(path, f"holds no operation on a scene ({error})") from error


def pack_objects(objects: Iterable[SceneObject]) -> bytes:
    """Return objects as NBT, not compressed, exact to the last bit."""
    return write_nbt({"objects": _packed_objects(objects)})


def unpack_objects(data: bytes, path: str | Path) -> tuple[SceneObject, ...]:
    """Return the objects that ``pack_objects`` made bytes of.

    Raises:
        DamagedFileError: the bytes are no objects. LimitError: they ask for too much.
    """
    _, root = read_nbt(data, path, OPERATION_LIMITS)
    try:
        return tuple(map(_unpacked_object, root["objects"]))
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise DamagedFileError(path, f"holds no objects of a scene ({error})") from error


def _packed_cells(held: GridCells, order: np.ndarray | None) -> dict[str, np.ndarray]:
    return {
        name: _packed_array(getattr(held, name) if order is None else getattr(held, name)[order])
        for name in _ARRAYS
    }


def _packed_array(values: np.ndarray) -> np.ndarray:
    same = len(values) > 1 and (values[1:] == values[0]).all()
    kept = np.ascontiguousarray(values[:1] if same else values)
    little = kept.astype(kept.dtype.newbyteorder("<"), copy=False)
    return little.reshape(-1).view(np.int8)


def _unpacked_cells(held: Mapping[str, Any], count: int) -> GridCells:
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


def _packed_objects(objects: Iterable[SceneObject]) -> list[dict[str, Any]]:
    return [
        {
            "id": one.id,
            "class_id": one.class_id,
            "box": [*map(float, one.center_m), *map(float, one.size_m), float(one.yaw_deg)],
            "confidence": float(one.confidence),
            "placements": [_packed_placement(placed) for placed in one.placements],
        }
        for one in objects
    ]


def _packed_placement(placed: Placement) -> dict[str, Any]:
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


def _unpacked_object(held: Mapping[str, Any]) -> SceneObject:
    number, class_id = int(held["id"]), int(held["class_id"])
    box = _numbers(held["box"], 7)
    placed = tuple(_unpacked_placement(number, class_id, one) for one in held["placements"])
    confidence = float(held["confidence"])
    return SceneObject(number, class_id, box[:3], box[3:6], float(box[6]), confidence, placed)


def _unpacked_placement(number: int, class_id: int, held: Mapping[str, Any]) -> Placement:
    box = _numbers(held["box"], 6)
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


def _numbers(values: Sequence[Any], count: int) -> np.ndarray:
    if len(values) != count:
        raise ValueError(f"a box of {len(values)} numbers, not {count}")
    return np.array(values, np.float64)
