"""Reading and writing of generated rooms and houses as ``layout.json`` and ``truth.npz``.

The files may come from an untrusted source: sizes are checked before memory is allocated, and every
value is checked before it is used.
"""

import math
import zipfile
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.archives import UNREADABLE
from world2minecraft.core.classes import CLASS_COUNT, CLASS_NAMES, class_id
from world2minecraft.core.errors import DamagedFileError, InputError, LimitError, UnknownNameError
from world2minecraft.core.files import read_json, read_npz, write_json, write_npz
from world2minecraft.core.types import Layout, LayoutObject, Opening, checks
from world2minecraft.core.whole_reads import read_whole
from world2minecraft.formats.objects_and_placements import round_metres
from world2minecraft.procgen.rooms.room import Room

LAYOUT, TRUTH = "layout.json", "truth.npz"
ARRAYS = ("colour", "instance", "labels", "origin_m", "voxel_m")
MAX_CELLS = 400_000_000  # A house of 14 rooms on one storey has about 90 million.
BYTES_A_CELL = 6  # One of labels, two of instance, three of colour.
MAX_LAYOUTS, MAX_OBJECTS = 64, 65_535
MAX_LAYOUT_BYTES = 32 << 20
VOXEL_RANGE_M = (0.005, 0.5)


def write_generated(room: Room, folder: str | Path) -> None:
    """Write a generated room or house, which ``read_generated`` can read.

    Raises:
        OutputError: If the folder cannot be written.
    """
    arrays = {name: np.asarray(getattr(room, name)) for name in ARRAYS}
    write_npz(Path(folder) / TRUTH, arrays)
    write_json(
        Path(folder) / LAYOUT,
        {
            "kind": room.kind,
            "seed": room.seed,
            "size_m": round_metres(room.size_m),
            "layouts": [_stated(layout) for layout in room.layouts],
        },
    )


def read_generated(folder: str | Path) -> Room:
    """Read a generated room or house. Lengths are rounded to 0.1 mm in the files.

    Raises:
        InputError: If a file is missing.
        DamagedFileError: If a file is invalid.
        LimitError: If the room has more than ``MAX_CELLS`` cells.
        ConflictError: If another process is changing the folder.
    """
    return read_whole(Path(folder), lambda: _read(Path(folder)))


def _read(folder: Path) -> Room:
    path, truth = folder / LAYOUT, folder / TRUTH
    if not path.is_file():
        raise InputError(path, "not found; create the folder with `w2m rooms generate --out DIR`")
    stated = read_json(path, MAX_LAYOUT_BYTES)
    try:
        kind, seed = str(stated["kind"]), int(stated["seed"])
        layouts = _layouts(stated["layouts"])
    except (KeyError, TypeError, ValueError, OverflowError, AttributeError, UnknownNameError) as e:
        raise DamagedFileError(path, f"is not a valid room layout ({e})") from e
    _check_declared(truth)
    arrays = read_npz(truth, ARRAYS)
    _check_arrays(truth, arrays, sum(len(layout.objects) for layout in layouts))
    return Room(
        kind=kind,
        seed=seed,
        layouts=layouts,
        labels=arrays["labels"],
        instance=arrays["instance"],
        colour=arrays["colour"],
        voxel_m=float(arrays["voxel_m"]),
        origin_m=arrays["origin_m"],
    )


def layout_to_json(layout: Layout) -> dict[str, Any]:
    """Return the name, the floor, the height and the openings of a layout as JSON values."""
    return {
        "name": layout.name,
        "floor_z_m": round(layout.floor_z_m, 4),
        "wall_height_m": round(layout.wall_height_m, 4),
        "floor_polygon_m": [round_metres(corner) for corner in layout.floor_polygon_m],
        "openings": [
            {
                "kind": opening.kind,
                "start_m": round_metres(opening.start_m),
                "end_m": round_metres(opening.end_m),
                "sill_m": round(opening.sill_m, 4),
                "head_m": round(opening.head_m, 4),
            }
            for opening in layout.openings
        ],
    }


def _stated(layout: Layout) -> dict[str, Any]:
    return {
        **layout_to_json(layout),
        "objects": [
            {
                "class": CLASS_NAMES[item.class_id],
                "name": item.name,
                "center_m": round_metres(item.center_m),
                "size_m": round_metres(item.size_m),
                "yaw_deg": round(item.yaw_deg, 4),
            }
            for item in layout.objects
        ],
    }


def _layouts(rows: Any) -> tuple[Layout, ...]:
    if not isinstance(rows, list) or not 1 <= len(rows) <= MAX_LAYOUTS:
        raise ValueError(f"layouts must be a list of 1 to {MAX_LAYOUTS} rooms")
    if sum(len(row["objects"]) for row in rows) > MAX_OBJECTS:
        raise ValueError(f"objects exceed the limit of {MAX_OBJECTS:,}")
    return tuple(_layout(row) for row in rows)


def _layout(row: dict[str, Any]) -> Layout:
    openings = tuple(
        Opening(o["kind"], o["start_m"], o["end_m"], float(o["sill_m"]), float(o["head_m"]))
        for o in row["openings"]
    )
    objects = tuple(
        LayoutObject(
            class_id(o["class"]), o["center_m"], o["size_m"], float(o["yaw_deg"]), str(o["name"])
        )
        for o in row["objects"]
    )
    return Layout(
        floor_polygon_m=np.array(row["floor_polygon_m"], np.float64),
        wall_height_m=float(row["wall_height_m"]),
        openings=openings,
        objects=objects,
        floor_z_m=float(row["floor_z_m"]),
        name=str(row["name"]),
    )


def _check_declared(path: Path) -> None:
    """Check the declared size of the arrays in a file before they are read."""
    if not path.is_file():
        raise InputError(path, "not found; it must be in the same folder as layout.json")
    try:
        with zipfile.ZipFile(path) as archive:
            declared = sum(entry.file_size for entry in archive.infolist())
    except UNREADABLE as error:
        raise DamagedFileError(path, f"is not a valid .npz file ({error})") from error
    if declared > MAX_CELLS * BYTES_A_CELL:
        raise LimitError(
            path, f"has {declared:,} bytes, which exceeds the limit of {MAX_CELLS:,} cells"
        )


def _check_arrays(path: Path, arrays: dict[str, np.ndarray], objects: int) -> None:
    labels, instance, colour = (arrays[name] for name in ("labels", "instance", "colour"))
    wanted = (
        (labels, np.uint8, labels.shape if labels.ndim == 3 and labels.size else None, "labels"),
        (instance, np.uint16, labels.shape, "instance"),
        (colour, np.uint8, (*labels.shape, 3), "colour"),
        (arrays["origin_m"], np.float64, (3,), "origin_m"),
        (arrays["voxel_m"], np.float64, (), "voxel_m"),
    )
    for values, dtype, shape, name in wanted:
        if values.dtype != dtype or values.shape != shape:
            given = f"{values.dtype} {values.shape}"
            raise DamagedFileError(path, f"array {name} has an invalid dtype or shape: {given}")
    voxel_m = float(arrays["voxel_m"])
    try:
        checks.coordinates("origin_m", arrays["origin_m"], (3,))
        checks.extent(labels.shape, voxel_m)
    except ValueError as error:
        raise DamagedFileError(path, str(error)) from error
    if not math.isfinite(voxel_m) or not VOXEL_RANGE_M[0] <= voxel_m <= VOXEL_RANGE_M[1]:
        raise DamagedFileError(path, f"voxel_m must be from 0.005 to 0.5, got {voxel_m}")
    if labels.max() >= CLASS_COUNT:
        raise DamagedFileError(path, f"labels must be below {CLASS_COUNT}, got {labels.max()}")
    if instance.max() > objects:
        raise DamagedFileError(
            path,
            f"instance must be at most {objects} (the number of objects), got {instance.max()}",
        )
