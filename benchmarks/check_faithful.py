"""The benchmark of fidelity: trials are scanned, reconstructed twice and scored.

``python -m benchmarks.check_faithful [--split tune] [--difficulty noise ...] [--trials N]
[--labels both] [--stages] [--keep DIR] [--json FILE] [--verbose]``

One table with the trials' label images (``labels``, a tenth of them wrong) and one without
(``none``), with a row for each difficulty (means over its trials) and the targets under it;
``--labels votes`` and ``geometric`` take these labellers in place of the usual one. ``clean`` are
the trials of ``noise`` without noise and jitter. With ``--keep`` what is there already is not made
again, so that a run that was cut off goes on; begin a new folder once rooms or stages have changed.
Seeds of ``--split test`` are for the last word alone: nobody tunes on them.
"""

import argparse
import shutil
import sys
import tempfile
import time
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console

from benchmarks.faithful_table import rows_table, stages_table, verdicts
from world2minecraft.evaluate import evaluate_reconstruction
from world2minecraft.evaluate.stages import allowed_cells, stage_losses
from world2minecraft.exchange.evidence import read_evidence, write_evidence
from world2minecraft.files import read_json, write_json
from world2minecraft.parameters import Parameters, with_settings
from world2minecraft.pipeline import reconstruct
from world2minecraft.rooms.trials import DIFFICULTIES, Trial, trials, write_trial

# How a trial is labelled: the labeller, and whether the label images are seen.
WAYS = {
    "labels": ("auto", True),
    "none": ("auto", False),
    "votes": ("votes", True),
    "geometric": ("geometric", False),
}
BOTH = ("labels", "none")
CLEAN = "clean"  # The noise trials, scanned without noise and jitter.


def chosen_trials(split: str, difficulties: Sequence[str], count: int) -> list[Trial]:
    """Return the first trials of each difficulty; ``clean`` are those of noise, made clean."""
    found = []
    for name in difficulties:
        if name == CLEAN:
            found += [trial.clean() for trial in trials(split, "noise")[:count]]  # type: ignore[arg-type]
        else:
            found += trials(split, name)[:count]  # type: ignore[arg-type]
    return found


def run_trial(
    trial: Trial, base: Path, ways: Sequence[str], settings: Sequence[str], stages: bool
) -> list[dict[str, Any]]:
    """Make what is missing of a trial; return one row of facts for each way to label it."""
    folder = base / trial.name
    capture = folder / "capture"
    begun = time.perf_counter()
    if not (capture / "truth.json").is_file():
        write_trial(trial, capture)
    rows = []
    for way in ways:
        path = folder / f"{way}.json"
        facts = read_json(path) if path.is_file() else {}
        if not facts:
            facts = _made(folder, way, settings)
        if stages and "stages" not in facts:
            facts["stages"] = stage_losses(folder / way, capture)
        if "seconds" not in facts:
            facts["seconds"] = round(time.perf_counter() - begun, 1)
        begun = time.perf_counter()
        write_json(path, facts)
        rows.append({"trial": trial.name, "labels": way, "difficulty": group(trial), **facts})
    return rows


def _made(folder: Path, way: str, settings: Sequence[str]) -> dict[str, Any]:
    """Reconstruct a trial in one way and score it.

    What comes before labels is the same for all ways, and taken from the first.
    """
    (labeller, voted), capture, out = WAYS[way], folder / "capture", folder / way
    chosen = with_settings(Parameters(labeller=labeller), list(settings))
    has_first = way != BOTH[0] and (folder / f"{BOTH[0]}.json").is_file()
    if has_first:
        shutil.copytree(folder / BOTH[0], out, dirs_exist_ok=True)
    else:
        reconstruct(capture, out, chosen)
    if not voted:
        evidence = read_evidence(out / "evidence.npz")
        silent = replace(evidence, votes=np.zeros_like(evidence.votes))
        write_evidence(out / "evidence.npz", silent)
    if has_first or not voted:
        reconstruct(capture, out, chosen, start="label")
    facts = evaluate_reconstruction(out, capture)
    if way == BOTH[0]:
        allowed = allowed_cells(out, capture)["occupancy"]["miou"]
        facts["allowed_miou"] = allowed
        facts["share_of_allowed"] = facts["occupancy"]["miou"] / allowed if allowed else 1.0
    return facts


def group(trial: Trial) -> str:
    """Return the row of the table that a trial belongs to."""
    return CLEAN if trial.name.endswith("-clean") else trial.difficulty


def main(words: Sequence[str]) -> int:
    """Run the trials that ``words`` ask for, print the tables and return the exit code."""
    chosen = _options(words)
    base = chosen.keep or Path(tempfile.mkdtemp())
    ways = BOTH if chosen.labels == "both" else (chosen.labels,)
    todo = chosen_trials(chosen.split, chosen.difficulty or (*DIFFICULTIES, CLEAN), chosen.trials)
    begun = time.perf_counter()
    jobs = [(trial, base, ways, chosen.set or [], chosen.stages) for trial in todo]
    rows: list[dict[str, Any]] = []
    if chosen.jobs > 1:
        with ProcessPoolExecutor(chosen.jobs) as pool:
            for found in pool.map(run_trial, *zip(*jobs, strict=True)):
                rows += found
    else:
        for job in jobs:
            rows += run_trial(*job)
            seconds = sum(row["seconds"] for row in rows[-len(ways) :])
            print(f"{job[0].name}: {seconds:.0f} s", file=sys.stderr, flush=True)
    minutes = (time.perf_counter() - begun) / 60
    console = Console(width=None if sys.stdout.isatty() else 190)
    for way in ways:
        mine = [row for row in rows if row["labels"] == way]
        console.print(rows_table(f"{way}, split {chosen.split}", mine, chosen.verbose))
        for line in verdicts(way, mine):
            console.print(line)
        if chosen.stages:
            console.print(stages_table(f"{way}, what is left to lose", mine))
    console.print(f"{len(todo)} trials in {minutes:.1f} minutes, kept in {base}")
    if chosen.json:
        write_json(chosen.json, rows)
    return 0


def _options(words: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.check_faithful", description=(__doc__ or "").splitlines()[0]
    )
    parser.add_argument("--split", choices=("tune", "test"), default="tune")
    parser.add_argument("--difficulty", nargs="+", choices=(*DIFFICULTIES, CLEAN))
    parser.add_argument("--trials", type=int, default=10, help="of each difficulty")
    parser.add_argument("--labels", choices=(*WAYS, "both"), default="both")
    parser.add_argument("--jobs", type=int, default=1, help="trials at a time")
    parser.add_argument("--stages", action="store_true", help="what each stage loses, too")
    parser.add_argument("--keep", type=Path, help="the folder to work in, and to go on from")
    parser.add_argument("--json", type=Path, help="write all figures to this file")
    parser.add_argument("--set", action="append", metavar="KEY=VALUE", help="a parameter")
    parser.add_argument("--verbose", action="store_true", help="a row for each trial")
    return parser.parse_args(words)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
