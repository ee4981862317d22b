"""All occupancy networks trained and scored on one data set.

``python -m benchmarks.train_table --set DATA --out RUNS``

DATA is any set with a test split, such as one of ``w2m dataset build DATA --houses 40 --images
1000``; test scenes are not used for training. Each network is trained for the same steps by ``w2m
train``; the weights of its last step are scored by ``monoscene`` on all test frames. An
interrupted table continues with the same command; each run is stored in RUNS/NET. ``--markdown
FILE`` writes the tables of the docs: scores with the paper's rows, classes, and mIoU of held-out
scenes during training. ``--preset 8k`` is the papers' grid and size, for a GPU. ``NET+depth`` is
given measured depth, as Symphonies was published; the others are not. ``no picture`` is the
average of all training boxes: a network that is not better has learned nothing from the pictures.
"""

import argparse
import sys
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table
from tests.evaluation.metrics.paper_occupancy import MINECRAFTOCC, row

from world2minecraft.api.progress import show_progress
from world2minecraft.core.classes import CLASS_NAMES
from world2minecraft.core.files import read_json, write_json, write_text
from world2minecraft.core.progress import Progress
from world2minecraft.evaluation.metrics.occupancy import OccupancyCounts
from world2minecraft.evaluation.metrics.protocols import PROTOCOLS, ProtocolCounts, count_frame
from world2minecraft.evaluation.metrics.score_aggregation import micro_figures
from world2minecraft.minecraftocc.importers import open_occupancy
from world2minecraft.networks.config import PRESETS, DataSource, RunConfig
from world2minecraft.networks.csv_logger import METRICS, read_metrics
from world2minecraft.networks.data.cache import Frames
from world2minecraft.networks.data.splits import split_rows
from world2minecraft.networks.data.training_data import (
    CacheLocation,
    frame_rule,
    open_frames,
    open_run_data,
)
from world2minecraft.networks.models import NETWORKS
from world2minecraft.networks.scoring import PredictedFrame, network_predictions, protocol_scores
from world2minecraft.networks.training import (
    FACTS,
    LAST_SCORES,
    load_trained_network,
    score_run,
    train_run,
)
from world2minecraft.networks.validation import predict_labels

SCENE_COUNTS = "scene_counts.json"


def done_run(
    config: RunConfig, folder: Path, device: str, cache: CacheLocation, progress: Progress
) -> dict[str, Any]:
    """Train and score where that is not done yet; return run.json and scores_last.json as one."""
    trained = train_run(config, folder, device=device, cache=cache, progress=progress)
    if not (folder / LAST_SCORES).is_file():
        score_run(trained, config, device, progress, last=True)
    return {"facts": read_json(folder / FACTS), "scores": read_json(folder / LAST_SCORES)}


def done_scenes(
    config: RunConfig,
    folder: Path,
    target: str,
    device: str,
    cache: CacheLocation,
    progress: Progress,
) -> dict[str, np.ndarray]:
    """Return the monoscene counts of each test scene of a target, int64 [12, 12] by name."""
    path = folder / SCENE_COUNTS
    if not path.is_file():
        on_target = replace(config, data=(DataSource(target),))
        found = open_occupancy(target)
        frames = open_frames(found, frame_rule(on_target), cache, progress)
        splits = [found.splits[key] for key in frames.keys]
        rows = split_rows(frames.scenes, splits, config.val_share, target).scored
        network = load_trained_network(folder, config, device, last=True)
        said = predict_labels(network, frames, rows, config, progress=progress)
        tables = scene_tables(network_predictions(frames, rows, said))
        write_json(path, {name: table.tolist() for name, table in tables.items()})
    return {name: np.array(table) for name, table in read_json(path).items()}


def scene_tables(frames: Iterable[PredictedFrame]) -> dict[str, np.ndarray]:
    """Return the monoscene counts of each scene, int64 [12, 12] by name."""
    counts: dict[str, ProtocolCounts] = {}
    for one in frames:
        scored = count_frame(PROTOCOLS["monoscene"], one.predicted, one.known)
        counts[one.scene_id] = counts.get(one.scene_id, ProtocolCounts()) + scored
    return {name: one.classes.table for name, one in counts.items()}


def figure_of(table: np.ndarray, name: str) -> float:
    """Return ``iou`` or ``miou`` of summed counts."""
    one = OccupancyCounts(table)
    return micro_figures(ProtocolCounts(one, one))[name]


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
    config: RunConfig, cache: CacheLocation, progress: Progress
) -> tuple[np.ndarray, Frames, list[int]]:
    """Return what the average of a run's target says, its frames, and the rows that are scored."""
    data = open_run_data(config, cache, progress)
    rows = data.split.train + (data.split.val if data.split.test else [])
    return average_labels(class_times(data.target.labels(rows))), data.target, data.split.scored


def average_scenes(
    config: RunConfig, cache: CacheLocation, progress: Progress
) -> dict[str, np.ndarray]:
    """Return the monoscene counts of each scored scene, int64 [12, 12] by name."""
    said, frames, rows = averaged(config, cache, progress)
    return scene_tables(network_predictions(frames, rows, iter([said] * len(rows))))


PAPER_ROWS = {
    "monoscene": "monoscene",
    "ndc_scene": "ndc",
    "iso": "iso",
    "symphonies": "symphonies",
}
BLIND = "no picture"
GIVEN = "+depth"  # Ends the name of a network that is shown measured depth,
ALSO = ("symphonies+depth",)  # as this one was published.
HEAD = (
    "network",
    "million weights",
    "steps",
    "core hours",
    "hardware",
    "IoU",
    "mIoU",
    "precision",
    "recall",
    "visible IoU",
    "visible mIoU",
)


def chosen(words: argparse.Namespace, network: str) -> RunConfig:
    """Return the run of a network."""
    config = RunConfig(network.removesuffix(GIVEN), (DataSource(words.set),))
    config = config.with_preset(words.preset)
    changes: dict[str, Any] = {"seed": words.seed, "threads": words.threads}
    if words.steps:
        changes["steps"] = words.steps
        changes["warmup_steps"] = min(config.warmup_steps, words.steps // 10)
    for name in ("size", "batch", "validate_every", "val_share"):
        if getattr(words, name) is not None:
            changes[name] = getattr(words, name)
    if network.endswith(GIVEN):
        changes["depth"] = "given"
    return replace(config, **changes)


def cells_of(network: str, done: dict[str, Any]) -> list[str]:
    """Return the cells of a row."""
    facts, found = done["facts"], done["scores"]["protocols"]["monoscene"]
    micro, spread = found["micro"], found["interval"]
    figures = [f"{100 * micro['iou']:.2f}", f"{100 * micro['miou']:.2f}"]
    if spread is not None:
        figures = [
            f"{text} ({100 * spread[name][0]:.1f}-{100 * spread[name][1]:.1f})"
            for text, name in zip(figures, ("iou", "miou"), strict=True)
        ]
    figures += [f"{100 * micro['precision']:.2f}", f"{100 * micro['recall']:.2f}"]
    seen = done["scores"]["protocols"].get("visible")
    figures += [f"{100 * seen['micro'][name]:.2f}" if seen else "-" for name in ("iou", "miou")]
    if facts is None:
        return [network, *["-"] * (len(HEAD) - 1 - len(figures)), *figures]
    return [
        network, f"{facts['parameters'] / 1e6:.2f}", f"{facts['steps']:,}",
        f"{facts['cpu_seconds'] / 3600:.2f}", f"{facts['hardware']}, {facts['precision']}",
        *figures,
    ]  # fmt: skip


def blind_row(config: RunConfig, cache: CacheLocation) -> dict[str, Any]:
    """Return the scores of the average of all training boxes."""
    with show_progress() as progress:
        said, frames, rows = averaged(config, cache, progress)
        scored = network_predictions(frames, rows, iter([said] * len(rows)))
        return {"facts": None, "scores": protocol_scores(scored, config.cells.voxel_m)}


def paper_rows(network: str) -> list[list[str]]:
    """Return the paper's row of a network at 8k, or none where it has none."""
    plain = network.removesuffix(GIVEN)
    if plain not in PAPER_ROWS:
        return []
    iou, miou, precision, recall, *_ = row(MINECRAFTOCC[f"8k {PAPER_ROWS[plain]}"])
    figures = (f"{value:.2f}" for value in (iou, miou, precision, recall))
    return [[f"paper, 8k: {plain}", *["-"] * 4, *figures, "-", "-"]]


def class_cells(network: str, done: dict[str, Any]) -> list[str]:
    """Return the IoU of each class."""
    values = done["scores"]["protocols"]["monoscene"]["micro"]["class_iou"]
    return [network, *(f"{100 * values[name]:.2f}" for name in CLASS_NAMES)]


def learning_rows(folders: dict[str, Path]) -> tuple[tuple[str, ...], list[list[str]]]:
    """Return head and rows of mIoU on the scenes held out of training, by step."""
    found = {
        name: {step: value for step, what, value in read_metrics(folder / METRICS)
               if what == "val_miou"}
        for name, folder in folders.items()
    }  # fmt: skip
    steps = sorted({step for values in found.values() for step in values})
    rows = [
        [name, *(f"{100 * values[step]:.2f}" if step in values else "-" for step in steps)]
        for name, values in found.items()
    ]
    return ("held-out mIoU at step", *(f"{step:,}" for step in steps)), rows


def markdown(head: tuple[str, ...], rows: list[list[str]]) -> str:
    """Return a table as Markdown."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines) + "\n"


def report(rows: dict[str, dict[str, Any]]) -> tuple[list[list[str]], list[list[str]]]:
    """Return the two tables' rows: figures with the paper's beside, and classes."""
    figures = [
        line for name, done in rows.items() for line in (cells_of(name, done), *paper_rows(name))
    ]
    return figures, [class_cells(name, done) for name, done in rows.items()]


def options() -> argparse.ArgumentParser:
    """Return the command's options."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--set", required=True, help="the data set")
    parser.add_argument("--out", type=Path, required=True, help="the folder of all runs")
    parser.add_argument("--networks", nargs="+", help="all by default; NET+depth is shown depth")
    parser.add_argument("--preset", default="1k", choices=PRESETS)
    parser.add_argument("--steps", type=int, help="instead of the preset's")
    parser.add_argument("--size", help="instead of the preset's")
    parser.add_argument("--batch", type=int)
    parser.add_argument("--validate-every", type=int)
    parser.add_argument("--val-share", type=float)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--threads", type=int, default=0)
    parser.add_argument("--device", default="auto")
    parser.add_argument("--cache", default="", help="where decoded frames are kept")
    parser.add_argument("--markdown", type=Path)
    return parser


def main(arguments: list[str] | None = None) -> int:
    """Train, score and print; 0 when every network has its row."""
    words = options().parse_args(arguments)
    names = words.networks or [*NETWORKS.names(), *ALSO]
    cache = CacheLocation.parse(words.cache)
    rows = {BLIND: blind_row(chosen(words, names[0]), cache)}
    for name in names:
        with show_progress() as progress:
            rows[name] = done_run(
                chosen(words, name), words.out / name, words.device, cache, progress
            )
        figures, classes = report(rows)  # After each, so that a stopped table says something.
        tables = [
            (HEAD, figures),
            (("class IoU", *CLASS_NAMES), classes),
            learning_rows({done: words.out / done for done in rows if done != BLIND}),
        ]
        if words.markdown is not None:
            write_text(words.markdown, "\n".join(markdown(*table) for table in tables))
    console = Console(width=200, highlight=False)
    for head, lines in tables:
        table = Table(*head, box=None)
        for line in lines:
            table.add_row(*line)
        console.print(table)
    return 0


if __name__ == "__main__":
    sys.exit(main())
