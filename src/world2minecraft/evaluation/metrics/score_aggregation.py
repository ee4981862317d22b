"""Aggregation of the scores of many frames, with confidence intervals.

- **micro**: Ratios of the counts summed over all frames, as reported in papers.
- **macro**: Means of the scores of each frame. As in DDRNet's line of work, a class only counts in
  frames whose ground truth contains it, and classes that no frame contains count as 0. Frames
  without any true or predicted occupied cell have no IoU and are excluded.
- **interval**: Intervals of the micro scores from a bootstrap over scenes, because frames of one
  scene are similar. An interval contains the middle 95 % of the samples. There is none for a single
  scene.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from world2minecraft.core.classes import CLASS_NAMES
from world2minecraft.evaluation.metrics.occupancy import OccupancyCounts
from world2minecraft.evaluation.metrics.protocols import ProtocolCounts

DRAWS = 1000
SHARE = 0.95  # Share of the draws within the interval.
FIGURES = ("iou", "precision", "recall", "miou")


@dataclass(frozen=True, eq=False)
class FrameScore:
    """The counts of one frame, with the ID of its scene."""

    scene_id: str
    counts: ProtocolCounts


def summarise(frames: Sequence[FrameScore], *, draws: int = DRAWS, seed: int = 0) -> dict[str, Any]:
    """Return micro and macro scores and intervals, as fractions from 0 to 1.

    Args:
        frames: The counts of frames for one protocol.
        draws: The number of bootstrap samples.
        seed: The random seed of the bootstrap.

    Returns:
        ``frames``, ``scenes`` and ``cells``; ``micro`` and ``macro`` with iou, precision, recall,
        miou, miou_present_classes and class_iou; and ``interval`` with [low, high] for each score
        and class, or None.
    """
    tables = scene_tables(frames)
    total = sum((frame.counts for frame in frames), ProtocolCounts())
    return {
        "frames": len(frames),
        "scenes": len(tables),
        "cells": total.classes.cells,
        "micro": micro_figures(total),
        "macro": macro_figures(frames),
        "interval": bootstrap(tables, draws=draws, seed=seed) if len(tables) > 1 else None,
    }


def micro_figures(counts: ProtocolCounts) -> dict[str, Any]:
    """Return the scores of summed counts, as reported in papers."""
    geometry, classes = counts.geometry, counts.classes
    return {
        "iou": geometry.iou,
        "precision": geometry.precision,
        "recall": geometry.recall,
        "miou": classes.miou,
        "miou_present_classes": classes.miou_present,
        "class_iou": _by_class(counts.class_iou),
    }


def macro_figures(frames: Sequence[FrameScore]) -> dict[str, Any]:
    """Return the mean scores over frames."""
    geometry = [frame.counts.geometry for frame in frames]
    classes = [frame.counts.classes for frame in frames]
    occupied = [one for one in geometry if one.table.sum() > one.table[0, 0]]
    held = np.array([one.present for one in classes]).reshape(-1, len(CLASS_NAMES))
    ious = np.array([frame.counts.class_iou for frame in frames]).reshape(-1, len(CLASS_NAMES))
    times = held.sum(axis=0)
    means = np.divide((ious * held).sum(axis=0), times, out=np.zeros(len(times)), where=times > 0)
    there = times[1:] > 0
    return {
        "iou": _mean(occupied, lambda one: one.iou),
        "precision": _mean(occupied, lambda one: one.precision),
        "recall": _mean(occupied, lambda one: one.recall),
        "miou": float(means[1:].mean()),
        "miou_present_classes": float(means[1:][there].mean()) if there.any() else 0.0,
        "class_iou": _by_class(means),
    }


def scene_tables(frames: Sequence[FrameScore]) -> list[ProtocolCounts]:
    """Return the summed counts of each scene, sorted by scene ID."""
    scenes: dict[str, ProtocolCounts] = {}
    for frame in frames:
        scenes[frame.scene_id] = scenes.get(frame.scene_id, ProtocolCounts()) + frame.counts
    return [scenes[name] for name in sorted(scenes)]


def bootstrap(
    scenes: Sequence[ProtocolCounts], *, draws: int = DRAWS, seed: int = 0
) -> dict[str, Any]:
    """Return the bootstrap interval [low, high] of each micro score over scenes.

    Args:
        scenes: The summed counts of each scene.
        draws: The number of bootstrap samples.
        seed: The random seed.

    Example:
        >>> table = np.zeros((12, 12), np.int64)
        >>> table[2, 2] = table[0, 2] = 1
        >>> one = OccupancyCounts(table)
        >>> bootstrap([ProtocolCounts(one, one)] * 3)["iou"]
        [0.5, 0.5]
    """
    rng = np.random.default_rng(seed)
    times = rng.multinomial(len(scenes), np.full(len(scenes), 1 / len(scenes)), size=draws)
    drawn = [
        np.tensordot(times, np.array([getattr(one, part).table for one in scenes]), axes=1)
        for part in ("geometry", "classes")
    ]
    found = [
        micro_figures(ProtocolCounts(OccupancyCounts(geometry), OccupancyCounts(classes)))
        for geometry, classes in zip(*drawn, strict=True)
    ]
    result: dict[str, Any] = {name: _middle([one[name] for one in found]) for name in FIGURES}
    result["class_iou"] = {
        name: _middle([one["class_iou"][name] for one in found]) for name in CLASS_NAMES
    }
    return result


def _middle(values: Sequence[float]) -> list[float]:
    low, high = np.quantile(values, [(1 - SHARE) / 2, (1 + SHARE) / 2])
    return [float(low), float(high)]


def _mean(counts: Sequence[OccupancyCounts], of: Callable[[OccupancyCounts], float]) -> float:
    return float(np.mean([of(one) for one in counts])) if counts else 0.0


def _by_class(values: np.ndarray) -> dict[str, float]:
    return dict(zip(CLASS_NAMES, values.tolist(), strict=True))
