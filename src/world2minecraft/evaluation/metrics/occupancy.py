"""Semantic occupancy scores: one 12 x 12 table of counts, and all that is read from it.

In: two label grids of the same shape, ids 0 to 11 and 255. Out: the figures of SSCMetrics, which
MonoScene and all after it use, and which reproduce the paper's tables. Cells whose truth is 255
are left out, and nothing else is. Counts are summed over a data set before any ratio is taken
(micro averaging): add the ``OccupancyCounts`` of its scenes.
"""

from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from world2minecraft.core.classes import CLASS_COUNT, CLASS_NAMES, UNKNOWN

TABLE_SHAPE = (CLASS_COUNT, CLASS_COUNT)


@dataclass(frozen=True, eq=False)
class OccupancyCounts:
    """How often each true class was called each class: ``table[truth, predicted]``, int64."""

    table: np.ndarray = field(default_factory=lambda: np.zeros(TABLE_SHAPE, np.int64))

    def __post_init__(self):
        table = np.asarray(self.table)
        if table.shape != (CLASS_COUNT, CLASS_COUNT) or table.min() < 0:
            raise ValueError(f"table must be {CLASS_COUNT} x {CLASS_COUNT} counts, not {table!r}")
        object.__setattr__(self, "table", table.astype(np.int64))

    def __add__(self, other: "OccupancyCounts") -> "OccupancyCounts":
        return OccupancyCounts(self.table + other.table)

    @property
    def cells(self) -> int:
        """The number of cells that were scored."""
        return int(self.table.sum())

    @property
    def true_positives(self) -> int:
        """Cells occupied in both, whatever their classes."""
        return int(self.table[1:, 1:].sum())

    @property
    def false_positives(self) -> int:
        """Cells called occupied that are empty."""
        return int(self.table[0, 1:].sum())

    @property
    def false_negatives(self) -> int:
        """Occupied cells that were called empty."""
        return int(self.table[1:, 0].sum())

    @property
    def iou(self) -> float:
        """Geometric IoU of occupied cells, 0 where there are none."""
        false = self.false_positives + self.false_negatives
        return ratio(self.true_positives, self.true_positives + false)

    @property
    def precision(self) -> float:
        """The share of cells called occupied that are."""
        return ratio(self.true_positives, self.true_positives + self.false_positives)

    @property
    def recall(self) -> float:
        """The share of occupied cells that were called so."""
        return ratio(self.true_positives, self.true_positives + self.false_negatives)

    @property
    def class_iou(self) -> np.ndarray:
        """IoU of each class, float64 [12], empty first; a class in neither grid counts 0."""
        same = np.diag(self.table).astype(np.float64)
        either = self.table.sum(axis=0) + self.table.sum(axis=1) - same
        return np.divide(same, either, out=np.zeros(CLASS_COUNT), where=either > 0)

    @property
    def present(self) -> np.ndarray:
        """Which classes the truth holds, bool [12]."""
        return self.table.sum(axis=1) > 0

    @property
    def miou(self) -> float:
        """The paper's mIoU: the mean over the 11 classes, absent ones counted as 0."""
        return float(self.class_iou[1:].mean())

    @property
    def miou_present(self) -> float:
        """The mean over those of the 11 classes that the truth holds, 0 where it holds none."""
        present = self.present[1:]
        return float(self.class_iou[1:][present].mean()) if present.any() else 0.0

    @property
    def label_accuracy(self) -> float:
        """Of the cells occupied in both, the share that has the right class."""
        return ratio(int(np.diag(self.table)[1:].sum()), self.true_positives)

    def figures(self) -> dict[str, float | int | dict[str, float]]:
        """All figures by name, fractions from 0 to 1, as reports write them."""
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
    """Count one scene.

    Args:
        predicted: uint8, any shape, ids 0 to 11 or 255.
        truth: uint8 of the same shape; cells of 255 are left out.
        mask: bool of the same shape: the cells to score, all by default.
        unknown_as: what a predicted 255 counts as. The paper's networks say a class for every
            cell; the maths of SSCMetrics, given 255, takes it for ``occupied`` and of no class
            (counted here as objs).

    Raises:
        ValueError: the shapes differ, or a grid holds another id.

    Example:
        >>> truth = np.array([0, 2, 2, 255], np.uint8)
        >>> count_occupancy(np.array([2, 2, 0, 3], np.uint8), truth).iou
        0.3333333333333333
    """
    predicted, truth = np.asarray(predicted), np.asarray(truth)
    for name, labels in (("predicted", predicted), ("truth", truth)):
        if labels.shape != truth.shape or labels.dtype != np.uint8:
            raise ValueError(
                f"{name} must be uint8 of shape {truth.shape}, not {labels.dtype} {labels.shape}"
            )
        if np.any((labels >= CLASS_COUNT) & (labels != UNKNOWN)):
            raise ValueError(f"{name} must hold class ids 0 to 11 or 255")
    scored = truth != UNKNOWN
    if mask is not None:
        if mask.shape != truth.shape:
            raise ValueError(f"mask must have shape {truth.shape}, not {mask.shape}")
        scored &= mask.astype(bool)
    predictions = predicted[scored].astype(np.int64)
    predictions[predictions == UNKNOWN] = 0 if unknown_as == "empty" else CLASS_COUNT - 1
    pairs = truth[scored].astype(np.int64) * CLASS_COUNT + predictions
    table = np.bincount(pairs, minlength=CLASS_COUNT**2).reshape(CLASS_COUNT, CLASS_COUNT)
    return OccupancyCounts(table)


def iou_of_precision_recall(precision: float, recall: float) -> float:
    """Return the IoU that a precision and a recall over the same cells stand for.

    Example:
        >>> round(100 * iou_of_precision_recall(0.4854, 0.7146), 2)
        40.66
    """
    if precision <= 0 or recall <= 0:
        return 0.0
    return 1 / (1 / precision + 1 / recall - 1)


def ratio(part: float, whole: float) -> float:
    """Return ``part / whole``, or 0 where the whole is 0."""
    return part / whole if whole else 0.0
