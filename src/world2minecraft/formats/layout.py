"""``layout.json``: the rooms of a place, each with its outline and its openings.

A list of ``{name, floor_polygon_m, floor_z_m, wall_height_m, openings}``; an opening is ``{kind,
start_m, end_m, sill_m, head_m}``. Polygons run counter-clockwise from above; sills, heads and the
height of the walls count from the room's floor. Objects are in ``objects.json``.
"""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.files import read_json, write_json
from world2minecraft.core.types import Layout, OccupancyGrid, Opening
from world2minecraft.formats.scan_record import read_room_size


def write_layouts(path: str | Path, layouts: tuple[Layout, ...]) -> None:
    """Write the rooms, in the order given."""
    write_json(path, [layout_to_json(layout) for layout in layouts])


def read_layouts(path: str | Path) -> tuple[Layout, ...]:
    """Read the rooms; they have no objects.

    Raises:
        InputError: the file is missing. DamagedFileError: a row is no room.
    """
    rows = read_json(path)
    if not isinstance(rows, list):
        raise DamagedFileError(path, f"must hold a list, not {type(rows).__name__}")
    layouts = []
    for number, row in enumerate(rows):
        try:
            layouts.append(layout_from_json(row))
        except (KeyError, TypeError, ValueError, AttributeError) as error:
            raise DamagedFileError(path, f"row {number} is not valid ({error})") from error
    return tuple(layouts)


def layout_to_json(layout: Layout) -> dict[str, Any]:
    """Return a room as plain values, without its objects."""
    return {
        "name": layout.name,
        "floor_polygon_m": _rounded(layout.floor_polygon_m),
        "floor_z_m": round(float(layout.floor_z_m), 4),
        "wall_height_m": round(float(layout.wall_height_m), 4),
        "openings": [
            {
                "kind": opening.kind,
                "start_m": _rounded(opening.start_m),
                "end_m": _rounded(opening.end_m),
                "sill_m": round(float(opening.sill_m), 4),
                "head_m": round(float(opening.head_m), 4),
            }
            for opening in layout.openings
        ],
    }


def layout_from_json(row: dict[str, Any]) -> Layout:
    """Return the room of a row.

    Raises:
        KeyError, TypeError, ValueError: the row is no room.
    """
    return Layout(
        floor_polygon_m=row["floor_polygon_m"],
        wall_height_m=float(row["wall_height_m"]),
        openings=tuple(
            Opening(o["kind"], o["start_m"], o["end_m"], float(o["sill_m"]), float(o["head_m"]))
            for o in row["openings"]
        ),
        floor_z_m=float(row["floor_z_m"]),
        name=str(row["name"]),
    )


def _rounded(values: np.ndarray) -> list:
    return np.round(np.asarray(values, np.float64), 4).tolist()


def read_rooms(folder: str | Path, grid: OccupancyGrid) -> tuple[Layout, ...]:
    """Return the rooms of a run's folder, none where no file holds any.

    They come from ``layout.json``; where a run has none, or it found no outline, from
    ``scan.json``: one room, as long, deep and high as the capture was aligned to.

    Args:
        folder: where the run's files lie.
        grid: its cells. Where none is ceiling, the rooms are as high as they reach.

    Raises:
        DamagedFileError: a file is not what it should be.
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
