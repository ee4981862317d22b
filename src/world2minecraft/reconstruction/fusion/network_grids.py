"""Grid evidence of a network, carried into the cells of the room.

A network guesses what it does not see, and errs alike in views that look alike. So its word is
soft: what one view is sure of carves as much as one ray, and no more. Words are summed without
bounds and bounded at read-out, so that the order of the views plays no part.
"""

from dataclasses import dataclass

import numpy as np

from world2minecraft.core.coordinates import apply, cell_centers_m
from world2minecraft.core.types import GridEvidence
from world2minecraft.reconstruction.fusion.parameters import FusionParameters

EDGE = 0.02  # Probabilities are kept off 0 and 1, so that one sure view cannot veto all others.
MIN_VOTE = 0.05  # Below, a cell is as good as free, and what it would be says nothing.


@dataclass(frozen=True, eq=False)
class GridGains:
    """What a grid adds to N cells of the room, sorted.

    ``cells`` int64 [N, 3], ``gains`` float32 [N] log-odds, ``votes`` float32 [N, 12], ``colour``
    float32 [N, 3] and ``coloured`` bool [N].
    """

    cells: np.ndarray
    gains: np.ndarray
    votes: np.ndarray
    colour: np.ndarray
    coloured: np.ndarray


def grid_gains(
    evidence: GridEvidence, scan_to_room: np.ndarray, parameters: FusionParameters
) -> GridGains:
    """Return what a network's grid adds to the map.

    Each seen cell speaks for the room cells that it covers: it is parted until its parts are no
    larger than those, and each part falls into the room cell that holds its centre. Where several
    fall into one, their mean counts.
    """
    centers_m, owner = _parts(evidence, parameters.voxel_m)
    in_room_m = apply(scan_to_room @ evidence.grid_to_scan, centers_m)
    room_cells = np.floor(in_room_m / parameters.voxel_m).astype(np.int64)
    cells, at = np.unique(room_cells, axis=0, return_inverse=True)
    at = at.reshape(-1)
    probabilities = evidence.probabilities[evidence.seen].astype(np.float64)[owner]
    mean = _means(probabilities, at, len(cells))
    occupied = np.clip(1 - mean[:, 0], EDGE, 1 - EDGE)
    gains = parameters.network_weight * np.log(occupied / (1 - occupied))
    votes = mean.astype(np.float32)
    votes[:, 0] = 0
    votes[votes.sum(axis=1) < MIN_VOTE] = 0
    if evidence.colour is None:
        colour = np.zeros((len(cells), 3))
    else:
        colour = _means(evidence.colour[evidence.seen].astype(np.float64)[owner], at, len(cells))
    coloured = np.logical_and(votes.any(axis=1), evidence.colour is not None)
    return GridGains(cells, gains.astype(np.float32), votes, colour.astype(np.float32), coloured)


def _parts(evidence: GridEvidence, room_voxel_m: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the centres of all parts of the seen cells, and the number of each part's cell."""
    side = max(1, int(np.ceil(evidence.voxel_m / room_voxel_m - 1e-6)))
    seen = np.argwhere(evidence.seen)
    within = np.stack(np.meshgrid(*[np.arange(side)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    fine = (seen[:, None] * side + within[None]).reshape(-1, 3)
    centers_m = cell_centers_m(fine, np.zeros(3), evidence.voxel_m / side)
    return centers_m, np.repeat(np.arange(len(seen)), len(within))


def _means(values: np.ndarray, at: np.ndarray, count: int) -> np.ndarray:
    """Return the mean of the rows that go to each of ``count`` cells."""
    number = np.maximum(np.bincount(at, minlength=count), 1)[:, None]
    columns = [np.bincount(at, column, count) for column in values.T]
    return np.stack(columns, axis=1) / number
