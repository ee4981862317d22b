"""How sure the completion network may be, on held-out rooms, and from when on it fills cells.

``python -m benchmarks.fit_completion --samples FOLDER [--weights FILE]``

Held-out are the seeds of 9,000 to 9,999. Printed are the expected calibration error of observed
surface by temperature, and of unseen cells near the surface how many that are filled are solid, and
of the right class, by the chance from which they are filled. The chosen figures stand in
``label/completion.py``; nothing is chosen on the rooms of ``check_completion``.
"""

import argparse
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table
from scipy import ndimage

from world2minecraft.classes import UNKNOWN
from world2minecraft.label.completion_net import CompletionModel
from world2minecraft.learn.completion.samples import Sample, read_samples
from world2minecraft.metrics.calibration import CalibrationCounts, count_calibration

HELD_OUT = range(9_000, 10_000)
TEMPERATURES = (0.6, 0.8, 1.0, 1.2, 1.5, 1.8, 2.2)
SURE = (0.4, 0.5, 0.6, 0.7, 0.8, 0.9)
REACH = 4


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--samples", type=Path, required=True)
    parser.add_argument("--weights", type=Path)
    parser.add_argument("--files", type=int, default=12)
    chosen = parser.parse_args()
    model = CompletionModel(chosen.weights)
    paths = [p for p in sorted(chosen.samples.glob("*.npz")) if int(p.stem) in HELD_OUT]
    errors = {name: {t: CalibrationCounts() for t in TEMPERATURES} for name in ("walk", "single")}
    filled = {name: {s: np.zeros(4, np.int64) for s in SURE} for name in ("walk", "single")}
    for path in paths[: chosen.files]:
        for sample in read_samples(path):
            if sample.kind in errors:
                chance = model.chances(sample.sight)
                _count_errors(errors[sample.kind], sample, chance)
                _count_filled(filled[sample.kind], sample, chance)
    table = Table("calibration error", *map(str, TEMPERATURES), box=None)
    for name, counts in errors.items():
        table.add_row(name, *(f"{counts[t].error:.3f}" for t in TEMPERATURES))
    Console(width=120).print(table)
    table = Table("filled from", *map(str, SURE), box=None)
    for name, rows in filled.items():
        for n, what in enumerate(("of solid cells", "are solid", "of the right class")):
            shares = (_share(rows[s], n) for s in SURE)
            table.add_row(f"{name}, {what}", *(f"{share:.2f}" for share in shares))
    Console(width=120).print(table)


def _share(row: np.ndarray, n: int) -> float:
    filled, solid, right, true = row
    return (solid / max(true, 1), solid / max(filled, 1), right / max(filled, 1))[n]


def _count_errors(
    counts: dict[float, CalibrationCounts], sample: Sample, chance: np.ndarray
) -> None:
    """Count observed surface that is solid in truth: there the class alone is in question."""
    cells = (sample.sight.log_odds > 0) & (sample.truth > 0) & (sample.truth != UNKNOWN)
    logs = np.log(np.maximum(chance[1:, cells], 1e-7))
    for temperature in counts:
        shares = np.exp(logs / temperature)
        shares /= shares.sum(axis=0)
        right = shares.argmax(axis=0) + 1 == sample.truth[cells]
        counts[temperature] += count_calibration(shares.max(axis=0), right)


def _count_filled(rows: dict[float, np.ndarray], sample: Sample, chance: np.ndarray) -> None:
    """Count the unseen cells near the surface: filled, of those solid and right, and all solid."""
    odds, truth = sample.sight.log_odds, sample.truth
    near = ndimage.binary_dilation(odds > 0, np.ones((3, 3, 3), bool), iterations=REACH)
    asked = near & (odds == 0) & (truth != UNKNOWN)
    solid, best = 1 - chance[0][asked], chance[1:, asked].argmax(axis=0) + 1
    true = truth[asked]
    for sure, row in rows.items():
        fill = solid >= sure
        row += [
            int(fill.sum()),
            int((true[fill] > 0).sum()),
            int((best[fill] == true[fill]).sum()),
            int((true > 0).sum()),
        ]


if __name__ == "__main__":
    main()
