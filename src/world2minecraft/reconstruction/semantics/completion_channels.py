"""The input channels of the completion network, shared by training and inference.

A ``Sight`` is the compact form: the log-odds of every cell and the features of the occupied cells.
``network_input`` expands it to the channels of the network. Missing features are None; their
channels are 0, as in training.
"""

from dataclasses import dataclass

import numpy as np

from world2minecraft.core.classes import CLASS_COUNT
from world2minecraft.core.types import FusedEvidence, OccupancyGrid

KINDS = CLASS_COUNT - 1  # The classes of occupied cells, 1 to 11.
ODDS_STEP = 0.05  # Log-odds a step of int8: -6 to 6 are -120 to 120.
OFFSET_STEP = 0.01  # Half cells per step of int8.
HITS_STEP = 1 / 16  # log(1 + points) a step of uint8: 16 million points at most.
HEIGHT_M = 2.5  # Unit of heights: about that of a room.
GREY = 127.5
# occupied, free, unknown, certainty, height, whether height is known
DENSE = 6
COLOUR, OFFSET, HITS, VOTES, HINT = DENSE, DENSE + 4, DENSE + 7, DENSE + 8, DENSE + 8 + KINDS + 1
CHANNELS = HINT + KINDS + 1


@dataclass(frozen=True, eq=False)
class Sight:
    """The known features of a grid [X, Y, Z] with N occupied cells.

    ``hint`` is the class given by the geometric labeller, 0 if it has none. ``bottom_m`` is the
    height of the lowest face of the grid above the floor.
    """

    log_odds: np.ndarray  # int8 [X, Y, Z] in ODDS_STEP; above 0 occupied, below free, 0 unknown
    at: np.ndarray  # int32 [N], flat indices of the occupied cells, rising
    hits: np.ndarray  # uint8 [N] in HITS_STEP of log(1 + points)
    voxel_m: float
    bottom_m: float | None = None
    colour: np.ndarray | None = None  # uint8 [N, 3]
    offset: np.ndarray | None = None  # int8 [N, 3] in OFFSET_STEP of half a cell
    votes: np.ndarray | None = None  # uint8 [N, 11], shares of classes 1 to 11 in 255ths
    hint: np.ndarray | None = None  # uint8 [N], 0 to 11


def sight_of(
    grid: OccupancyGrid,
    evidence: FusedEvidence,
    hint: np.ndarray | None = None,
    floor_m: float | None = 0.0,
) -> Sight:
    """Return the compact network input of a cleaned grid.

    Args:
        grid: Cleaned grid; its occupied, free and unseen cells are used.
        evidence: Evidence of the grid on the same cells.
        hint: Labels of the geometric labeller, uint8 [X, Y, Z], or None.
        floor_m: Height of the floor in the room frame, or None if unknown.
    """
    odds = np.clip(evidence.log_odds.astype(np.float32) / ODDS_STEP, -127, 127)
    occupied = grid.occupied
    odds = np.where(occupied, np.maximum(odds, 1), np.minimum(odds, -1))
    odds = np.where(grid.source == 0, 0, odds).astype(np.int8)
    at = np.flatnonzero(occupied).astype(np.int32)
    hits = evidence.hits.reshape(-1)[at].astype(np.float32)
    points = np.maximum(hits, 1)[:, None]
    offset = evidence.offset_sum.reshape(-1, 3)[at] / points / (evidence.voxel_m / 2)
    votes = evidence.votes.reshape(-1, CLASS_COUNT)[at, 1:].astype(np.float32)
    total = votes.sum(axis=1, keepdims=True)
    return Sight(
        log_odds=odds,
        at=at,
        hits=np.clip(np.log1p(hits) / HITS_STEP, 0, 255).astype(np.uint8),
        voxel_m=grid.voxel_m,
        bottom_m=None if floor_m is None else float(grid.origin_m[2]) - floor_m,
        colour=grid.colour.reshape(-1, 3)[at] if evidence.colour_sum.any() else None,
        offset=np.clip(offset / OFFSET_STEP, -127, 127).round().astype(np.int8),
        votes=(votes / np.maximum(total, 1e-6) * 255).round().astype(np.uint8)
        if total.any()
        else None,
        hint=None if hint is None else hint.reshape(-1)[at],
    )


def network_input(sight: Sight) -> np.ndarray:
    """Return the network input, float32 [CHANNELS, X, Y, Z], with values in the order of 1."""
    shape = sight.log_odds.shape
    result = np.zeros((CHANNELS, *shape), np.float32)
    result[0], result[1], result[2] = (
        sight.log_odds > 0,
        sight.log_odds < 0,
        sight.log_odds == 0,
    )
    np.multiply(np.abs(sight.log_odds.astype(np.float32)), ODDS_STEP / 6, out=result[3])
    if sight.bottom_m is not None:
        middles = sight.bottom_m + (np.arange(shape[2]) + 0.5) * sight.voxel_m
        result[4], result[5] = (middles / HEIGHT_M).astype(np.float32), 1
    flat = result.reshape(CHANNELS, -1)
    flat[HITS, sight.at] = sight.hits * np.float32(HITS_STEP / 8)
    if sight.colour is not None:
        flat[COLOUR : COLOUR + 3, sight.at] = (sight.colour.T / np.float32(GREY)) - 1
        flat[COLOUR + 3, sight.at] = 1
    if sight.offset is not None:
        flat[OFFSET : OFFSET + 3, sight.at] = sight.offset.T * np.float32(OFFSET_STEP)
    if sight.votes is not None:
        flat[VOTES : VOTES + KINDS, sight.at] = sight.votes.T * np.float32(1 / 255)
        flat[VOTES + KINDS, sight.at] = sight.votes.any(axis=1)
    if sight.hint is not None:
        named = sight.hint > 0
        flat[HINT + sight.hint[named] - 1, sight.at[named]] = 1
        flat[HINT + KINDS, sight.at] = 1
    return result
