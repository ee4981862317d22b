"""How well holes are filled: ``python -m benchmarks.check_mending 512 521``.

Of each tuning trial named (seeds 500 to 549), the room is scanned and reconstructed, all planes
are filled by one command, and what was filled is held against the truth. ``--keep FOLDER`` keeps
the runs, and uses those that are there.
"""

import argparse
import itertools
import tempfile
from pathlib import Path

import numpy as np

from world2minecraft.edit.scene import SceneDraft, Tools, parse_command
from world2minecraft.edit.scene.floaters import find_floaters
from world2minecraft.edit.scene.holes import plane_gaps
from world2minecraft.edit.scene.planes import find_planes
from world2minecraft.evaluate.frames import truth_of_run
from world2minecraft.exchange.room import read_room
from world2minecraft.metrics.occupancy import count_occupancy
from world2minecraft.metrics.truth import carry_truth
from world2minecraft.pipeline import reconstruct
from world2minecraft.rooms.trials import trials, write_trial
from world2minecraft.types import OccupancyGrid

TOOLS = Tools(match=lambda grid, one: (), find=lambda grid, fields: (grid.instance, ()))
AROUND = np.array(list(itertools.product((-1, 0, 1), repeat=3)))


def main() -> None:
    """Print one row a trial, and the sum."""
    parser = argparse.ArgumentParser(description="Fill the holes of reconstructed tuning rooms.")
    parser.add_argument("seeds", type=int, nargs="+", help="500 to 549")
    parser.add_argument("--keep", type=Path, help="a folder for the runs")
    arguments = parser.parse_args()
    print(f"{'trial':14} {'filled':>7} {'exact':>6} {'near':>6} {'IoU':>13} {'left':>6} floaters")
    total = np.zeros(3, np.int64)
    with tempfile.TemporaryDirectory() as scratch:
        for trial in trials("tune"):
            if trial.seed in arguments.seeds:
                folder = (arguments.keep or Path(scratch)) / str(trial.seed)
                if not (folder / "out" / "room.npz").is_file():
                    write_trial(trial, folder / "cap")
                    reconstruct(folder / "cap", folder / "out")
                total += row(trial.name, folder)
    filled, exact, near = total.tolist()
    print(f"{'all':14} {filled:7} {exact / max(filled, 1):6.1%} {near / max(filled, 1):6.1%}")


def row(name: str, folder: Path) -> np.ndarray:
    """Print the row of one run; return how many cells were filled, right, and nearly so."""
    grid, scan_to_room = read_room(folder / "out" / "room.npz")
    truth = truth_in(grid, folder, scan_to_room)
    draft = SceneDraft(grid)
    floating = [len(one.cells) for one in find_floaters(draft, grid.labels.size)]
    before = count_occupancy(draft.labels, truth).iou
    planned = parse_command({"op": "fill_holes", "plane": "all"}).plan(draft, TOOLS)
    draft.apply(planned)
    wanted, cells = planned.after.labels, planned.cells
    around = np.clip(cells[:, None] + AROUND, 0, np.array(grid.shape) - 1)
    near = (kinds(truth[tuple(np.moveaxis(around, -1, 0))]) == wanted[:, None]).any(axis=1)
    exact = kinds(truth[tuple(cells.T)]) == wanted
    after = count_occupancy(draft.labels, truth).iou
    left = max(plane_gaps(draft, plane).share for plane in find_planes(draft))
    shares = f"{len(cells):7} {exact.mean():6.1%} {near.mean():6.1%}"
    print(f"{name:14} {shares} {before:.3f} > {after:.3f} {left:6.1%} {floating}")
    return np.array([len(cells), exact.sum(), near.sum()])


def kinds(labels: np.ndarray) -> np.ndarray:
    """Return labels with windows counted as the walls that they are in."""
    return np.where(labels == 4, 3, labels)


def truth_in(grid: OccupancyGrid, folder: Path, scan_to_room: np.ndarray) -> np.ndarray:
    """Return the truth of a run, uint8 [X, Y, Z], in its cells."""
    truth = truth_of_run(folder / "out", folder / "cap")
    truth_to_room = scan_to_room @ truth.truth_to_scan
    left, _, right = np.linalg.svd(truth_to_room[:3, :3])
    truth_to_room[:3, :3] = left @ right  # Without what rounding left of it.
    fine = (truth.labels, truth.voxel_m, truth.origin_m)
    return carry_truth(*fine, truth_to_room, grid.shape, grid.origin_m, grid.voxel_m)


if __name__ == "__main__":
    main()
