"""The rooms of a run, each as a Layout: its outline, its height and its floor.

They come from ``scan.json``: one room, as long, deep and high as the capture was aligned to.
"""

from pathlib import Path

import numpy as np

from world2minecraft.classes import SemanticClass
from world2minecraft.exchange.scan import read_room_size
from world2minecraft.types import Layout, OccupancyGrid


def read_rooms(folder: str | Path, grid: OccupancyGrid) -> tuple[Layout, ...]:
    """Return the rooms of a run's folder; none where it has no ``scan.json``.

    Args:
        folder: where the run's files lie.
        grid: its cells. Where none is ceiling, the room is as high as they reach.

    Raises:
        DamagedFileError: a file is not what it should be.
    """
    source = Path(folder) / "scan.json"
    if not source.is_file():
        return ()
    width, depth, height = read_room_size(source).tolist()
    if not (grid.labels == SemanticClass.CEILING).any():
        height = max(height, float(grid.origin_m[2] + grid.shape[2] * grid.voxel_m))
    outline = np.array([[0, 0], [width, 0], [width, depth], [0, depth]], np.float64)
    return (Layout(outline, height),)
