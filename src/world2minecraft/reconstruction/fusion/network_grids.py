"""Transfer of a network's grid evidence to the cells of the room.

A network guesses unseen cells and makes similar errors in similar views, so its evidence has a low
weight: one fully confident view counts as much as one ray. The evidence is summed without bounds
and clipped when the map is read, so the result does not depend on the order of the views.
"""

from dataclasses import dataclass

import numpy as np

from world2minecraft.core.coordinates import apply, cell_centers_m
from world2minecraft.core.types import GridEvidence
from world2minecraft.reconstruction.fusion.parameters import FusionParameters

EDGE = 0.02  # Probabilities are clipped to this distance from 0 and 1, so that no view is decisive.
MIN_VOTE = 0.05  # Cells with a lower probability of being occupied do not vote for a class.


@dataclass(frozen=True, eq=False)
class GridGains:
    """The evidence that a network's grid adds to N sorted cells of the room.

    Attributes:
        cells: Cells of the room, int64 [N, 3].
        gains: Log-odds, float32 [N].
        votes: Votes per class, float32 [N, 12].
        colour: Colours, float32 [N, 3].
        coloured: Mask of valid colours, bool [N].
    """

    cells: np.ndarray
    gains: np.ndarray
    votes: np.ndarray
    colour: np.ndarray
    coloured: np.ndarray


def grid_gains(
    evidence: GridEvidence, scan_to_room: np.ndarray, parameters: FusionParameters
) -> GridGains:
    """Compute the evidence that a network's grid adds to the map.

    Each seen cell is subdivided until its parts are no larger than the cells of the room. Each part
    adds to the room cell that contains its centre, and the parts in one room cell are averaged.
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
