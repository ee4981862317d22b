"""``layout.json``: the rooms of a place, each with its outline and its openings.

A list of ``{name, floor_polygon_m, floor_z_m, wall_height_m, openings}``; an opening is ``{kind,
start_m, end_m, sill_m, head_m}``. Polygons run counter-clockwise from above; sills, heads and the
height of the walls count from the room's floor. Objects are in ``objects.json``.
"""

from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.files import read_json, write_json
from world2minecraft.core.types import Layout, Opening


def write_layouts(path: str | Path, layouts: tuple[Layout, ...]) -> None:
    """Write the rooms, in the order given."""
    write_json(path, [layout_row(layout) for layout in layouts])


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
            layouts.append(layout_of_row(row))
        except (KeyError, TypeError, ValueError, AttributeError) as error:
            raise DamagedFileError(path, f"row {number} is not valid ({error})") from error
    return tuple(layouts)


def layout_row(layout: Layout) -> dict[str, Any]:
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


def layout_of_row(row: dict[str, Any]) -> Layout:
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
