"""A check that a ground truth belongs to the room of a run."""

from pathlib import Path

import numpy as np
from scipy.ndimage import binary_dilation

from world2minecraft.core.classes import UNKNOWN
from world2minecraft.core.coordinates import apply, cell_centers_m, invert_rigid
from world2minecraft.core.errors import InputError
from world2minecraft.core.files import read_json
from world2minecraft.core.types import OBSERVED, OccupancyGrid
from world2minecraft.evaluation.scoring.truth_files import Truth
from world2minecraft.reconstruction.run_folder import hash_capture

COARSE = 4  # Fine cells of the truth on the side of a coarse one: 8 cm.
NEAR_CELLS = 2  # Coarse cells between observed and true surface that count as near.
MIN_NEAR = 0.5  # Share of near cells: above 0.9 beside the own truth, below 0.3 beside another.


def check_same_room(out: Path, truth: Truth, grid: OccupancyGrid, scan_to_room: np.ndarray) -> None:
    """Check that a ground truth is of the room of a run.

    It is if most of the observed surface lies near true surface, or if the run was made from the
    capture of the truth, however bad it is.

    Raises:
        InputError: If it is the ground truth of another room.
    """
    near = share_near(truth, grid, scan_to_room)
    if near >= MIN_NEAR or _is_from_capture(out, truth.capture):
        return
    raise InputError(
        truth.folder,
        f"is the ground truth of another room: {near:.0%} of the surface in {out} is near its "
        "surface; use the capture that the run was made from",
    )


def share_near(truth: Truth, grid: OccupancyGrid, scan_to_room: np.ndarray) -> float:
    """Return the share of observed occupied cells that are near the surface of a truth.

    Args:
        truth: The ground truth.
        grid: The occupancy grid of the run.
        scan_to_room: The rigid 4x4 transform that the run estimated.
    """
    cells = np.argwhere(grid.occupied & (grid.source == OBSERVED))
    if not len(cells):
        return 1.0
    occupied = _coarsened((truth.solid != 0) & (truth.solid != UNKNOWN))
    near = binary_dilation(np.pad(occupied, NEAR_CELLS), iterations=NEAR_CELLS)
    room_to_truth = invert_rigid(scan_to_room @ truth.truth_to_scan)
    points_m = apply(room_to_truth, cell_centers_m(cells, grid.origin_m, grid.voxel_m))
    at = np.floor((points_m - truth.origin_m) / (COARSE * truth.voxel_m)).astype(np.int64)
    at += NEAR_CELLS
    inside = ((at >= 0) & (at < near.shape)).all(axis=1)
    return float(near[tuple(at[inside].T)].sum() / len(cells))


def _coarsened(mask: np.ndarray) -> np.ndarray:
    """Return which coarse cells of a mask bool [A, B, C] contain any set cell."""
    padded = np.pad(mask, [(0, -length % COARSE) for length in mask.shape])
    a, b, c = (length // COARSE for length in padded.shape)
    return np.asarray(padded.reshape(a, COARSE, b, COARSE, c, COARSE).any(axis=(1, 3, 5)))


def _is_from_capture(out: Path, capture: Path) -> bool:
    """Return whether a run states the capture with this content as its source."""
    manifest = out / "manifest.json"
    if not manifest.is_file():
        return False
    stated = read_json(manifest)
    return isinstance(stated, dict) and stated.get("capture") == hash_capture(capture, without=out)
