"""Any occupancy file: ours, the paper's, or a bare array of class ids.

===================  ==========================================================================
``room.npz``         all arrays of OccupancyGrid
``*.npz``            ``labels`` uint8 [X, Y, Z]; optional ``voxel_m`` (0.08) and ``origin_m`` (0)
``*.npy``            the labels alone
``*.json``           ``occ.json``
===================  ==========================================================================
"""

from pathlib import Path

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.errors import DamagedFileError, InputError
from world2minecraft.core.files import array_names, read_npy, read_npz
from world2minecraft.core.types import OBSERVED, UNSEEN, OccupancyGrid
from world2minecraft.formats.paper_json import read_occ_json
from world2minecraft.formats.room import GRID_ARRAYS, read_room

DEFAULT_VOXEL_M = 0.08  # The paper's.


def read_occupancy(path: str | Path) -> OccupancyGrid:
    """Read a grid from any of the files above, found out by suffix and content.

    Raises:
        InputError: the file is missing or of another kind. DamagedFileError: it is not what its
        format says. LimitError: it is too large.
    """
    source = Path(path)
    if not source.is_file():
        raise InputError(source, "is not there; give a room.npz, occ.json, .npz or .npy of labels")
    if source.suffix == ".json":
        return read_occ_json(source)
    if source.suffix == ".npy":
        return labels_grid(read_npy(source), source)
    if source.suffix != ".npz":
        raise InputError(source, "is no occupancy file; those end with .npz, .npy or .json")
    held = array_names(source)
    if set(GRID_ARRAYS) <= set(held):
        return read_room(source)[0]
    wanted = ("labels", *(name for name in ("voxel_m", "origin_m") if name in held))
    arrays = read_npz(source, wanted)
    return labels_grid(
        arrays["labels"],
        source,
        float(arrays.get("voxel_m", DEFAULT_VOXEL_M)),
        np.asarray(arrays.get("origin_m", np.zeros(3)), np.float64),
    )


def labels_grid(
    labels: np.ndarray,
    source: str | Path = "labels",
    voxel_m: float = DEFAULT_VOXEL_M,
    origin_m: np.ndarray | None = None,
) -> OccupancyGrid:
    """Return a grid of labels alone: sure of everything, without colour.

    Raises:
        DamagedFileError: they are no [X, Y, Z] array of class ids.
    """
    try:
        whole = labels.astype(np.uint8)
        if not np.array_equal(whole, labels):
            raise ValueError("labels must be whole numbers, 0 to 11 or 255")
        known = whole != 255
        return OccupancyGrid(
            labels=whole,
            confidence=known.astype(np.float16),
            colour=np.zeros((*whole.shape, 3), np.uint8),
            source=np.where(known, OBSERVED, UNSEEN).astype(np.uint8),
            instance=np.zeros(whole.shape, np.uint16),
            voxel_m=voxel_m,
            origin_m=np.zeros(3) if origin_m is None else origin_m,
        )
    except (ValueError, TypeError) as error:
        raise DamagedFileError(source, f"holds no grid of class ids ({error})") from error


def inner_corner_m(grid: OccupancyGrid) -> np.ndarray:
    """Return the corner (x_min, y_max) of the room's inner box, float64 [2], whole cells.

    It is the inner face of the outermost wall layers; where there is no wall, the outermost
    occupied cells.
    """
    walls = np.equal(grid.labels, SemanticClass.WALL)
    occupied = grid.occupied
    x_cell = _inner_cell(walls.sum(axis=(1, 2)), np.asarray(occupied.any(axis=(1, 2))))
    y_cell = _inner_cell(walls.sum(axis=(0, 2))[::-1], np.asarray(occupied.any(axis=(0, 2)))[::-1])
    cells = np.array([x_cell, grid.shape[1] - y_cell])
    return np.round(grid.origin_m[:2] / grid.voxel_m + cells) * grid.voxel_m


def _inner_cell(wall_counts: np.ndarray, occupied: np.ndarray) -> int:
    """Return the first cell past the outermost large wall layer, or the first occupied cell."""
    half = len(wall_counts) // 2
    layers = np.flatnonzero(wall_counts[: half + 1] >= 0.5 * max(wall_counts.max(), 1))
    if len(layers):
        return int(layers[0]) + 1
    return int(occupied.argmax())
