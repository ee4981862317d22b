"""What the networks of ``train_table`` say: ``python -m benchmarks.draw_networks RUNS --out JPG``.

Test pictures of their set, sorted by the mean over all networks of the mIoU of the classes that are
there: the best, the middle and the worst are drawn. Below each picture stands what is true of the
cells before it, then what each network says, from above without the ceiling, a colour a class.
"""

import argparse
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from PIL import Image

from benchmarks.class_sheet import drawn, framed, sheet
from benchmarks.draw_mono import figures
from world2minecraft.classes import UNKNOWN
from world2minecraft.cli.progress import shown
from world2minecraft.dataset.importers import open_occupancy
from world2minecraft.learn.config import GRIDS, read_config
from world2minecraft.learn.data.cache import Frames
from world2minecraft.learn.data.opening import CachePlace, open_frames, rule_of
from world2minecraft.learn.training import LAST_SCORES, trained_network
from world2minecraft.learn.validation import said_labels
from world2minecraft.progress import Progress

SIDE = 300
NAMES = ("the best", "the middle", "the worst")
Labels = list[np.ndarray]  # uint8 [X, Y, Z] of each test picture.


def said_by_run(folder: Path, progress: Progress) -> tuple[Frames, list[int], Labels, float]:
    """Return the frames of a run's target, the rows that test it, what it says, the cells' side."""
    config = read_config(folder / "run.yaml")
    found = open_occupancy(config.data[0].path)
    frames = open_frames(found, rule_of(config), CachePlace.named(""), progress)
    rows = [n for n, key in enumerate(frames.keys) if found.splits[key] == "test"]
    network = trained_network(folder, config, "cpu", last=True)
    said = said_labels(network, frames, rows, config, progress=progress, stage=folder.name)
    return frames, rows, list(said), GRIDS[config.grid].voxel_m


def picked(scores: np.ndarray) -> list[int]:
    """Return the columns of the best, the middle and the worst mean; float64 [networks, N]."""
    order = np.argsort(scores.mean(axis=0), kind="stable")
    return [int(order[-1]), int(order[len(order) // 2]), int(order[0])]


def lines_of(
    frames: Frames, rows: list[int], said: Mapping[str, Labels], voxel_m: float
) -> list[tuple[str, list[Image.Image]]]:
    """Return the sheet's rows: pictures, truth, and one a network."""
    scores = {
        name: [figures(labels, frames[row].labels) for row, labels in zip(rows, of, strict=True)]
        for name, of in said.items()
    }
    chosen = picked(np.array([[miou for _, miou in of] for of in scores.values()]))
    shown_frames = [frames[rows[at]] for at in chosen]
    known = [frame.labels != UNKNOWN for frame in shown_frames]

    def pictures(of: Labels) -> list[Image.Image]:
        kept = [np.where(seen, one, np.uint8(0)) for seen, one in zip(known, of, strict=True)]
        return [drawn(labels, voxel_m, SIDE) for labels in kept]

    lines = [
        ("the picture", [framed(frame.image, SIDE) for frame in shown_frames]),
        ("the truth", pictures([frame.labels for frame in shown_frames])),
    ]
    for name, of in said.items():
        told = "  ".join(f"{100 * iou:.0f} / {100 * miou:.0f}" for iou, miou in
                         (scores[name][at] for at in chosen))  # fmt: skip
        lines.append((f"{name}: IoU / mIoU of the classes there  {told}",
                      pictures([of[at] for at in chosen])))  # fmt: skip
    return lines


def main() -> None:
    """Draw the sheet."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("runs", type=Path, help="the folder that train_table keeps its runs in")
    parser.add_argument("--out", type=Path, required=True)
    chosen = parser.parse_args()
    folders = sorted(path.parent for path in chosen.runs.glob(f"*/{LAST_SCORES}"))
    if not folders:
        parser.error(f"no finished runs in {chosen.runs}; make some with benchmarks.train_table")
    said = {}
    with shown() as progress:
        for folder in folders:
            frames, rows, said[folder.name], voxel_m = said_by_run(folder, progress)
    lines = lines_of(frames, rows, said, voxel_m)
    sheet(NAMES, lines, SIDE).save(chosen.out, quality=85)
    print(f"{chosen.out}: {len(rows)} pictures looked at, {len(folders)} networks")


if __name__ == "__main__":
    main()
