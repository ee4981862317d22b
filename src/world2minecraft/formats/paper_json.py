"""``occ.json`` and ``centers.json``: the two files that the paper's SceneForge reads.

The paper prints no schema, so this one is our own, with one JSON object per file:

- ``occ.json``: ``{"format": "world2minecraft/occ", "version": 1, "voxel_m", "origin_m": [x, y, z],
  "shape": [X, Y, Z], "classes": [12 names], "voxels": [[x, y, z, class], ...]}``. It contains only
  occupied cells, sorted. The centre of cell i is ``origin_m + (i + 0.5) * voxel_m``.
- ``centers.json``: ``{"format": "world2minecraft/centers", "version": 1, "centers": [{"id",
  "class", "class_id", "position_m": [x, y, z], "voxels"}]}``. ``voxels`` is the number of cells.
"""

import json
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.core.classes import CLASS_NAMES
from world2minecraft.core.errors import MALFORMED, DamagedFileError, LimitError
from world2minecraft.core.files import read_json, write_text
from world2minecraft.core.types import OBSERVED, ObjectInstance, OccupancyGrid, checks

MAX_CELLS = 200_000_000
_CHUNK = 1 << 18  # Rows that are made into text at once.


def write_occ_json(path: str | Path, grid: OccupancyGrid) -> None:
    """Write the occupied cells of a grid, one voxel per line."""
    cells = np.argwhere(grid.occupied)
    rows = np.column_stack([cells, grid.labels[tuple(cells.T)]])
    head = (
        f'"format":"world2minecraft/occ","version":1,"voxel_m":{grid.voxel_m},'
        f'"origin_m":{[round(float(v), 6) for v in grid.origin_m]},"shape":{list(grid.shape)},'
        f'"classes":{list(CLASS_NAMES)}'
    ).replace("'", '"')
    parts = (_lines(rows[at : at + _CHUNK]) for at in range(0, len(rows), _CHUNK))
    voxels = "".join(parts).removesuffix(",\n")
    write_text(path, f'{{{head},"voxels":[\n{voxels}\n]}}\n')


def _lines(rows: np.ndarray) -> str:
    """Return ``[x,y,z,class],`` and a line feed for each row, int [N, 4], with no negative value.

    All digits are written by array operations: four million voxels take one second, not twenty.
    """
    digits = len(str(rows.max()))
    powers = 10 ** np.arange(digits)[::-1]
    numbers = np.full((len(rows), 4, digits + 1), ord(","), np.uint8)
    numbers[..., :digits] = rows[..., None] // powers % 10 + ord("0")
    is_shown = np.ones(numbers.shape, bool)
    is_shown[..., : digits - 1] = rows[..., None] >= powers[:-1]
    numbers[:, -1, -1] = ord("]")
    ends = np.ones((len(rows), 1), np.uint8)
    text = np.hstack([ends * ord("["), numbers.reshape(len(rows), -1), ends * ord(","), ends * 10])
    shown = np.hstack([ends, is_shown.reshape(len(rows), -1), ends, ends]).astype(bool)
    return text[shown].tobytes().decode()


def read_occ_json(path: str | Path) -> OccupancyGrid:
    """Read ``occ.json``. Cells that are not listed are empty.

    Raises:
        DamagedFileError: If the file is not valid in the format.
        LimitError: If the shape is too large.
    """
    value = read_json(path)
    try:
        shape = tuple(int(side) for side in value["shape"])
        voxels = np.array(value["voxels"], np.int64).reshape(-1, 4)
        voxel_m, origin_m = float(value["voxel_m"]), np.array(value["origin_m"], np.float64)
        checks.voxel_size(voxel_m)
        checks.extent(shape, voxel_m)
        origin_m = checks.coordinates("origin_m", origin_m, (3,))
    except MALFORMED as error:
        raise DamagedFileError(
            path, f"is not an occ.json file of this program ({error})"
        ) from error
    _check_voxels(path, shape, voxels)
    labels = np.zeros(shape, np.uint8)
    labels[tuple(voxels[:, :3].T)] = voxels[:, 3]
    source = np.full(shape, OBSERVED, np.uint8)
    return OccupancyGrid(
        labels=labels,
        confidence=np.ones(shape, np.float16),
        colour=np.zeros((*shape, 3), np.uint8),
        source=source,
        instance=np.zeros(shape, np.uint16),
        voxel_m=voxel_m,
        origin_m=np.round(origin_m / voxel_m) * voxel_m,
    )


def _check_voxels(path: str | Path, shape: tuple[int, ...], voxels: np.ndarray) -> None:
    if len(shape) != 3 or min(shape) < 1:
        raise DamagedFileError(path, f"shape must be three sizes, got {list(shape)}")
    if np.prod(np.array(shape, np.float64)) > MAX_CELLS:
        raise LimitError(path, f"shape {list(shape)} exceeds the limit of {MAX_CELLS:,} cells")
    inside = ((voxels[:, :3] >= 0) & (voxels[:, :3] < shape)).all()
    if len(voxels) and not (inside and (voxels[:, 3] >= 1).all() and (voxels[:, 3] <= 11).all()):
        raise DamagedFileError(
            path, "a voxel is outside the shape or has a class other than 1 to 11"
        )


def write_centers_json(path: str | Path, instances: tuple[ObjectInstance, ...]) -> None:
    """Write one centre per object."""
    rows: list[dict[str, Any]] = [
        {
            "id": instance.id,
            "class": CLASS_NAMES[instance.class_id],
            "class_id": instance.class_id,
            "position_m": [round(float(v), 4) for v in instance.center_m],
            "voxels": len(instance.cells),
        }
        for instance in instances
    ]
    body = ",\n".join(_line(row) for row in rows)
    write_text(path, f'{{"format":"world2minecraft/centers","version":1,"centers":[\n{body}\n]}}\n')


def _line(row: dict[str, Any]) -> str:
    return json.dumps(row, separators=(",", ":"))
