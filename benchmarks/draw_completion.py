"""Pictures of what the completion network does: ``python -m benchmarks.draw_completion --out PNG``.

Of the scans of ``check_completion`` the best, the middle and the worst by mIoU of all cells are
drawn, and the worst single picture: what was fused, what ``geometric`` and ``completion`` say, and
the truth, from above without the ceiling, a colour a class.
"""

import argparse
from pathlib import Path

import numpy as np

from benchmarks.check_completion import FIRST_SEED, SEEDS_APART, answers, samples_of
from benchmarks.class_sheet import drawn, sheet
from world2minecraft.classes import UNKNOWN
from world2minecraft.label.completion_net import CompletionModel
from world2minecraft.learn.completion.samples import Sample
from world2minecraft.metrics.occupancy import count_occupancy

COLUMNS = ("surface", "geometric", "completion", "truth")
TITLES = ("what was fused", "geometric", "completion", "truth")


def scored(sample: Sample, model: CompletionModel) -> tuple[float, float, dict[str, np.ndarray]]:
    """Return mIoU of the classes present, IoU, and what each says; walls cut at the ceiling."""
    said = answers(sample, model)
    counts = count_occupancy(said["completion"], sample.truth)
    present = np.unique(sample.truth[(sample.truth > 0) & (sample.truth != UNKNOWN)])
    miou = float(np.mean([counts.class_iou[kind] for kind in present]))
    known = sample.truth != UNKNOWN
    shown = {name: np.where(known, labels, np.uint8(0)) for name, labels in said.items()} | {
        "truth": sample.truth
    }
    return miou, counts.iou, shown


def main() -> None:
    """Draw the sheet."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--rooms", type=int, default=6)
    parser.add_argument("--weights", type=Path)
    parser.add_argument("--keep", type=Path, help="the folder of check_completion's scans")
    chosen = parser.parse_args()
    model, found = CompletionModel(chosen.weights), []
    for number in range(3):
        first = FIRST_SEED + SEEDS_APART * number
        for seed in range(first, first + chosen.rooms):
            for sample in samples_of(seed, chosen.keep):
                if sample.sight.hint is not None:
                    found.append((sample.kind, seed, *scored(sample, model)))
    several = sorted((row for row in found if row[0] != "single"), key=lambda row: row[2])
    single = sorted((row for row in found if row[0] == "single"), key=lambda row: row[2])
    rows = [several[-1], several[len(several) // 2], several[0], single[len(single) // 2]]
    names = ("the best of several pictures", "the middle", "the worst", "one picture, the middle")
    lines = []
    for name, (_, seed, miou, iou, shown) in zip(names, rows, strict=True):
        told = (
            f"{name}: seed {seed}, IoU {100 * iou:.0f}, mIoU of the classes there {100 * miou:.0f}"
        )
        lines.append((told, [drawn(shown[who]) for who in COLUMNS]))
    sheet(TITLES, lines).save(chosen.out)
    print(f"{chosen.out}: {len(found)} scans looked at")


if __name__ == "__main__":
    main()
