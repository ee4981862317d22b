"""Grid evidence of a network, carried into the cells of the room."""

import numpy as np

from world2minecraft.coordinates import apply, cell_centers_m
from world2minecraft.fuse.parameters import FuseParameters
from world2minecraft.types import GridEvidence

EDGE = 0.02  # Probabilities are kept off 0 and 1, so that one sure view cannot veto all others.


def grid_gains(
    evidence: GridEvidence, scan_to_room: np.ndarray, parameters: FuseParameters
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return what a network's grid adds to the map.

    Each seen cell gives the logarithm of its odds of being occupied to the room cell that holds
    its centre; where several fall into one room cell, their mean counts.

    Returns:
        ``cells`` int64 [N, 3] of the room (not yet shifted to an array), ``gains`` float32 [N]
        and ``votes`` float32 [N, 12], sorted by cell.
    """
    seen = np.argwhere(evidence.seen)
    centers_m = cell_centers_m(seen, np.zeros(3), evidence.voxel_m)
    in_room_m = apply(scan_to_room @ evidence.grid_to_scan, centers_m)
    room_cells = np.floor(in_room_m / parameters.voxel_m).astype(np.int64)
    cells, owner = np.unique(room_cells, axis=0, return_inverse=True)
    probabilities = evidence.probabilities[tuple(seen.T)].astype(np.float64)
    count = np.bincount(owner.reshape(-1), minlength=len(cells))
    mean = np.zeros((len(cells), probabilities.shape[1]))
    np.add.at(mean, owner.reshape(-1), probabilities)
    mean /= np.maximum(count, 1)[:, None]
    occupied = np.clip(1 - mean[:, 0], EDGE, 1 - EDGE)
    votes = mean.astype(np.float32)
    votes[:, 0] = 0
    return cells, np.log(occupied / (1 - occupied)).astype(np.float32), votes
