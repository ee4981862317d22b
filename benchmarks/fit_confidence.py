"""Calibrate the confidence of labels on tuning scans.

``python -m benchmarks.fit_confidence [--each 2 --keep FOLDER --check N]``

The first scans of each difficulty of the tuning split are reconstructed. Each is labelled by its
2D label images, a tenth of them wrong, by geometry alone, and by the completion network with and
without the images; the truth of the cells that rays could reach decides which labels are correct.
A logistic fit for each labeller is written to ``fuse/data/confidence.json``. Scans have equal
weight regardless of their size. ``--check N`` excludes every N-th scan from the fit and prints
the expected calibration error on those.
"""

import argparse
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from sklearn.linear_model import LogisticRegression

from world2minecraft.core.classes import CLASS_COUNT, UNKNOWN
from world2minecraft.core.files import write_json
from world2minecraft.core.types import COMPLETED, OBSERVED, FusedEvidence, OccupancyGrid
from world2minecraft.evaluation.metrics.calibration import CalibrationCounts, count_calibration
from world2minecraft.evaluation.scoring.score import TrueRoom, see_truth
from world2minecraft.evaluation.scoring.truth_files import read_truth
from world2minecraft.evaluation.scoring.used_frames import used_frames
from world2minecraft.formats.run_arrays import read_evidence
from world2minecraft.procgen.benchmark_trials import DIFFICULTIES, list_trials, write_trial
from world2minecraft.reconstruction.fusion import (
    CleaningParameters,
    close_structure,
    extract_grid,
    remove_floaters,
)
from world2minecraft.reconstruction.fusion.confidence_calibration import (
    FREE_FEATURES,
    OCCUPIED_FEATURES,
    TABLES,
    ConfidenceTable,
    calibrate,
    free_features,
    occupied_features,
)
from world2minecraft.reconstruction.parameters import Parameters
from world2minecraft.reconstruction.pipeline import reconstruct
from world2minecraft.reconstruction.semantics import labeller

# Whether their evidence keeps its votes. A network's own confidence counts beside the evidence.
LABELLERS = {"geometric": (True,), "votes": (True,), "completion": (True, False)}
PULL = 20.0  # Completed cells that a class needs before it leaves the mean of all classes.


class Example:
    """One labelled scan: which of its cells are scored, and which of those are right."""

    def __init__(self, number: int, grid: OccupancyGrid, evidence: FusedEvidence, room: TrueRoom):
        self.number, self.grid, self.evidence = number, grid, evidence
        true = _in_grid(room.labels, grid, room, UNKNOWN)
        reached = _in_grid(room.reached.scored, grid, room, False)
        self.scored = reached & (true != UNKNOWN)
        self.right = grid.labels == true


def _in_grid(values: np.ndarray, grid: OccupancyGrid, room: TrueRoom, fill: Any) -> np.ndarray:
    """Return values of the truth's box in the cells of a grid."""
    result = np.full(grid.shape, fill, values.dtype)
    start = np.round(grid.origin_m / grid.voxel_m).astype(np.int64) - room.reached.low
    first, last = np.maximum(start, 0), np.minimum(start + grid.shape, values.shape)
    here = tuple(slice(a - s, b - s) for a, b, s in zip(first, last, start, strict=True))
    result[here] = values[tuple(slice(a, b) for a, b in zip(first, last, strict=True))]
    return result


def gather(each: int, base: Path) -> dict[str, list[Example]]:
    """Reconstruct the first tuning scans of each difficulty, and label them in both ways."""
    found: dict[str, list[Example]] = {name: [] for name in LABELLERS}
    chosen = [trial for name in DIFFICULTIES for trial in list_trials("tune", name)[:each]]
    for number, trial in enumerate(chosen):
        capture, out = base / trial.name, base / f"{trial.name}-out"
        if not (capture / "truth.json").is_file():
            write_trial(trial, capture)
        if not (out / "evidence.npz").is_file():
            reconstruct(capture, out, Parameters())
        truth, evidence = read_truth(capture), read_evidence(out / "evidence.npz")
        frames = used_frames(out, truth)
        room = see_truth(truth, frames, evidence.scan_to_room, evidence.voxel_m)
        silent = replace(evidence, votes=np.zeros_like(evidence.votes))
        for name, ways in LABELLERS.items():
            for voted in ways:
                told = evidence if voted else silent
                found[name].append(Example(number, named(name, told), told, room))
        print(f"read {trial.name}", flush=True)
    return found


def named(name: str, evidence: FusedEvidence) -> OccupancyGrid:
    """Return what a labeller says, with its own confidence."""
    grid = remove_floaters(extract_grid(evidence), CleaningParameters())
    return close_structure(labeller(name).label(grid, evidence), CleaningParameters())


def fit(examples: list[Example], uses_votes: bool, uses_said: bool = False) -> ConfidenceTable:
    """Return the table that explains best which labels were right."""
    rows, classes, right, weights = [], [], [], []
    free_rows, free_right, free_weights = [], [], []
    done, done_right = np.zeros(CLASS_COUNT), np.zeros(CLASS_COUNT)
    for item in examples:
        grid = item.grid
        cells = item.scored & grid.occupied & (grid.source == OBSERVED)
        rows.append(occupied_features(grid, item.evidence, cells, uses_votes, uses_said))
        classes.append(grid.labels[cells])
        right.append(item.right[cells])
        weights.append(np.full(len(right[-1]), 1e4 / max(len(right[-1]), 1)))
        cells = item.scored & (grid.labels == 0)
        free_rows.append(free_features(grid, item.evidence, cells))
        free_right.append(item.right[cells])
        free_weights.append(np.full(len(free_right[-1]), 1e5 / max(len(free_right[-1]), 1)))
        cells = (grid.source == COMPLETED) & item.scored & (grid.labels < CLASS_COUNT)
        done += np.bincount(grid.labels[cells], minlength=CLASS_COUNT)
        done_right += np.bincount(
            grid.labels[cells], weights=item.right[cells], minlength=CLASS_COUNT
        )
    labels = np.concatenate(classes)
    one_hot = (labels[:, None] == np.arange(CLASS_COUNT)).astype(np.float64)
    weight = _logistic(np.hstack([np.concatenate(rows), one_hot]), right, weights)
    count = len(OCCUPIED_FEATURES)
    mean = done_right.sum() / max(done.sum(), 1)
    return ConfidenceTable(
        occupied=tuple(np.round(weight[:count], 4)),
        classes=tuple(np.round(weight[count:], 4)),
        free=tuple(np.round(_logistic(np.concatenate(free_rows), free_right, free_weights), 4)),
        completed=tuple(np.round((done_right + PULL * mean) / (done + PULL), 3)),
        uses_votes=uses_votes,
        uses_said=uses_said,
    )


def _logistic(rows: np.ndarray, right: list[np.ndarray], weights: list[np.ndarray]) -> np.ndarray:
    # The intercept is among the columns: "one" for free cells, the classes for occupied ones.
    model = LogisticRegression(C=1.0, fit_intercept=False, max_iter=2000, tol=1e-6)
    model.fit(rows, np.concatenate(right), sample_weight=np.concatenate(weights))
    return model.coef_[0]


def errors(examples: list[Example], table: ConfidenceTable) -> tuple[float, float]:
    """Return the calibration error over all and over the occupied observed cells."""
    every, occupied = CalibrationCounts(), CalibrationCounts()
    for item in examples:
        grid = calibrate(item.grid, item.evidence, table)
        cells = item.scored & (grid.source == OBSERVED)
        every += count_calibration(grid.confidence[cells], item.right[cells])
        cells &= grid.occupied
        occupied += count_calibration(grid.confidence[cells], item.right[cells])
    return every.error, occupied.error


def main() -> None:
    """Fit and write the tables, or check them on scans left out."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--each", type=int, default=2, help="scans of each difficulty")
    parser.add_argument("--keep", type=Path, help="a folder for scans and runs, used again")
    parser.add_argument("--check", type=int, default=0, help="leave out every N-th scan")
    chosen = parser.parse_args()
    found = gather(chosen.each, chosen.keep or Path(tempfile.mkdtemp()))
    tables: dict[str, Any] = {}
    for name, examples in found.items():
        kept = [e for e in examples if not chosen.check or e.number % chosen.check]
        table = fit(kept, name != "geometric", name == "completion")
        left = [e for e in examples if chosen.check and not e.number % chosen.check]
        tables[name] = {key: getattr(table, key) for key in table.__dataclass_fields__}
        print(f"{name}: ECE all, occupied; fitted {_two(kept, table)}", end="")
        print(f", left out {_two(left, table)}" if left else "")
    if not chosen.check:
        how = {
            "fitted": "python -m benchmarks.fit_confidence",
            "scans": f"the first {chosen.each} of each difficulty of the tuning split",
            "occupied_features": OCCUPIED_FEATURES,
            "free_features": FREE_FEATURES,
        }
        write_json(TABLES, how | {"labellers": tables})


def _two(examples: list[Example], table: ConfidenceTable) -> str:
    return " ".join(f"{value:.3f}" for value in errors(examples, table))


if __name__ == "__main__":
    main()
