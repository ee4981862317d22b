"""Runs of training that a table is made of: each in its folder, none done twice.

Scored are the weights of the last step. Few scenes are held out of a small set, and choosing by
them is chance: see docs/network-table.md.
"""

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from world2minecraft.dataset.importers import open_occupancy
from world2minecraft.files import read_json, write_json
from world2minecraft.learn.config import DataSource, RunConfig
from world2minecraft.learn.data.opening import CachePlace, open_frames, rule_of
from world2minecraft.learn.data.splits import split_rows
from world2minecraft.learn.scoring import SaidOfFrame, said_by_network
from world2minecraft.learn.training import (
    FACTS,
    LAST_SCORES,
    score_run,
    train_run,
    trained_network,
)
from world2minecraft.learn.validation import said_labels
from world2minecraft.metrics.intervals import micro_figures
from world2minecraft.metrics.occupancy import OccupancyCounts
from world2minecraft.metrics.protocols import PROTOCOLS, ProtocolCounts, count_frame
from world2minecraft.progress import Progress

SCENE_COUNTS = "scene_counts.json"


def done_run(
    config: RunConfig, folder: Path, device: str, cache: CachePlace, progress: Progress
) -> dict[str, Any]:
    """Train and score where that is not done yet; return run.json and scores_last.json as one."""
    trained = train_run(config, folder, device=device, cache=cache, progress=progress)
    if not (folder / LAST_SCORES).is_file():
        score_run(trained, config, device, progress, last=True)
    return {"facts": read_json(folder / FACTS), "scores": read_json(folder / LAST_SCORES)}


def done_scenes(
    config: RunConfig, folder: Path, target: str, device: str, cache: CachePlace, progress: Progress
) -> dict[str, np.ndarray]:
    """Return the monoscene counts of each test scene of a target, int64 [12, 12] by name."""
    path = folder / SCENE_COUNTS
    if not path.is_file():
        on_target = replace(config, data=(DataSource(target),))
        found = open_occupancy(target)
        frames = open_frames(found, rule_of(on_target), cache, progress)
        splits = [found.splits[key] for key in frames.keys]
        rows = split_rows(frames.scenes, splits, config.val_share, target).scored
        network = trained_network(folder, config, device, last=True)
        said = said_labels(network, frames, rows, config, progress=progress)
        tables = scene_tables(said_by_network(frames, rows, said))
        write_json(path, {name: table.tolist() for name, table in tables.items()})
    return {name: np.array(table) for name, table in read_json(path).items()}


def scene_tables(frames: Iterable[SaidOfFrame]) -> dict[str, np.ndarray]:
    """Return the monoscene counts of each scene, int64 [12, 12] by name."""
    counts: dict[str, ProtocolCounts] = {}
    for one in frames:
        scored = count_frame(PROTOCOLS["monoscene"], one.said, one.known)
        counts[one.scene_id] = counts.get(one.scene_id, ProtocolCounts()) + scored
    return {name: one.classes.table for name, one in counts.items()}


def figure_of(table: np.ndarray, name: str) -> float:
    """Return ``iou`` or ``miou`` of summed counts."""
    one = OccupancyCounts(table)
    return micro_figures(ProtocolCounts(one, one))[name]
