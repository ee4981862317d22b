"""``room.npz``: an OccupancyGrid, and where it stands in the scan.

Arrays: ``labels``, ``confidence``, ``colour``, ``source``, ``instance`` as in OccupancyGrid;
``voxel_m`` float64; ``origin_m`` float64 [3]; ``scan_to_room`` float64 [4, 4].
"""

from pathlib import Path

import numpy as np

from world2minecraft.core.errors import DamagedFileError
from world2minecraft.core.files import read_npz, write_npz
from world2minecraft.core.types import OccupancyGrid

GRID_ARRAYS = ("labels", "confidence", "colour", "source", "instance", "voxel_m", "origin_m")


def write_room(path: str | Path, grid: OccupancyGrid, scan_to_room: np.ndarray) -> None:
    """Write a grid; the same grid gives the same bytes."""
    arrays = {name: np.asarray(getattr(grid, name)) for name in GRID_ARRAYS}
    write_npz(path, arrays | {"scan_to_room": np.asarray(scan_to_room, np.float64)})


def read_room(path: str | Path) -> tuple[OccupancyGrid, np.ndarray]:
    """Read a grid and its ``scan_to_room``.

    Raises:
        InputError: the file is missing. DamagedFileError: it holds no valid grid.
        LimitError: an array is too large.
    """
    arrays = read_npz(path, (*GRID_ARRAYS, "scan_to_room"))
    scan_to_room = arrays.pop("scan_to_room")
    try:
        arrays["voxel_m"] = float(arrays["voxel_m"])  # type: ignore[assignment]
        return OccupancyGrid(**arrays), np.asarray(scan_to_room, np.float64).reshape(4, 4)  # type: ignore[arg-type]
    except (ValueError, TypeError) as error:
        raise DamagedFileError(path, f"is no room ({error})") from error
