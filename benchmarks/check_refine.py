"""Number of editing operations from a raw reconstruction, and from an empty grid, to the truth.

``python -m benchmarks.check_refine [--seeds 550-564] [--labels] [--only raw] [--work FOLDER]``

Each room is generated, scanned with the virtual depth camera (default noise, 40 frames) and
reconstructed, from depth and colour alone or, with ``--labels``, from label images of which a tenth
is wrong too. Then a script refines it through ``Editor`` (``refinement`` defines its operations and
when a scene is done). The folder contains the reconstructions and the scenes with their journals,
which ``w2m forge stats`` reads. Seeds 500 to 549 are for tuning, 1000 to 1049 and 2000 to 2019 are
reserved for tests.
"""

import argparse
import shutil
import tempfile
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

from benchmarks.refinement import (
    MOST_GESTURES,
    Wanted,
    agreement,
    defects_of,
    next_gesture,
    wanted_of,
)
from world2minecraft.core.files import write_json
from world2minecraft.core.types import OBSERVED, OccupancyGrid
from world2minecraft.formats.objects_and_placements import write_objects, write_placements
from world2minecraft.formats.run_arrays import read_room, write_room
from world2minecraft.procgen import BASE_KINDS, generate_room, scan_room
from world2minecraft.reconstruction.parameters import Parameters
from world2minecraft.reconstruction.pipeline import reconstruct
from world2minecraft.sceneforge.document.document_metadata import document_folder
from world2minecraft.sceneforge.editor import Editor

LABEL_ERROR = 0.1
KINDS_COUNTED = ("add", "delete", "orient", "move", "relabel", "other")
STARTS = ("raw", "empty")
TARGET, PAPER, PAPER_EMPTY = 10.0, 24.5, "the paper 340"


@dataclass(frozen=True)
class Refined:
    """One scene: what was done, what was wrong before and after, how right its cells were."""

    seed: int
    start: str  # raw, or empty
    gestures: tuple[dict[str, Any], ...]
    counted: dict[str, int]
    wrong: tuple[int, int]
    right: tuple[float, float]

    def row(self) -> dict[str, Any]:
        """Return it as JSON values."""
        kinds = dict(Counter(one["op"] for one in self.gestures))
        told = {"wrong": list(self.wrong), "cells_right": [round(v, 4) for v in self.right]}
        facts = {"seed": self.seed, "start": self.start, "operations": len(self.gestures)}
        counts = {"counted": self.counted, "commands": kinds, "script": list(self.gestures)}
        return facts | told | counts


def reconstructed(seed: int, work: Path, labels: bool) -> tuple[Path, Path]:
    """Return the run and the capture of a seed; both are made where they are missing."""
    capture, run = work / str(seed) / "capture", work / str(seed) / ("run" if labels else "geo")
    if not (capture / "truth.npz").is_file():
        room = generate_room(seed, kind=sorted(BASE_KINDS)[seed % len(BASE_KINDS)])
        known = {"with_labels": True, "label_error": LABEL_ERROR}
        scan_room(room, capture, frames=40, seed=seed, **known)
    if not (run / "placements.json").is_file():
        reconstruct(capture, run, Parameters(labeller="votes" if labels else "geometric"))
    return run, capture


def scene_of(run: Path, folder: Path, empty: bool) -> Path:
    """Return a folder with a copy of a run's scene, or with its grid seen to be empty."""
    for old in (folder, document_folder(folder)):
        shutil.rmtree(old, ignore_errors=True)
    folder.mkdir(parents=True)
    if not empty:
        for name in ("room.npz", "objects.json", "placements.json", "layout.json", "scan.json"):
            if (run / name).is_file():
                shutil.copy(run / name, folder / name)
        return folder
    grid, scan_to_room = read_room(run / "room.npz")
    nothing = OccupancyGrid(
        labels=np.zeros_like(grid.labels),
        confidence=np.ones_like(grid.confidence),
        colour=np.zeros_like(grid.colour),
        source=np.full_like(grid.source, OBSERVED),
        instance=np.zeros_like(grid.instance),
        voxel_m=grid.voxel_m,
        origin_m=grid.origin_m,
    )
    write_room(folder / "room.npz", nothing, scan_to_room)
    write_objects(folder / "objects.json", ())
    write_placements(folder / "placements.json", ())
    return folder


def refine(scene: Path, wanted: Wanted, seed: int, start: str) -> Refined:
    """Refine a scene through the editor until nothing is wrong, or nothing helps."""
    editor = Editor.open(scene)
    before, right = defects_of(editor.draft, wanted).total, agreement(editor.draft, wanted)
    done: list[dict[str, Any]] = []
    counted: Counter[str] = Counter()
    while len(done) < MOST_GESTURES:
        gesture = next_gesture(editor.draft, editor.tools, wanted)
        if gesture is None:
            break
        counted[editor.do(actor="script", **gesture).counts_as] += 1
        done.append(gesture)
    after = defects_of(editor.draft, wanted).total
    both = (right, agreement(editor.draft, wanted))
    editor.save()
    editor.close()
    counts = {name: counted[name] for name in KINDS_COUNTED}
    return Refined(seed, start, tuple(done), counts, (before, after), both)


def table_of(rows: list[Refined]) -> Table:
    """Return the table: a row for each scene, and the means."""
    table = Table("seed", "from", "wrong", "operations", *KINDS_COUNTED, "left", "cells right")
    for start in STARTS:
        mine = [row for row in rows if row.start == start]
        for row in mine:
            cells = f"{row.right[0]:.3f} to {row.right[1]:.3f}"
            counts = [str(row.counted[name]) for name in KINDS_COUNTED]
            count = str(len(row.gestures))
            table.add_row(
                str(row.seed), start, str(row.wrong[0]), count, *counts, str(row.wrong[1]), cells
            )
        if mine:
            means = [np.mean([row.counted[name] for row in mine]) for name in KINDS_COUNTED]
            whole = np.mean([len(row.gestures) for row in mine])
            done = sum(row.wrong[1] == 0 for row in mine)
            table.add_row(
                "mean", start, f"{np.mean([row.wrong[0] for row in mine]):.1f}", f"{whole:.1f}",
                *(f"{value:.1f}" for value in means), f"{done} of {len(mine)} done",
                " to ".join(f"{np.mean([row.right[n] for row in mine]):.3f}" for n in (0, 1)),
            )  # fmt: skip
    return table


def main() -> None:
    """Refine the scenes of the seeds that are asked for, and print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--seeds", default="550-564", help="such as 550-564 or 503,507")
    parser.add_argument("--labels", action="store_true", help="reconstruct with label images")
    parser.add_argument("--only", choices=STARTS, help="leave out the other start")
    parser.add_argument("--work", type=Path, help="keeps reconstructions and scenes")
    parser.add_argument("--json", type=Path, help="where every gesture is written")
    chosen = parser.parse_args()
    work = chosen.work or Path(tempfile.mkdtemp(prefix="w2m-refine-"))
    console, rows = Console(width=150), []
    for seed in seeds_of(chosen.seeds):
        run, capture = reconstructed(seed, work, chosen.labels)
        wanted = wanted_of(run, capture)
        for start in (chosen.only,) if chosen.only else STARTS:
            folder = work / "scenes" / f"{run.name}-{start}-{seed}"
            rows.append(refine(scene_of(run, folder, start == "empty"), wanted, seed, start))
            told = ", ".join(one["op"] for one in rows[-1].gestures)
            console.print(f"{seed} {start}: {len(rows[-1].gestures)} ({told})", highlight=False)
    console.print(table_of(rows))
    for start, other in zip(
        STARTS, (f"target {TARGET:g}, the paper {PAPER}", PAPER_EMPTY), strict=True
    ):
        counts = [len(row.gestures) for row in rows if row.start == start]
        if counts:
            console.print(f"{start}: {np.mean(counts):.1f} operations a scene ({other})")
    console.print(f"the scenes lie in {work / 'scenes'}")
    if chosen.json:
        write_json(chosen.json, [row.row() for row in rows])


def seeds_of(text: str) -> list[int]:
    """Return the seeds of a list of numbers and ranges, such as ``503,550-564``."""
    parts = [part.partition("-") for part in text.split(",")]
    return [n for a, dash, b in parts for n in range(int(a), int(b if dash else a) + 1)]


if __name__ == "__main__":
    main()
