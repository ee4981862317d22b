"""What the labels of a set say without any picture: the row that shows whether a network sees.

Of each cell of the box the training frames tell how often it is each class. A cell is said to be
occupied where it is so in a share of the frames, of its most frequent class; the share is the one
of the best IoU on the training frames themselves.
"""

from collections.abc import Iterable

import numpy as np

from benchmarks.train_runs import scene_tables
from world2minecraft.classes import CLASS_NAMES
from world2minecraft.learn.config import RunConfig
from world2minecraft.learn.data.cache import Frames
from world2minecraft.learn.data.opening import CachePlace, open_run_data
from world2minecraft.learn.scoring import said_by_network
from world2minecraft.progress import Progress

SHARES = np.arange(0.1, 0.95, 0.05)


def class_times(labels: Iterable[np.ndarray]) -> np.ndarray:
    """Return how often each cell is each class, int64 [12, X, Y, Z]; 255 counts for none."""
    kinds = np.arange(len(CLASS_NAMES))[:, None, None, None]
    return sum((one == kinds).astype(np.int64) for one in labels)  # type: ignore[return-value]


def iou_of(times: np.ndarray, said: np.ndarray) -> float:
    """Return the IoU of saying the same labels uint8 [X, Y, Z] of all frames that were counted."""
    occupied, known, there = times[1:].sum(axis=0), times.sum(axis=0), said > 0
    return occupied[there].sum() / max(known[there].sum() + occupied[~there].sum(), 1)


def average_labels(times: np.ndarray) -> np.ndarray:
    """Return the labels uint8 [X, Y, Z] that all frames are said to have."""
    occupied, known = times[1:].sum(axis=0), times.sum(axis=0)
    kinds = 1 + times[1:].argmax(axis=0)
    found = [
        np.where((known > 0) & (occupied >= share * known), kinds, 0).astype(np.uint8)
        for share in SHARES
    ]
    return max(found, key=lambda said: iou_of(times, said))


def averaged(
    config: RunConfig, cache: CachePlace, progress: Progress
) -> tuple[np.ndarray, Frames, list[int]]:
    """Return what the average of a run's target says, its frames, and the rows that are scored."""
    data = open_run_data(config, cache, progress)
    rows = data.split.train + (data.split.val if data.split.test else [])
    return average_labels(class_times(data.target.labels(rows))), data.target, data.split.scored


def average_scenes(
    config: RunConfig, cache: CachePlace, progress: Progress
) -> dict[str, np.ndarray]:
    """Return the monoscene counts of each scored scene, int64 [12, 12] by name."""
    said, frames, rows = averaged(config, cache, progress)
    return scene_tables(said_by_network(frames, rows, iter([said] * len(rows))))
