"""Pictures of what a monocular network says: ``python -m benchmarks.draw_mono DATA --out PNG``.

Of DATA's test pictures (``w2m dataset rooms`` makes a set) the best, the middle and the worst by
mIoU of the classes that are there are drawn, and the worst by IoU: the picture, what is said of
the cells before it, and what is true, from above without the ceiling, a colour a class.
"""

import argparse
from pathlib import Path

import numpy as np

from benchmarks.class_sheet import drawn, framed, sheet
from world2minecraft.classes import UNKNOWN
from world2minecraft.cli.progress import shown
from world2minecraft.dataset.importers import open_occupancy
from world2minecraft.learn.config import GRIDS
from world2minecraft.learn.data.frames import FrameRule
from world2minecraft.learn.data.opening import CachePlace, open_frames
from world2minecraft.learn.scoring import said_by_onnx
from world2minecraft.metrics.occupancy import count_occupancy
from world2minecraft.occupy.mono import SHIPPED
from world2minecraft.occupy.network_file import OccupancyNetwork

TITLES = ("the picture", "what the network says", "the truth")
NAMES = ("the best", "the middle", "the worst", "the worst by IoU")


def figures(said: np.ndarray, truth: np.ndarray) -> tuple[float, float]:
    """Return IoU, and mIoU of the classes that are there."""
    counts = count_occupancy(said, truth)
    present = np.unique(truth[(truth > 0) & (truth != UNKNOWN)])
    return counts.iou, float(np.mean([counts.class_iou[kind] for kind in present]))


def main() -> None:
    """Draw the sheet."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("data", type=Path)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--network", type=Path, default=SHIPPED)
    chosen = parser.parse_args()
    facts, found = OccupancyNetwork(chosen.network).facts, open_occupancy(chosen.data)
    grid = next(one for one in GRIDS.values() if one.voxel_m == facts.voxel_m)
    with shown() as progress:
        rule = FrameRule(grid, *facts.image_size_px)
        frames = open_frames(found, rule, CachePlace.named(""), progress)
        rows = [n for n, key in enumerate(frames.keys) if found.splits[key] == "test"]
        said = [one.said for one in said_by_onnx(chosen.network, frames, rows, progress)]
    scores = [figures(labels, frames[row].labels) for row, labels in zip(rows, said, strict=True)]
    order = np.argsort([miou for _, miou in scores])
    picked = [order[-1], order[len(order) // 2], order[0], np.argmin([iou for iou, _ in scores])]
    lines = []
    for name, at in zip(NAMES, picked, strict=True):
        frame, (iou, miou) = frames[rows[at]], scores[at]
        known = frame.labels != UNKNOWN
        cells = [drawn(np.where(known, labels, np.uint8(0)), grid.voxel_m)
                 for labels in (said[at], frame.labels)]  # fmt: skip
        told = f"{name}: {frame.key}, IoU {100 * iou:.0f}, mIoU of the classes there "
        lines.append((f"{told}{100 * miou:.0f}", [framed(frame.image), *cells]))
    sheet(TITLES, lines).save(chosen.out)
    print(f"{chosen.out}: {len(rows)} pictures looked at")


if __name__ == "__main__":
    main()
