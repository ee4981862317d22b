"""Labellers side by side on the evidence of finished runs, up to the objects that are found.

``python -m benchmarks.compare_labellers RUN=CAPTURE [RUN=CAPTURE ...] [--weights FILE]
[--hint-share 0.9]``

RUN is a folder of ``w2m reconstruct``, CAPTURE the virtual scan with its truth. Each labeller
labels the same ``evidence.npz`` with and without its 2D votes, and ``find`` looks for objects in
what it says. Only cells that noise-free rays reached or crossed are scored.
"""

import argparse
import shutil
import tempfile
import time
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

from world2minecraft.evaluate.frames import truth_of_run, used_frames
from world2minecraft.evaluate.objects import object_counts, object_facts
from world2minecraft.evaluate.score import TrueRoom, cell_facts, see_truth
from world2minecraft.exchange.evidence import read_evidence, write_evidence
from world2minecraft.exchange.objects import read_objects
from world2minecraft.exchange.room import read_room
from world2minecraft.label import completion, completion_net
from world2minecraft.parameters import Parameters
from world2minecraft.steps import LATER_STEPS

FILES = ("scan.json", "evidence.npz")
COLUMNS = ("IoU", "mIoU", "present", "object F1", "calibration", "completed", "CPU s")


def scored(run: Path, truth: TrueRoom, name: str, voted: bool) -> dict[str, float] | None:
    """Return a row: one labeller on one run; None where votes are asked for and there are none."""
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        for file in FILES:
            shutil.copy(run / file, work)
        evidence = read_evidence(work / "evidence.npz")
        if voted and not evidence.votes.any():
            return None
        if not voted:
            without = replace(evidence, votes=np.zeros_like(evidence.votes))
            write_evidence(work / "evidence.npz", without)
        chosen = Parameters(labeller=name)
        start = time.process_time()
        LATER_STEPS["label"](work, chosen)
        spent = time.process_time() - start
        LATER_STEPS["find"](work, chosen)
        grid, _ = read_room(work / "room.npz")
        cells = cell_facts(grid, truth)
        found = object_counts(read_objects(work / "objects.json", grid), truth.objects)
    return {
        "IoU": cells["occupancy"]["iou"],
        "mIoU": cells["occupancy"]["miou"],
        "present": cells["occupancy"]["miou_present_classes"],
        "object F1": object_facts(found)["f1"],
        "calibration": cells["calibration"]["occupied"]["error"],
        "completed": float((grid.source == 2).sum()),
        "CPU s": spent,
    }


def main() -> None:
    """Print a row for each run and labeller, then the means."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("pairs", nargs="+", metavar="RUN=CAPTURE")
    parser.add_argument("--weights", type=Path)
    parser.add_argument("--hint-share", type=float, help="of the completion labeller")
    chosen = parser.parse_args()
    if chosen.weights:
        completion_net.WEIGHTS = chosen.weights
    if chosen.hint_share is not None:
        usual = partial(completion.CompletionParameters, hint_share=chosen.hint_share)
        completion.CompletionParameters = usual  # type: ignore[misc]
    table, rows = Table("run", "labeller", "votes", *COLUMNS, box=None), {}
    for pair in chosen.pairs:
        run, capture = (Path(text) for text in pair.split("="))
        known = truth_of_run(run, capture)
        grid, scan_to_room = read_room(run / "room.npz")
        truth = see_truth(known, used_frames(run, known), scan_to_room, grid.voxel_m)
        for name, voted in (
            ("geometric", False), ("completion", False), ("votes", True), ("completion", True),
        ):  # fmt: skip
            row = scored(run, truth, name, voted)
            if row is None:
                continue
            rows.setdefault((name, voted), []).append(row)
            said = (f"{row[column]:.3f}" for column in COLUMNS)
            table.add_row(capture.name, name, "yes" if voted else "no", *said)
    for (name, voted), found in rows.items():
        means = (f"{np.mean([row[column] for row in found]):.3f}" for column in COLUMNS)
        table.add_row("mean", name, "yes" if voted else "no", *means)
    Console(width=140).print(table)


if __name__ == "__main__":
    main()
