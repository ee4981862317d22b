"""The rooms of a run, each as a Layout: its outline, its height, its floor and its openings.

They come from ``layout.json``; where a run has none, or it found no outline, from ``scan.json``:
one room, as long, deep and high as the capture was aligned to.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import Layout, OccupancyGrid
from world2minecraft.formats.layout import read_layouts
from world2minecraft.formats.scan import read_room_size


def read_rooms(folder: str | Path, grid: OccupancyGrid) -> tuple[Layout, ...]:
    """Return the rooms of a run's folder; none where nothing tells of them.

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
