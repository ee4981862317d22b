"""Calibrated confidence: of the cells with confidence 0.9, nine in ten have the right label.

The confidence of a cell is the probability that its label is right, a logistic function of a few
features of the cell. The weights were fitted on generated rooms (``python -m
benchmarks.fit_confidence``) separately for each labeller, since labels without 2D images have more
errors. Completed cells get the observed accuracy of completed cells of their class.
"""

from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np
from scipy import ndimage

from world2minecraft.core.classes import CLASS_COUNT, UNKNOWN
from world2minecraft.core.errors import MALFORMED, DamagedFileError
from world2minecraft.core.files import read_json
from world2minecraft.core.types import COMPLETED, OBSERVED, FusedEvidence, OccupancyGrid

TABLES = Path(__file__).parent / "data" / "confidence.json"
OCCUPIED_FEATURES = (
    "log_odds", "hits", "voted", "share", "share_squared", "same_class", "occupied_around", "said",
)  # fmt: skip
FREE_FEATURES = ("one", "log_odds", "hits", "beside_occupied", "two_off", "beside_unknown")
LEAST, MOST = 0.01, 0.995  # Limits of the confidence, since few rooms were used for calibration.
DECIMALS = 3  # The confidence is rounded to a thousandth.


@dataclass(frozen=True)
class ConfidenceTable:
    """The fitted calibration weights of one labeller.

    Attributes:
        occupied: Weights of ``OCCUPIED_FEATURES``.
        classes: Intercept of each of the 12 classes; the first (empty) is not used.
        free: Weights of ``FREE_FEATURES``.
        completed: Accuracy of the completed cells of each of the 12 classes.
        uses_votes: Whether the share of votes is a feature.
        uses_said: Whether the confidence reported by the labeller is a feature.
    """

    occupied: tuple[float, ...]
    classes: tuple[float, ...]
    free: tuple[float, ...]
    completed: tuple[float, ...]
    uses_votes: bool
    uses_said: bool = False

    def __post_init__(self):
        for name, size in (
            ("occupied", len(OCCUPIED_FEATURES)),
            ("classes", CLASS_COUNT),
            ("free", len(FREE_FEATURES)),
            ("completed", CLASS_COUNT),
        ):
            values = np.array(getattr(self, name), np.float64)
            if values.shape != (size,) or not np.isfinite(values).all():
                raise ValueError(f"{name} must be {size} finite numbers, got {values.tolist()}")
            object.__setattr__(self, name, tuple(values.tolist()))


def confidence_table(labeller: str) -> ConfidenceTable | None:
    """Return the calibration table of a labeller, or None if it has none.

    Raises:
        DamagedFileError: If the table file of the package is damaged.
    """
    return _tables().get(labeller)


@cache
def _tables() -> dict[str, ConfidenceTable]:
    stated = read_json(TABLES)
    try:
        return {name: ConfidenceTable(**row) for name, row in stated["labellers"].items()}
    except MALFORMED as error:
        raise DamagedFileError(TABLES, f"is not a valid confidence table file ({error})") from error


def calibrate(
    grid: OccupancyGrid, evidence: FusedEvidence, table: ConfidenceTable | None
) -> OccupancyGrid:
    """Return the grid with calibrated confidence, or the same grid if there is no table.

    Unseen cells have confidence 0. The confidence of a completed cell is the accuracy of completed
    cells of its class. That of an observed cell is computed from its features.

    Raises:
        ValueError: If grid and evidence do not have the same shape.
    """
    if table is None:
        return grid
    occupied, free = grid.occupied & (grid.source == OBSERVED), grid.labels == 0
    confidence = np.zeros(grid.shape, np.float64)
    weights = np.array(table.occupied)
    offset = np.array(table.classes)[grid.labels[occupied]]
    rows = occupied_features(grid, evidence, occupied, table.uses_votes, table.uses_said)
    confidence[occupied] = _chance(_weighed(rows, weights) + offset)
    rows = free_features(grid, evidence, free)
    confidence[free] = _chance(_weighed(rows, np.array(table.free)))
    completed = (grid.source == COMPLETED) & (grid.labels < CLASS_COUNT)
    confidence[completed] = np.array(table.completed)[grid.labels[completed]]
    return replace(grid, confidence=np.round(confidence, DECIMALS).astype(np.float16))


def occupied_features(
    grid: OccupancyGrid,
    evidence: FusedEvidence,
    cells: np.ndarray,
    uses_votes: bool,
    uses_said: bool = False,
) -> np.ndarray:
    """Return the ``OCCUPIED_FEATURES``, float64 [N, 8], of the cells of a mask [X, Y, Z].

    Log-odds are divided by 6, logarithmic hits by 8. ``share`` is the share of votes for the label,
    ``same_class`` and ``occupied_around`` are shares of the 26 neighbours, and ``reported`` is the
    log-odds of the confidence reported by the labeller.
    """
    if evidence.log_odds.shape != grid.shape:
        raise ValueError(
            f"evidence shape {evidence.log_odds.shape} does not match grid shape {grid.shape}"
        )
    labels = grid.labels[cells]
    votes = evidence.votes[cells].astype(np.float64)
    total = votes.sum(axis=1) * uses_votes
    share = votes[np.arange(len(labels)), labels] / np.maximum(total, 1e-9) * (total > 0)
    around, same = _around(grid, cells)
    own = np.clip(grid.confidence[cells].astype(np.float64), LEAST, MOST)
    reported = np.log(own / (1 - own)) * uses_said
    return np.column_stack(
        [
            np.clip(evidence.log_odds[cells].astype(np.float64), -6, 6) / 6,
            np.log1p(evidence.hits[cells].astype(np.float64)) / 8,
            total > 0,
            share,
            share**2,
            same,
            around,
            reported,
        ]
    )


def free_features(grid: OccupancyGrid, evidence: FusedEvidence, cells: np.ndarray) -> np.ndarray:
    """Return the ``FREE_FEATURES``, float64 [N, 6], of the cells of a mask [X, Y, Z]."""
    box = np.ones((3, 3, 3), bool)
    adjacent = np.asarray(ndimage.binary_dilation(grid.occupied, box), bool)
    two_off = np.asarray(ndimage.binary_dilation(adjacent, box), bool) & ~adjacent
    unknown = np.asarray(ndimage.binary_dilation(grid.labels == UNKNOWN, box), bool)
    return np.column_stack(
        [
            np.ones(np.count_nonzero(cells)),
            np.clip(evidence.log_odds[cells].astype(np.float64), -6, 6) / 6,
            evidence.hits[cells] > 0,
            adjacent[cells],
            two_off[cells],
            unknown[cells],
        ]
    ).astype(np.float64)


def _around(grid: OccupancyGrid, cells: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return for each chosen cell the parts of its 26 neighbours occupied, and of its class."""
    labels = grid.labels[cells]
    around = _neighbours(grid.occupied)[cells]
    same = np.zeros(len(labels))
    for class_id in np.unique(labels):
        same[labels == class_id] = _neighbours(grid.labels == class_id)[cells][labels == class_id]
    return around, same


def _neighbours(mask: np.ndarray) -> np.ndarray:
    """Return the part of each cell's 26 neighbours that is in the mask."""
    count = mask.astype(np.uint8)
    for axis in range(3):
        count = ndimage.convolve1d(count, np.ones(3, np.uint8), axis=axis, mode="constant")
    return (count - mask) / 26


def _weighed(rows: np.ndarray, weights: np.ndarray) -> np.ndarray:
    # Column by column: a matrix product may differ in its last bits with the number of threads.
    result = np.zeros(len(rows))
    for column, weight in zip(rows.T, weights, strict=True):
        result += column * weight
    return result


def _chance(value: np.ndarray) -> np.ndarray:
    return np.clip(1 / (1 + np.exp(-np.clip(value, -30, 30))), LEAST, MOST)
