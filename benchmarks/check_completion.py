"""IoU and mIoU of the completion network on unseen virtual scans.

``python -m benchmarks.check_completion [--seeds 3 --rooms 6] [--weights FILE] [--keep FOLDER]
[--json FILE]``

Each seed is a separate set of rooms (from 8,000 on, which training never uses), scanned with the
noise of the training samples; the share of fused surface cells that are empty in the truth is
printed. Baselines in the same table: ``surface`` (the fused surface, without classes),
``geometric`` (its labels on that surface; not defined for single views outside the room's axes),
``votes`` (simulated votes, which every second scan has) and ``ceiling`` (the observed surface, and
the truth everywhere else). Figures are IoU / mIoU of 11 classes in percent, micro-averaged over the
rooms of a seed, with mean and spread over the seeds. ``near`` allows an error of one cell.
"""

import argparse
import resource
import time
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table
from scipy import ndimage

from world2minecraft.core.classes import CLASS_NAMES, UNKNOWN
from world2minecraft.core.files import write_json
from world2minecraft.evaluation.metrics.occupancy import (
    OccupancyCounts,
    count_occupancy,
    iou_of_precision_recall,
)
from world2minecraft.networks.completion.augmentation import prepare_evaluation
from world2minecraft.networks.completion.samples import (
    Sample,
    make_samples,
    read_samples,
    write_samples,
)
from world2minecraft.reconstruction.semantics.completion_channels import Sight
from world2minecraft.reconstruction.semantics.completion_labeller import CompletionModel, likeliest

FIRST_SEED, SEEDS_APART = 8_000, 100
BANDS = ((0.0, 0.25), (0.25, 0.55), (0.55, 1.0))
COLUMNS = ("all", "observed", "unseen", "observed, near")
WHO = ("surface", "geometric", "votes", "completion", "ceiling")
STRUCTURE_PRIOR, OBJECT_PRIOR = 0.5, 0.15  # Of ``reconstruction/semantics/votes_labeller.py``.
ROOT = Path(__file__).resolve().parents[1]


class Near:
    """Counts with one cell of tolerance: found cells near their like, and true ones near theirs."""

    def __init__(self):
        self.counts = np.zeros((12, 4), np.int64)  # Row 0: any class.

    def add(self, labels: np.ndarray, truth: np.ndarray, mask: np.ndarray) -> None:
        """Add one scene; ``mask`` bool says which cells count, their neighbours help."""
        known = truth != UNKNOWN
        for kind in range(12):
            said = ((labels == kind) if kind else (labels > 0)) & known
            true = ((truth == kind) if kind else (truth > 0)) & known
            if not (said.any() or true.any()):
                continue
            box = np.ones((3, 3, 3), bool)
            near_true = ndimage.binary_dilation(true, box)
            near_said = ndimage.binary_dilation(said, box)
            row = (said & mask, said & mask & near_true, true & mask, true & mask & near_said)
            self.counts[kind] += [int(cells.sum()) for cells in row]

    def figures(self) -> tuple[float, float]:
        """Return IoU and mIoU of the 11 classes."""
        said, said_near, true, true_near = (self.counts[:, n] for n in range(4))
        values = [
            iou_of_precision_recall(sn / max(s, 1), tn / max(t, 1))
            for s, sn, t, tn in zip(said, said_near, true, true_near, strict=True)
        ]
        return values[0], float(np.mean(values[1:]))


class Scores:
    """Counts by who answered, which scans and which cells."""

    def __init__(self):
        self.exact: dict[tuple[str, str, str], OccupancyCounts] = {}
        self.near: dict[tuple[str, str], Near] = {}

    def add(self, who: str, group: str, labels: np.ndarray, sample: Sample) -> None:
        """Add one answer."""
        observed = sample.sight.log_odds != 0
        for cells, mask in (("all", None), ("observed", observed), ("unseen", ~observed)):
            key = (who, group, cells)
            one = count_occupancy(labels, sample.truth, mask)
            self.exact[key] = self.exact.get(key, OccupancyCounts()) + one
        near = self.near.setdefault((who, group), Near())
        near.add(labels, sample.truth, observed & (sample.truth != UNKNOWN))


def samples_of(seed: int, keep: Path | None) -> list[Sample]:
    """Return the samples of a seed with simulated votes, kept in a folder if one is given."""
    path = None if keep is None else keep / f"{seed}.npz"
    if path is not None and path.exists():
        return prepare_evaluation(read_samples(path), seed)
    samples = make_samples(seed)
    if path is not None:
        path.parent.mkdir(parents=True, exist_ok=True)
        write_samples(path, samples)
    return prepare_evaluation(samples, seed)


def answers(sample: Sample, model: CompletionModel) -> dict[str, np.ndarray]:
    """Return what each says of a sample: uint8 [X, Y, Z]."""
    sight, truth = sample.sight, sample.truth
    surface = sight.log_odds > 0
    chance = model.chances(sight)
    flat = np.where(surface, np.uint8(11), np.uint8(0))
    result = {"surface": flat, "completion": likeliest(chance, sight.log_odds)}
    true = np.where(truth == UNKNOWN, np.uint8(0), truth)
    result["ceiling"] = np.where(surface & (true == 0), np.uint8(11), true)
    if sight.hint is not None:
        named = flat.copy()
        named.reshape(-1)[sight.at] = np.where(sight.hint, sight.hint, 11)
        result["geometric"] = named
        if sight.votes is not None:
            result["votes"] = _by_votes(sight, named)
    return result


def _by_votes(sight: Sight, named: np.ndarray) -> np.ndarray:
    """Return what the ``votes`` labeller says of the surface, before it smooths."""
    voted = sight.votes.astype(np.float32) / 255 if sight.votes is not None else np.zeros((0, 11))
    base = named.reshape(-1)[sight.at].astype(np.int64)
    prior = np.where(base <= 4, STRUCTURE_PRIOR, OBJECT_PRIOR)
    voted[np.arange(len(base)), base - 1] += np.where(voted.any(axis=1), prior, 1)
    result = named.copy()
    result.reshape(-1)[sight.at] = voted.argmax(axis=1) + 1
    return result


def groups(sample: Sample) -> list[str]:
    """Return the rows that a sample belongs to."""
    known = sample.truth != UNKNOWN
    share = (sample.sight.log_odds[known] != 0).mean()
    views = "single" if sample.kind == "single" else "multi"
    band = next(n for n, (low, high) in enumerate(BANDS) if low <= share <= high)
    low, high = BANDS[band]
    result = [views, f"{views}, {low:.0%} to {high:.0%} seen"]
    if sample.sight.hint is not None:
        result.append(f"{views}, along the axes")
        if sample.sight.votes is not None:
            result.append(f"{views}, along the axes, with votes")
    return result


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--rooms", type=int, default=6)
    parser.add_argument("--weights", type=Path)
    parser.add_argument("--keep", type=Path, help="a folder for the scans, to run again sooner")
    parser.add_argument("--json", type=Path, help="write the figures to this file")
    chosen = parser.parse_args()
    model, console = CompletionModel(chosen.weights), Console(width=150)
    per_seed, false, spent = [], [], []
    for number in range(chosen.seeds):
        scores = Scores()
        first = FIRST_SEED + SEEDS_APART * number
        for seed in range(first, first + chosen.rooms):
            for sample in samples_of(seed, chosen.keep):
                false.append((sample.false_share, len(sample.sight.at)))
                start = time.perf_counter()
                said = answers(sample, model)
                spent.append(time.perf_counter() - start)
                for group in groups(sample):
                    for who, labels in said.items():
                        scores.add(who, group, labels, sample)
        per_seed.append(scores)
    shares = np.array(false)
    print(f"false surface: {np.average(shares[:, 0], weights=shares[:, 1]):.3f} of its cells")
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"a room took {np.median(spent):.2f} s, {np.max(spent):.2f} at most; peak {peak:.0f} MB")
    console.print(score_table(per_seed))
    console.print(class_table(per_seed))
    if chosen.json:
        cost = {"median_s": float(np.median(spent)), "peak_mb": peak}
        write_json(chosen.json, cost | figures_told(per_seed))


def figures_told(per_seed: list[Scores]) -> dict[str, Any]:
    """Return means over the seeds in percent: ``scores`` by scans, who and cells, and classes."""
    scores: dict[str, Any] = {}
    keys = sorted({(group, who) for one in per_seed for who, group, _ in one.exact})
    for group, who in keys:
        there = [one for one in per_seed if (who, group, "all") in one.exact]
        for column in COLUMNS:
            mean = 100 * np.mean([figures(one, who, group, column) for one in there], axis=0)
            told = scores.setdefault(group, {}).setdefault(who, {})
            told[column] = {"iou": float(mean[0]), "miou": float(mean[1])}
    classes = dict(zip(CLASS_NAMES[1:], map(float, class_iou(per_seed, "completion")), strict=True))
    return {"scores": scores, "observed classes": classes}


def score_table(per_seed: list[Scores]) -> Table:
    """Return IoU / mIoU by scans, cells and who answered."""
    table = Table("scans", "who", *COLUMNS, box=None)
    names = sorted({group for scores in per_seed for _, group, _ in scores.exact})
    for group in names:
        for who in WHO:
            if not any((who, group, "all") in scores.exact for scores in per_seed):
                continue
            cells = []
            for column in COLUMNS:
                values = [
                    figures(scores, who, group, column)
                    for scores in per_seed
                    if (who, group, "all") in scores.exact
                ]
                cells.append(_spread(values))
            table.add_row(group, who, *cells)
    return table


def figures(scores: Scores, who: str, group: str, column: str) -> tuple[float, float]:
    """Return IoU and mIoU of one cell of the table."""
    if column == "observed, near":
        return scores.near[who, group].figures()
    counts = scores.exact[who, group, column]
    return counts.iou, counts.miou


def _spread(values: list[tuple[float, float]]) -> str:
    rows = 100 * np.array(values)
    mean, spread = rows.mean(axis=0), rows.std(axis=0)
    return f"{mean[0]:.1f}/{mean[1]:.1f} +-{spread[0]:.1f}/{spread[1]:.1f}"


def class_table(per_seed: list[Scores]) -> Table:
    """Return the IoU of each class on observed cells of aligned multi-view scans."""
    table = Table("observed, multi", *CLASS_NAMES[1:], box=None)
    for who in ("geometric", "completion"):
        table.add_row(who, *(f"{value:.0f}" for value in class_iou(per_seed, who)))
    return table


def class_iou(per_seed: list[Scores], who: str) -> list[float]:
    """Return the IoU of each class but empty, in percent, over the observed cells of all seeds."""
    total = sum(
        (s.exact.get((who, "multi", "observed"), OccupancyCounts()) for s in per_seed),
        OccupancyCounts(),
    )
    return [100 * float(value) for value in total.class_iou[1:]]


if __name__ == "__main__":
    main()
