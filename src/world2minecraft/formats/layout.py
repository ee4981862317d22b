"""``layout.json``: the rooms of a place with their outlines and openings.

The file is a list of ``{name, floor_polygon_m, floor_z_m, wall_height_m, openings}``. An opening is
``{kind, start_m, end_m, sill_m, head_m}``. A door also has ``hinge``, ``left`` or ``right`` as seen
from inside the room, and ``open``, whether its leaf stands open; files of former versions have
neither. Polygons are counter-clockwise seen from above. Sills, heads and wall heights are relative
to the floor of the room. Objects are in ``objects.json``.
"""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.errors import MALFORMED, DamagedFileError
from world2minecraft.core.files import read_json, write_json
from world2minecraft.core.types import Layout, OccupancyGrid, Opening
from world2minecraft.formats.scan_record import read_room_size


def write_layouts(path: str | Path, layouts: tuple[Layout, ...]) -> None:
    """Write rooms in the given order."""
    write_json(path, [layout_to_json(layout) for layout in layouts])


def read_layouts(path: str | Path) -> tuple[Layout, ...]:
    """Read rooms, which have no objects.

    Raises:
        InputError: If the file does not exist.
        DamagedFileError: If a row is not a valid room.
    """
    rows = read_json(path)
    if not isinstance(rows, list):
        raise DamagedFileError(path, f"must contain a list, got {type(rows).__name__}")
    layouts = []
    for number, row in enumerate(rows):
        try:
            layouts.append(layout_from_json(row))
        except MALFORMED as error:
            raise DamagedFileError(path, f"row {number} is not valid ({error})") from error
    return tuple(layouts)


def layout_to_json(layout: Layout) -> dict[str, Any]:
    """Return a room as JSON values without its objects."""
    return {
        "name": layout.name,
        "floor_polygon_m": _rounded(layout.floor_polygon_m),
        "floor_z_m": round(float(layout.floor_z_m), 4),
        "wall_height_m": round(float(layout.wall_height_m), 4),
        "openings": [_opening_to_json(opening) for opening in layout.openings],
    }


def _opening_to_json(opening: Opening) -> dict[str, Any]:
    row = {
        "kind": opening.kind,
        "start_m": _rounded(opening.start_m),
        "end_m": _rounded(opening.end_m),
        "sill_m": round(float(opening.sill_m), 4),
        "head_m": round(float(opening.head_m), 4),
    }
    if opening.hinge is None:
        return row
    return row | {"hinge": opening.hinge, "open": opening.is_open}


def layout_from_json(row: dict[str, Any]) -> Layout:
    """Return a room from JSON values.

    Raises:
        KeyError: If a field is missing.
        TypeError: If a field has the wrong type.
        ValueError: If a field has an invalid value.
    """
    return Layout(
        floor_polygon_m=row["floor_polygon_m"],
        wall_height_m=float(row["wall_height_m"]),
        openings=tuple(
            Opening(
                o["kind"],
                o["start_m"],
                o["end_m"],
                float(o["sill_m"]),
                float(o["head_m"]),
                o.get("hinge"),
                o.get("open", False),
            )
            for o in row["openings"]
        ),
        floor_z_m=float(row["floor_z_m"]),
        name=str(row["name"]),
    )


def _rounded(values: np.ndarray) -> list:
    return np.round(np.asarray(values, np.float64), 4).tolist()


def read_rooms(folder: str | Path, grid: OccupancyGrid) -> tuple[Layout, ...]:
    """Return the rooms of a run folder, or an empty tuple if no file contains any.

    The rooms are read from ``layout.json``. If a run has no such file, or no outline was found, one
    room is read from ``scan.json``, with the size from the alignment of the capture.

    Args:
        folder: Folder of the run.
        grid: Cells of the run. If none of them is ceiling, the height of the rooms is that of the
            highest cells.

    Raises:
        DamagedFileError: If a file is damaged.
    """
    found, scan = Path(folder) / "layout.json", Path(folder) / "scan.json"
    rooms = read_layouts(found) if found.is_file() else ()
    if not rooms and scan.is_file():
        width, depth, height = read_room_size(scan).tolist()
        outline = np.array([[0, 0], [width, 0], [width, depth], [0, depth]], np.float64)
        rooms = (Layout(outline, height),)
    if (grid.labels == SemanticClass.CEILING).any():
        return rooms
    top_m = float(grid.origin_m[2] + grid.shape[2] * grid.voxel_m)
    return tuple(
        replace(room, wall_height_m=max(room.wall_height_m, top_m - room.floor_z_m))
        for room in rooms
    )
