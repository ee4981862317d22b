"""Semantic occupancy scores from a 12 x 12 confusion matrix.

The input is two label grids of the same shape, with class IDs 0 to 11 and 255. The scores are those
of SSCMetrics, which MonoScene and its successors use, and reproduce the paper's tables. Only cells
with the true label 255 are excluded. Counts are summed over a data set before ratios are computed
(micro-averaging), by adding the ``OccupancyCounts`` of its scenes.
"""

from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from world2minecraft.core.classes import CLASS_COUNT, CLASS_NAMES, UNKNOWN

TABLE_SHAPE = (CLASS_COUNT, CLASS_COUNT)


@dataclass(frozen=True, eq=False)
class OccupancyCounts:
    """A confusion matrix of cells, ``table[truth, predicted]``, as int64 [12, 12]."""

    table: np.ndarray = field(default_factory=lambda: np.zeros(TABLE_SHAPE, np.int64))

    def __post_init__(self):
        table = np.asarray(self.table)
        if table.shape != (CLASS_COUNT, CLASS_COUNT) or table.min() < 0:
            raise ValueError(
                f"table must contain {CLASS_COUNT} x {CLASS_COUNT} counts, got {table!r}"
            )
        object.__setattr__(self, "table", table.astype(np.int64))

    def __add__(self, other: "OccupancyCounts") -> "OccupancyCounts":
        return OccupancyCounts(self.table + other.table)

    @property
    def cells(self) -> int:
        """The number of scored cells."""
        return int(self.table.sum())

    @property
    def true_positives(self) -> int:
        """The number of cells that are occupied in both grids, regardless of class."""
        return int(self.table[1:, 1:].sum())

    @property
    def false_positives(self) -> int:
        """The number of empty cells that are predicted as occupied."""
        return int(self.table[0, 1:].sum())

    @property
    def false_negatives(self) -> int:
        """The number of occupied cells that are predicted as empty."""
        return int(self.table[1:, 0].sum())

    @property
    def iou(self) -> float:
        """The geometric IoU of occupied cells, or 0 without any."""
        false = self.false_positives + self.false_negatives
        return ratio(self.true_positives, self.true_positives + false)

    @property
    def precision(self) -> float:
        """The share of cells predicted as occupied that are occupied."""
        return ratio(self.true_positives, self.true_positives + self.false_positives)

    @property
    def recall(self) -> float:
        """The share of occupied cells that are predicted as occupied."""
        return ratio(self.true_positives, self.true_positives + self.false_negatives)

    @property
    def class_iou(self) -> np.ndarray:
        """The IoU of each class as float64 [12], with empty first and 0 for absent classes."""
        same = np.diag(self.table).astype(np.float64)
        either = self.table.sum(axis=0) + self.table.sum(axis=1) - same
        return np.divide(same, either, out=np.zeros(CLASS_COUNT), where=either > 0)

    @property
    def present(self) -> np.ndarray:
        """Whether each class occurs in the ground truth, as bool [12]."""
        return self.table.sum(axis=1) > 0

    @property
    def miou(self) -> float:
        """The paper's mIoU: the mean over the 11 classes, where absent classes count as 0."""
        return float(self.class_iou[1:].mean())

    @property
    def miou_present(self) -> float:
        """The mean IoU over the classes, except empty, that occur in the ground truth, or 0."""
        present = self.present[1:]
        return float(self.class_iou[1:][present].mean()) if present.any() else 0.0

    @property
    def label_accuracy(self) -> float:
        """The share of correct classes among the cells occupied in both grids."""
        return ratio(int(np.diag(self.table)[1:].sum()), self.true_positives)

    def figures(self) -> dict[str, float | int | dict[str, float]]:
        """Return all scores by name for reports, as fractions from 0 to 1."""
        return {
            "cells": self.cells,
            "iou": self.iou,
            "precision": self.precision,
            "recall": self.recall,
            "miou": self.miou,
            "miou_present_classes": self.miou_present,
            "label_accuracy": self.label_accuracy,
            "class_iou": dict(zip(CLASS_NAMES[1:], self.class_iou[1:].tolist(), strict=True)),
        }


def count_occupancy(
    predicted: np.ndarray,
    truth: np.ndarray,
    mask: np.ndarray | None = None,
    *,
    unknown_as: Literal["empty", "occupied"] = "empty",
) -> OccupancyCounts:
    """Count the cells of one scene.

    Args:
        predicted: The predicted labels as uint8 of any shape, 0 to 11 or 255.
        truth: The true labels as uint8 of the same shape. Cells with 255 are excluded.
        mask: The cells to score as bool of the same shape. None scores all.
        unknown_as: How a predicted 255 counts. The paper's networks predict a class for every cell.
            SSCMetrics would treat 255 as ``occupied`` without a class, which counts as objs here.

    Raises:
        ValueError: If the shapes differ, or a grid contains another ID.

    Example:
        >>> truth = np.array([0, 2, 2, 255], np.uint8)
        >>> count_occupancy(np.array([2, 2, 0, 3], np.uint8), truth).iou
        0.3333333333333333
    """
    predicted, truth = np.asarray(predicted), np.asarray(truth)
    for name, labels in (("predicted", predicted), ("truth", truth)):
        if labels.shape != truth.shape or labels.dtype != np.uint8:
            raise ValueError(
                f"{name} must be uint8 with shape {truth.shape}, got {labels.dtype} {labels.shape}"
            )
        if np.any((labels >= CLASS_COUNT) & (labels != UNKNOWN)):
            raise ValueError(f"{name} must contain only class IDs 0 to 11 or 255")
    scored = truth != UNKNOWN
    if mask is not None:
        if mask.shape != truth.shape:
            raise ValueError(f"mask must have shape {truth.shape}, got {mask.shape}")
        scored &= mask.astype(bool)
    predictions = predicted[scored].astype(np.int64)
    predictions[predictions == UNKNOWN] = 0 if unknown_as == "empty" else CLASS_COUNT - 1
    pairs = truth[scored].astype(np.int64) * CLASS_COUNT + predictions
    table = np.bincount(pairs, minlength=CLASS_COUNT**2).reshape(CLASS_COUNT, CLASS_COUNT)
    return OccupancyCounts(table)


def iou_of_precision_recall(precision: float, recall: float) -> float:
    """Return the IoU that corresponds to a precision and a recall over the same cells.

    Example:
        >>> round(100 * iou_of_precision_recall(0.4854, 0.7146), 2)
        40.66
    """
    if precision <= 0 or recall <= 0:
        return 0.0
    return 1 / (1 / precision + 1 / recall - 1)


def ratio(part: float, whole: float) -> float:
    """Return ``part / whole``, or 0 if the whole is 0."""
    return part / whole if whole else 0.0
