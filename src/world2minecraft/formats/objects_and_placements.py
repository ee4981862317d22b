"""``objects.json`` and ``placements.json``: detected objects and their furniture templates.

``objects.json`` is a list of ``{id, class, center_m, size_m, yaw_deg, confidence}``, and if known
``name``, ``name_confidence`` and ``supported_by`` (an object id, floor, wall or ceiling). The cells
of an object are those in ``room.npz`` whose ``instance`` is its id. ``placements.json`` is a list
of ``{object_id, class, template, parameters, center_m, size_m, quarter_turns, iou, alternatives}``
and, for templates of named things, ``name``, which tells what the template shows.
"""

from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.classes import CLASS_NAMES, class_id
from world2minecraft.core.errors import MALFORMED, DamagedFileError, World2MinecraftError
from world2minecraft.core.files import read_json, write_json
from world2minecraft.core.types import Alternative, ObjectInstance, OccupancyGrid, Placement
from world2minecraft.core.vocabulary import read_vocabulary


def write_objects(path: str | Path, instances: tuple[ObjectInstance, ...]) -> None:
    """Write objects in the given order."""
    write_json(path, [_object_row(instance) for instance in instances])


def read_objects(path: str | Path, grid: OccupancyGrid) -> tuple[ObjectInstance, ...]:
    """Read objects, with their cells from the grid.

    Raises:
        InputError: If the file does not exist.
        DamagedFileError: If a row is not a valid object.
    """
    at = np.argwhere(grid.instance > 0).astype(np.int32)
    owners = grid.instance[tuple(at.T)]
    return tuple(_rows(path, lambda row: _object_of(row, at[owners == int(row["id"])])))


def write_placements(
    path: str | Path, placements: tuple[Placement, ...], *, named: bool = True
) -> None:
    """Write placements in the given order, with the names of what templates show if ``named``."""
    write_json(path, [_placement_row(placement, named) for placement in placements])


def read_placements(path: str | Path) -> tuple[Placement, ...]:
    """Read placements.

    Raises:
        InputError: If the file does not exist.
        DamagedFileError: If a row is not a valid placement.
    """
    return tuple(_rows(path, _placement_of))


def _object_row(instance: ObjectInstance) -> dict[str, Any]:
    row = {
        "id": instance.id,
        "class": CLASS_NAMES[instance.class_id],
        "center_m": round_metres(instance.center_m),
        "size_m": round_metres(instance.size_m),
        "yaw_deg": round(float(instance.yaw_deg), 3),
        "confidence": round(float(instance.confidence), 4),
    }
    if instance.name:
        row |= {
            "name": instance.name,
            "name_confidence": round(float(instance.name_confidence), 4),
        }
    if instance.supported_by:
        row["supported_by"] = instance.supported_by
    return row


def _object_of(row: dict[str, Any], cells: np.ndarray) -> ObjectInstance:
    return ObjectInstance(
        id=int(row["id"]),
        class_id=class_id(row["class"]),
        center_m=row["center_m"],
        size_m=row["size_m"],
        yaw_deg=float(row["yaw_deg"]),
        cells=cells,
        confidence=float(row["confidence"]),
        name=str(row.get("name", "")),
        name_confidence=float(row.get("name_confidence", 0.0)),
        supported_by=row.get("supported_by", ""),
    )


def _placement_row(placement: Placement, named: bool) -> dict[str, Any]:
    shown = read_vocabulary().of_template(placement.template) if named else None
    return ({"name": shown.name} if shown else {}) | {
        "object_id": placement.object_id,
        "class": CLASS_NAMES[placement.class_id],
        "template": placement.template,
        "parameters": {name: round(float(v), 4) for name, v in placement.parameters.items()},
        "center_m": round_metres(placement.center_m),
        "size_m": round_metres(placement.size_m),
        "quarter_turns": placement.quarter_turns,
        "iou": round(float(placement.iou), 4),
        "alternatives": [
            {"template": a.template, "quarter_turns": a.quarter_turns, "iou": round(a.iou, 4)}
            for a in placement.alternatives
        ],
    }


def _placement_of(row: dict[str, Any]) -> Placement:
    return Placement(
        object_id=int(row["object_id"]),
        class_id=class_id(row["class"]),
        template=str(row["template"]),
        center_m=row["center_m"],
        size_m=row["size_m"],
        quarter_turns=int(row["quarter_turns"]),
        iou=float(row["iou"]),
        parameters={str(name): float(v) for name, v in row["parameters"].items()},
        alternatives=tuple(
            Alternative(str(a["template"]), int(a["quarter_turns"]), float(a["iou"]))
            for a in row["alternatives"]
        ),
    )


def _rows(path: str | Path, reader):
    rows = read_json(path)
    if not isinstance(rows, list):
        raise DamagedFileError(path, f"must contain a list, got {type(rows).__name__}")
    for number, row in enumerate(rows):
        try:
            yield reader(row)
        except (*MALFORMED, World2MinecraftError) as error:
            raise DamagedFileError(path, f"row {number} is not valid ({error})") from error


def round_metres(values: np.ndarray) -> list[float]:
    """Return lengths in metres rounded to 0.1 mm for writing to files."""
    return [round(float(value), 4) for value in values]
