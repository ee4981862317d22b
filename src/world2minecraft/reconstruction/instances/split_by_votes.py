"""Splitting of furniture where the recognition of its parts changes.

A stove in a row of cupboards has their colour and height, and a shower curtain hangs in its bath.
Where most votes for the parts of an object are for different things, it is split.
"""

from itertools import pairwise

import numpy as np

from world2minecraft.core.classes import SemanticClass
from world2minecraft.core.types import OccupancyGrid
from world2minecraft.core.vocabulary import nyu40_names
from world2minecraft.reconstruction.instances.cabinet_runs import MIN_RUN_M
from world2minecraft.reconstruction.instances.change_points import change_points
from world2minecraft.reconstruction.instances.object_voxels import cells_by_owner

# Classes of votes that tell the units of a row apart; all others are one more.
UNITS = (
    ("refrigerator",),
    ("sink",),
    ("bathtub",),
    ("other furniture", "other structure"),  # Ovens, dishwashers and washing machines.
)
MIN_UNIT_M = 0.4
MAX_BOTTOM_M = 0.4  # Wall cabinets get votes for the refrigerator beside them.
SHARE_STEP = 0.35  # Of the votes; a unit of 0.6 m is split off if 0.6 of its votes differ.
MIN_VOTES = 20.0  # Of a slice of a row; fewer say nothing.
MAX_RIM_M = 0.8  # Height of a bath's rim.
MIN_CURTAIN_M = 0.4  # Height of what stands on the rim.
BATH_SHARE = 0.5  # Of the votes below the rim; above it, fewer are for a bath.


def split_by_votes(
    owners: np.ndarray, grid: OccupancyGrid, cells: np.ndarray, votes: np.ndarray
) -> np.ndarray:
    """Return owners, int32 [X, Y, Z], with a number for each part of a piece of furniture.

    Args:
        owners: Number of the object of each cell, int32 [X, Y, Z], 0 for none.
        grid: Grid with labels.
        cells: Cells that have votes, int64 [N, 3].
        votes: Their votes for the NYU40 classes from 1, float [N, 40].
    """
    result = owners.copy()
    next_id = int(owners.max(initial=0)) + 1
    voters = owners[tuple(cells.T)]
    for class_id in (SemanticClass.FURN, SemanticClass.OBJS):
        for owner, own in cells_by_owner(owners, grid.labels, class_id):
            mine = voters == owner
            curtain = _above_bath(own, cells[mine], votes[mine], grid)
            parts = [] if curtain is None else [curtain]
            if curtain is None and class_id == SemanticClass.FURN:
                parts = _units(own, cells[mine], votes[mine], grid)
            for part in parts:
                result[tuple(own[part].T)] = next_id
                next_id += 1
    return result


def _units(
    own: np.ndarray, cells: np.ndarray, votes: np.ndarray, grid: OccupancyGrid
) -> list[np.ndarray]:
    """Return the units of a standing row but the first, each as a mask of its cells, bool [M]."""
    if grid.origin_m[2] + own[:, 2].min() * grid.voxel_m > MAX_BOTTOM_M:
        return []
    axis = int(np.ptp(own[:, 1]) > np.ptp(own[:, 0]))
    first, last = int(own[:, axis].min()), int(own[:, axis].max()) + 1
    if (last - first) * grid.voxel_m < MIN_RUN_M:
        return []
    profile = np.zeros((last - first, len(UNITS) + 1))
    np.add.at(profile, cells[:, axis] - first, _by_unit(votes))
    total = profile.sum(axis=1, keepdims=True)
    shares = np.where(total >= MIN_VOTES, profile / np.maximum(total, 1e-6), np.nan)
    least = max(1, round(MIN_UNIT_M / grid.voxel_m))
    cuts = [*change_points(shares / SHARE_STEP, least), last - first]
    place = own[:, axis] - first
    return [(place >= a) & (place < b) for a, b in pairwise(cuts)]


def _by_unit(votes: np.ndarray) -> np.ndarray:
    """Return the votes for each of ``UNITS`` and for all else, float [N, units + 1]."""
    ids = nyu40_names()
    units = [votes[:, [ids[name] - 1 for name in names]].sum(axis=1) for names in UNITS]
    return np.stack([*units, votes.sum(axis=1) - sum(units)], axis=1)


def _above_bath(
    own: np.ndarray, cells: np.ndarray, votes: np.ndarray, grid: OccupancyGrid
) -> np.ndarray | None:
    """Return the mask, bool [M], of a bath's cells that are a curtain or screen on its rim."""
    low_m, high_m = grid.origin_m[2] + grid.voxel_m * np.array([own[:, 2].min(), own[:, 2].max()])
    if high_m < MAX_RIM_M + MIN_CURTAIN_M or not len(cells):
        return None
    bath = np.bincount(cells[:, 2], votes[:, nyu40_names()["bathtub"] - 1])
    total = np.bincount(cells[:, 2], votes.sum(axis=1))
    middles_m = grid.origin_m[2] + (np.arange(len(bath)) + 0.5) * grid.voxel_m
    below = (middles_m > low_m) & (middles_m < MAX_RIM_M)
    if bath[below].sum() <= max(BATH_SHARE * total[below].sum(), MIN_VOTES):
        return None
    if bath[middles_m >= MAX_RIM_M].sum() > BATH_SHARE * total[middles_m >= MAX_RIM_M].sum():
        return None
    rim = np.flatnonzero(below & (bath > BATH_SHARE * total))[-1]
    return own[:, 2] > rim
