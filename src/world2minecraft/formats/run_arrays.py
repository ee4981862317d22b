"""Arrays of a run folder: ``room.npz``, ``evidence.npz`` and ``centers.npz``.

- ``room.npz``: an OccupancyGrid and its position in the scan: ``labels``, ``confidence``,
  ``colour``, ``source`` and ``instance`` as in OccupancyGrid; ``voxel_m`` float64; ``origin_m``
  float64 [3]; ``scan_to_room`` float64 [4, 4].
- ``evidence.npz``: FusedEvidence, which is sufficient to repeat the label stage and all later
  stages. Cells without votes use most of the memory, but compress to almost nothing.
- ``centers.npz``: the paper's D, C and C': ``density`` float32 [X, Y, Z]; ``candidates`` int32 [M,
  3], cells; ``cluster`` int32 [M], the cluster of each candidate, or -1 for none.
"""

from pathlib import Path

import numpy as np

from world2minecraft.core.errors import MALFORMED, DamagedFileError
from world2minecraft.core.files import read_npz, write_npz
from world2minecraft.core.types import FusedEvidence, OccupancyGrid, checks

GRID_ARRAYS = ("labels", "confidence", "colour", "source", "instance", "voxel_m", "origin_m")
EVIDENCE_ARRAYS = (
    "log_odds",
    "votes",
    "colour_sum",
    "offset_sum",
    "hits",
    "voxel_m",
    "origin_m",
    "scan_to_room",
)


def write_room(path: str | Path, grid: OccupancyGrid, scan_to_room: np.ndarray) -> None:
    """Write an occupancy grid. Equal grids give identical files."""
    arrays = {name: np.asarray(getattr(grid, name)) for name in GRID_ARRAYS}
    write_npz(path, arrays | {"scan_to_room": np.asarray(scan_to_room, np.float64)})


def read_room(path: str | Path) -> tuple[OccupancyGrid, np.ndarray]:
    """Read an occupancy grid and its ``scan_to_room`` transform.

    Raises:
        InputError: If the file does not exist.
        DamagedFileError: If the file does not contain a valid grid.
        LimitError: If an array is too large.
    """
    arrays = read_npz(path, (*GRID_ARRAYS, "scan_to_room"))
    scan_to_room = arrays.pop("scan_to_room")
    try:
        arrays["voxel_m"] = float(arrays["voxel_m"])  # type: ignore[assignment]
        return OccupancyGrid(**arrays), checks.transform("scan_to_room", scan_to_room)  # type: ignore[arg-type]
    except MALFORMED as error:
        raise DamagedFileError(path, f"does not contain a valid room ({error})") from error


def write_evidence(path: str | Path, evidence: FusedEvidence) -> None:
    """Write fused evidence. Equal evidence gives identical files."""
    write_npz(path, {name: np.asarray(getattr(evidence, name)) for name in EVIDENCE_ARRAYS})


def read_evidence(path: str | Path) -> FusedEvidence:
    """Read fused evidence.

    Raises:
        InputError: If the file does not exist.
        DamagedFileError: If the file does not contain valid evidence.
        LimitError: If an array is too large.
    """
    arrays = read_npz(path, EVIDENCE_ARRAYS)
    try:
        arrays["voxel_m"] = float(arrays["voxel_m"])  # type: ignore[assignment]
        return FusedEvidence(**arrays)  # type: ignore[arg-type]
    except MALFORMED as error:
        raise DamagedFileError(path, f"does not contain valid evidence ({error})") from error


def write_centers(
    path: str | Path, density: np.ndarray, candidates: np.ndarray, cluster: np.ndarray
) -> None:
    """Write the density map, the candidates and their clusters."""
    write_npz(
        path,
        {
            "density": density.astype(np.float32),
            "candidates": candidates.astype(np.int32),
            "cluster": cluster.astype(np.int32),
        },
    )
