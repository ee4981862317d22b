"""Generated rooms, scanned with the sensor model and rebuilt, against their truth.

``python -m benchmarks.check_rooms [--first 100 --rooms 10 --frames 40 --keep FOLDER]
[--json FILE]``

Each room is reconstructed twice: with the ``geometric`` labeller, and with its 2D label images of
which a tenth is wrong. The table is that of the report; figures are means over the rooms.
"""

import argparse
import tempfile
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

from world2minecraft.files import write_json
from world2minecraft.parameters import Parameters
from world2minecraft.pipeline import reconstruct
from world2minecraft.report import write_report
from world2minecraft.rooms import BASE_KINDS, generate_room, scan_room

LABEL_ERROR = 0.1
COLUMNS = (
    "precision", "recall", "free", "IoU", "mIoU", "object F1", "turned right", "tilt deg",
    "yaw deg", "floor cm", "collisions", "outside", "floaters",
)  # fmt: skip


def score(folder: Path, out: Path, labeller: str) -> dict[str, float]:
    """Reconstruct one capture and return a row of the table."""
    scan = reconstruct(folder, out, Parameters(labeller=labeller))
    facts = write_report(out, scan, truth=folder)
    truth, layout = facts["truth"], facts["layout"]
    return {
        "precision": truth["surface_within_one_voxel"]["precision"],
        "recall": truth["surface_within_one_voxel"]["recall"],
        "free": truth["free_recall"],
        "IoU": truth["occupancy"]["iou"],
        "mIoU": truth["occupancy"]["miou"],
        "object F1": truth["objects"]["f1"],
        "turned right": truth["objects"]["orientation_right"]
        if truth["objects"]["orientation_asked"]
        else float("nan"),
        "tilt deg": truth["frame_error"]["tilt_deg"],
        "yaw deg": truth["frame_error"]["yaw_deg"],
        "floor cm": 100 * abs(truth["frame_error"]["floor_m"]),
        "collisions": layout["collisions"],
        "outside": layout["out_of_bounds"],
        "floaters": layout["floaters"],
    }


def main() -> None:
    """Print a row for each room and labeller, then the means."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--first", type=int, default=100)
    parser.add_argument("--rooms", type=int, default=10)
    parser.add_argument("--frames", type=int, default=40)
    parser.add_argument("--keep", type=Path)
    parser.add_argument("--json", type=Path, help="write the figures to this file")
    chosen = parser.parse_args()
    base = chosen.keep or Path(tempfile.mkdtemp())
    rows: dict[str, list[dict[str, float]]] = {"geometric": [], "votes": []}
    table = Table("room", "labels", *COLUMNS)
    for seed in range(chosen.first, chosen.first + chosen.rooms):
        kind = sorted(BASE_KINDS)[seed % len(BASE_KINDS)]
        capture = base / f"capture{seed}"
        scan_room(
            generate_room(seed, kind=kind), capture, frames=chosen.frames, seed=seed,
            with_labels=True, label_error=LABEL_ERROR,
        )  # fmt: skip
        for labeller, found in rows.items():
            found.append(score(capture, base / f"{labeller}{seed}", labeller))
            table.add_row(f"{seed} {kind}", labeller, *(f"{found[-1][c]:.3f}" for c in COLUMNS))
    means = {
        labeller: {column: float(np.nanmean([row[column] for row in found])) for column in COLUMNS}
        for labeller, found in rows.items()
    }
    for labeller, mean in means.items():
        table.add_row("mean", labeller, *(f"{value:.3f}" for value in mean.values()))
    Console(width=170).print(table)
    if chosen.json:
        write_json(chosen.json, means)


if __name__ == "__main__":
    main()
