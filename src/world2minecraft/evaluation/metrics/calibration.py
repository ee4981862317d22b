"""Calibration of confidences: cells of confidence 0.9 should be correct nine times out of ten.

The counts are collected in bins of equal width and can be summed over scenes. They give the
reliability table and the expected calibration error (Naeini et al., "Obtaining Well Calibrated
Probabilities Using Bayesian Binning", 2015).
"""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from world2minecraft.evaluation.metrics.occupancy import ratio

BINS = 10


@dataclass(frozen=True, eq=False)
class CalibrationCounts:
    """The number of cells, of correct cells, and the sum of confidences in each bin."""

    cells: np.ndarray = field(default_factory=lambda: np.zeros(BINS, np.int64))
    right: np.ndarray = field(default_factory=lambda: np.zeros(BINS, np.int64))
    confidence_sum: np.ndarray = field(default_factory=lambda: np.zeros(BINS))

    def __add__(self, other: "CalibrationCounts") -> "CalibrationCounts":
        return CalibrationCounts(
            self.cells + other.cells,
            self.right + other.right,
            self.confidence_sum + other.confidence_sum,
        )

    @property
    def error(self) -> float:
        """The expected calibration error: the mean gap between confidence and accuracy."""
        gaps = np.abs(self.confidence_sum - self.right)
        return ratio(float(gaps.sum()), int(self.cells.sum()))

    def rows(self) -> list[dict[str, Any]]:
        """Return the reliability table, with a row for each non-empty bin."""
        edges = np.linspace(0, 1, len(self.cells) + 1)
        return [
            {
                "from": round(float(edges[n]), 3),
                "to": round(float(edges[n + 1]), 3),
                "cells": int(self.cells[n]),
                "confidence": round(float(self.confidence_sum[n] / self.cells[n]), 4),
                "right": round(float(self.right[n] / self.cells[n]), 4),
            }
            for n in np.flatnonzero(self.cells)
        ]


def count_calibration(confidence: np.ndarray, right: np.ndarray) -> CalibrationCounts:
    """Count the cells of one scene.

    Args:
        confidence: The confidences as a float array of any shape, 0 to 1. A bin includes its lower
            edge, and the last bin also its upper edge.
        right: Whether each label is correct, as a bool array of the same shape.

    Raises:
        ValueError: If the shapes differ, or a confidence is outside 0 to 1.

    Example:
        >>> counts = count_calibration(np.array([0.9, 0.9]), np.array([True, False]))
        >>> round(counts.error, 3)
        0.4
    """
    values = np.asarray(confidence, np.float64).reshape(-1)
    hits = np.asarray(right, bool).reshape(-1)
    if np.shape(confidence) != np.shape(right):
        raise ValueError(
            f"confidence and right must have the same shape, got {np.shape(confidence)} and "
            f"{np.shape(right)}"
        )
    if values.size and not (values.min() >= 0 and values.max() <= 1):
        raise ValueError("confidence must be between 0 and 1")
    # A stored float16 of 0.8 is 0.7998; rounding keeps it in the bin that it was meant for.
    at = np.minimum(np.floor(np.round(values, 3) * BINS + 1e-9).astype(np.int64), BINS - 1)
    return CalibrationCounts(
        np.bincount(at, minlength=BINS),
        np.bincount(at[hits], minlength=BINS),
        np.bincount(at, weights=values, minlength=BINS),
    )
